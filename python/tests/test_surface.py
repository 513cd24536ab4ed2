"""From heights to a gap: each step compared with a known result, and the effect of mistakes."""

import time
import unittest
import warnings
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal import surface
from contact_normal.surface._faults import neighbours_median

MY, MX, DX, DY = 24, 36, 0.5, 0.25
X = (np.arange(MX) - 0.5 * (MX - 1)) * DX
Y = (np.arange(MY) - 0.5 * (MY - 1)) * DY


def rough(n=64, seed=1):
    """A self-affine surface with the grid as its period, and an rms of 1."""
    rng = np.random.default_rng(seed)
    waves = np.fft.fftfreq(n) * n
    k = np.hypot(waves[:, None], waves[None, :])
    amplitudes = np.where((k >= 2) & (k <= max(n / 8, 2)), np.maximum(k, 1.0) ** -1.8, 0.0)
    z = np.fft.ifft2(np.fft.fft2(rng.normal(size=(n, n))) * amplitudes).real
    return z / z.std()


class Arrays(unittest.TestCase):
    Z = np.arange(12.0).reshape(3, 4)

    def test_the_indices_are_turned(self):
        self.assertEqual(surface.heights(self.Z, 1, 1).z.shape, (3, 4))
        turned = surface.heights(self.Z, 2.0, 3.0, axes="xy")
        np.testing.assert_array_equal(turned.z, self.Z.T)
        self.assertEqual((turned.dx, turned.dy), (2.0, 3.0))
        self.assertTrue(turned.z.flags.c_contiguous)
        with self.assertRaisesRegex(ValueError, 'axes is \'ij\'; it must be "yx" or "xy"'):
            surface.heights(self.Z, 1, 1, axes="ij")
        np.testing.assert_array_equal(surface.heights(self.Z, 1, 1, top_first=True).z, self.Z[::-1])

    def test_the_size_of_an_element_in_four_ways(self):
        for given, dx, dy in (
            ({"dx": 0.5, "dy": 2.0}, 0.5, 2.0),
            ({"size": (2.0, 6.0)}, 0.5, 2.0),
            ({"span": (1.5, 4.0)}, 0.5, 2.0),
            ({"x": [1.0, 1.5, 2.0, 2.5], "y": [0.0, 2.0, 4.0]}, 0.5, 2.0),
        ):
            made = surface.heights(self.Z, **given)
            self.assertEqual((made.dx, made.dy), (dx, dy))
            self.assertEqual(made.area, 12.0)
            self.assertEqual(made.force(3.0), 36.0)
            np.testing.assert_array_equal(made.z, self.Z)
        falling = surface.heights(self.Z, x=[2.5, 2.0, 1.5, 1.0], y=[4.0, 2.0, 0.0])
        np.testing.assert_array_equal(falling.z, self.Z[::-1, ::-1])
        self.assertEqual((falling.dx, falling.dy), (0.5, 2.0))
        # Decreasing y and top_first mean the same, so that rows are reversed only once.
        twice = surface.heights(self.Z, x=[1.0, 1.5, 2.0, 2.5], y=[4.0, 2.0, 0.0], top_first=True)
        np.testing.assert_array_equal(twice.z, self.Z[::-1])
        with self.assertRaisesRegex(ValueError, "y has one place, which tells no spacing: give dx and dy"):
            surface.heights(self.Z[:1], x=[1.0, 1.5, 2.0, 2.5], y=[0.0])
        for given in ({}, {"dx": 1.0, "dy": 1.0, "size": (1.0, 1.0)}, {"size": (1.0, 1.0), "span": (1.0, 1.0)}):
            with self.assertRaisesRegex(TypeError, "give the size of an element in one way"):
                surface.heights(self.Z, **given)
        with self.assertRaisesRegex(ValueError, "x is not evenly spaced"):
            surface.heights(self.Z, x=[0.0, 1.0, 2.0, 3.1], y=[0.0, 1.0, 2.0])
        with self.assertRaisesRegex(ValueError, "x is not evenly spaced"):
            surface.heights(self.Z, x=[0.0, 1e-6, 2e-6, 3.1e-6], y=[0.0, 1e-6, 2e-6])
        for given in ({"x": [0.0, 1.0, 2.0, 3.0]}, {"dy": 1.0}, {"dx": 1.0}):
            with self.assertRaises(TypeError):
                surface.heights(self.Z, **given)
        with self.assertRaisesRegex(ValueError, r"y has shape \(4,\); it must be \(3,\)"):
            surface.heights(self.Z, x=[0.0, 1.0, 2.0, 3.0], y=[0.0, 1.0, 2.0, 3.0])
        with self.assertRaisesRegex(ValueError, "element sizes are 0.0 and 1.0; they must be positive"):
            surface.heights(self.Z, 0.0, 1.0)

    def test_what_was_not_measured_becomes_a_hole(self):
        z = self.Z.copy()
        z[0, 1], z[1, 2], z[2, 3] = np.nan, np.inf, -np.inf
        masked = np.ma.masked_where(self.Z == 4.0, self.Z)
        self.assertEqual(np.argwhere(surface.heights(z, 1, 1).holes).tolist(), [[0, 1], [1, 2], [2, 3]])
        self.assertEqual(np.argwhere(surface.heights(masked, 1, 1).holes).tolist(), [[1, 0]])
        self.assertEqual(np.argwhere(surface.heights(masked.astype(int), 1, 1).holes).tolist(), [[1, 0]])
        self.assertEqual(np.argwhere(surface.heights(self.Z, 1, 1, fill=7.0).holes).tolist(), [[1, 3]])
        np.testing.assert_array_equal(surface.heights(self.Z, 1, 1).without(self.Z > 9).holes, self.Z > 9)
        with self.assertRaisesRegex(ValueError, "it must be a mask of booleans"):
            surface.heights(self.Z, 1, 1).without(np.ones((3, 4)))


    def test_masked_values_are_numbers(self):
        rows = [np.ma.masked_equal(row, 5.0) for row in self.Z]
        self.assertEqual(np.argwhere(surface.heights(rows, 1, 1).holes).tolist(), [[1, 1]])
        for values in (self.Z * 1j, self.Z > 1, self.Z.astype(str)):
            with self.assertRaisesRegex(TypeError, "it must hold real numbers"):
                surface.heights(np.ma.masked_array(values, self.Z == 5.0), 1, 1)

    def test_fill_values_of_single_precision_that_a_reader_made_double(self):
        values = np.where(self.Z == 5.0, -9999.9, self.Z).astype(np.float32).astype(np.float64)
        self.assertEqual(np.argwhere(surface.heights(values, 1, 1, fill=-9999.9).holes).tolist(), [[1, 1]])
        # The decimal text of the largest number of single precision is rounded up: read as a double it exceeds that number.
        for largest in (3.4028235e38, -3.4028235e38):
            values = np.where(self.Z == 5.0, largest, self.Z).astype(np.float32).astype(np.float64)
            self.assertEqual(np.argwhere(surface.heights(values, 1, 1, fill=largest).holes).tolist(), [[1, 1]])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaisesRegex(UserWarning, "no element has the value 1e\\+300"):
                surface.heights(self.Z, 1, 1, fill=1e300)
        with self.assertRaisesRegex(TypeError, "fill is '-9999'; it must be a real number"):
            surface.heights(values, 1, 1, fill="-9999")


