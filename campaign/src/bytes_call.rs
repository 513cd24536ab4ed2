//! A call of the library whose scene, options, guesses and effects are made from random bytes, and the checks of its result.

use std::ffi::CStr;
use std::ptr::null;

use contact_normal::ffi::*;

use crate::bytes_friction::Sliding;
use crate::bytes_reader::{Bytes, Target, ROOM, SENTINEL, SENTINEL_CONTACT};
use crate::call::Outputs;
use crate::case::{Case, How};
use crate::effect_structs::{effect_structs, EffectStructs};
use crate::effects::{Effects, Patches, UserCoefficients, Values};
use crate::friction_place::{Place, Stop};
use crate::grid::{Grid, Load};
use crate::init::initialised;
use crate::rules::is_true;

/// All inputs and outputs of a call. Arrays have room for [`ROOM`] elements.
pub struct Call {
    /// Undeformed distances.
    h: Vec<f64>,
    /// A table of influence coefficients.
    table: Vec<f64>,
    pressure: Vec<f64>,
    pub contact: Vec<i32>,
    displacement: Vec<f64>,
    pub scene: contact_normal_scene,
    /// The struct of `table`.
    influence: contact_normal_influence,
    /// The other effects.
    effects: Effects,
    /// The structs of these effects, to which the scene points.
    structs: Box<EffectStructs>,
    /// Deformed distances.
    distance: Vec<f64>,
    /// Friction, if the scene has it.
    sliding: Option<Box<Sliding>>,
    cycle: Box<contact_normal_cycle>,
    pub options: contact_normal_options,
    pub fields: contact_normal_fields,
    pub report: contact_normal_report,
}

impl Call {
    /// Makes the inputs of a call from bytes.
    pub fn new(bytes: &mut Bytes<'_>, target: Target) -> Box<Call> {
        let mut call = Box::new(Call {
            h: Vec::new(),
            table: Vec::new(),
            pressure: Vec::new(),
            contact: Vec::new(),
            displacement: vec![SENTINEL; ROOM],
            scene: initialised(contact_normal_scene_init),
            influence: initialised(contact_normal_influence_init),
            effects: Effects::default(),
            structs: effect_structs(&Effects::default()),
            distance: vec![SENTINEL; ROOM],
            sliding: None,
            cycle: Box::default(),
            options: initialised(contact_normal_options_init),
            fields: initialised(contact_normal_fields_init),
            report: initialised(contact_normal_report_init),
        });
        let scene = &mut call.scene;
        (scene.mx, scene.my) = (bytes.size(), bytes.size());
        (scene.dx, scene.dy) = (bytes.sometimes(0.5), bytes.sometimes(0.25));
        scene.shear_modulus = [bytes.sometimes(1.0), bytes.sometimes(f64::INFINITY)];
        scene.poisson_ratio = [bytes.sometimes(0.3), bytes.sometimes(0.0)];
        (scene.load, scene.reserved) = (bytes.integer(2).wrapping_add(1), i32::from(bytes.byte() == 77));
        (scene.approach, scene.force) = (bytes.number(), bytes.number());
        call.set_options(bytes);
        let n = if call.has_room() { (call.scene.mx * call.scene.my) as usize } else { 0 };
        call.h = (0..ROOM).map(|i| if i < n { bytes.number() } else { 0.0 }).collect();
        let given = call.options.initial_guess == CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
        call.pressure = (0..ROOM).map(|i| if given && i < n { bytes.number() } else { SENTINEL }).collect();
        let fixed = call.options.active_set == CONTACT_NORMAL_ACTIVE_SET_FIXED;
        let chosen = given || fixed;
        call.contact = (0..ROOM).map(|i| if chosen && i < n { bytes.integer(2) } else { SENTINEL_CONTACT }).collect();
        call.scene.undeformed_distance = if bytes.byte() == 99 { null() } else { call.h.as_ptr() };
        call.fields.pressure = call.pressure.as_mut_ptr();
        call.fields.contact = call.contact.as_mut_ptr();
        call.fields.displacement = call.displacement.as_mut_ptr();
        call.fields.deformed_distance = call.distance.as_mut_ptr();
        if target == Target::Table {
            call.set_table(bytes);
        }
        for size in [&mut call.scene.struct_size, &mut call.options.struct_size, &mut call.fields.struct_size] {
            if bytes.byte() == 99 {
                // The size becomes a smaller one. With a larger one the library would read beyond the end of the struct, which is an error of the
                // caller.
                *size = (*size).min(bytes.word() as i64);
            }
        }
        call.set_effects(bytes);
        // Friction comes after the effects. It cuts the sizes of its structs for the same reason.
        if target == Target::Friction || bytes.byte() % 2 == 1 {
            let mut sliding = Box::new(Sliding::new(bytes, n, &mut call.scene));
            sliding.point_from(&mut call.fields);
            call.scene.friction = &raw const sliding.input;
            call.sliding = Some(sliding);
        }
        call
    }

