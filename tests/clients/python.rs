//! The Python package: its own tests pass, and its examples print what is expected and have certified solutions.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{assert_certified, finished, recompute, root, run, scratch, Recomputed};
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace};
use contact_normal::scene::Bodies;

/// The tolerance of python_examples/wheel_rail.py.
const TOLERANCE: f64 = 1e-9;

/// The path of a Python that has numpy and matplotlib.
fn python() -> PathBuf {
    let named = std::env::var_os("PYTHON").map(PathBuf::from);
    let mut tried = String::new();
    for candidate in named.into_iter().chain(["python3".into(), "/usr/bin/python3".into()]) {
        match Command::new(&candidate).args(["-c", "import numpy, matplotlib"]).output() {
            Ok(output) if output.status.success() => return candidate,
            Ok(output) => {
                let error = String::from_utf8_lossy(&output.stderr);
                writeln!(tried, "{}: {}", candidate.display(), error.lines().last().unwrap_or("failed"))
            }
            Err(error) => writeln!(tried, "{}: {error}", candidate.display()),
        }
        .expect("a string takes it");
    }
    panic!(
        "no Python with numpy and matplotlib (python3-numpy, python3-matplotlib); name one in PYTHON. Tried:\n{tried}"
    );
}

/// The command of a Python with numpy and matplotlib that runs in `folder`, and finds the module and the library there.
pub fn python_in(folder: &Path) -> Command {
    in_folder(Command::new(python()), folder)
}

/// Makes a command of Python run in `folder` and find the module and the library there.
pub fn in_folder(mut command: Command, folder: &Path) -> Command {
    command
        .current_dir(folder)
        .env("CONTACT_NORMAL_LIBRARY", folder.join("libcontact_normal.so"))
        .env("PYTHONPATH", root().join("python"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        // If a program hangs and is aborted, Python prints the place.
        .env("PYTHONFAULTHANDLER", "1")
        // matplotlib keeps its cache in this folder, and complains if it cannot.
        .env("MPLCONFIGDIR", folder);
    command
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

/// The measures of the arrays that an example wrote: "mx my dx dy approach", then "h p contact" for each element. The bodies are of steel.
fn recomputed(arrays: &Path) -> Recomputed {
    let arrays = std::fs::read_to_string(arrays).expect("the arrays");
    let (first, rows) = arrays.split_once('\n').expect("a first line");
    let numbers: Vec<f64> = first.split_whitespace().map(number).collect();
    let grid = Grid::new(numbers[0] as usize, numbers[1] as usize, numbers[2], numbers[3]).expect("a grid");
    let rows: Vec<Vec<f64>> = rows.lines().map(|line| line.split_whitespace().map(number).collect()).collect();
    let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
    let contact: Vec<bool> = column(2).iter().map(|&inside| inside != 0.0).collect();
    let steel = Bodies::same(82000.0, 0.28);
    let influence = Coefficients::from(HalfSpace::new(grid.dx, grid.dy, steel.compliance()));
    recompute(&grid, &influence, &column(0), numbers[4], &column(1), &contact)
}

/// The package's own tests, in Python: arguments, handles, batches, pictures, processes and threads.
#[test]
fn the_tests_of_the_package_pass() {
    let mut command = python_in(&scratch("python_package"));
    let tests = root().join("python/tests");
    let output = finished(command.args(["-m", "unittest", "discover", "-s"]).arg(&tests));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    // The output has "Ran 15 tests in ...". The number is compared, because without any test the run would succeed, too.
    let ran = told.lines().find_map(|line| line.strip_prefix("Ran ")?.split(' ').next()?.parse::<usize>().ok());
    let written: usize = std::fs::read_dir(&tests)
        .expect("python/tests")
        .map(|file| file.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "py"))
        .map(|path| std::fs::read_to_string(path).expect("a test").matches("\n    def test_").count())
        .sum();
    assert_eq!(ran, Some(written), "{told}");
    assert!(!told.contains("skipped"), "{told}");
}

/// The examples in the documentation of the package's functions.
#[test]
fn the_examples_in_docstrings_hold() {
    let script = "
import doctest, pkgutil, importlib, contact_normal
found = [doctest.testmod(importlib.import_module('contact_normal.' + module.name)) for module in pkgutil.iter_modules(contact_normal.__path__)]
print(sum(each.failed for each in found), sum(each.attempted for each in found) > 10)
";
    let printed = run(python_in(&scratch("python_docstrings")).args(["-c", script]));
    assert_eq!(printed, "0 True\n");
}

#[test]
fn the_to_accuracy_example_prints_what_is_expected() {
    let folder = scratch("python_to_accuracy");
    let example = root().join("python_examples/to_accuracy.py");
    let printed = run(python_in(&folder).arg(&example).arg("arrays.txt"));
    let expected = std::fs::read_to_string(example.with_extension("expected")).expect("to_accuracy.expected");
    assert_eq!(printed, expected);
    // The tolerance is that of the example.
    assert_certified(&recomputed(&folder.join("arrays.txt")), 1e-8);
}

/// Asserts that an example, which takes the name of its picture, prints what is expected and draws a picture of some size.
fn prints_what_is_expected_and_draws(name: &str) {
    let folder = scratch(&format!("python_{name}"));
    let example = root().join("python_examples").join(name).with_extension("py");
    let printed = run(python_in(&folder).arg(&example).arg("picture.png"));
    let expected = std::fs::read_to_string(example.with_extension("expected")).expect("what is expected");
    assert_eq!(printed, expected);
    let picture = std::fs::read(folder.join("picture.png")).expect("the picture");
    let reader = png::Decoder::new(std::io::Cursor::new(picture)).read_info().expect("a PNG");
    assert!(reader.info().width > 400 && reader.info().height > 300);
}

#[test]
fn the_price_list_example_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("price_list");
}

#[test]
fn the_bill_of_six_scenes_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("what_matters");
}

