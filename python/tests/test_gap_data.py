"""The data files of docs/heights_to_gap.md and docs/profiles_to_gap.md equal those that the examples make."""

import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

import numpy as np

from contact_normal import profiles
from contact_normal.surface import Gap

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python_examples"))

import heights_to_gap  # noqa: E402
import profiles_to_gap  # noqa: E402


class Data(unittest.TestCase):
    def test_heights(self):
        kept = np.load(ROOT / "data" / "heights" / "ground.npy")
        # Heights are rounded to 1e-8. The FFT of another machine may lead to the next rounded value.
        np.testing.assert_allclose(kept, heights_to_gap.ground(), rtol=0, atol=2e-8)

    def test_profiles(self):
        for name, made in (("arcs.prr", profiles_to_gap.made_rail()), ("arcs.prw", profiles_to_gap.made_wheel())):
            kept = profiles.read(ROOT / "data" / "profiles" / name)
            # The profiles are written with seven digits behind the point.
            np.testing.assert_allclose(np.stack([kept.y, kept.z], axis=1), made, rtol=0, atol=1.01e-7)

    def test_arcs_are_those_of_their_radii(self):
        rail = profiles_to_gap.made_rail()
        head = rail[np.abs(rail[:, 0]) < 10.3]
        np.testing.assert_allclose(np.hypot(head[:, 0], head[:, 1] - 300.0), 300.0, atol=1e-9)
        # The flanks are 1:20, and the corner is an arc of radius 13: the circle through three of its points.
        slopes = np.diff(rail[-80:, 0]) / np.diff(rail[-80:, 1])
        np.testing.assert_allclose(slopes, 1.0 / 20.0, atol=1e-9)
        corner = rail[(rail[:, 1] > 4.0) & (rail[:, 1] < 10.0) & (rail[:, 0] > 0)]
        a, b, c = corner[[0, len(corner) // 2, -1]]
        sides = [np.linalg.norm(p - q) for p, q in ((a, b), (b, c), (c, a))]
        area = 0.5 * abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
        self.assertAlmostEqual(np.prod(sides) / (4.0 * area), 13.0, delta=1e-6)


class Texts(unittest.TestCase):
    def test_comments_of_one_line(self):
        gap = Gap(np.arange(6.0).reshape(2, 3), 0.1, 0.2)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "gap.txt")
            for comment in ("", "period x: 2", "a\x0cb", "a\u2028b\x85"):
                gap.write(path, comment)
                np.testing.assert_array_equal(Gap.read(path).h, gap.h)
                for period in ("x", "y", "xy", None):
                    replace(gap, period=period).write(path, comment)
                    self.assertEqual(Gap.read(path).period, period)
            for comment in ("a\nb", "a\rb"):
                with self.assertRaisesRegex(ValueError, "comment has several lines"):
                    gap.write(path, comment)

    def test_sizes_are_positive(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "gap.txt")
            Gap(np.zeros((2, 2)), 1.0, 1.0).write(path)
            text = path.read_text()
            for sizes in ("-2 -2 1.0 1.0", "2 2 0.0 1.0", "2 2 nan 1.0", "2 2 1.0 inf"):
                path.write_text(text.replace("2 2 1.0 1.0", sizes))
                with self.assertRaisesRegex(ValueError, f"'{sizes}' in line 3; mx, my, dx and dy must be positive"):
                    Gap.read(path)
