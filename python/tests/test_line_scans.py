"""Line scans: heights of one row or one column, as a stylus gives them, have a tilt and a form along the line alone."""

import tempfile
import unittest
from pathlib import Path

import numpy as np
from test_command import called

from contact_normal import surface

N, D = 50, 0.2
X = (np.arange(N) - 0.5 * (N - 1)) * D
ROUGH = 0.01 * np.random.default_rng(3).normal(size=N)
SCAN = 0.5 + 0.03 * X - 0.002 * X**2 + ROUGH


def scans(values, **given):
    """The same scan along x and along y."""
    return surface.heights(values[None, :], D, 7.0, **given), surface.heights(values[:, None], 7.0, D, **given)


class Scans(unittest.TestCase):
    def test_a_tilt_and_a_form_are_those_of_a_polynomial(self):
        for kind, degree in (("mean", 0), ("plane", 1), ("quadric", 2)):
            # The reference is numpy.polyfit, which solves the same problem by singular values, to about 1e-12.
            fitted = np.polyfit(X, SCAN, degree)[::-1]
            left = SCAN - np.polyval(fitted[::-1], X)
            slope, curvature = (*fitted, 0.0, 0.0)[1:3]
            for along, made in enumerate(scans(SCAN)):
                with self.subTest(kind, along="xy"[along]):
                    found = surface.form(made, kind)
                    self.assertAlmostEqual(found.tilt[along], slope, places=12)
                    self.assertAlmostEqual(found.rms, np.sqrt(np.mean(left**2)), places=12)
                    self.assertEqual((found.tilt[1 - along], found.radii[1 - along]), (0.0, np.inf))
                    if curvature:
                        self.assertAlmostEqual(found.radii[along] / (-0.5 / curvature), 1.0, places=9)
                    np.testing.assert_allclose(surface.level(made, kind).z.ravel(), left, atol=1e-12)

    def test_one_element_has_a_height_alone(self):
        for kind in ("mean", "plane", "quadric"):
            self.assertEqual(surface.level(surface.heights([[3.0]], 1.0, 1.0), kind).z, 0.0)

    def test_too_few_heights_are_refused(self):
        for kind, values, told in (("plane", [1.0, np.nan, np.nan], "a plane has 2 unknowns along a line; 1 heights"), ("quadric", [1.0, 2.0], "a quadric has 3 unknowns along a line; 2 heights")):
            for made in scans(np.array(values)):
                with self.assertRaisesRegex(ValueError, told):
                    surface.level(made, kind)

    def test_a_period_across_the_line_stays_whole(self):
        for made, across, along in zip(scans(SCAN), "yx", "xy"):
            given = surface.heights(made.z, made.dx, made.dy, period=across)
            np.testing.assert_array_equal(surface.level(given).z, surface.level(made).z)
            for period in (along, "xy"):
                with self.assertRaisesRegex(ValueError, f"repeats itself in {period}: a plane would break the period"):
                    surface.level(surface.heights(made.z, made.dx, made.dy, period=period))

    def test_the_command_line_levels_them(self):
        with tempfile.TemporaryDirectory() as folder:
            for made in scans(SCAN):
                path, out = Path(folder, "scan.npy"), Path(folder, "fields.npz")
                np.save(path, made.z)
                code, _, told = called("solve", path, "--dx", made.dx, "--dy", made.dy, "--level", "quadric", "--mean-pressure", 10.0, "--e-star", 1e5, "-o", out)
                self.assertEqual(code, 0, told)
                fields, z = np.load(out), surface.level(made, "quadric").z
                h = fields["deformed_distance"] - fields["displacement"]
                np.testing.assert_allclose(h - h.min(), z.max() - z, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