#[test]
fn the_ledger_example_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("ledger");
}

#[test]
fn the_creep_force_table_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("creep_force_table");
}

#[test]
fn the_example_of_laws_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("laws");
}

/// A friction law of the example itself, solved in turns.
#[test]
fn the_example_of_hot_friction_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("hot_friction");
}

#[test]
fn the_example_of_coated_wheels_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("coated_wheels");
}

#[test]
fn the_friction_example_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("friction");
}

/// Asserts that an example, which takes a folder for its pictures and a file for its gap, draws the pictures and makes the gap.
fn makes_the_gap(name: &str, gap: &str, pictures: &[&str]) {
    let folder = scratch(&format!("python_{name}"));
    let example = root().join("python_examples").join(name).with_extension("py");
    let printed = run(python_in(&folder).arg(&example).args([".", "gap.txt"]));
    let expected = std::fs::read_to_string(example.with_extension("expected")).expect("what is expected");
    assert_eq!(printed, expected);
    for picture in pictures {
        let picture = folder.join(format!("{name}_{picture}.png"));
        let drawn = std::fs::metadata(&picture).unwrap_or_else(|e| panic!("{}: {e}", picture.display()));
        assert!(drawn.len() > 10_000, "{}: {} bytes", picture.display(), drawn.len());
    }
    // The examples in C and Fortran read this gap from data/gaps. Another NumPy, or another machine, may round differently: the place of a least
    // distance is known to the root of round-off, 1.5e-8 of lengths of up to 30 mm, and slopes there are less than 1. The largest measured difference
    // is 2.4e-7.
    let distances = |path: &Path| -> Vec<f64> {
        let text = std::fs::read_to_string(path).expect("a gap");
        text.lines().skip(2).flat_map(str::split_whitespace).map(number).collect()
    };
    let (made, kept) = (distances(&folder.join("gap.txt")), distances(&root().join("data/gaps").join(gap)));
    assert_eq!(made.len(), kept.len());
    assert!(made.iter().zip(&kept).all(|(a, b)| a == b || (a - b).abs() < 5e-7), "{gap} is not what {name} makes");
}