    /// Makes the options of the solve from bytes.
    fn set_options(&mut self, bytes: &mut Bytes<'_>) {
        let options = &mut self.options;
        let cycle = &mut self.cycle;
        (options.method, cycle.smoother) = (bytes.integer(5), bytes.integer(5));
        (cycle.pre_sweeps, cycle.post_sweeps) = (bytes.integer(4), bytes.integer(4));
        cycle.relaxation = bytes.sometimes(0.0);
        cycle.coarsest = 1 + bytes.integer(8).min(1000);
        options.cycle = &raw const **cycle;
        (options.active_set, options.initial_guess) = (bytes.integer(2), bytes.integer(3));
        options.tolerance = bytes.sometimes(1e-6);
        (options.criterion, options.precision) = (bytes.integer(2), bytes.integer(3));
        options.error_ratio = bytes.sometimes(0.0);
        // Few cycles, so that a solve is short. Other tests have values out of range (tests/abi/bad_input.rs).
        options.max_cycles = bytes.integer(200).min(200);
        options.threads = 1;
    }

    /// Whether the arrays are as long as the grid. Otherwise the call must be refused before they are read.
    fn has_room(&self) -> bool {
        let (mx, my) = (i64::from(self.scene.mx), i64::from(self.scene.my));
        mx > 0 && my > 0 && mx * my <= ROOM as i64
    }

    /// Whether the call may be made: the arrays have room for the grid, or the library refuses the grid before it reads them.
    pub fn may_be_tried(&self) -> bool {
        let (mx, my) = (i64::from(self.scene.mx), i64::from(self.scene.my));
        self.has_room() || mx <= 0 || my <= 0 || mx * my > i64::from(i32::MAX)
    }

    /// Adds a table with the coefficients of the half-space, some of which are replaced by arbitrary numbers.
    fn set_table(&mut self, bytes: &mut Bytes<'_>) {
        let (cx, cy) = (self.scene.mx.clamp(1, 16), self.scene.my.clamp(1, 16));
        self.table = vec![0.0; (4 * cx * cy) as usize];
        let (g, nu) = ([1.0, f64::INFINITY], [0.3, 0.0]);
        // SAFETY: two values each, and room for 2 cy by 2 cx.
        let status = unsafe {
            contact_normal_influence_half_space(cx, cy, 0.5, 0.25, g.as_ptr(), nu.as_ptr(), self.table.as_mut_ptr())
        };
        assert_eq!(status, CONTACT_NORMAL_OK);
        for _ in 0..bytes.byte() % 32 {
            let at = bytes.word() as usize % self.table.len();
            self.table[at] = bytes.number();
        }
        (self.influence.cx, self.influence.cy) = (cx, cy);
        self.influence.coefficients = self.table.as_ptr();
        self.scene.influence = &raw const self.influence;
    }

