//! The hard cases: two like bodies, with E* = G/(1 - nu), under a load and a motion.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Coefficient, Friction, Load, Motion, Prescribed, Previous, Scene};

use crate::case::{distance, grid, paraboloid};

/// The motions in which each case is solved. A step of rolling is one element along x.
pub const MOTIONS: [(&str, Motion); 3] = [
    ("SHIFT", Motion::Shift),
    ("TRANSIENT_ROLLING", Motion::TransientRolling),
    ("STEADY_ROLLING", Motion::SteadyRolling),
];

/// Two arrays: the components in x and in y of each element.
type Pair = [Vec<f64>; 2];

/// A scene that owns its arrays.
#[derive(Clone)]
pub struct Case {
    pub name: &'static str,
    pub grid: Grid,
    pub h: Vec<f64>,
    pub nu: f64,
    pub load: Load,
    pub mu: Vec<f64>,
    pub prescribed: [Prescribed; 2],
    pub spin: f64,
    /// The previous tractions.
    pub previous: Option<Pair>,
    pub rigid_slip: Option<Pair>,
    /// The status with which the library must refuse the case. `None`: the library must solve it.
    pub refusal: Option<&'static str>,
}

impl Case {
    /// A case with mu = 0.3 and creepages at which a part of the contact sticks.
    fn new(name: &'static str, grid: Grid, h: Vec<f64>, load: Load) -> Case {
        let mu = vec![0.3; grid.len()];
        let prescribed = [Prescribed::Creepage(-0.1), Prescribed::Creepage(0.05)];
        let (previous, rigid_slip, refusal) = (None, None, None);
        Case { name, grid, h, nu: 0.3, load, mu, prescribed, spin: 0.05, previous, rigid_slip, refusal }
    }

    /// A ball of radius 1 on a plane, pressed to a contact radius of about 1, on 31 x 31 elements of side 0.08.
    fn ball(name: &'static str) -> Case {
        let square = grid(31, 31, 0.08, 0.08);
        Case::new(name, square, paraboloid(&square, 0.5), Load::Approach(1.0))
    }

    fn refused(name: &'static str, status: &'static str) -> Case {
        Case { refusal: Some(status), ..Case::ball(name) }
    }

    pub fn bodies(&self) -> Bodies {
        Bodies::same(1.0, self.nu)
    }

    /// The library's scene of the case, with one of the motions.
    pub fn scene(&self, motion: Motion) -> Scene<'_> {
        let friction = Friction {
            coefficient: Coefficient::PerElement(&self.mu),
            motion,
            prescribed: self.prescribed,
            spin: self.spin,
            previous: self.previous.as_ref().map_or(Previous::None, |[x, y]| Previous::Given([x, y])),
            rigid_slip: self.rigid_slip.as_ref().map(|[x, y]| [x.as_slice(), y.as_slice()]),
            ..Friction::new(0.0)
        };
        Scene { friction: Some(friction), ..Scene::new(self.grid, &self.h, self.bodies(), self.load) }
    }
}

fn creepages(x: f64, y: f64) -> [Prescribed; 2] {
    [Prescribed::Creepage(x), Prescribed::Creepage(y)]
}

fn forces(x: f64, y: f64) -> [Prescribed; 2] {
    [Prescribed::Force(x), Prescribed::Force(y)]
}

/// Every case of every family.
pub fn all() -> Vec<(&'static str, Vec<Case>)> {
    vec![
        ("contact areas", contact_areas()),
        ("coefficients of friction", coefficients()),
        ("motions", motions()),
        ("forces", with_forces()),
        ("tractions before", previous()),
        ("refused", refused()),
    ]
}

fn contact_areas() -> Vec<Case> {
    let square = grid(31, 31, 0.08, 0.08);
    let wide = grid(40, 36, 0.1, 0.1);
    let mut spots = vec![1.0; wide.len()];
    (spots[wide.index(4, 3)], spots[wide.index(35, 32)]) = (0.0, 0.001);
    let ridge = grid(60, 21, 0.1, 0.1);
    let (row, column, long) = (grid(200, 1, 0.1, 0.1), grid(1, 200, 0.1, 0.1), grid(12, 48, 0.2, 0.05));
    let mut gaps = paraboloid(&square, 0.5);
    (0..gaps.len()).filter(|i| (i % 31 + 2 * (i / 31)) % 3 == 0).for_each(|i| gaps[i] = f64::INFINITY);
    vec![
        Case::ball("a ball"),
        Case::new("one element", square, paraboloid(&square, 10.0), Load::Approach(0.01)),
        Case::new("two elements far apart", wide, spots, Load::Approach(0.01)),
        Case::new(
            "a row of elements in contact",
            ridge,
            distance(&ridge, |x, y| 0.001 * x * x + 50.0 * y * y),
            Load::Approach(0.02),
        ),
        Case::new("a grid of one row", row, paraboloid(&row, 0.01), Load::Approach(0.5)),
        Case::new("a grid of one column", column, paraboloid(&column, 0.01), Load::Approach(0.5)),
        Case::new("elements 4:1", long, paraboloid(&long, 0.5), Load::Approach(1.0)),
        Case::new("flat punch, full contact", square, vec![0.0; square.len()], Load::Approach(1.0)),
        Case::new("every third element without surface", square, gaps, Load::Approach(1.0)),
        Case::new("a touch without pressure", square, paraboloid(&square, 0.5), Load::Approach(0.0)),
        Case::new("bodies apart", square, paraboloid(&square, 0.5), Load::Approach(-1.0)),
    ]
}

