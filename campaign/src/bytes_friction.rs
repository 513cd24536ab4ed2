//! Makes friction from random bytes: all motions, forces, the caller's tables, previous tractions, like and unlike bodies. Also checks the results.

use std::ptr::null;

use contact_normal::ffi::*;

use crate::bytes_reader::{Bytes, ROOM, SENTINEL, SENTINEL_CONTACT};

use crate::friction_case::Case;
use crate::friction_found::Found;
use crate::friction_place::{Place, Stop};
use crate::friction_rules::{answer, tables};
use crate::grid::Grid;
use crate::init::initialised;
use crate::slide::Slide;

/// The components x and y of a field of vectors.
type Pair = [Vec<f64>; 2];

/// The inputs and outputs of a call with friction, except those of the normal problem. Arrays have room for `ROOM` elements.
pub struct Sliding {
    /// The friction coefficients of the elements; empty: there is one for all.
    mu: Vec<f64>,
    /// The tractions before the step.
    previous: Option<Pair>,
    /// The rigid slip of each element.
    rigid: Option<Pair>,
    /// The tables xx, yy, xy, xz, yz.
    tables: Vec<Vec<f64>>,
    /// The structs of these tables.
    structs: Vec<contact_normal_influence>,
    /// Whether the campaign can check the result: it has the coefficients and the slip of the call.
    certified: bool,
    pub input: contact_normal_friction,
    traction: Pair,
    slip: Pair,
    stick_slip: Vec<i32>,
}

/// Numbers of about this size for a grid of n elements. Some may be arbitrary.
fn numbers(bytes: &mut Bytes<'_>, n: usize, size: f64) -> Vec<f64> {
    let usual = |bytes: &mut Bytes<'_>| size * (f64::from(bytes.byte()) / 128.0 - 1.0);
    let mut values: Vec<f64> = (0..ROOM).map(|i| if i < n { usual(bytes) } else { 0.0 }).collect();
    for _ in 0..(bytes.byte() % 16).saturating_sub(12) {
        values[bytes.word() as usize % ROOM] = bytes.number();
    }
    values
}

/// A field of vectors, if it is selected.
fn pair(bytes: &mut Bytes<'_>, n: usize, is_selected: bool) -> Option<Pair> {
    is_selected.then(|| {
        let size = [0.01, 1.0, 1e6, 1e-9][usize::from(bytes.byte() % 4)];
        [numbers(bytes, n, size), numbers(bytes, n, size)]
    })
}

/// The struct of the C ABI for a table.
fn influence_struct((cx, cy): (i32, i32), coefficients: &[f64], scale: f64) -> contact_normal_influence {
    contact_normal_influence { cx, cy, coefficients: coefficients.as_ptr(), scale, ..Default::default() }
}

impl Sliding {
    /// Makes friction for a scene with n elements. In most cases the bodies of the scene become alike.
    pub fn new(bytes: &mut Bytes<'_>, n: usize, scene: &mut contact_normal_scene) -> Sliding {
        if bytes.byte() % 4 != 0 {
            scene.shear_modulus[1] = scene.shear_modulus[0];
            scene.poisson_ratio[1] = scene.poisson_ratio[0];
        }
        let selected = bytes.byte();
        let mut sliding = Sliding {
            mu: if selected & 1 != 0 { numbers(bytes, n, 0.5).into_iter().map(f64::abs).collect() } else { Vec::new() },
            previous: pair(bytes, n, selected & 6 == 2),
            rigid: pair(bytes, n, selected & 24 == 8),
            tables: Vec::new(),
            structs: Vec::new(),
            certified: true,
            input: initialised(contact_normal_friction_init),
            traction: [0, 1].map(|_| vec![SENTINEL; ROOM]),
            slip: [0, 1].map(|_| vec![SENTINEL; ROOM]),
            stick_slip: vec![SENTINEL_CONTACT; ROOM],
        };
        sliding.set_motion(bytes);
        if selected & 96 == 32 && n > 0 {
            sliding.set_tables(bytes, scene);
        }
        let pointers = |pair: &Option<Pair>| pair.as_ref().map_or([null(); 2], |[x, y]| [x.as_ptr(), y.as_ptr()]);
        let input = &mut sliding.input;
        if selected & 1 != 0 {
            input.coefficients = sliding.mu.as_ptr();
        }
        (input.previous_traction, input.rigid_slip) = (pointers(&sliding.previous), pointers(&sliding.rigid));
        if bytes.byte() == 99 {
            // Only one of the two arrays.
            input.previous_traction[1] = null();
        }
        if bytes.byte() == 99 {
            input.struct_size = input.struct_size.min(bytes.word() as i64);
            sliding.certified = false;
        }
        sliding
    }

