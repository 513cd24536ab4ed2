"""The Manchester benchmark: seven positions of an S1002 wheel on a UIC 60 rail, compared with the output of another program."""

import math
import sys
import unittest
from pathlib import Path

import numpy as np

import contact_normal as cn

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benches"))

import manchester  # noqa: E402


def half_of_last_digit(value, digits=4):
    """Half of the last of some printed digits."""
    return 0.5 * 10.0 ** (math.floor(math.log10(abs(value))) + 1 - digits) if value else 0.0


def rounding_of(part, y):
    """The error at y by half of the tenth digit of each coefficient. For arcs and lines, whose constants have six decimals, with a slope of 3."""
    if len(part) < 3 or part in manchester.ARCS:
        return 2e-6
    return sum(half_of_last_digit(coefficient, 10) * abs(y) ** power for power, coefficient in enumerate(part))


class Profiles(unittest.TestCase):
    def test_the_parts_of_the_wheel_meet(self):
        # A wrong digit of a coefficient would cause a step or a corner.
        for (end, part), (_, following) in zip(manchester.PARTS, manchester.PARTS[1:]):
            rounding = max(rounding_of(part, end), rounding_of(following, end))
            self.assertAlmostEqual(manchester.height(part, end), manchester.height(following, end), delta=rounding)
            slopes = [(manchester.height(one, end + 1e-4) - manchester.height(one, end - 1e-4)) / 2e-4 for one in (part, following)]
            self.assertAlmostEqual(math.atan(slopes[0]), math.atan(slopes[1]), delta=rounding)
        self.assertAlmostEqual(manchester.s1002().z.max(), 28.0, delta=1e-3)

    def test_the_rail_has_its_radii_and_its_width(self):
        rail = manchester.uic60()
        for radius, inner, outer in ((300.0, 0.0, 10.5), (80.0, 10.5, 25.9), (13.0, 26.1, 35.9)):
            chosen = (rail.y >= inner) & (rail.y <= outer)
            a, b, c = np.stack([rail.y, rail.z], axis=1)[chosen][[0, chosen.sum() // 2, -1]]
            sides = [np.linalg.norm(p - q) for p, q in ((a, b), (b, c), (c, a))]
            area = 0.5 * abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
            self.assertAlmostEqual(np.prod(sides) / (4.0 * area), radius, delta=1e-6 * radius)
        # The flanks of 1:20 begin 14.26 mm below the top; the rail is 0.01 mm wider a tenth of a millimetre further down.
        self.assertAlmostEqual(2.0 * np.interp(14.26, rail.z[rail.y > 0], rail.y[rail.y > 0]), 72.0, delta=1e-3)
        # Segments are joined without corners: slopes of points change by at most 0.2 mm over the smallest radius.
        slopes = np.arctan2(np.diff(rail.z), np.diff(rail.y))
        self.assertLess(np.abs(np.diff(slopes)).max(), 1.01 * 0.2 / 13.0)


class Positions(unittest.TestCase):
    def test_yaw_before_roll_is_converted(self):
        for row in manchester.PRINTED:
            roll, yaw = row.roll, row.yaw
            axle = manchester.position(row).rotation()[:, 1]
            # The direction of the axle: e_y, yawed about z, then rolled about x.
            np.testing.assert_allclose(axle, (-math.sin(yaw), math.cos(yaw) * math.cos(roll), math.cos(yaw) * math.sin(roll)), atol=1e-15)

    def test_pressures_elements_and_approaches_are_those_of_the_benchmark(self):
        for row in manchester.PRINTED:
            with self.subTest(y=row.y):
                result, approach = manchester.pressed(manchester.contact_point(row), row)
                self.assertEqual(result.status, cn.OK)
                # Three parts of the tolerance. The force has four digits; half of the last one is 5e-4, which changes the pressure by a third of
                # this: 0.02 %. The grids differ: the largest pressure may be half an element off the nearest centre, where a semi-ellipsoid with
                # half-widths of ten and 16 elements is lower by 1 - sqrt(1 - 0.5^2/10^2 - 0.5^2/16^2) = 0.17 %. The rest, 0.1 %, is for the other
                # program's surfaces between points.
                self.assertAlmostEqual(result.max_pressure / row.largest, 1.0, delta=0.003)
                # The number of grid points in an oval of mean radius R at a random place has the variance 0.676 R (Kendall 1948, for circles). Three standard
                # deviations of the difference of two such numbers:
                deviation = math.sqrt(0.676 * math.sqrt(row.elements / math.pi))
                self.assertLess(abs((result.contact > 0).sum() - row.elements), 3.0 * math.sqrt(2.0) * deviation)
                # Three parts of the tolerance: half of the last digit; two thirds of that of the force; and the error of the least h on the other
                # program's grid, half an element off the least one of the bodies, which is 1/n^2 of the 1.2 approaches at the border of our grid, n
                # elements wide.
                rows, columns = result.contact.shape
                force = half_of_last_digit(row.force) / row.force
                delta = 0.5e-5 + (2.0 / 3.0 * force + 1.2 * (rows**-2 + columns**-2)) * row.approach
                self.assertAlmostEqual(approach, row.approach, delta=delta)

    def test_the_position_gives_the_approach(self):
        for row in manchester.PRINTED:
            with self.subTest(y=row.y):
                point = manchester.contact_point(row)
                overlap = -point.clearance * math.cos(point.angle)
                # The sum of three roundings: z has four decimals; the roll lifts the left wheel by its distance from the middle; and the approach has
                # five decimals.
                delta = 0.5e-4 + half_of_last_digit(row.roll) * 758.0 + 0.5e-5
                self.assertAlmostEqual(overlap, row.approach, delta=1.1 * delta)


if __name__ == "__main__":
    unittest.main()
