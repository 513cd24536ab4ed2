//! One call of the C ABI, with every input and output. Outputs have sentinel values before the call, so that any write shows.

use std::ffi::CStr;
use std::ptr::{null, null_mut};

use contact_normal::ffi::*;

/// The numbers of elements of the scene in x and y.
pub const MX: usize = 6;
pub const MY: usize = 5;
const N: usize = MX * MY;
/// The table has more offsets than the grid.
pub const CX: usize = 8;
pub const CY: usize = 7;
/// The value of outputs before a call, which no solution has.
const SENTINEL: f64 = -12345.678;
const SENTINEL_CONTACT: i32 = -77;

/// A struct of a later version, with members that this version does not know.
#[repr(C)]
pub struct Grown<T> {
    pub known: T,
    pub excess: [u8; 64],
}

impl<T> Grown<T> {
    fn new(known: T) -> Box<Self> {
        Box::new(Grown { known, excess: [0; 64] })
    }

    fn bytes(&self) -> Vec<u8> {
        // SAFETY: the structs of the ABI have no padding (tests/clients/python.rs compares all offsets).
        unsafe { std::slice::from_raw_parts((self as *const Self).cast::<u8>(), size_of::<Self>()) }.to_vec()
    }
}

/// The functions of the library that a row of bad input is passed to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Through {
    Solve,
    SolverNew,
    SolverSolve,
    /// The call is the only problem of a batch.
    SolverSolveBatch,
    /// The handle that the call makes is freed again.
    ToAccuracy,
}

/// The arguments of a call. `Call::new` gives valid ones.
pub struct Call {
    pub scene: Box<Grown<contact_normal_scene>>,
    pub influence: Box<Grown<contact_normal_influence>>,
    pub layer: Box<Grown<contact_normal_layer>>,
    pub limit: Box<Grown<contact_normal_pressure_limit>>,
    pub period: Box<Grown<contact_normal_period>>,
    pub patches: Box<Grown<contact_normal_patches>>,
    pub row_tables: Box<Grown<contact_normal_row_tables>>,
    pub friction: Box<Grown<contact_normal_friction>>,
    /// The tables of tangential coefficients: xx, yy, xy.
    pub tangential: Box<[contact_normal_influence; 3]>,
    pub tangential_rows: Box<[contact_normal_row_tables; 3]>,
    pub cycle: Box<Grown<contact_normal_cycle>>,
    pub options: Box<Grown<contact_normal_options>>,
    pub fields: Box<Grown<contact_normal_fields>>,
    pub report: Box<Grown<contact_normal_report>>,
    pub accuracy: Box<Grown<contact_normal_accuracy>>,
    pub h: Vec<f64>,
    pub table: Vec<f64>,
    /// Row tables: one table for each loaded row.
    pub tables: Vec<f64>,
    /// One value per element, for a layer or for limits.
    pub each: Vec<f64>,
    /// The patch of each element.
    pub patch: Vec<i32>,
    pub factors: Box<[f64; 4]>,
    pub pressure: Vec<f64>,
    pub contact: Vec<i32>,
    /// The name of the argument that is passed as NULL.
    pub without: &'static str,
    /// The status of the only problem of a batch.
    status: i32,
    others: Vec<f64>,
    ledger: Vec<contact_normal_ledger_row>,
    handle: *mut contact_normal_solver,
}

/// A `T` as its `_init` function leaves it.
pub fn initialised<T>(init: unsafe extern "C" fn(*mut T)) -> T {
    let mut value = std::mem::MaybeUninit::uninit();
    // SAFETY: `_init` fills a whole struct.
    unsafe {
        init(value.as_mut_ptr());
        value.assume_init()
    }
}