    /// Makes the motion from bytes.
    fn set_motion(&mut self, bytes: &mut Bytes<'_>) {
        let input = &mut self.input;
        input.coefficient = bytes.sometimes(0.3);
        input.motion = bytes.integer(3);
        input.prescribed = [0, 1].map(|_| i32::from(bytes.byte() % 4 == 0));
        let signed = |bytes: &mut Bytes<'_>| match bytes.byte() % 8 {
            0 => bytes.number(),
            1 => 0.0,
            _ => f64::from(bytes.byte() as i8) / 256.0,
        };
        input.creepage = [0, 1].map(|_| signed(bytes));
        input.force = [0, 1].map(|_| signed(bytes));
        input.spin = signed(bytes);
        input.spin_centre = [0, 1].map(|_| bytes.sometimes(0.0));
        input.rolling_distance = bytes.sometimes(0.0);
        let quarters = f64::from(bytes.byte() % 4);
        input.rolling_direction = bytes.sometimes(quarters * std::f64::consts::FRAC_PI_2);
        input.spin_offset = bytes.sometimes(input.spin_offset);
        input.continues = i32::from(bytes.byte() % 8 == 0);
        input.sensitivities = i32::from(bytes.byte() % 8 == 0);
        input.reserved = i32::from(bytes.byte() == 99);
        // The campaign computes the slip with the default offset, and does not have the tractions that a handle holds.
        let default: contact_normal_friction = initialised(contact_normal_friction_init);
        self.certified = input.spin_offset.to_bits() == default.spin_offset.to_bits() && input.continues == 0;
    }

    /// Adds tables with the coefficients of the half-space. Some entries may be replaced by arbitrary numbers.
    fn set_tables(&mut self, bytes: &mut Bytes<'_>, scene: &contact_normal_scene) {
        let (cx, cy) = (scene.mx + 1 + bytes.integer(2).clamp(0, 2), scene.my + 1);
        let grid = Grid { mx: cx as usize, my: cy as usize, dx: scene.dx, dy: scene.dy };
        self.tables = tables(&Place::new(grid, scene.shear_modulus, scene.poisson_ratio));
        for _ in 0..(bytes.byte() % 16).saturating_sub(12) {
            let (table, at) = (usize::from(bytes.byte()) % self.tables.len(), bytes.word() as usize);
            let length = self.tables[table].len();
            self.tables[table][at % length] = bytes.number();
            self.certified = false;
        }
        let input = &mut self.input;
        let scale = bytes.sometimes(1.0);
        self.certified &= scale.to_bits() == 1.0f64.to_bits();
        if bytes.byte() % 8 == 0 {
            // The tables xz and yz, which couple unlike bodies, are 0 here.
            self.tables.extend([vec![0.0; self.tables[0].len()], vec![0.0; self.tables[0].len()]]);
        }
        self.structs = self.tables.iter().map(|table| influence_struct((cx, cy), table, scale)).collect();
        input.influence = [0, 1, 2].map(|k: usize| &raw const self.structs[k]);
        if self.structs.len() > 3 {
            input.influence_cross = [3, 4].map(|k: usize| &raw const self.structs[k]);
        }
    }

    /// Points the fields to the arrays of this struct.
    pub fn point_from(&mut self, fields: &mut contact_normal_fields) {
        fields.traction = [0, 1].map(|k: usize| self.traction[k].as_mut_ptr());
        fields.slip = [0, 1].map(|k: usize| self.slip[k].as_mut_ptr());
        fields.stick_slip = self.stick_slip.as_mut_ptr();
    }

    /// All outputs of a call, as bits.
    pub fn outputs(&self) -> impl Iterator<Item = u64> + '_ {
        let numbers = self.traction.iter().chain(&self.slip).flatten().map(|value| value.to_bits());
        numbers.chain(self.stick_slip.iter().map(|&a| a as u64))
    }

    /// The broken promises of a result, whose normal part is the place, the status, the pressures, the displacements and the report.
    pub fn failures(
        &self,
        place: Place,
        stop: Stop,
        (status, p, u, report): (i32, &[f64], &[f64], contact_normal_report),
    ) -> Vec<String> {
        let (n, input) = (place.grid.len(), &self.input);
        let writes_beyond = self.writes_beyond(n);
        let has_force = |k: usize| input.prescribed[k] == CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE;
        let slide = Slide {
            mu: if self.mu.is_empty() { vec![input.coefficient; n] } else { self.mu[..n].to_vec() },
            uniform: self.mu.is_empty(),
            motion: input.motion,
            prescribed: input.prescribed,
            amount: [0, 1].map(|k| if has_force(k) { input.force[k] } else { input.creepage[k] }),
            spin: input.spin,
            spin_centre: input.spin_centre,
            distance: input.rolling_distance,
            direction: input.rolling_direction,
            previous: self.previous.as_ref().map(|pair| [0, 1].map(|k: usize| pair[k][..n].to_vec())),
            rigid: self.rigid.as_ref().map(|pair| [0, 1].map(|k: usize| pair[k][..n].to_vec())),
            sensitivities: input.sensitivities == 1,
        };
        let vectors = |pair: &Pair| (0..n).map(|i| [pair[0][i], pair[1][i]]).collect::<Vec<_>>();
        let found = Found {
            status,
            message: String::new(),
            p: p.to_vec(),
            e: Vec::new(),
            contact: Vec::new(),
            u: u.to_vec(),
            q: vectors(&self.traction),
            slip: vectors(&self.slip),
            stick_slip: self.stick_slip[..n].to_vec(),
            report,
            overrun: None,
            written: true,
        };
        let case = Case { place, slide, stop, carried: 0.0 };
        // For unlike bodies the campaign does not check results with the caller's tables, which do not couple, or with negative pressures on a fixed
        // area.
        let couples = !case.place.is_alike();
        let certified = self.certified && !(couples && (!self.tables.is_empty() || p.iter().any(|p| *p < 0.0)));
        let verdict = answer(&case, &found, certified);
        let mut texts: Vec<String> =
            verdict.failures.into_iter().map(|f| format!("{}: {}", f.promise, f.details)).collect();
        texts.extend(writes_beyond.then(|| "friction writes beyond the grid".to_string()));
        texts
    }

    /// Whether the call wrote to outputs beyond the n elements of the grid.
    fn writes_beyond(&self, n: usize) -> bool {
        let beyond =
            self.traction.iter().chain(&self.slip).any(|a| a[n..].iter().any(|v| v.to_bits() != SENTINEL.to_bits()));
        beyond || self.stick_slip[n..].iter().any(|&a| a != SENTINEL_CONTACT)
    }
}