fn coefficients() -> Vec<Case> {
    let of = |name, mu: &dyn Fn(usize) -> f64| {
        let case = Case::ball(name);
        Case { mu: (0..case.grid.len()).map(mu).collect(), ..case }
    };
    vec![
        of("mu = 0", &|_| 0.0),
        of("mu = 1e-9: full slip", &|_| 1e-9),
        of("mu = 1e9: full stick", &|_| 1e9),
        of("mu = 0 in every second element", &|i| if i % 2 == 0 { 0.0 } else { 0.3 }),
        of("mu = 0 in half of the contact area", &|i| if i % 31 < 15 { 0.0 } else { 0.3 }),
        of("mu > 0 in one element of the contact area", &|i| if i == 15 * 31 + 15 { 0.3 } else { 0.0 }),
        of("mu over 18 decades", &|i| 10f64.powi((7 * i % 19) as i32 - 9)),
        Case { nu: 0.0, ..Case::ball("nu = 0") },
        Case { nu: 0.5, ..Case::ball("nu = 0.5") },
    ]
}

fn motions() -> Vec<Case> {
    let of = |name, prescribed, spin| Case { prescribed, spin, ..Case::ball(name) };
    let case = of("a rigid slip of noise", creepages(0.0, 0.0), 0.0);
    let noise = |k: usize| (0..case.grid.len()).map(|i| 0.01 * ((i * k % 101) as f64 / 50.0 - 1.0)).collect();
    vec![
        of("no motion", creepages(0.0, 0.0), 0.0),
        of("creepages of 1e3: full slip", creepages(-1e3, 1e3), 0.0),
        of("creepages of 1e-12", creepages(-1e-12, 0.0), 0.0),
        of("spin alone", creepages(0.0, 0.0), 0.3),
        of("spin of 1e-12", creepages(0.0, 0.0), 1e-12),
        of("spin of 1e3", creepages(0.0, 0.0), 1e3),
        Case { rigid_slip: Some([noise(7919), noise(104_729)]), ..case },
    ]
}

fn with_forces() -> Vec<Case> {
    // The normal force is 10, so that mu N is 3.
    let of = |name, prescribed, spin| Case { load: Load::Force(10.0), prescribed, spin, ..Case::ball(name) };
    let beside = [Prescribed::Creepage(-1e-11), Prescribed::Force(1.5)];
    vec![
        of("no force", forces(0.0, 0.0), 0.0),
        of("1e-9 of what friction carries", forces(3e-9, 0.0), 0.0),
        of("half of it", forces(1.2, -0.9), 0.0),
        of("0.999 of it", forces(2.4 * 0.999, -1.8 * 0.999), 0.0),
        of("0.9 of it, and a spin of 10", forces(2.7, 0.0), 10.0),
        of("a force beside a creepage of 1e-11", beside, 0.0),
    ]
}

fn previous() -> Vec<Case> {
    let of = |name, size: f64, prescribed| {
        let case = Case::ball(name);
        let noise = |k: usize| (0..case.grid.len()).map(|i| size * ((i * k % 101) as f64 / 50.0 - 1.0)).collect();
        Case { previous: Some([noise(7919), noise(104_729)]), prescribed, ..case }
    };
    let usual = creepages(-0.1, 0.05);
    let n = Case::ball("").grid.len();
    let smooth = Case {
        previous: Some([vec![0.1; n], vec![0.0; n]]),
        prescribed: creepages(-1e-6, 0.0),
        spin: 0.0,
        ..Case::ball("slip of 1e-6 beside A q")
    };
    vec![
        of("noise within the bounds", 0.05, usual),
        of("noise of 10 times the bounds", 10.0, usual),
        of("noise of 1e6 times the bounds", 1e6, usual),
        smooth,
    ]
}

fn refused() -> Vec<Case> {
    const ARGUMENT: &str = "INVALID_ARGUMENT";
    const FINITE: &str = "NOT_FINITE";
    let n = Case::ball("").grid.len();
    let pair = |length: usize, value: f64| Some([vec![0.0; n], [vec![value; 1], vec![0.0; length - 1]].concat()]);
    let nan = f64::NAN;
    let of_mu = |name, status, length: usize, first: f64| {
        let mut mu = vec![0.3; length];
        mu[0] = first;
        Case { mu, ..Case::refused(name, status) }
    };
    vec![
        of_mu("mu of a wrong size", ARGUMENT, n - 1, 0.3),
        of_mu("mu = -1", ARGUMENT, n, -1.0),
        of_mu("mu = NaN", FINITE, n, nan),
        of_mu("mu = infinity", FINITE, n, f64::INFINITY),
        Case { previous: pair(n + 1, 0.0), ..Case::refused("tractions before of a wrong size", ARGUMENT) },
        Case { previous: pair(n, nan), ..Case::refused("tractions before of NaN", FINITE) },
        Case { rigid_slip: pair(n - 1, 0.0), ..Case::refused("a rigid slip of a wrong size", ARGUMENT) },
        Case { rigid_slip: pair(n, nan), ..Case::refused("a rigid slip of NaN", FINITE) },
        Case { prescribed: creepages(nan, 0.0), ..Case::refused("a creepage of NaN", FINITE) },
        Case { spin: nan, ..Case::refused("a spin of NaN", FINITE) },
        Case { prescribed: creepages(1e200, 0.0), ..Case::refused("a creepage of 1e200", ARGUMENT) },
        Case { rigid_slip: pair(n, 1e200), ..Case::refused("a rigid slip of 1e200", ARGUMENT) },
        Case { prescribed: forces(nan, 0.0), ..Case::refused("a force of NaN", FINITE) },
        Case {
            load: Load::Force(10.0),
            prescribed: forces(3.0, 0.0),
            spin: 0.0,
            ..Case::refused("a force of mu N", "INFEASIBLE")
        },
    ]
}