impl Call {
    /// A ball on a plane, with a prescribed approach. All outputs are wanted.
    pub fn new() -> Call {
        let mut call = Call {
            scene: Grown::new(initialised(contact_normal_scene_init)),
            influence: Grown::new(initialised(contact_normal_influence_init)),
            layer: Grown::new(initialised(contact_normal_layer_init)),
            limit: Grown::new(initialised(contact_normal_pressure_limit_init)),
            period: Grown::new(initialised(contact_normal_period_init)),
            patches: Grown::new(initialised(contact_normal_patches_init)),
            row_tables: Grown::new(initialised(contact_normal_row_tables_init)),
            friction: Grown::new(initialised(contact_normal_friction_init)),
            tangential: Box::new([contact_normal_influence::default(); 3]),
            tangential_rows: Box::new([contact_normal_row_tables::default(); 3]),
            cycle: Grown::new(initialised(contact_normal_cycle_init)),
            options: Grown::new(initialised(contact_normal_options_init)),
            fields: Grown::new(initialised(contact_normal_fields_init)),
            report: Grown::new(initialised(contact_normal_report_init)),
            accuracy: Grown::new(initialised(contact_normal_accuracy_init)),
            h: (0..N)
                .map(|i| 0.01 * ((i % MX) as f64 - 2.5).powi(2) + 0.02 * ((i / MX) as f64 - 2.0).powi(2))
                .collect(),
            table: vec![0.0; 4 * CX * CY],
            tables: Vec::new(),
            each: vec![1.0; N],
            patch: (0..N).map(|i| (2 * (i % MX) / MX) as i32).collect(),
            factors: Box::new([1.0, 0.5, 0.5, 1.0]),
            pressure: vec![SENTINEL; N],
            contact: vec![SENTINEL_CONTACT; N],
            without: "",
            status: SENTINEL_CONTACT,
            others: vec![SENTINEL; 2 * N],
            ledger: vec![contact_normal_ledger_row { mx: SENTINEL_CONTACT, ..Default::default() }; 4],
            handle: null_mut(),
        };
        let scene = &mut call.scene.known;
        (scene.mx, scene.my, scene.dx, scene.dy) = (MX as i32, MY as i32, 0.5, 0.25);
        (scene.shear_modulus, scene.poisson_ratio) = ([82000.0; 2], [0.28; 2]);
        (scene.load, scene.approach, scene.force) = (CONTACT_NORMAL_PRESCRIBED_APPROACH, 0.03, 100.0);
        scene.undeformed_distance = call.h.as_ptr();
        let (g, nu) = (scene.shear_modulus.as_ptr(), scene.poisson_ratio.as_ptr());
        let (cx, cy) = (CX as i32, CY as i32);
        // SAFETY: room for 2 cy by 2 cx values.
        let status = unsafe { contact_normal_influence_half_space(cx, cy, 0.5, 0.25, g, nu, call.table.as_mut_ptr()) };
        assert_eq!(status, CONTACT_NORMAL_OK);
        (call.influence.known.cx, call.influence.known.cy) = (cx, cy);
        call.influence.known.coefficients = call.table.as_ptr();
        let rows = (0..MY * MY).map(|k| (CY + k % MY - k / MY) * 2 * CX);
        call.tables = rows.flat_map(|start| call.table[start..start + 2 * CX].to_vec()).collect();
        (call.row_tables.known.cx, call.row_tables.known.rows) = (cx, MY as i32);
        call.row_tables.known.coefficients = call.tables.as_ptr();
        let fields = &mut call.fields.known;
        (fields.pressure, fields.contact) = (call.pressure.as_mut_ptr(), call.contact.as_mut_ptr());
        fields.deformed_distance = call.others.as_mut_ptr();
        fields.displacement = call.others[N..].as_mut_ptr();
        let report = &mut call.report.known;
        (report.ledger, report.ledger_capacity) = (call.ledger.as_mut_ptr(), call.ledger.len() as i64);
        (report.normal.force, report.statistics.cycles) = (SENTINEL, -77);
        (call.accuracy.known.target, call.accuracy.known.reached) = (0.05, SENTINEL);
        call
    }

    /// Sets the table of coefficients in the scene, and returns it for changes.
    pub fn use_table(&mut self) -> &mut contact_normal_influence {
        self.scene.known.influence = &raw const self.influence.known;
        &mut self.influence.known
    }

    /// Sets row tables in the scene, and returns them for changes.
    pub fn use_row_tables(&mut self) -> &mut contact_normal_row_tables {
        self.scene.known.row_tables = &raw const self.row_tables.known;
        &mut self.row_tables.known
    }

    /// Sets the cycle in the options, and returns it for changes.
    pub fn use_cycle(&mut self) -> &mut contact_normal_cycle {
        self.options.known.cycle = &raw const self.cycle.known;
        &mut self.cycle.known
    }

