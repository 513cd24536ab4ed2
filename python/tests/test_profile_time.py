"""The grid for a wheel on a rail: no more steps than digits need, and an end if no time is left."""

import time
import unittest
from unittest import mock

import numpy as np
from test_profiles import STEEL, TRACK, WHEELSET

import contact_normal as cn
from contact_normal import profiles
from contact_normal.profiles._curve import Curve
from contact_normal.profiles._patch import ContactPoint
from contact_normal.surface import Gap


class Times(unittest.TestCase):
    POINT = profiles.contact_points(TRACK, WHEELSET)[0]

    def test_distances_take_no_more_steps_than_they_need(self):
        found, where = [], Curve.where
        with mock.patch.object(Curve, "where", lambda *given, **more: found.append(1) or where(*given, **more)):
            h = self.POINT.distance(np.linspace(-5.0, 5.0, 11), np.linspace(-4.0, 4.0, 9))
        self.assertLessEqual(len(found), 5)
        with mock.patch("contact_normal.profiles._patch._TIGHT", 0.0):
            np.testing.assert_allclose(self.POINT.distance(np.linspace(-5.0, 5.0, 11), np.linspace(-4.0, 4.0, 9)), h, atol=1e-12)

    def test_blocks_of_rows_are_one_grid(self):
        x, y = np.linspace(-5.0, 5.0, 11), np.linspace(-40.0, 40.0, 81)
        whole = self.POINT.distance(x, y)
        with mock.patch("contact_normal.profiles._patch._BLOCK", 50):
            np.testing.assert_allclose(self.POINT.distance(x, y), whole, atol=1e-12)
        self.assertTrue(np.isinf(whole).any() and np.isfinite(whole).any())

    def test_no_second_grid_is_made_without_time(self):
        made, solved = [], Gap.solve
        of_wheel = ContactPoint._to_wheel

        def slowly(gap, **scene):
            result = solved(gap, **{**scene, "max_seconds": 0.0})
            time.sleep(0.02)
            made.clear()
            return result

        with mock.patch.object(Gap, "solve", slowly), mock.patch.object(ContactPoint, "_to_wheel", lambda *given: made.append(1) or of_wheel(*given)):
            gap, result = self.POINT.press(10e3, 0.3, 0.3, depth=0.01, max_seconds=0.015, **STEEL)
            self.assertEqual((result.status, len(made)), (cn.ITERATION_LIMIT, 0))
            self.assertRegex(result.message, "max_seconds was reached on a grid for an approach of 0.01 mm; the approach is 0.02")
            self.assertEqual(result.pressure.shape, gap.h.shape)
            self.POINT.press(10e3, 0.3, 0.3, depth=0.01, **STEEL)


if __name__ == "__main__":
    unittest.main()
