"""A layer on a rigid base beside ContactMechanics: `build/peers/bin/python benches/peers/thickness.py`, after `make bench-peers` or with the packages
of `requirements.txt`.

A ball is pressed on a cell that repeats itself, by a force. ContactMechanics has an elastic half-space of finite thickness; contact-normal has a coating on
a body of infinite modulus. Compares the largest pressure, the contact area and the approach on finer and finer grids. ContactMechanics
multiplies waves at its nodes, contact-normal has pressures that are constant on elements: both tend to the same answer. The columns are relative
differences, which fall to a quarter where elements are halved. One element at the edge is 1e-2 to 1e-4 of the contact area.
"""

import os
import sys

os.environ["OMP_NUM_THREADS"] = "1"
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402
from ContactMechanics import PeriodicFFTElasticHalfSpace  # noqa: E402
from ContactMechanics.Systems import NonSmoothContactSystem  # noqa: E402
from SurfaceTopography import Topography  # noqa: E402

import contact_normal  # noqa: E402

SIDE, MODULUS = 1.0, 1.0  # E* of the layer
TOLERANCE = 1e-7


def base(n, thickness, ratio):
    """Its half-space of finite thickness: it takes E, not E*."""
    young = MODULUS * (1 - ratio**2)
    return PeriodicFFTElasticHalfSpace((n, n), young, (SIDE, SIDE), thickness=thickness, poisson=ratio)


def layer(thickness, ratio):
    """The same for contact-normal: a rigid counterbody, a coating on a rigid base."""
    shear = 0.5 * MODULUS * (1 - ratio)
    return {"shear_modulus": (np.inf, np.inf), "poisson_ratio": (0.3, 0.3), "coating": ((thickness, shear, ratio), None)}


def solve(n, thickness, ratio, force):
    """Largest pressure, contact area and approach: theirs, ours."""
    x = (np.arange(n) + 0.5) / n - 0.5
    h = x[None, :] ** 2 + x[:, None] ** 2
    system = NonSmoothContactSystem(base(n, thickness, ratio), Topography(-h, physical_sizes=(SIDE, SIDE), periodic=True))
    found = system.minimize_proxy(
        maxiter=20000, external_force=force, pentol=TOLERANCE * 0.01, forcetol=TOLERANCE * force / n**2, thermotol=TOLERANCE
    )
    theirs, area = np.array(found.jac) * n**2, (SIDE / n) ** 2
    ours = contact_normal.solve(h, SIDE / n, SIDE / n, force=force, period="xy", tolerance=TOLERANCE, **layer(thickness, ratio))
    offset = float(system.offset)
    return (
        (theirs.max(), (theirs > 0).sum() * area, offset),
        (ours.pressure.max(), (ours.pressure > 0).sum() * area, ours.report["approach"]),
    )


def main():
    """The table."""
    print("| Poisson ratio | thickness | elements | largest pressure | contact area | approach |")
    print("|---|---|---|---|---|---|")
    for ratio in (0.0, 0.3, 0.49):
        for thickness in (0.05, 0.2):
            for n in (64, 128, 256):
                theirs, ours = solve(n, thickness, ratio, 0.01)
                differences = [f"{abs(a / b - 1):.1e}" for a, b in zip(theirs, ours, strict=True)]
                print(f"| {ratio} | {thickness} | {n} x {n} | " + " | ".join(differences) + " |", flush=True)


if __name__ == "__main__":
    main()