    /// Sets friction in the scene, a shift with the coefficient 0.3, and returns it for changes.
    pub fn use_friction(&mut self) -> &mut contact_normal_friction {
        self.scene.known.friction = &raw const self.friction.known;
        (self.friction.known.coefficient, self.friction.known.creepage) = (0.3, [1e-3, 0.0]);
        &mut self.friction.known
    }

    /// Sets friction with tables of tangential coefficients: the table of the call for xx and yy, and 0 for xy.
    pub fn use_tangential_tables(&mut self) -> &mut contact_normal_friction {
        self.tables.clear();
        self.tables.resize(4 * CX * CY, 0.0);
        let (table, zeros) = (self.table.as_ptr(), self.tables.as_ptr());
        for (own, coefficients) in self.tangential.iter_mut().zip([table, table, zeros]) {
            (own.cx, own.cy, own.coefficients) = (CX as i32, CY as i32, coefficients);
        }
        let influence = [0, 1, 2].map(|k: usize| &raw const self.tangential[k]);
        let friction = self.use_friction();
        friction.influence = influence;
        friction
    }

    /// Sets friction with row tables of tangential coefficients, made of the table of the call.
    pub fn use_tangential_row_tables(&mut self) -> &mut contact_normal_friction {
        let count = MY * MY * 2 * CX;
        self.tables.clear();
        for k in 0..MY * MY {
            let row = (CY + k % MY - k / MY) * 2 * CX;
            self.tables.extend_from_slice(&self.table[row..row + 2 * CX]);
        }
        self.tables.resize(2 * count, 0.0);
        let (rows, zeros) = (self.tables.as_ptr(), self.tables[count..].as_ptr());
        for (own, coefficients) in self.tangential_rows.iter_mut().zip([rows, rows, zeros]) {
            (own.cx, own.rows, own.coefficients) = (CX as i32, MY as i32, coefficients);
        }
        let row_tables = [0, 1, 2].map(|k: usize| &raw const self.tangential_rows[k]);
        let friction = self.use_friction();
        friction.row_tables = row_tables;
        friction
    }

    /// Sets the coefficient of row tables for the loaded row `jy`, the row `iy` and the offset kx.
    pub fn set_in_row(&mut self, jy: usize, iy: usize, kx: i64, value: f64) {
        self.use_row_tables();
        self.tables[(jy * MY + iy) * 2 * CX + (kx + CX as i64) as usize] = value;
    }

    /// Sets a layer in the scene, and returns it for changes.
    pub fn use_layer(&mut self) -> &mut contact_normal_layer {
        self.scene.known.layer = &raw const self.layer.known;
        &mut self.layer.known
    }

    /// Sets a limit of the pressures in the scene, and returns it for changes.
    pub fn use_limit(&mut self) -> &mut contact_normal_pressure_limit {
        self.scene.known.pressure_limit = &raw const self.limit.known;
        &mut self.limit.known
    }

    /// Sets the periods of the scene.
    pub fn use_period(&mut self, x: i32, y: i32) {
        self.scene.known.period = &raw const self.period.known;
        (self.period.known.x, self.period.known.y) = (x, y);
    }

    /// Sets two patches side by side with these factors.
    pub fn use_patches(&mut self, factors: [f64; 4]) -> &mut contact_normal_patches {
        // The factors are on the heap, because a call may be moved.
        *self.factors = factors;
        let patches = &mut self.patches.known;
        (patches.count, patches.patch, patches.factors) = (2, self.patch.as_ptr(), self.factors.as_ptr());
        self.scene.known.patches = &raw const self.patches.known;
        &mut self.patches.known
    }

    /// Gives the layer one compliance per element, and sets that of element i to `value`.
    pub fn set_compliance(&mut self, i: usize, value: f64) {
        self.each[i] = value;
        self.use_layer().compliances = self.each.as_ptr();
    }

    /// Gives the pressure limit one value per element, and sets that of element i to `value`.
    pub fn set_limit(&mut self, i: usize, value: f64) {
        self.each[i] = value;
        self.use_limit().limits = self.each.as_ptr();
    }

