"""Compares this library on the Manchester contact benchmark with the results that the program CONTACT prints for the left wheel: `manchester.py`.

An S1002 wheel is on a UIC 60 rail with 10 kN on each wheel, in seven positions of the wheelset: simulation A-2.2 of Shackleton and Iwnicki,
Vehicle System Dynamics 46 (2008). The profiles are computed from their definitions: the lines, arcs and polynomials of EN 13715 (S1002), and the
arcs of the rail head. Prints one line per position, with the results of this library and those of CONTACT. Lengths are in mm, forces in N, angles
in rad.
"""

import math
import os
import sys
from typing import NamedTuple

# A test also imports this file, and then chooses the package and the library itself.
if __name__ == "__main__":
    ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
    sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402

import contact_normal  # noqa: E402
from contact_normal import profiles  # noqa: E402

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
ELEMENT = 0.2


class Printed(NamedTuple):
    """A row that CONTACT prints: the position of the wheelset, and of the contact of the left wheel the force, the largest pressure, the number of
    elements and the approach."""

    y: float
    z: float
    roll: float
    yaw: float
    force: float
    largest: float
    elements: int
    approach: float


PRINTED = (
    Printed(0.0, 0.1981, 0.0, 0.0, 9997, 338.3, 1291, 0.01596),
    Printed(2.0, 0.153, -0.0001128, 0.0048, 10040, 465.9, 830, 0.02054),
    Printed(4.0, 0.068, -0.0002557, 0.0096, 10030, 527.2, 727, 0.02185),
    Printed(5.0, 0.0019, -0.0003554, 0.012, 10030, 552.8, 692, 0.02232),
    Printed(6.0, -0.1957, -0.0006272, 0.0144, 10020, 578.5, 658, 0.02278),
    Printed(8.0, -6.2606, -0.008606, 0.0192, 10020, 701.1, 549, 0.02458),
    Printed(10.0, -8.2662, -0.01126, 0.024, 10020, 744.0, 515, 0.02511),
)

# The parts of the S1002 profile from the tread to the flange back. LINE and POLYNOMIAL have the coefficients of 1, y, y^2, ... of z.
LINE_A = (1.364323640, -0.066666667)
POLYNOMIAL_B = (0.0, -3.358537058e-2, 1.565681624e-3, -2.810427944e-5, 5.844240864e-8, -1.562379023e-8, 5.309217349e-15, -5.957839843e-12,
                2.646656573e-13)
POLYNOMIAL_C = (-4.320221063e3, -1.038384026e3, -1.065501873e2, -6.051367875, -2.054332446e-1, -4.169739389e-3, -4.687195829e-5, -2.252755540e-7)
LINE_E = (-93.576667419, -2.747477419)
# Each arc has the y and z of its centre, its radius, and its side: -1 if the arc lies above the centre (z grows downwards), 1 if it lies below.
ARC_D, ARC_F, ARC_G, ARC_H = (
    (-26.210665, 16.446, 13.0, -1), (-58.558326413, 8.834924130, 20.0, 1), (-55.0, 16.0, 12.0, 1), (-49.5, 9.519259302, 20.5, 1))
# The parts in the order of decreasing y. Each holds for y above its first number and below that of the part before it.
PARTS = ((32.15796, LINE_A), (-26.0, POLYNOMIAL_B), (-35.0, POLYNOMIAL_C), (-38.426669071, ARC_D), (-39.764473993, LINE_E),
         (-49.662510381, ARC_F), (-62.764705882, ARC_G), (-70.0, ARC_H))
ARCS = (ARC_D, ARC_F, ARC_G, ARC_H)


def height(part, y):
    """z of a part of S1002 at y."""
    if part in ARCS:
        middle, above, radius, side = part
        return above + side * np.sqrt(np.maximum(radius**2 - (y - middle) ** 2, 0.0))
    return np.polynomial.polynomial.polyval(y, part)