class Faults(unittest.TestCase):
    def test_fill_values_are_those_of_the_array(self):
        z = np.array([[0.5, -9999.9, 0.7], [0.1, 1e20, 0.3]], dtype=np.float32)
        for value, place in ((-9999.9, [0, 1]), (1e20, [1, 1])):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                self.assertEqual(np.argwhere(surface.heights(z, 1, 1, fill=value).holes).tolist(), [place])
                # NaN needs no fill value, but may be given as one.
                surface.heights(np.where(z > 1.0, np.nan, z), 1, 1, fill=np.nan)

    def test_fill_values_are_found(self):
        z = 1e-6 * rough()
        where = np.zeros(z.shape, dtype=bool)
        where[10:20, 30:35] = True
        for value in (-9999.0, 1e38, 0.1):
            found = surface.faults(surface.heights(np.where(where, value, z), 1, 1))
            self.assertEqual(found.fill_values, (value,))
            np.testing.assert_array_equal(found.fills, where)
            np.testing.assert_array_equal(found.removed.holes, where)
            self.assertEqual(found.spikes.sum(), 0)
            self.assertIn(f"50 elements have the value {value:g}", str(found))
        both = np.where(where, -9999.0, z)
        both[40:42, 3] = 9999.0
        self.assertEqual(set(surface.faults(surface.heights(both, 1, 1)).fill_values), {-9999.0, 9999.0})

    def test_fill_values_that_are_left_are_told(self):
        z = 1e-3 * rough() + 0.01
        made = surface.heights(np.where(np.arange(64) == 7, 0.0, z), 0.1, 0.1)
        plain = surface.heights(z, 0.1, 0.1)
        for use in (surface.level, surface.gap, lambda one: surface.gap(plain, one)):
            with self.assertWarnsRegex(UserWarning, "64 elements have the value 0, which seems to stand for 'not measured': .*fill=.*faults") as told:
                use(made)
            self.assertEqual(told.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            surface.gap(surface.level(surface.faults(made).removed))
            surface.gap(plain)

    def test_what_is_measured_is_no_fault(self):
        # No spikes: a plateau at the top, a bump, and heights of an 8-bit instrument.
        for z in (np.minimum(rough(), 1.0), rough() + np.where(np.hypot(*np.mgrid[-32:32, -32:32]) < 9, 3.0, 0.0), np.round(8 * rough())):
            found = surface.faults(surface.heights(z, 1, 1))
            self.assertEqual(found.fill_values, ())
            self.assertEqual(found.fills.sum(), 0)
        self.assertEqual(surface.faults(surface.heights(rough(), 1, 1)).spikes.sum(), 0)
        self.assertEqual(surface.faults(surface.heights(np.round(8 * rough()), 1, 1)).spikes.sum(), 0)
        steps = np.where(np.arange(64) < 32, 0.0, 5.0) + np.zeros((64, 1))
        self.assertEqual(surface.faults(surface.heights(steps, 1, 1)).fill_values, ())
        self.assertEqual(surface.faults(surface.heights(np.full((5, 5), np.nan), 1, 1)).spikes.sum(), 0)

    def test_large_maps_are_worked_on_in_blocks(self):
        made = surface.heights(np.tile(rough(), (10, 10)) + 0.01 * np.arange(640), 1, 1)
        with mock.patch("contact_normal.surface._heights._BLOCK", 1 << 30):
            whole, plane = neighbours_median(made.z, "x"), surface.form(made)
        np.testing.assert_array_equal(neighbours_median(made.z, "x"), whole)
        np.testing.assert_allclose(surface.form(made).coefficients, plane.coefficients, rtol=1e-9)

    def test_the_median_of_neighbours(self):
        z = rough(16)[:6, :7]
        z[2, 3] = z[0, 1] = z[5, 6] = np.nan
        z[3, 0:2] = np.nan
        for period, modes in ((None, ("constant", "constant")), ("x", ("constant", "wrap")), ("y", ("wrap", "constant")), ("xy", ("wrap", "wrap"))):
            padded = z
            for axis, mode in enumerate(modes):
                width = [(1, 1) if k == axis else (0, 0) for k in range(2)]
                padded = np.pad(padded, width, **({"mode": "wrap"} if mode == "wrap" else {"constant_values": np.nan}))
            around = np.stack([padded[j : j + 6, i : i + 7] for j in range(3) for i in range(3) if (j, i) != (1, 1)])
            np.testing.assert_array_equal(neighbours_median(z, period), np.nanmedian(around, axis=0))

    def test_spikes_are_found_also_at_borders_and_beside_holes(self):
        z = rough()
        z[20, 21] = np.nan
        spikes = np.zeros(z.shape, dtype=bool)
        for iy, ix, height in ((5, 7, 4.0), (20, 20, 5.0), (0, 0, -4.0), (63, 30, 6.0), (40, 40, -6.0)):
            z[iy, ix] += height
            spikes[iy, ix] = True
        found = surface.faults(surface.heights(z, 1, 1))
        np.testing.assert_array_equal(found.spikes, spikes)
        self.assertIn("1 of 4096 elements (0.02%) were not measured", str(found))
        self.assertIn("5 spikes, the first ones at (iy, ix) = (0, 0), (5, 7)", str(found))
        self.assertEqual(found.removed.holes.sum(), 6)
        # With a period the neighbours of elements at the border are at the opposite border.
        step = np.zeros((8, 8))
        step[:, 0] = step[0, :] = 1.0
        step += 1e-3 * np.random.default_rng(2).normal(size=step.shape)
        step[0, 0] = 0.0
        self.assertTrue(surface.faults(surface.heights(step, 1, 1)).spikes[0, 0])

    def test_slopes_at_borders_and_beside_holes_are_no_spikes(self):
        x, y = np.arange(120.0)[None, :], np.arange(100.0)[:, None]
        z = 1.5 * np.sin(2 * np.pi * x / 60) * np.cos(2 * np.pi * y / 45) + 0.3 * x + 0.2 * y
        z[30:50, 40:70] = np.nan
        made = surface.heights(z, 1, 1)
        self.assertEqual(surface.faults(made).spikes.sum(), 0)
        # Inside only the spike is found. At an edge its two neighbours along the edge may be marked, too, because the spike is one of their five
        # neighbours.
        for place, most in (((20, 20), 1), ((0, 60), 3), ((99, 3), 3), ((40, 39), 3), ((50, 55), 3), ((0, 0), 3)):
            spoiled = made.z.copy()
            spoiled[place] += 4.0
            found = np.argwhere(surface.faults(surface.heights(spoiled, 1, 1)).spikes)
            self.assertIn(place, [tuple(one) for one in found])
            self.assertLessEqual(len(found), most, place)
            self.assertLessEqual(np.abs(found - place).max(), 1)

    def test_one_spike_carries_the_load(self):
        z = 1e-3 * rough()
        z[5, 7] += 0.5
        found = surface.faults(surface.heights(z, 1, 1))
        taken = surface.gap(found.heights).solve(force=1e-3, e_star=1.0)
        self.assertGreater(taken.pressure[5, 7] / taken.pressure.sum(), 0.99)
        self.assertLess(surface.gap(found.removed).solve(force=1e-3, e_star=1.0).pressure.max() / taken.pressure.max(), 0.2)


class Levels(unittest.TestCase):
    def test_planes_and_quadrics_are_removed(self):
        plane = 3.0 + 0.02 * X[None, :] - 0.01 * Y[:, None]
        quadric = plane - X[None, :] ** 2 / 80.0 + 1e-3 * X[None, :] * Y[:, None] + Y[:, None] ** 2 / 60.0
        for z, kind in ((np.full((MY, MX), 3.0), "mean"), (plane, "plane"), (quadric, "quadric")):
            z = z.copy()
            z[3:9, 4:12] = np.nan
            made = surface.heights(z, DX, DY)
            left = surface.level(made, kind).z
            # A few hundred rounding errors of heights of about 3.
            self.assertLess(np.nanmax(np.abs(left)), 1e-12)
            np.testing.assert_array_equal(np.isnan(left), np.isnan(z))
            self.assertLess(surface.form(made, kind).rms, 1e-12)
        fitted = surface.form(surface.heights(quadric, DX, DY), "quadric")
        np.testing.assert_allclose(fitted.tilt, (0.02, -0.01), rtol=1e-10)
        np.testing.assert_allclose(fitted.radii, (40.0, -30.0), rtol=1e-10)
        self.assertEqual(surface.form(surface.heights(plane, DX, DY)).radii, (np.inf, np.inf))
        self.assertEqual(surface.form(surface.heights(plane, DX, DY), "mean").tilt, (0.0, 0.0))

    def test_a_plane_is_that_of_least_squares(self):
        z = rough(32)
        left = surface.level(surface.heights(z, DX, DY)).z
        x, y = (np.arange(32) - 15.5) * DX, (np.arange(32) - 15.5) * DY
        # After least squares the rest has no moments. Each moment is a sum of 1024 terms of about 10.
        for moment in (left.sum(), (left * x[None, :]).sum(), (left * y[:, None]).sum()):
            self.assertLess(abs(moment), 1e-10)

    def test_what_cannot_be_levelled_is_refused(self):
        with self.assertRaisesRegex(ValueError, "a plane would break the period"):
            surface.level(surface.heights(rough(), 1, 1, period="xy"))
        self.assertLess(abs(surface.level(surface.heights(rough() + 5, 1, 1, period="xy"), "mean").z.mean()), 1e-12)
        with self.assertRaisesRegex(ValueError, "a plane has 3 unknowns; 20 heights of the"):
            surface.level(surface.heights(np.where(np.arange(30)[:, None] == 4, np.ones((30, 20)), np.nan), 1, 1))
        with self.assertRaisesRegex(ValueError, "kind is 'cubic'; it must be one of mean, plane, quadric"):
            surface.form(surface.heights(rough(), 1, 1), "cubic")

    def test_jumps_at_the_border_tell_a_period(self):
        self.assertLess(max(surface.border_jumps(surface.heights(rough(), 1, 1))), 1.5)
        self.assertEqual(surface.border_jumps(surface.heights(np.ones((4, 5)), 1, 1)), (0.0, 0.0))
        steps = np.where(np.arange(4)[:, None] < 2, 0.0, 1.0) + np.zeros((4, 5))
        self.assertEqual(surface.border_jumps(surface.heights(steps, 1, 1))[0], 0.0)
        # One of the three steps between rows is 1, the others are 0: an rms of sqrt(1/3). The step across the border is 1.
        self.assertAlmostEqual(surface.border_jumps(surface.heights(steps, 1, 1))[1], np.sqrt(3.0), delta=1e-12)
        # Without pairs of heights across the border, or inside, the ratio is NaN, without a warning of numpy.
        holes = np.where(np.arange(5) == 4, np.nan, rough()[:5, :5])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            jump_x, jump_y = surface.border_jumps(surface.heights(holes, 1, 1))
            self.assertTrue(np.isnan(surface.border_jumps(surface.heights(np.ones((1, 5)), 1, 1))[1]))
        self.assertTrue(np.isnan(jump_x) and jump_y > 0.0)
        tilted = rough() + 0.2 * np.arange(64)
        jump_x, jump_y = surface.border_jumps(surface.heights(tilted, 1, 1))
        self.assertGreater(jump_x, 10.0)
        self.assertLess(jump_y, 1.5)


class Gaps(unittest.TestCase):
    def test_a_gap_is_zero_where_the_highest_places_are(self):
        z = rough()
        z[3, 4] = np.nan
        gap = surface.gap(surface.heights(z, DX, DY, period="x", units=("mm", "N")))
        np.testing.assert_array_equal(gap.h, np.where(np.isnan(z), np.inf, np.nanmax(z) - z))
        self.assertEqual((gap.dx, gap.dy, gap.period, gap.units), (DX, DY, "x", ("mm", "N")))
        self.assertEqual(gap.area, 64 * 64 * DX * DY)
        moved = surface.Gap(gap.h[:10], DX, DY, middle=(3.0, -4.0))
        np.testing.assert_allclose(moved.x, 3.0 + (np.arange(64) - 31.5) * DX, atol=1e-13)
        np.testing.assert_allclose(moved.y, -4.0 + (np.arange(10) - 4.5) * DY, atol=1e-13)
        result = gap.solve(force=1e-2, e_star=1.0)
        self.assertEqual(result.pressure[3, 4], 0.0)
        self.assertEqual(result.units, ("mm", "N"))
        other = cn.solve(gap.h, DX, DY, force=1e-2, e_star=1.0, period="x")
        np.testing.assert_array_equal(result.pressure, other.pressure)

    def test_two_surfaces_lie_face_to_face(self):
        one, other = rough(seed=1), rough(seed=2)
        other[7, 9] = np.nan
        lower, upper = surface.heights(one, DX, DY), surface.heights(other, DX, DY)
        for turned, seen in (("y", other[:, ::-1]), ("x", other[::-1]), ("", other)):
            expected = -(one + seen)
            expected -= np.nanmin(expected)
            np.testing.assert_array_equal(surface.gap(lower, upper, turned=turned).h, np.where(np.isnan(expected), np.inf, expected))
        # A replica of a surface, turned over, fits everywhere.
        print_of = surface.heights(-one[:, ::-1], DX, DY)
        np.testing.assert_allclose(surface.gap(lower, print_of).h, 0.0, atol=1e-14)
        with self.assertRaisesRegex(ValueError, "grids must be equal"):
            surface.gap(lower, surface.heights(other, DX, 2 * DY))
        with self.assertRaisesRegex(ValueError, "the periods are None and 'x'"):
            surface.gap(lower, surface.heights(other, DX, DY, period="x"))
        with self.assertRaisesRegex(ValueError, "no element was measured on both"):
            surface.gap(surface.heights(np.full((3, 3), np.nan), 1, 1))

    def test_e_star(self):
        self.assertAlmostEqual(surface.e_star(210e3, 0.3), 210e3 / (2 * 0.91), delta=1e-9)
        self.assertAlmostEqual(surface.e_star((210e3, np.inf), (0.3, 0.2)), 210e3 / 0.91, delta=1e-9)
        self.assertAlmostEqual(surface.e_star((210e3, 70e3), (0.3, 0.33)), 1 / (0.91 / 210e3 + (1 - 0.33**2) / 70e3), delta=1e-9)
        self.assertEqual(surface.e_star(np.inf, 0.3), np.inf)
        gap = surface.gap(surface.heights(rough(), 1, 1))
        by_e_star = gap.solve(mean_pressure=10.0, e_star=surface.e_star((210e3, 70e3), (0.3, 0.33)))
        by_young = gap.solve(mean_pressure=10.0, young_modulus=(210e3, 70e3), poisson_ratio=(0.3, 0.33))
        np.testing.assert_allclose(by_e_star.pressure, by_young.pressure, rtol=1e-9, atol=1e-6 * by_young.max_pressure)
        for young, nu in ((0.0, 0.3), (1.0, 0.6), (-1.0, 0.3)):
            with self.assertRaisesRegex(ValueError, f"young_modulus is {young} and poisson_ratio {nu}"):
                surface.e_star(young, nu)


class Balance(unittest.TestCase):
    def test_a_tilted_ball_is_turned_upright(self):
        # A tilted paraboloid is a shifted one. In balance its lowest point is under the force.
        n, d, radius, tilt = 65, 0.02, 2.0, (0.15, -0.1)
        x = (np.arange(n) - n // 2) * d
        h = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius) + tilt[0] * x[None, :] + tilt[1] * x[:, None]
        found = surface.balance(surface.Gap(h, d, d), 2e-2, tolerance=1e-5, e_star=1.0)
        # The centre is within 1e-5 n d of the force. Divided by the radius, that is the error of the tilt.
        np.testing.assert_allclose(found.tilt, tilt, atol=1e-5 * n * d / radius)
        self.assertLess(np.abs(found.centre).max(), 1e-5 * n * d)
        upright = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius)
        np.testing.assert_allclose(found.gap.h, upright, atol=1e-5 * (n * d) ** 2 / radius)
        # The same for a tilt in one direction.
        for one in ((tilt[0], 0.0), (0.0, tilt[1])):
            found = surface.balance(surface.Gap(upright + one[0] * x[None, :] + one[1] * x[:, None], d, d), 2e-2, tolerance=1e-5, e_star=1.0)
            np.testing.assert_allclose(found.tilt, one, atol=1e-5 * n * d / radius)
        # A force off the middle tilts the ball.
        beside = surface.balance(surface.Gap(h, d, d), 2e-2, at=(0.1, 0.05), tolerance=1e-5, e_star=1.0)
        np.testing.assert_allclose(beside.tilt, (tilt[0] + 0.1 / radius, tilt[1] + 0.05 / radius), atol=1e-5 * n * d / radius)

    def test_a_rough_body_rests_where_its_moments_vanish(self):
        made = surface.heights(1e-2 * rough() + 0.01 * np.arange(64), 1 / 64, 1 / 48)
        found = surface.balance(surface.gap(surface.level(made)), 1e-3, at=(0.1, -0.2), e_star=1.0)
        self.assertEqual(found.result.status, cn.OK)
        p, result = found.result.pressure, found.result
        np.testing.assert_allclose(found.centre, (0.1, -0.2), atol=2e-4)
        self.assertEqual(found.gap.h.min(), 0.0)
        self.assertAlmostEqual((p.sum(axis=0) @ result.x) / p.sum(), 0.1, delta=1e-4)
        self.assertAlmostEqual((p.sum(axis=1) @ result.y) / p.sum(), -0.2, delta=1e-4 * 64 / 48)
        level = surface.gap(surface.level(made)).solve(force=1e-3, e_star=1.0)
        centre = (level.pressure.sum(axis=0) @ level.x) / level.pressure.sum()
        self.assertGreater(abs(centre - 0.1), 0.01)

    def test_a_body_of_one_row_tilts_along_it(self):
        x = (np.arange(33) - 16.0) * 0.02
        h = (x**2 / 4.0 + 0.01 * x)[None, :]
        whole = np.full((5, 33), np.inf)
        whole[2] = h[0]
        for one, along in ((h, 0), (h.T, 1), (whole, 0), (np.ascontiguousarray(whole.T), 1)):
            found = surface.balance(surface.Gap(one, 0.02, 0.02), 1e-4, e_star=1.0)
            self.assertEqual(found.result.status, cn.OK)
            self.assertAlmostEqual(found.tilt[along], 0.01, delta=1e-4)
            self.assertAlmostEqual(found.tilt[1 - along], 0.0, delta=1e-12)

    def test_a_search_that_is_cancelled_ends(self):
        gap = surface.gap(surface.heights(1e-3 * rough(), 1.0, 1.0))
        calls = []
        found = surface.balance(gap, 1.0, e_star=1.0, progress=lambda _: calls.append(1) or True)
        self.assertEqual((found.result.status, len(calls)), (cn.CANCELLED, 1))
        given = []

        def solve(gap, **scene):
            given.append(scene["max_seconds"])
            return solved(gap, **{**scene, "max_seconds": 0.0})

        solved = surface.Gap.solve
        with mock.patch.object(surface.Gap, "solve", solve):
            surface.balance(gap, 1.0, e_star=1.0, max_seconds=100.0)
        self.assertLess(np.diff(given).max(), 0.0)
        found = surface.balance(gap, 1.0, e_star=1.0, max_seconds=1e-9)
        self.assertIn("max_seconds was reached", found.result.message)

        def slowly(gap, progress=None, **scene):
            result = solve(gap, **{"max_seconds": 1.0, **scene})
            time.sleep(0.01)
            if progress:
                progress(None)
            return result

        # The result is the last complete solve.
        for given_to, status, why in (({"max_seconds": 0.005}, cn.ITERATION_LIMIT, "max_seconds was reached before a tilt"),
                                      ({"progress": lambda _: True}, cn.CANCELLED, "the progress callback cancelled")):
            given.clear()
            with mock.patch.object(surface.Gap, "solve", slowly):
                found = surface.balance(gap, 1.0, e_star=1.0, **given_to)
            self.assertEqual((len(given), found.result.status), (1, status))
            self.assertTrue(found.result.message.startswith(why), found.result.message)
            self.assertAlmostEqual(found.result.force, 1.0, delta=1e-4)
            self.assertTrue(np.isfinite(found.centre).all())

    def test_what_cannot_be_balanced_is_refused(self):
        flat = surface.Gap(np.zeros((4, 4)), 1.0, 1.0)
        for given, text in (({"force": 0.0}, "force is 0; a body that nothing presses"), ({"period": "xy"}, "a body with a period cannot tilt"),
                            ({"at": (np.nan, 0.0)}, "at is .nan, 0.0.; it must be finite"), ({"tolerance": 0.0}, "tolerance is 0.0; it must be positive")):
            with self.assertRaisesRegex(ValueError, text):
                surface.balance(flat, **{"force": 1.0, "e_star": 1.0, **given})
        h = np.full((20, 20), np.inf)
        h[8:12, 8:12] = 0.0
        with self.assertRaisesRegex(ValueError, "are there elements all around it"):
            surface.balance(surface.Gap(h, 1.0, 1.0), 1.0, at=(7.0, 0.0), e_star=1.0)
        with self.assertRaisesRegex(ValueError, "a body with a period cannot tilt"):
            surface.balance(surface.Gap(h, 1.0, 1.0, period="x"), 1.0, e_star=1.0)