    /// Sets the coefficient of the table at an offset.
    pub fn set_coefficient(&mut self, kx: i64, ky: i64, value: f64) {
        self.use_table();
        self.table[(ky + CY as i64) as usize * 2 * CX + (kx + CX as i64) as usize] = value;
    }

    /// Fixes the contact area. It has all elements unless the test changes `contact`.
    pub fn fix_contact(&mut self) {
        self.options.known.active_set = CONTACT_NORMAL_ACTIVE_SET_FIXED;
        self.contact.fill(1);
    }

    /// Makes the call, and returns its status and message.
    pub fn run(&mut self, through: Through, handle: *mut contact_normal_solver) -> (i32, String) {
        let scene = if self.without == "scene" { null() } else { &raw const self.scene.known };
        let options = if self.without == "options" { null() } else { &raw const self.options.known };
        let fields = if self.without == "fields" { null_mut() } else { &raw mut self.fields.known };
        let report = if self.without == "report" { null_mut() } else { &raw mut self.report.known };
        let accuracy = if self.without == "accuracy" { null_mut() } else { &raw mut self.accuracy.known };
        // SAFETY: pointers to structs with room for what they declare; a wrong size or NULL is what is tested.
        unsafe {
            let status = match through {
                Through::Solve => contact_normal_solve(scene, options, fields, report),
                Through::SolverNew => contact_normal_solver_new(scene, options, &raw mut self.handle),
                Through::SolverSolve => contact_normal_solver_solve(handle, scene, options, fields, report),
                Through::SolverSolveBatch => {
                    let status = &raw mut self.status;
                    let returned = contact_normal_solver_solve_batch(handle, 1, scene, options, fields, report, status);
                    // The status of the problem is not written if the call itself is refused.
                    assert!(self.status == SENTINEL_CONTACT || self.status == returned);
                    returned
                }
                Through::ToAccuracy => {
                    let made = &raw mut self.handle;
                    let status = contact_normal_solve_to_accuracy(scene, options, accuracy, made, report);
                    if status >= CONTACT_NORMAL_OK {
                        contact_normal_solver_free(std::mem::replace(&mut self.handle, null_mut()));
                    }
                    status
                }
            };
            // After the status OK `contact_normal_last_error` still has the message of an earlier call.
            (status, if status == CONTACT_NORMAL_OK { String::new() } else { last_error() })
        }
    }

    /// A handle for this scene.
    pub fn new_handle(&mut self) -> *mut contact_normal_solver {
        let (status, message) = self.run(Through::SolverNew, null_mut());
        assert_eq!(status, CONTACT_NORMAL_OK, "{message}");
        std::mem::replace(&mut self.handle, null_mut())
    }

    /// Every byte that a call may write.
    pub fn outputs(&self) -> Vec<u8> {
        let mut bytes = [self.fields.bytes(), self.report.bytes(), self.accuracy.bytes()].concat();
        bytes.extend((self.handle as usize).to_ne_bytes());
        bytes.extend(self.pressure.iter().chain(&self.others).flat_map(|value| value.to_ne_bytes()));
        bytes.extend(self.contact.iter().flat_map(|value| value.to_ne_bytes()));
        for row in &self.ledger {
            // SAFETY: 4-byte and 8-byte members without padding.
            let size = size_of::<contact_normal_ledger_row>();
            bytes.extend(unsafe {
                std::slice::from_raw_parts((row as *const contact_normal_ledger_row).cast::<u8>(), size)
            });
        }
        bytes
    }

    /// Asserts that a valid call wrote every output. Otherwise equal `outputs` before and after a refusal would show nothing.
    pub fn assert_all_written(&self) {
        assert!(self.pressure.iter().chain(&self.others).all(|&value| value != SENTINEL));
        assert!(self.contact.iter().all(|&value| value == 0 || value == 1));
        assert!(self.report.known.normal.force != SENTINEL && self.report.known.statistics.cycles >= 0);
        assert!(self.ledger[0].mx > 0);
    }
}

/// The message of the last call on this thread.
pub fn last_error() -> String {
    // SAFETY: never NULL, valid until the next call.
    unsafe { CStr::from_ptr(contact_normal_last_error()) }.to_str().expect("UTF-8").to_owned()
}