def s1002(step=0.2):
    """The profile of the wheel. y is 0 at the tape circle and grows to the field side; z is downwards."""
    y = np.linspace(-69.9, 60.0, round(129.9 / step) + 1)
    z = np.select([y > end for end, _ in PARTS], [height(part, y) for _, part in PARTS])
    return profiles.Profile(y, z, "wheel", "S1002")


def uic60(step=0.2):
    """The profile of the rail without inclination: arcs with radii of 300, 80 and 13 mm with common tangents, and flanks of 1:20.

    The flanks are 72 mm apart where the arcs end. The arc of 300 mm is 21 mm wide as in the benchmark; in drawings of UIC 60 it is 20.456 mm wide.
    """
    flank = math.atan(20.0)
    first = math.asin(10.5 / 300.0)
    one = np.array([220.0 * math.sin(first), 300.0 - 220.0 * math.cos(first)])
    second = math.asin((36.0 - 13.0 * math.sin(flank) - one[0]) / 67.0)
    other = one + 67.0 * np.array([math.sin(second), -math.cos(second)])
    points = []
    for middle, radius, begin, end in (((0.0, 300.0), 300.0, 0.0, first), (one, 80.0, first, second), (other, 13.0, second, flank)):
        angle = np.linspace(begin, end, math.ceil(radius * (end - begin) / step), endpoint=False)
        points.append(np.stack([middle[0] + radius * np.sin(angle), middle[1] - radius * np.cos(angle)], axis=1))
    down = np.arange(0.0, 20.0, step)
    points.append(np.stack([36.0 + down / 20.0, other[1] - 13.0 * math.cos(flank) + down], axis=1))
    half = np.concatenate(points)
    both = np.concatenate([half[:0:-1] * [-1.0, 1.0], half])
    return profiles.Profile(both[:, 0], both[:, 1], "rail", "UIC 60")


def position(row):
    """The position of a row. CONTACT applies the yaw before the roll, and `Position` the roll first. The angles give the axle the same direction."""
    roll = math.asin(math.cos(row.yaw) * math.sin(row.roll))
    yaw = math.atan2(math.sin(row.yaw), math.cos(row.yaw) * math.cos(row.roll))
    return profiles.Position(row.y, row.z, roll, yaw)


def contact_point(row):
    """The point at which the left wheel touches the rail, which is inclined by 1:40."""
    track = profiles.Track(uic60(), gauge=1435.0, gauge_height=14.0, inclination=math.atan(1.0 / 40.0))
    wheelset = profiles.Wheelset(s1002(), radius=460.0, flange_back=1360.0, flange_back_at=-70.0)
    return profiles.contact_points(track, wheelset, position(row), side="left")[0]


def pressed(point, row):
    """The result under the printed force, and the approach from the position in which the bodies just touch."""
    gap = point.gap(ELEMENT, ELEMENT, 1.2 * row.approach)
    h = point.distance(gap.x, gap.y)
    result = contact_normal.solve(h, ELEMENT, ELEMENT, force=row.force, **STEEL)
    if result.status != contact_normal.OK:
        sys.exit(f"y = {row.y}: stopped early: {result.message}")
    # In a position with an overlap the least h is negative. The approach is converted to that from the first contact.
    return result, result.approach - point.clearance * math.cos(point.angle)


def main():
    """Prints the table."""
    print("| y | largest pressure | printed | | elements | printed | approach | printed | overlap of the position |")
    print("|---|---|---|---|---|---|---|---|---|")
    for row in PRINTED:
        point = contact_point(row)
        result, approach = pressed(point, row)
        overlap = -point.clearance * math.cos(point.angle)
        print(f"| {row.y:.0f} | {result.max_pressure:.1f} | {row.largest} | {100 * (result.max_pressure / row.largest - 1):+.2f} % "
              f"| {(result.contact > 0).sum()} | {row.elements} | {approach:.5f} | {row.approach} | {overlap:.5f} |")


if __name__ == "__main__":
    main()
