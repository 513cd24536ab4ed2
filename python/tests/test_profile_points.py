"""Points of profiles: dense and noisy ones, few of them, and files of few decimals."""

import re
import unittest
import warnings
from pathlib import Path

import numpy as np

from contact_normal import profiles
from test_profiles import HEAD, STEEL, rail

ARCS = Path(__file__).resolve().parents[2] / "data" / "profiles"


def scanned(made, count, noise, seed):
    """Points of a scan: `count` along the curve, with noise in y and z, sorted by y."""
    curve, rng = made.curve(), np.random.default_rng(seed)
    y, z, _, _ = curve.at(np.linspace(0.0, curve.t[-1], count))
    y, z = y + noise * rng.normal(size=count), z + noise * rng.normal(size=count)
    order = np.argsort(y)
    return profiles.Profile(y[order], z[order], made.kind)


def pressed(track_rail, tread):
    track, wheelset = profiles.Track(track_rail), profiles.Wheelset(tread, 460.0)
    return profiles.contact_points(track, wheelset, profiles.Position(y=4.0))[0].press(10e3, 0.4, 0.4, **STEEL)[1]


class Thinned(unittest.TestCase):
    def test_a_dense_scan_becomes_a_curve(self):
        dense = scanned(rail(), 20000, 0.01, 1)
        with self.assertRaisesRegex(ValueError, r"closer to each other than their noise, thinned\(step\) takes the mean of each step"):
            dense.curve()
        thin = dense.thinned(0.5).smoothed(8.0)
        self.assertLess(len(thin.y), 400)
        at = np.linspace(-30.0, 30.0, 101)
        curve = thin.curve()
        z = curve.at(curve.where(at, near=curve.t[len(curve.t) // 2]))[1]
        # The tolerance is the noise of a mean of 50 to 100 points, and the error of a mean over an arc of 0.5 mm, which leaves its tangent by
        # 0.5^2/(24 HEAD).
        np.testing.assert_allclose(z, HEAD - np.sqrt(HEAD**2 - at**2), atol=0.003)

    def test_steps_are_means_and_both_ends_stay(self):
        y = np.arange(0.0, 40.0, 0.125)
        z = 0.01 * (y - 20.0) ** 2
        thin = profiles.Profile(y, z, "rail").thinned(1.05)
        self.assertEqual((thin.y[0], thin.y[-1], thin.z[0], thin.z[-1]), (y[0], y[-1], z[0], z[-1]))
        # Where the rail is level, a step of 1.05 mm has the first point and the eight within 1 mm behind it.
        steps = np.diff(thin.y)[15:25]
        np.testing.assert_allclose(steps, 1.125, atol=1e-12)
        k = int(np.argmin(thin.z))
        chosen = np.abs(y - thin.y[k]) <= 0.5 + 1e-9
        self.assertEqual(chosen.sum(), 9)
        self.assertAlmostEqual(thin.z[k], z[chosen].mean(), delta=1e-15)
        self.assertGreater(np.diff(thin.y)[[0, -1]].min(), 0.5)
        for step, text in ((0.0, "step is 0.0; it must be positive"), (300.0, "it leaves 3 points of the rail")):
            with self.assertRaisesRegex(ValueError, text):
                profiles.Profile(y, z, "rail").thinned(step)

    def test_smoothing_leaves_a_steep_face_where_it_is(self):
        # A head of 30 mm beside corners of 13 mm, down to 80 degrees: the face of the gauge.
        angle = np.deg2rad(np.linspace(-80.0, 80.0, 801))
        y, z = 13.0 * np.sin(angle) + 15.0 * np.sign(angle), 13.0 - 13.0 * np.cos(angle)
        y, z = (np.concatenate([v[:400], np.linspace(v[399], v[401], 101)[1:-1], v[401:]]) for v in (y, z))
        smooth = profiles.Profile(y, z, "rail").smoothed(3.0)
        off = np.hypot(np.abs(smooth.y) - 15.0, 13.0 - smooth.z) - 13.0
        corner = np.abs(y) > 18.0
        # At an end the spline is straight, which moves the arc by about (3/(2 pi))^2/13.
        self.assertLess(np.abs(off[corner]).max(), 1.5 * (3.0 / (2.0 * np.pi)) ** 2 / 13.0)


class FarOff(unittest.TestCase):
    def test_a_point_on_the_flange_is_refused(self):
        # The neighbours of a point on the flange are as steep as a face at which a profile could end.
        wheel = profiles.read(ARCS / "arcs.prw")
        steep = np.abs(np.diff(wheel.z) / np.diff(wheel.y)) > 2.0
        chosen = [k for k in range(8, len(wheel.y) - 8) if steep[k - 5 : k + 5].all()]
        self.assertGreater(len(chosen), 3)
        for k in chosen[::3]:
            for off in (-3.0, -1.0, 1.0, 3.0):
                z = wheel.z.copy()
                z[k] += off
                with self.assertRaisesRegex(ValueError, re.escape(f"far off, at y = {wheel.y[k]:.6g}, z = {z[k]:.6g}")):
                    profiles.Profile(wheel.y, z, "wheel").curve()
        self.assertEqual(len(profiles.Profile(np.delete(wheel.y, k), np.delete(wheel.z, k), "wheel").curve().y), len(wheel.curve().y) - 1)

    def test_a_step_is_a_face(self):
        # The profile continues beyond a step down, but the step counts as its end.
        y = np.linspace(0.0, 60.0, 121)
        z = 0.001 * (y - 20.0) ** 2 + np.where(y > 50.2, 6.0, 0.0)
        self.assertEqual(len(profiles.Profile(y, z, "rail").curve().y), 101)


class Uncertain(unittest.TestCase):
    def setUp(self):
        self.rail, self.wheel = profiles.read(ARCS / "arcs.prr"), profiles.read(ARCS / "arcs.prw")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.largest = pressed(self.rail, self.wheel).max_pressure

    def each(self, change):
        return change(self.rail), change(self.wheel)

    def test_few_decimals_are_told(self):
        coarse = self.each(lambda one: profiles.Profile(one.y.round(3), one.z.round(3), one.kind))
        with self.assertWarnsRegex(UserWarning, r"pressures are uncertain by some \d+%: .* has 1\d of its points across .*smoothed\(wave_length\) removes"):
            largest = pressed(*coarse).max_pressure
        self.assertGreater(largest / self.largest, 1.05)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            smooth = pressed(*(one.smoothed(4.0) for one in coarse)).max_pressure
        self.assertAlmostEqual(smooth / self.largest, 1.0, delta=0.01)

    def test_what_light_smoothing_leaves_of_few_decimals_is_told(self):
        coarse = self.each(lambda one: profiles.Profile(one.y.round(2), one.z.round(2), one.kind))
        for length, least in ((2.0, 10), (3.0, 6)):
            with self.assertWarnsRegex(UserWarning, r"so much is left of noise, or of the few decimals of the points.* a longer wave_length") as told:
                largest = pressed(*(one.smoothed(length).moved() for one in coarse)).max_pressure
            amount = int(re.search(r"some (\d+)%", str(told.warning))[1])
            self.assertGreater(largest / self.largest, 1.0 + least / 100.0)
            self.assertTrue(least <= amount <= 100.0 * (largest / self.largest - 1.0) * 2.5, amount)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertAlmostEqual(pressed(*(one.smoothed(8.0) for one in coarse)).max_pressure / self.largest, 1.0, delta=0.02)

    def test_what_light_smoothing_leaves_of_noise_is_told(self):
        random = np.random.default_rng(4)
        noisy = self.each(lambda one: profiles.Profile(one.y, one.z + 1e-3 * random.normal(size=len(one.y)), one.kind))
        with self.assertWarnsRegex(UserWarning, r"uncertain by some [12]\d%: so much is left of noise"):
            self.assertGreater(pressed(*(one.smoothed(1.0) for one in noisy)).max_pressure / self.largest, 1.1)
        # Two smoothings leave no more noise than the longer one alone.
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            largest = pressed(*(one.smoothed(1.0).smoothed(4.0) for one in noisy)).max_pressure
        self.assertAlmostEqual(largest / self.largest, 1.0, delta=0.03)

    def test_a_form_that_smoothing_removes_is_told(self):
        with self.assertWarnsRegex(UserWarning, "so much form smoothing has removed.*use a shorter wave_length"):
            largest = pressed(self.rail.smoothed(25.0), self.wheel.smoothed(25.0)).max_pressure
        self.assertLess(largest / self.largest, 0.95)

    def test_few_points_are_told(self):
        few = self.each(lambda one: profiles.Profile(one.y[::25], one.z[::25], one.kind))
        with self.assertWarnsRegex(UserWarning, "pressures are uncertain by .* of its points across the contact, .*: give more points"):
            self.assertGreater(abs(pressed(*few).max_pressure / self.largest - 1.0), 0.05)

    def test_contact_points_of_few_points_are_told(self):
        def place(one, other, y):
            return profiles.contact_points(profiles.Track(one), profiles.Wheelset(other, 460.0), profiles.Position(y=y))[0].place[1]

        few = self.each(lambda one: profiles.Profile(one.y[::30], one.z[::30], one.kind))
        for y in (2.0, 4.0):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                right = place(self.rail, self.wheel, y)
                self.assertAlmostEqual(place(*self.each(lambda one: profiles.Profile(one.y[::2], one.z[::2], one.kind)), y), right, delta=0.3)
            with self.assertWarnsRegex(UserWarning, r"the contact point is uncertain by some \d+(\.\d)? mm along the profiles: .* mm apart there") as told:
                off = abs(place(*few, y) - right)
            amount = float(re.search(r"some (\S+) mm", str(told.warning))[1])
            self.assertLess(off, 2.0 * amount)

    def test_half_of_many_points_is_enough(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            largest = pressed(*self.each(lambda one: profiles.Profile(one.y[::2], one.z[::2], one.kind))).max_pressure
        self.assertAlmostEqual(largest / self.largest, 1.0, delta=0.02)


if __name__ == "__main__":
    unittest.main()