#[test]
fn from_heights_to_a_gap() {
    makes_the_gap("heights_to_gap", "ground.txt", &["array", "faults", "level", "gap", "pressures"]);
}

#[test]
fn from_profiles_to_a_gap() {
    makes_the_gap("profiles_to_gap", "wheel_rail.txt", &["place", "shift", "gap", "forces"]);
}

#[test]
fn the_adhesion_example_prints_what_is_expected_and_draws() {
    let folder = scratch("python_adhesion");
    let example = root().join("python_examples/adhesion.py");
    let printed = run(python_in(&folder).arg(&example).arg("."));
    assert_eq!(printed, std::fs::read_to_string(example.with_extension("expected")).expect("what is expected"));
    for picture in ["adhesion_loop.png", "adhesion_rough.png"] {
        assert!(std::fs::metadata(folder.join(picture)).expect("the picture").len() > 10_000, "{picture}");
    }
}

#[test]
fn the_visco_example_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("visco");
}

#[test]
fn the_wear_example_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("wear");
}

#[test]
fn the_rolling_example_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("rolling");
}

#[test]
fn the_rough_surface_example_prints_what_is_expected_and_draws() {
    prints_what_is_expected_and_draws("rough_surface");
}

#[test]
fn the_wheel_rail_example_prints_what_is_expected_and_draws() {
    let folder = scratch("python_wheel_rail");
    let example = root().join("python_examples/wheel_rail.py");
    let data = root().join("data/wheel_rail/y4_82kN.txt");
    let printed = run(python_in(&folder).arg(&example).arg(&data).args(["picture.png", "arrays.txt"]));
    let expected = std::fs::read_to_string(example.with_extension("expected")).expect("wheel_rail.expected");
    assert_eq!(printed, expected);

    let measures = recomputed(&folder.join("arrays.txt"));
    assert_certified(&measures, TOLERANCE);
    // The force is that of the data file, up to the round-off of a sum of 8360 terms.
    let data = std::fs::read_to_string(&data).expect("the data");
    let force = number(data.lines().nth(3).expect("a line of numbers").split(' ').nth(5).expect("a force"));
    assert!((measures.force / force - 1.0).abs() <= 8360.0 * f64::EPSILON, "{measures:?}");

    let picture = std::fs::read(folder.join("picture.png")).expect("the picture");
    let mut reader = png::Decoder::new(std::io::Cursor::new(picture)).read_info().expect("a PNG");
    let mut decoded = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut decoded).expect("pixels");
    assert!(info.width >= 800 && info.height >= 600, "{} x {}", info.width, info.height);
    // A blank page would have one colour. The pressures alone have hundreds.
    let pixel = info.line_size / info.width as usize;
    let colours: std::collections::HashSet<&[u8]> = decoded.chunks_exact(pixel).collect();
    assert!(colours.len() > 100, "{} colours", colours.len());
}

#[test]
fn the_effects_print_what_is_expected_and_draw() {
    let folder = scratch("python_effects");
    let example = root().join("python_examples/effects.py");
    let printed = run(python_in(&folder).arg(&example).arg("."));
    let expected = std::fs::read_to_string(example.with_extension("expected")).expect("effects.expected");
    assert_eq!(printed, expected);
    for name in ["layer", "pressure_limit", "period", "patches", "row_tables", "coating"] {
        let picture = std::fs::metadata(folder.join(format!("effects_{name}.png"))).expect("a picture");
        assert!(picture.len() > 10_000, "{name}: {} bytes", picture.len());
    }
}

