"""Topographies of the package SurfaceTopography that do not say the size of an element."""

import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from test_command import called
from test_surface_files import instruments

from contact_normal import surface

Z = 0.01 * np.random.default_rng(2).normal(size=(12, 7))
GIVEN = (
    ({"dx": 2.0, "dy": 3.0}, Z.T), ({"size": (24.0, 21.0)}, Z.T), ({"span": (22.0, 18.0)}, Z.T), ({"x": 2.0 * np.arange(12), "y": 3.0 * np.arange(7)}, Z.T),
    ({"dx": 2.0, "dy": 3.0, "axes": "xy"}, Z.T), ({"dx": 2.0, "dy": 3.0, "axes": "yx"}, Z), ({"size": (14.0, 36.0), "axes": "yx"}, Z),
)


def topography(sizes=None):
    """What such a reader returns for a file without sizes."""
    return SimpleNamespace(dim=2, is_uniform=True, is_periodic=False, unit="um", physical_sizes=sizes, heights=lambda: Z)


class Sizes(unittest.TestCase):
    def test_those_that_are_given_are_used(self):
        for sizes in (None, (float("nan"), float("nan")), (0.0, 0.0)):
            for given, z in GIVEN:
                with self.subTest(sizes=sizes, given=given):
                    with instruments(lambda sizes=sizes, **_: topography(sizes)):
                        for made in (surface.from_topography(topography(sizes), **given), surface.read("a.opd", **given)):
                            np.testing.assert_array_equal(made.z, z)
                            self.assertEqual((made.dx, made.dy, made.units), (2.0, 3.0, ("um", "N")))

    def test_a_message_asks_for_them(self):
        advice = "does not say the size of an element: give size, the lengths of the field, or dx and dy"
        for sizes in (None, (float("nan"), 1.0), (0.0, 1.0)):
            for given in ({}, {"axes": "yx"}):
                with self.subTest(sizes=sizes, given=given):
                    with self.assertRaisesRegex(TypeError, f"the topography {advice}"):
                        surface.from_topography(topography(sizes), **given)
                    with instruments(lambda sizes=sizes, **_: topography(sizes)), self.assertRaisesRegex(TypeError, f"a.opd {advice}"):
                        surface.read("a.opd", **given)

    def test_the_command_line_asks_for_them(self):
        with tempfile.TemporaryDirectory() as folder, instruments(lambda **_: topography()):
            path = Path(folder, "a.opd")
            path.write_bytes(b"\1\0")
            scene = ("solve", path, "--mean-pressure", 10.0, "--e-star", 1e5)
            code, _, told = called(*scene)
            self.assertEqual((code, "a.opd does not say how large its elements are: give --dx, and --dy if it differs" in told), (3, True), told)
            self.assertEqual(called(*scene, "--dx", 2.0)[0], 0)


if __name__ == "__main__":
    unittest.main()
