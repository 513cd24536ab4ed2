"""A real wheel on a real rail, 82 kN: solves it with the force prescribed, compares with the CONTACT program and draws it.

    python3 wheel_rail.py [data file [picture [arrays]]]

The picture (default wheel_rail.png) shows pressure and contact area. `arrays`, if named, gets a line
"mx my dx dy approach" and one line "h p contact" per element, x fastest.
"""

import os
import sys

import numpy as np

import contact_normal

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "wheel_rail", "y4_82kN.txt")


def read(path):
    """Reads the scene of a data file and its reference solution. Lengths are in mm, forces in N."""
    with open(path, encoding="ascii") as file:
        title = [next(file) for _ in range(3)][0].lstrip("# ").strip()
        numbers = next(file).split()
        columns = np.loadtxt(file)
    mx, my = int(numbers[0]), int(numbers[1])
    names = ("dx", "dy", "approach", "force", "shear_modulus", "poisson_ratio")
    scene = dict(zip(names, map(float, numbers[2:])))
    h, pressure, contact = (column.reshape(my, mx) for column in columns.T)
    return title, scene, h, pressure, contact != 0


def compare(scene, h, reference, reference_contact, result):
    """Prints the result and the reference side by side, with those digits that do not depend on the machine."""
    my, mx = h.shape
    print(f"wheel-rail contact, {mx} x {my} elements of {scene['dx']} mm x {scene['dy']} mm, force prescribed")
    print(f"{'':22}{'ours':>14}{'CONTACT':>14}")
    area = scene["dx"] * scene["dy"]
    rows = [
        ("force [N]", result.force, scene["force"], ".1f"),
        ("approach [mm]", result.approach, scene["approach"], ".7f"),
        ("max. pressure [N/mm2]", result.pressure.max(), reference.max(), ".1f"),
        ("contact area [mm2]", result.contact.sum() * area, reference_contact.sum() * area, ".2f"),
        ("elements in contact", result.contact.sum(), reference_contact.sum(), "d"),
    ]
    for name, ours, theirs, digits in rows:
        print(f"{name:22}{ours:>14{digits}}{theirs:>14{digits}}")
    # The reference agrees to 7e-8 of the maximum with an independent solution at tolerance 1e-11.
    difference = np.abs(result.pressure - reference).max() / reference.max()
    print(f"elements in contact in one of the two only: {(result.contact != reference_contact).sum()}")
    print(f"largest difference of pressures below 1e-6 of the maximum: {'yes' if difference < 1e-6 else difference}")


def draw(path, title, result):
    """Draws the pressures and the contact area in a view from above."""
    import matplotlib

    matplotlib.use("Agg")
    axes = result.plot()
    axes.set(xlabel="x, along the rail [mm]", ylabel="y, across the rail [mm]")
    axes.set_title(
        f"{title.split(';')[0]}\n{result.force / 1000:.1f} kN: largest pressure {result.pressure.max():.0f} N/mm²,"
        f" contact area {result.report['contact_area']:.1f} mm²",
        fontsize=10,
    )
    axes.figure.savefig(path, dpi=150)


def write_arrays(path, scene, h, result):
    """Writes the arrays for a check of the result. repr() keeps every bit."""
    with open(path, "w", encoding="ascii") as file:
        my, mx = h.shape
        print(mx, my, repr(scene["dx"]), repr(scene["dy"]), repr(result.approach), file=file)
        for values in zip(h.flat, result.pressure.flat, result.contact.flat):
            print(repr(float(values[0])), repr(float(values[1])), int(values[2]), file=file)


def main(data=DATA, picture="wheel_rail.png", arrays=None):
    """Runs the example."""
    title, scene, h, reference, reference_contact = read(data)
    # The relative error of the pressures is about 100 times the residual. The reference is good to 1e-7 of the largest pressure.
    result = contact_normal.solve(
        h,
        scene["dx"],
        scene["dy"],
        force=scene["force"],
        shear_modulus=scene["shear_modulus"],
        poisson_ratio=scene["poisson_ratio"],
        tolerance=1e-9,
        units=("mm", "N"),
    )
    if result.status != contact_normal.OK:
        sys.exit(f"stopped early: {result.message}")
    compare(scene, h, reference, reference_contact, result)
    draw(picture, title, result)
    if arrays:
        write_arrays(arrays, scene, h, result)


if __name__ == "__main__":
    main(*sys.argv[1:])