#[test]
fn stresses_below_the_surface_print_what_is_expected_and_draw() {
    let folder = scratch("python_subsurface");
    let example = root().join("python_examples/subsurface.py");
    let case = root().join("data/wheel_rail/y4_82kN.txt");
    let printed = run(python_in(&folder).arg(&example).arg(case).arg("."));
    let expected = std::fs::read_to_string(example.with_extension("expected")).expect("subsurface.expected");
    assert_eq!(printed, expected);
    for name in ["depth", "sliding", "wheel_rail"] {
        let picture = std::fs::metadata(folder.join(format!("stress_{name}.png"))).expect("a picture");
        assert!(picture.len() > 10_000, "{name}: {} bytes", picture.len());
    }
}

/// Effects of a handle, of its later solves and of batches give the results of single calls.
#[test]
fn a_handle_in_python_keeps_its_effects() {
    let script = "
import numpy as np, contact_normal as cn
steel = dict(shear_modulus=82000.0, poisson_ratio=0.28)
x = np.arange(16) - 7.5
h = 0.01 * (x[None, :] ** 2 + x[:, None] ** 2)
layer = 1e-6 * (1 + (np.arange(256) % 3)).reshape(16, 16)
effects = dict(layer=layer, period='x')
alone = cn.solve(h, 0.2, 0.2, force=1000.0, pressure_limit=3000.0, **effects, **steel)
with cn.Solver(16, 16, 0.2, 0.2, **effects, **steel) as solver:
    again = solver.solve(h, force=1000.0, pressure_limit=3000.0)
    batch = solver.solve_batch([h], force=1000.0, pressure_limit=3000.0)
    free = solver.solve(h, force=1000.0)
print(np.array_equal(alone.pressure, again.pressure), np.array_equal(alone.pressure, batch[0].pressure))
print(alone.at_limit.any(), alone.pressure.max() == 3000.0, free.at_limit.any(), free.pressure.max() > 3000.0)
for bad in (dict(period='z'), dict(layer=layer[1:])):
    try:
        cn.solve(h, 0.2, 0.2, force=1000.0, **bad, **steel)
    except ValueError as error:
        print(error)
";
    let printed = run(python_in(&scratch("python_handle_effects")).args(["-c", script]));
    let expected = "\
True True
True True False True
period is 'z'; it must be 'x', 'y' or 'xy'
layer has shape (15, 16); it must be (16, 16)
";
    assert_eq!(printed, expected);
}

