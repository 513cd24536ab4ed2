"""An accuracy instead of a grid: the paper's ellipse, refined from 16 x 16 elements until the force is good to `target`.

    python3 to_accuracy.py [arrays]

For each target the program prints the last grid, and whether the estimated error and the difference from the exact solution of Hertz meet the target.
`arrays`, if named, gets the last solution: a line "mx my dx dy approach", then one line "h p contact" per element, x fastest.
"""

import sys

import contact_normal

CURVATURE_X, CURVATURE_Y, APPROACH = 0.0016681, 0.0030671, 0.1091  # 1/mm, 1/mm, mm
STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}


def undeformed_distance(x, y):
    """h at the centres (x, y) of elements."""
    return CURVATURE_X * x**2 + CURVATURE_Y * y**2


def solve(target):
    """Solves on [-10, 10] x [-6, 6] mm, around (0, 0), to a relative error of the force."""
    return contact_normal.solve_to_accuracy(
        undeformed_distance,
        20.0 / 16,
        12.0 / 16,
        shape=(16, 16),
        target=target,
        max_elements=1024 * 1024,
        approach=APPROACH,
        tolerance=1e-8,
        **STEEL,
    )


def write_arrays(path, result):
    """Writes the arrays for a check of the result. repr() keeps every bit."""
    my, mx = result.pressure.shape
    with open(path, "w", encoding="ascii") as file:
        print(mx, my, repr(result.dx), repr(result.dy), repr(result.approach), file=file)
        for iy in range(my):
            for ix in range(mx):
                x, y = (ix + 0.5) * result.dx - 10.0, (iy + 0.5) * result.dy - 6.0
                h, p = undeformed_distance(x, y), float(result.pressure[iy, ix])
                print(repr(h), repr(p), int(result.contact[iy, ix]), file=file)


def main(arrays=None):
    """Runs the example."""
    exact = contact_normal.hertz(CURVATURE_X, CURVATURE_Y, approach=APPROACH, **STEEL)
    print(f"{'target':>8}{'elements':>14}{'force [N]':>12}{'met by estimate':>18}{'met in fact':>14}")
    for target in (1e-2, 1e-3, 1e-4):
        result = solve(target)
        if result.status != contact_normal.OK:
            sys.exit(f"stopped early: {result.message}")
        my, mx = result.pressure.shape
        error = abs(result.force / exact.force - 1.0)
        met = ["yes" if found <= target else "no" for found in (result.reached, error)]
        print(f"{target:8.0e}{f'{mx} x {my}':>14}{result.force:12.0f}{met[0]:>18}{met[1]:>14}")
    if arrays:
        write_arrays(arrays, result)


if __name__ == "__main__":
    main(*sys.argv[1:])
