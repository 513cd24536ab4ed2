"""Wrong arguments are named by a message of this package, not by an error of Python within it."""

import contextlib
import re
import unittest
from types import SimpleNamespace

import matplotlib
import numpy as np

import contact_normal as cn
from contact_normal import surface

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
X = (np.arange(24) - 11.5) * 0.1
H = (X[None, :] ** 2 + X[:, None] ** 2) / 100.0


class Arguments(unittest.TestCase):
    def test_places_of_sections(self):
        self.addCleanup(pyplot.close, "all")
        found = cn.solve(H, 0.1, 0.1, force=100.0, **STEEL)
        below = found.subsurface([0.1, 0.5])
        for draw, name in ((lambda v: found.plot_section(x=v), "x"), (lambda v: found.plot_section(y=v), "y"), (lambda v: below.plot_section(x=v), "x"),
                           (lambda v: below.plot_depth(v, 0.0), "x"), (lambda v: below.plot_depth(0.0, v), "y")):
            for wrong in (np.nan, np.inf, -np.inf, 9.0, 1e300):
                with self.subTest(name, wrong=wrong), self.assertRaisesRegex(ValueError, re.escape(f"{name} is {wrong}; it must lie within the grid")):
                    draw(wrong)
            for wrong in ("a", [1.0], np.array([0.1])):
                with self.subTest(name, wrong=wrong), self.assertRaisesRegex(TypeError, f"^{name} is .*; it must be a real number"):
                    draw(wrong)
        found.plot_section(x=np.float32(0.5))

    def test_targets_of_quantities(self):
        for wrong in (["force"], 0.1, "force", np.array([1.0, 2.0])):
            with self.subTest(wrong), self.assertRaisesRegex(TypeError, r"^targets is .*; it must be a mapping, as \{'force': 0.01\}"):
                cn.solve_to_accuracy(lambda x, y: x * x + y * y, 0.1, 0.1, shape=(24, 24), force=1.0, targets=wrong, **STEEL)

    def test_a_quantity_that_was_not_asked_for(self):
        rows = cn.quantities(H, 0.1, 0.1, force=100.0, names=["force", "contact_area"], **STEEL)
        self.assertEqual(rows.last("force").name, "force")
        for wrong in ("stiffness", 3):
            with self.assertRaisesRegex(ValueError, f"^name is {wrong!r}; it must be one of those asked for: force, contact_area"):
                rows.last(wrong)

    def test_a_share_of_heat(self):
        given = {"conductivity": 1.0, "diffusivity": 1.0}
        for wrong in ("a", [0.5], 1j):
            with self.assertRaisesRegex(TypeError, "^share is .*; it must be a real number"):
                cn.flash_temperature(np.ones((4, 4)), 0.1, 0.1, share=wrong, **given)
        for wrong in (np.nan, -1.0):
            with self.assertRaisesRegex(ValueError, r"^share is .*; a part must lie in \[0, 1\]"):
                cn.flash_temperature(np.ones((4, 4)), 0.1, 0.1, share=wrong, **given)

    def test_what_is_no_array_of_a_package(self):
        dataset = SimpleNamespace(dims={"y": 4, "x": 4}, data_vars={"z": 1, "mask": 2}, values=dict)
        with self.assertRaisesRegex(TypeError, r"^array is a SimpleNamespace; it must be a DataArray: choose one of z, mask"):
            surface.from_xarray(dataset, dx=1.0, dy=1.0)
        for wrong in (H, None):
            with self.assertRaisesRegex(TypeError, rf"^array is a {type(wrong).__name__}; it must be a DataArray$"):
                surface.from_xarray(wrong, dx=1.0, dy=1.0)
            with self.assertRaisesRegex(TypeError, rf"^topography is a {type(wrong).__name__}; it must be a topography of SurfaceTopography$"):
                surface.from_topography(wrong, dx=1.0, dy=1.0)

    def test_counts_below_0_are_named(self):
        for shape, told in (((-3, 24), "my is -3"), ((24, -3), "mx is -3"), ((0, 24), "my is 0")):
            calls = [lambda: cn.Solver(*shape, 0.1, 0.1, **STEEL)]
            calls += [lambda call=call: call(lambda x, y: x * x + y * y, 0.1, 0.1, shape=shape, force=1.0, **STEEL) for call in (cn.solve_to_accuracy, cn.cost_of_accuracy)]
            for call in calls:
                with self.subTest(shape), self.assertRaisesRegex(cn.ContactNormalError, f"^{told}; it must be positive"):
                    call()

    def test_names_of_an_array_of_names_are_names(self):
        for period in np.array(["x", "y", "xy"]):
            self.assertIsInstance(period, np.str_)
            plain = cn.solve(H, 0.1, 0.1, force=1.0, period=str(period), **STEEL)
            np.testing.assert_array_equal(cn.solve(H, 0.1, 0.1, force=1.0, period=period, **STEEL).pressure, plain.pressure)
            with cn.Solver(24, 24, 0.1, 0.1, period=period, **STEEL) as solver:
                np.testing.assert_array_equal(solver.solve(H, force=1.0).pressure, plain.pressure)
            gap = surface.gap(surface.heights(-H, 0.1, 0.1, period=period))
            self.assertEqual(gap.solve(force=1.0, **STEEL).status, cn.OK)
            self.assertEqual(cn.pull_off(H, 0.1, 0.1, e_star=1.0, period=period, adhesion={"work": 1e-3, "range": 0.1}).status, cn.OK)
        with self.assertRaisesRegex(ValueError, "^period is .*'z'.*; it must be 'x', 'y' or 'xy'"):
            cn.solve(H, 0.1, 0.1, force=1.0, period=np.str_("z"), **STEEL)


class Closed:
    """A stream of a host that closed it. Nothing can be said of it, or written."""

    def __init__(self, error):
        self.write = self.flush = self.isatty = self.fail
        self._error = error

    def fail(self, *_):
        raise self._error("the stream is closed")


class Streams(unittest.TestCase):
    def test_a_stderr_that_fails_ends_no_solve(self):
        from contact_normal._bar import has_terminal

        plain = cn.solve(H, 0.1, 0.1, force=1.0, **STEEL)
        for error in (RuntimeError, OSError, ValueError, AttributeError, TypeError, UnicodeError):
            with self.subTest(error), contextlib.redirect_stderr(Closed(error)):
                found = cn.solve(H, 0.1, 0.1, force=1.0, progress=True, **STEEL)
                is_terminal = has_terminal()
            np.testing.assert_array_equal(found.pressure, plain.pressure)
            self.assertFalse(is_terminal)
        for error in (KeyboardInterrupt, SystemExit):
            with contextlib.redirect_stderr(Closed(error)), self.assertRaises(error):
                cn.solve(H, 0.1, 0.1, force=1.0, progress=True, **STEEL)


if __name__ == "__main__":
    unittest.main()