#[test]
fn errors_and_shapes_are_checked() {
    let script = "
import numpy as np, contact_normal as cn
steel = dict(shear_modulus=82000.0, poisson_ratio=0.28)
x = np.arange(12) - 5.5
h = 0.01 * (x[None, :] ** 2 + x[:10, None] ** 2)
try:
    cn.solve(h, -0.2, 0.2, approach=0.1, **steel)
except cn.ContactNormalError as error:
    print(error.status, error.message)
for bad in (h[0], h.astype(complex), h.astype(object)):
    try:
        cn.solve(bad, 0.2, 0.2, approach=0.1, **steel)
    except (TypeError, ValueError) as error:
        print(type(error).__name__)
# Strided and single-precision arrays are copied.
full = cn.solve(np.asfortranarray(h), 0.2, 0.2, approach=0.1, **steel)
print(full.status, full.pressure.shape, np.array_equal(full.contact, full.pressure > 0), len(full.ledger) > 0)
# The library's own coefficients as the caller's table: the same pressures but for round-off.
table = cn.influence_half_space(12, 10, 0.2, 0.2, **steel)
own = cn.solve(h, 0.2, 0.2, approach=0.1, influence=table, tolerance=1e-12, **steel)
half = cn.solve(h, 0.2, 0.2, approach=0.1, tolerance=1e-12, **steel)
print(np.abs(own.pressure - half.pressure).max() <= 1e-9 * half.pressure.max())
# The handle, the previous solution as the guess, and cancelling.
with cn.Solver(10, 12, 0.2, 0.2, tolerance=1e-10, **steel) as solver:
    first = solver.solve(h, force=1000.0)
    again = solver.solve(h, force=1000.0, initial_guess=cn.INITIAL_GUESS_PREVIOUS)
    print(abs(first.approach - again.approach) < 1e-9 * first.approach, again.report['cycles'] <= first.report['cycles'])
    print(solver.solve(h, force=1000.0, tolerance=1e-15, progress=lambda told: True).status == cn.CANCELLED)
    try:
        solver.solve(h, force=1000.0, tolerance=1e-15, progress=lambda told: 1 / 0)
    except ZeroDivisionError:
        print('raised')
# A batch on two threads: one refused problem between others, which are those of single solves to the last bit.
with cn.Solver(10, 12, 0.2, 0.2, threads=2, **steel) as solver:
    forces = [100.0, 200.0, -300.0, 400.0]
    batch = solver.solve_batch([h, 2 * h, h, 0.5 * h], force=forces)
    print([found.status for found in batch], batch[2].message)
    single = solver.solve(0.5 * h, force=400.0)
    print(np.array_equal(batch[3].pressure, single.pressure), batch[3].report['cycles'] == single.report['cycles'])
    print(len(solver.solve_batch([], approach=0.1)))
    try:
        solver.solve_batch([h], approach=0.1, initial_guess=cn.INITIAL_GUESS_PREVIOUS)
    except cn.ContactNormalError as error:
        print('PREVIOUS' in error.message)
# An accuracy: from an array and from a callable, whose exception comes through, and a limit, whose message says the best.
ball = lambda x, y: 0.01 * (x ** 2 + y ** 2)
near = cn.solve_to_accuracy(0.04 * h, 0.5, 0.5, target=1e-2, approach=0.1, **steel)
print(near.status, near.reached <= 1e-2, near.pressure.shape[1] * near.dx, near.seconds > 0, len(near.ledger) > 1)
prices = cn.cost_of_accuracy(0.04 * h, 0.5, 0.5, targets=(1e-2, 1e-15), approach=0.1, **steel)
assert prices[0].seconds > 0 and prices[0].shape[0] >= 12 and not prices[0].obstacle, prices
assert prices[1].obstacle == 'below round-off' and prices[1].shape == (0, 0), prices
far = cn.solve_to_accuracy(ball, 0.5, 0.5, shape=(10, 12), target=1e-9, max_elements=40 * 48, approach=0.1, **steel)
print(far.status == cn.ITERATION_LIMIT, far.pressure.shape, 'max_elements' in far.message and '48 x 40' in far.message)
for bad in (dict(shape=(10, 12)), dict()):
    try:
        cn.solve_to_accuracy(lambda x, y: 1 / 0, 0.5, 0.5, approach=0.1, **bad, **steel)
    except (ZeroDivisionError, TypeError) as error:
        print(type(error).__name__)
try:
    cn.solve_to_accuracy(h, 0.5, 0.5, target=-1, approach=0.1, **steel)
except cn.ContactNormalError as error:
    print(error.message)
exact = cn.hertz(0.0016681, 0.0030671, approach=0.1091, **steel)
print(round(exact.force), round(exact.max_pressure))
";
    let printed = run(python_in(&scratch("python_errors")).args(["-c", script]));
    let expected = "\
-2 dx is -0.2; an element size must be positive and finite
ValueError
TypeError
TypeError
0 (10, 12) True True
True
True True
True
raised
[0, 0, -2, 0] force is -300; it must not be negative: an elastic contact does not pull, only a given contact area (active_set FIXED) or adhesion with a work above 0 does
True True
0
True
0 True 6.0 True True
True (40, 48) True
ZeroDivisionError
TypeError
target is -1; it must lie between 0 and 1, or be 0 for none
";
    let (start, hertz) = printed.split_at(expected.len().min(printed.len()));
    assert_eq!(start, expected);
    // The paper's problem has the values of the closed form in Rust, which other tests compare with tables.
    let compliance = Bodies::same(82000.0, 0.28).compliance();
    let exact = contact_normal::analytic::hertz(0.0016681, 0.0030671, 0.1091, compliance).expect("a contact");
    assert_eq!(hertz.trim(), format!("{:.0} {:.0}", exact.force, exact.max_pressure));
}
