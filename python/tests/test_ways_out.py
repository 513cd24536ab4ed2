"""Common mistakes: messages say what to do instead, objects print on one line, pictures of extreme scenes are readable."""

import tempfile
import unittest
from pathlib import Path

import matplotlib
import numpy as np

import contact_normal as cn
from contact_normal import profiles, rollers, surface
from test_command import BALL, HEIGHTS, called
from test_profiles import rail, wheel

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
M, D = 24, 0.1
X = (np.arange(M) - 0.5 * (M - 1)) * D
H = (X[None, :] ** 2 + X[:, None] ** 2) / (2 * 50.0)
ROLLING = {"coefficient": 0.3, "motion": "STEADY_ROLLING"}


class DecimalCommas(unittest.TestCase):
    """One profile with its numbers in different formats."""

    def test_columns_of_a_profile(self):
        y = np.arange(-40.0, 41.0, 5.0)
        z = 0.004 * y**2
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "rail.txt"
            # The columns mix whole numbers with others (-35 4,9), exponents, and remarks.
            for form in ("%g %g", "%.3f;%.4f", "%g\t%g", "%.4e %.4e", "%g %g ; remark", "%g %g;"):
                for commas in (False, True):
                    text = "\n".join(form % point for point in zip(y, z))
                    path.write_text(text.replace(".", ",") if commas else text)
                    found = profiles.read(path, kind="rail")
                    np.testing.assert_allclose(found.y, y, atol=1e-3, err_msg=form)
                    np.testing.assert_allclose(found.z, z, atol=1e-3, err_msg=form)
            path.write_text("\n".join("%g,%g" % point for point in zip(y, z)))
            np.testing.assert_allclose(profiles.read(path, kind="rail").z, z, atol=1e-3)


