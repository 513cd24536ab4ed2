"""Compares an elastic layer on a rigid base with ContactMechanics: `build/peers/bin/python benches/peers/thickness.py`, after `make bench-peers` or
with the packages of `requirements.txt`.

A ball is pressed by a force onto a periodic layer. ContactMechanics has an elastic half-space of finite thickness; contact-normal has a coating on
a rigid body. The bench compares the largest pressure, the contact area and the approach on finer and finer grids. ContactMechanics computes with
Fourier coefficients of values at nodes, and the pressures of contact-normal are constant on elements, so that both tend to the same solution. The
columns are relative differences, which fall to a quarter where elements are halved. One element at the edge of the contact is 1e-2 to 1e-4 of its
area.
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
    """ContactMechanics' half-space of finite thickness, which takes E instead of E*.

    For an incompressible layer it would divide by 0 in the mean compliance, and for Poisson ratios nearer to 1/2 than this one its solver does not
    end. The difference from 1/2 changes results by some 1e-6.
    """
    young = MODULUS * (1 - ratio**2)
    return PeriodicFFTElasticHalfSpace((n, n), young, (SIDE, SIDE), thickness=thickness, poisson=min(ratio, 0.5 - 1e-6))


def layer(thickness, ratio):
    """The same bodies for contact-normal: a coating on a rigid base, and a rigid ball."""
    shear = 0.5 * MODULUS * (1 - ratio)
    return {"shear_modulus": (np.inf, np.inf), "poisson_ratio": (0.3, 0.3), "coating": ((thickness, shear, ratio), None)}


def solve(n, thickness, ratio, force):
    """The largest pressure, the contact area and the approach by ContactMechanics, and by contact-normal."""
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


# The limit of the differences of the largest pressure and of the approach on 256 x 256 elements, and the least factor by which they must be smaller there
# than on 64 x 64.
AGREE, FALLS = 2e-4, 4.0


def main():
    """Prints the table. Ends with an error if the programs disagree."""
    print("| Poisson ratio | thickness | elements | largest pressure | contact area | approach |")
    print("|---|---|---|---|---|---|")
    wrong = []
    for ratio in (0.0, 0.3, 0.49, 0.5):
        for thickness in (0.05, 0.2):
            found = {}
            for n in (64, 128, 256):
                theirs, ours = solve(n, thickness, ratio, 0.01)
                found[n] = [abs(a / b - 1) for a, b in zip(theirs, ours, strict=True)]
                print(f"| {ratio} | {thickness} | {n} x {n} | " + " | ".join(f"{off:.1e}" for off in found[n]) + " |", flush=True)
            for name, coarse, fine in zip(("pressure", "area", "approach"), found[64], found[256], strict=True):
                if name != "area" and not (fine < AGREE and fine * FALLS < coarse):
                    wrong.append(f"{name} of {ratio}, {thickness}: {coarse:.1e} on 64 x 64, {fine:.1e} on 256 x 256")
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main()