    /// Adds the other effects that the bits of a byte select, with usual or arbitrary values. This byte is read after those of the scene, so that the
    /// older, shorter strings of bytes of the corpus have no such effects.
    fn set_effects(&mut self, bytes: &mut Bytes<'_>) {
        let selected = bytes.byte();
        let n = self.h.len();
        let values = |bytes: &mut Bytes<'_>, usual: f64| match bytes.byte() % 2 {
            0 => Values::Uniform(bytes.sometimes(usual)),
            _ => Values::PerElement((0..n).map(|_| bytes.sometimes(usual)).collect()),
        };
        if selected & 1 != 0 {
            self.effects.layer = Some(values(bytes, 0.3));
        }
        if selected & 2 != 0 {
            self.effects.limit = Some(values(bytes, 0.2));
        }
        if selected & 12 == 4 {
            let count = 1 + usize::from(bytes.byte() % 3);
            let patch = (0..n).map(|_| bytes.integer(count as u8)).collect();
            let mut factors: Vec<f64> = (0..count * count).map(|_| bytes.sometimes(0.5)).collect();
            (0..count).for_each(|a| factors[a * count + a] = bytes.sometimes(1.0));
            self.effects.patches = Some(Patches { count, patch, factors });
        }
        if selected & 48 == 16 && self.has_room() {
            self.set_row_tables(bytes);
        }
        self.structs = effect_structs(&self.effects);
        let scene = &mut self.scene;
        self.structs.point_from(scene, &self.effects);
        if selected & 192 == 64 {
            (self.structs.period.x, self.structs.period.y) = (bytes.integer(2), bytes.integer(2));
            self.effects.period = Some((self.structs.period.x != 0, self.structs.period.y != 0));
            scene.period = &raw const self.structs.period;
            // For slender elements the campaign needs many waves. (tests/problems/coefficients.rs has slender elements with periods.)
            let ratio = scene.dx / scene.dy;
            if ratio.is_finite() && !(1e-2..1e2).contains(&ratio) {
                scene.dy = scene.dx;
            }
        }
        if self.influence.cx > 0 {
            let (cx, cy) = (self.influence.cx as usize, self.influence.cy as usize);
            self.effects.influence = Some(UserCoefficients { cx, cy, values: self.table.clone() });
            scene.influence = &raw const self.influence;
        }
    }

    /// Adds row tables with the coefficients of the half-space, some of which are replaced by arbitrary numbers.
    fn set_row_tables(&mut self, bytes: &mut Bytes<'_>) {
        let (cx, my) = (self.scene.mx as usize, self.scene.my as usize);
        let quadrant = crate::half_space::free(cx + 1, my, 0.5, 0.25, 0.2);
        let rows = (0..my * my).flat_map(|k| (-(cx as i64)..cx as i64).map(move |kx| (kx, (k % my).abs_diff(k / my))));
        let mut values: Vec<f64> = rows.map(|(kx, ky)| quadrant.at(kx, ky as i64)).collect();
        for _ in 0..bytes.byte() % 8 {
            let at = bytes.word() as usize % values.len();
            values[at] = bytes.number();
        }
        self.effects.row_tables = Some(UserCoefficients { cx, cy: my, values });
    }

    /// All outputs of a call, as bits.
    pub fn outputs(&self) -> Vec<u64> {
        let numbers = self.pressure.iter().chain(&self.displacement).chain(&self.distance).map(|value| value.to_bits());
        let report = [self.report.normal.force.to_bits(), self.report.statistics.cycles as u64];
        let sliding = self.sliding.iter().flat_map(|sliding| sliding.outputs());
        numbers.chain(self.contact.iter().map(|&c| c as u64)).chain(report).chain(sliding).collect()
    }

    /// Checks the result of a call. `before` has the outputs before it, and `fixed` the contact area that was given.
    pub fn check(&self, status: i32, before: &[u64], fixed: &[i32]) {
        // SAFETY: never NULL, valid until the next call.
        let message = unsafe { CStr::from_ptr(contact_normal_last_error()) }.to_str().expect("UTF-8");
        assert!((-9..=3).contains(&status), "status {status}: {message}");
        if status < 0 {
            assert!(!message.is_empty(), "status {status} without a message");
            assert!(self.outputs() == before, "status {status}, and outputs were written: {message}");
            return;
        }
        let n = (self.scene.mx * self.scene.my) as usize;
        assert!(self.pressure[n..].iter().all(|&p| p.to_bits() == SENTINEL.to_bits()), "written beyond the grid");
        let (case, mut found) = (self.case(fixed), self.found(status));
        if let Some(fixed) = &case.how.fixed {
            assert!(found.contact == *fixed, "a fixed area was written");
            // An element with any code other than 0 is in contact, unless it is excluded (h infinite).
            let in_contact = fixed.iter().zip(&case.h).map(|(code, h)| i32::from(*code != 0 && h.is_finite()));
            found.contact = in_contact.collect();
        }
        let Some(sliding) = &self.sliding else {
            let failures = is_true(&case, &found);
            assert!(failures.is_empty(), "status {status}: {failures:?}");
            return;
        };
        let Case { grid, shear_modulus, poisson_ratio, h, load, .. } = case.clone();
        let place = Place { surface: "bytes".into(), h, load, ..Place::new(grid, shear_modulus, poisson_ratio) };
        // For unlike bodies tractions cause normal displacements, which the check of the normal problem does not have.
        if place.is_alike() {
            let failures = is_true(&case, &found);
            assert!(failures.is_empty(), "friction, status {status}: {failures:?}");
        }
        let How { tolerance, precision, threads, max_cycles, .. } = case.how;
        let stop = Stop { tolerance, precision, threads, max_cycles, cancel_at: None };
        let failures = sliding.failures(place, stop, (status, &found.p, &found.u, found.report));
        assert!(failures.is_empty(), "friction, status {status}: {failures:?}");
    }

    /// The scene and options of the call as a case, for the checks. The library has accepted them.
    fn case(&self, fixed: &[i32]) -> Case {
        let (scene, options) = (&self.scene, &self.options);
        let grid = Grid { mx: scene.mx as usize, my: scene.my as usize, dx: scene.dx, dy: scene.dy };
        // The library reads either the approach or the force. If `load` is not set, the one that is NaN is not read.
        let by_approach = match scene.load {
            CONTACT_NORMAL_PRESCRIBED_UNSET => scene.force.is_nan(),
            load => load == CONTACT_NORMAL_PRESCRIBED_APPROACH,
        };
        let load = if by_approach { Load::Approach(scene.approach) } else { Load::Force(scene.force) };
        let is_fixed = options.active_set == CONTACT_NORMAL_ACTIVE_SET_FIXED;
        let how = How {
            method: options.method,
            smoother: self.cycle.smoother,
            // If an error ratio ends the solve instead of the tolerance, the residual must be below 1e-2, as with the criterion UPDATE.
            criterion: if options.error_ratio > 0.0 { CONTACT_NORMAL_CRITERION_UPDATE } else { options.criterion },
            tolerance: options.tolerance,
            precision: options.precision,
            threads: options.threads,
            coarsest: self.cycle.coarsest,
            max_cycles: options.max_cycles,
            cancel_at: None,
            fixed: is_fixed.then(|| fixed[..grid.len()].to_vec()),
            given: None,
        };
        Case {
            seed: 0,
            grid,
            shear_modulus: scene.shear_modulus,
            poisson_ratio: scene.poisson_ratio,
            surface: "bytes".into(),
            surfaces: crate::surface::any,
            h: self.h[..grid.len()].to_vec(),
            h_rounding: 0.0,
            load,
            effects: self.effects.clone(),
            how,
            through_handle: false,
            is_measured: false,
        }
    }

    /// The outputs of the call.
    fn found(&self, status: i32) -> Outputs {
        let n = (self.scene.mx * self.scene.my) as usize;
        Outputs {
            status,
            message: String::new(),
            p: self.pressure[..n].to_vec(),
            u: self.displacement[..n].to_vec(),
            e: self.distance[..n].to_vec(),
            contact: self.contact[..n].to_vec(),
            report: self.report,
            overrun: None,
            written: true,
        }
    }
}