class Messages(unittest.TestCase):
    def assert_says(self, words, call):
        with self.assertRaisesRegex((TypeError, ValueError, cn.ContactNormalError), words):
            call()

    def test_a_name_that_is_written_wrong_is_named(self):
        meant = r"no argument and no option forces \(is force meant\?\)"
        self.assert_says(meant, lambda: cn.solve(H, D, D, forces=1.0, **STEEL))
        self.assert_says(meant, lambda: cn.to_accuracy(H, D, D, forces=1.0, **STEEL))
        self.assert_says(meant, lambda: cn.quantities(H, D, D, forces=1.0, **STEEL))
        self.assert_says(meant, lambda: cn.cost_of_accuracy(H, D, D, forces=1.0, **STEEL))
        self.assert_says(r"\(is e_star meant\?\)", lambda: cn.solve(H, D, D, force=1.0, estar=1.0))
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            self.assert_says(meant, lambda: solver.solve(H, forces=1.0))

    def test_units_are_taken_wherever_a_scene_is(self):
        scene = {"force": 100.0, "units": ("mm", "N"), **STEEL}
        self.assertEqual(len(cn.quantities(H, D, D, coarser=0, **scene)), 3)
        self.assertEqual(len(cn.cost_of_accuracy(H, D, D, targets=[0.1], **scene)), 1)
        self.assertEqual(len(cn.what_matters(H, D, D, layer=1e-5, quantities=["force"], **scene)), 1)
        self.assert_says("units is 'mm'", lambda: cn.quantities(H, D, D, **{**scene, "units": "mm"}))

    def test_what_is_no_array(self):
        made = surface.heights(-H, D, D)
        self.assert_says("give dy, too", lambda: surface.heights(H, D))
        self.assert_says("h is a Gap; it must be an array: call its solve", lambda: cn.solve(surface.gap(made), D, D, force=1.0, **STEEL))
        self.assert_says("h is a Heights; it must be an array: make a gap", lambda: cn.solve(made, D, D, force=1.0, **STEEL))
        for function in (surface.faults, surface.level, surface.form, surface.border_jumps):
            self.assert_says("heights is a ndarray; it must be Heights: surface.heights", lambda function=function: function(H))
        self.assert_says("lower is a ndarray", lambda: surface.gap(H))
        self.assert_says("upper is a ndarray", lambda: surface.gap(made, H))
        self.assert_says("gap is a Heights; it must be a Gap", lambda: surface.balance(made, 1.0, **STEEL))

    def test_a_labelled_array_that_is_transposed(self):
        class Labelled(np.ndarray):
            dims = ("x", "y")

        self.assert_says(r"h has the dimensions \('x', 'y'\); x must be the last one", lambda: cn.solve(H.view(Labelled), D, D, force=1.0, **STEEL))
        self.assert_says("values has the dimensions", lambda: surface.heights(H.view(Labelled), D, D))
        np.testing.assert_array_equal(surface.heights(H.view(Labelled), D, D, axes="xy").z, H.T)

    def test_an_element_is_named_as_python_counts(self):
        h = H.copy()
        h[3, 17] = np.nan
        self.assert_says(r"element \[3, 17\] is NaN", lambda: cn.solve(h, D, D, force=1.0, **STEEL))

    def test_bodies(self):
        self.assert_says("give one of .*, and only one", lambda: cn.solve(H, D, D, force=1.0, e_star=1.0, **STEEL))
        self.assert_says("give poisson_ratio beside young_modulus", lambda: cn.solve(H, D, D, force=1.0, young_modulus=1.0))
        self.assert_says(r"each \(thickness, shear_modulus", lambda: cn.solve(H, D, D, force=1.0, coating=(0.1, 1.0, 0.3), **STEEL))

    def test_per_cent(self):
        for targets in ({"target": 1}, {"contact_area_target": 5.0}, {"targets": {"mean_gap": 2.0}}):
            self.assert_says("a relative error, below 1: that of 1 % is 0.01", lambda targets=targets: cn.to_accuracy(H, D, D, force=1.0, **targets, **STEEL))

        self.assert_says(r"targets\[1\] is 5; it is a relative error", lambda: cn.cost_of_accuracy(H, D, D, force=1.0, targets=[0.1, 5.0], **STEEL))
        self.assert_says("target is 5; it is a relative error", lambda: cn.what_matters(H, D, D, force=1.0, layer=1e-5, target=5.0, **STEEL))

    def test_a_creepage_that_is_looked_for(self):
        scene = {"force": 1000.0, "tolerance": 1e-8, **STEEL}
        one = cn.solve(H, D, D, friction={**ROLLING, "force": (100.0, None), "creepage": (None, 1e-4)}, **scene)
        same = cn.solve(H, D, D, friction={**ROLLING, "force": (100.0, None), "creepage": (0.0, 1e-4)}, **scene)
        np.testing.assert_array_equal(one.traction, same.traction)
        self.assert_says(r"creepage'\]\[0\] and friction\['force'\]\[0\] are None; give one",
                         lambda: cn.solve(H, D, D, friction={**ROLLING, "creepage": (None, 1e-4)}, **scene))

    def test_rollers(self):
        made = lambda **given: rollers.gap((1.2, 14.0), (12, 14), **{"radii": (6.0, 25.0), **given})  # noqa: E731
        self.assert_says("drop has a number; it must be a function of places y", lambda: made(drop=np.zeros(14)))
        self.assert_says("radii is 6.0; it must have one radius for each body", lambda: made(radii=6.0))
        self.assert_says("curvatures add up to", lambda: made(radii=(np.inf,)))

    def test_tracks(self):
        self.assert_says("rail is a wheel", lambda: profiles.Track(wheel()))
        self.assert_says("wheel is a rail", lambda: profiles.Wheelset(rail()))
        self.assert_says("rail is a str; it must be a Profile", lambda: profiles.Track("a.prr"))
        for wrong in ({"gauge": 1.435}, {"inclination": 40.0}):
            self.assert_says(f"{next(iter(wrong))} is", lambda wrong=wrong: profiles.Track(rail(), **wrong))
        for wrong in ({"radius": 0.46}, {"flange_back": 1.36}):
            self.assert_says("lengths are in mm", lambda wrong=wrong: profiles.Wheelset(wheel(), **wrong))

    def test_a_wheel_without_a_load(self):
        table = cn.creep_force_table(xi=[0.0, 0.5, 3.0], eta=[0.0], phi=[0.0, 1.0], axis_ratio=[1.0], elements=9)
        contact = {"semi_axes": (5.0, 5.0), "shear_modulus": 82e3, "coefficient": 0.3}
        for zero in ({"normal_force": 0.0}, {"normal_force": 8e4, "coefficient": 0.0}):
            for force in table.wheel_rail((np.full(4, -1e-3), 0.0), 1e-4, **{**contact, **zero}):
                np.testing.assert_array_equal(force, np.zeros(4))
        both = table.wheel_rail((-1e-3, 0.0), 1e-5, **contact, normal_force=np.array([0.0, 8e4]))
        one = table.wheel_rail((-1e-3, 0.0), 1e-5, **contact, normal_force=8e4)
        self.assertEqual([force[0] for force in both], [0.0, 0.0, 0.0])
        np.testing.assert_array_equal([force[1] for force in both], one)
        self.assert_says("normal_force is -1.0; it must not be negative", lambda: table.wheel_rail((0.0, 0.0), 0.0, **contact, normal_force=-1.0))
        self.assert_says("hold=True", lambda: table.wheel_rail((-1.0, 0.0), 0.0, **contact, normal_force=8e4))


class Texts(unittest.TestCase):
    def test_what_holds_arrays_prints_in_a_line(self):
        z = -H.copy()
        z[2, 3] = np.nan
        made = surface.heights(z, D, D, units=("mm", "N"))
        gap = surface.gap(made)
        self.assertEqual(repr(made), f"Heights(z=<24 x 24: from {np.nanmin(z):.6g} to {np.nanmax(z):.6g}, 1 not finite>, dx=0.1, dy=0.1, units=('mm', 'N'))")
        found = cn.solve(H, D, D, force=1000.0, friction={**ROLLING, "creepage": (-1e-3, 0.0)}, **STEEL)
        wear = cn.frictional_wear(found.traction, found.slip, D, D, coefficient=1e-4, hardness=1e3, rolling_distance=D)
        track = profiles.Track(rail())
        point = profiles.contact_points(track, profiles.Wheelset(wheel()))[0]
        for one in (gap, surface.faults(made), rail(), track, wear, point):
            self.assertLess(len(repr(one)), 400, type(one))
            self.assertNotIn("\n", repr(one))
        self.assertIn("rolling radius", repr(point))

    def test_lists_print_as_tables(self):
        rows = cn.quantities(H, D, D, names=["force", "mean_gap", "max_von_mises"], force=100.0, coating=((0.1, 4e4, 0.3), None), **STEEL)
        lines = str(rows).splitlines()
        self.assertIn("not with an effect of the scene", lines[3])
        # The columns have 18, 13, 16, 12 and 12 letters. Then follows the reason for a missing value.
        self.assertEqual({len(line[:71].rstrip()) for line in lines[:-1]}, {71})
        self.assertEqual(lines[-1], "force is that of the approach: the force is prescribed")
        self.assertNotIn("prescribed", str(cn.quantities(H, D, D, approach=0.01, **STEEL)))
        prices = cn.cost_of_accuracy(H, D, D, force=100.0, targets=[0.1, 0.01], **STEEL)
        self.assertEqual(len(str(prices).splitlines()), 3)

    def test_the_mean_gap_is_that_of_the_library(self):
        h = H.copy()
        h[:, :3] = np.inf
        found = cn.solve(h, D, D, force=100.0, **STEEL)
        rows = cn.quantities(h, D, D, names=["mean_gap"], coarser=0, force=100.0, **STEEL)
        # The two solves have a relative tolerance of 1e-6.
        self.assertAlmostEqual(found.mean_gap, rows.last("mean_gap").value, delta=1e-6 * found.mean_gap)
        self.assertAlmostEqual(found.mean_gap, (h - found.approach + found.displacement)[:, 3:].mean(), delta=1e-12)


class Pictures(unittest.TestCase):
    def tearDown(self):
        pyplot.close("all")

    def test_pressures_of_both_signs(self):
        x = X * 2
        sticky = cn.solve((x[None, :] ** 2 + x[:, None] ** 2) / 2, 2 * D, 2 * D, approach=0.0, e_star=0.75, adhesion={"work": 1 / np.pi})
        low, high = sticky.plot().images[0].get_clim()
        self.assertEqual(low, -high)
        self.assertLess(low, 0.0)
        plain = cn.solve(H, D, D, force=100.0, **STEEL).plot()
        self.assertEqual(plain.images[0].get_clim()[0], 0.0)
        self.assertEqual(plain.get_aspect(), 1.0)

    def test_what_cannot_be_drawn(self):
        plain = cn.solve(H, D, D, force=100.0, **STEEL)
        with self.assertRaisesRegex(ValueError, "names no friction"):
            plain.plot_traction()
        with self.assertRaisesRegex(TypeError, "results is a Result; it must be a sequence"):
            cn.plot_contact_area(plain)
        self.assertEqual(str(cn.what_matters(H, D, D, force=100.0, **STEEL)), "the scene names no effect: there is nothing to leave out")

    def test_a_few_peaks_do_not_darken_the_rest(self):
        x = np.arange(64) - 31.5
        waves = 1e-3 * np.cos(2 * np.pi * x / 8)[None, :] * np.cos(2 * np.pi * x / 8)[:, None]
        waves[30, 30] -= 0.02
        axes = cn.solve(waves, D, D, force=3e3, period="xy", **STEEL).plot()
        pressures = axes.images[0].get_array()
        self.assertLess(axes.images[0].get_clim()[1], 0.5 * pressures.max())
        bar = axes.figure.axes[1]
        self.assertEqual(bar.get_ylabel(), f"pressure, at most {pressures.max():.4g}")

    def test_slender_grids_are_not_drawn_to_scale(self):
        gap = rollers.gap((1.2, 14.0), (24, 28), (6.0, 25.0), drop=rollers.crown(14.0, 500.0, 8.0))
        for axes in (gap.plot(), gap.solve(force=3000.0, e_star=1e5).plot()):
            self.assertEqual(axes.get_aspect(), "auto")

    def test_what_has_no_error_is_named(self):
        cone = 0.1 * np.hypot(X[None, :], X[:, None])
        axes = cn.quantities(cone, D, D, names=["force", "max_pressure"], force=100.0, **STEEL).plot()
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["approach", "max pressure:\nsingular"])
        prices = cn.cost_of_accuracy(H, D, D, force=100.0, max_elements=4, **STEEL)
        with self.assertRaisesRegex(ValueError, "no accuracy of the list can be had: too many elements"):
            prices.plot()

    def test_times_have_two_numbers_or_more(self):
        for rows in (cn.quantities(H, D, D, force=100.0, **STEEL), cn.solve(H, D, D, force=100.0, **STEEL).ledger):
            axes = rows.plot()
            axes.figure.canvas.draw()
            first, last = axes.get_xlim()
            shown = [tick for tick in axes.get_xticks() if first <= tick <= last]
            # The ticks are 1, 2, 3, 5, 7 and their decades, so that neighbours differ by a factor of 2 at most.
            self.assertGreaterEqual(len(shown), int(np.log2(last / first)))

    def test_a_creep_curve(self):
        entries = np.outer(np.linspace(-4e-3, 0.0, 5), (0.0, 1.0, 0.0))
        batch = cn.friction_batch(H, D, D, entries, force=1000.0, friction=ROLLING, units=("mm", "N"), **STEEL)
        axes = batch.plot()
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("creepage in y", "tangential force on body 1 [N]"))
        np.testing.assert_array_equal(axes.get_lines()[1].get_xydata(), np.column_stack([entries[:, 1], batch.force[:, 1]]))
        self.assertEqual(batch.plot("x").get_xlabel(), "creepage in x")
        with self.assertRaisesRegex(ValueError, "over is 'spin'"):
            batch.plot("spin")


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def written(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def test_texts_that_are_no_grid_of_heights(self):
        for name, text, words in (
            ("a.csv", "x,y\n1,2\n", "a.csv: .*separated by commas; put # before other lines"),
            ("b.csv", "1,5;2,5\n3;four\n", "b.csv: .*separated by semicolons"),
            ("c.txt", "1 2 3\n4 5\n", "c.txt: .*separated by spaces"),
            ("d.txt", "# nothing\n", "d.txt has no numbers"),
            ("e.txt", "".join(f"{x} {y} {x * y}\n" for x in range(3) for y in range(2)), "e.txt has x, y and z of 6 points"),
            ("f.npy", "hello", "f.npy is no file of numbers"),
            ("g.npz", "PK", "g.npz is no file of numbers"),
        ):
            with self.assertRaisesRegex(ValueError, words):
                surface.read(self.written(name, text), dx=1, dy=1)
        with self.assertRaisesRegex(OSError, "is a folder"):
            surface.read(self.folder, dx=1, dy=1)
        # Semicolons separate values. Three columns that are not points of a grid are read as heights.
        np.testing.assert_array_equal(surface.read(self.written("h.csv", "1,5;2\n3;4\n"), dx=1, dy=1).z, [[1.5, 2], [3, 4]])
        self.assertEqual(surface.read(self.written("i.txt", "1 2 3\n1 2 4\n1 3 3\n2 3 1\n"), dx=1, dy=1).z.shape, (4, 3))

    def test_a_file_that_cannot_be_written_is_refused_before_the_solve(self):
        npy = self.folder / "ball.npy"
        np.save(npy, HEIGHTS)
        for option, file, words in (("-o", "no/p.npz", "there is no folder"), ("--plot", "no/p.png", "there is no folder")):
            code, out, told = called("solve", npy, *BALL, option, self.folder / file)
            self.assertEqual((code, out), (4, ""))
            self.assertIn(words, told)

    def test_hints(self):
        spiked = HEIGHTS.copy()
        spiked[5, 6] += 10.0
        np.save(self.folder / "spiked.npy", spiked)
        _, out, _ = called("solve", self.folder / "spiked.npy", *BALL)
        self.assertRegex(out, "hint +--faults finds spikes")
        _, out, _ = called("solve", self.folder / "spiked.npy", *BALL, "--faults")
        self.assertNotIn("hint", out)
        for line in ("mean gap", "error of the pressure", "error of the area"):
            self.assertIn(f"\n{line}", out)
        surface.gap(surface.heights(HEIGHTS, 0.06, 0.05)).write(self.folder / "gap.txt")
        lines = (self.folder / "gap.txt").read_text().splitlines()
        for broken, words in (([*lines[:2], "3 4"], "has '3 4' in line 3; it must have mx my dx dy"), ([*lines[:2], "a 4 1 1"], "must have mx my"),
                              ([*lines[:3], "x"], "one undeformed distance a line"), (lines[:3], "has 0 distances; 56 x 40 elements need 2240")):
            self.written("broken.txt", "\n".join(broken))
            code, _, told = called("solve", self.folder / "broken.txt", *BALL[4:], "--gap")
            self.assertEqual(code, 3)
            self.assertIn(words, told)
        self.assertEqual(called("solve", self.folder / "gap.txt", *BALL)[0], 3)
        self.assertIn("holds a gap, and not heights: add --gap", called("solve", self.folder / "gap.txt", *BALL)[2])


if __name__ == "__main__":
    unittest.main()
