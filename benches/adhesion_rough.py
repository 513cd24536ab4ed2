"""Solves rough surfaces with weak to strong adhesion: `adhesion_rough.py [--largest 512]`.

The surface is a unit square with two periods, waves of 4 to 16 per side, a Hurst exponent of 0.8 and an rms slope of 0.1. E* = 1, and the law is
exponential with kappa = 0.25. The force is given. The work of adhesion is a part of the elastic energy of full contact, which is
`E*/4 sum of k |h_k|^2` per area (Johnson 1985, section 13.2). Prints one line per load, with values of the reports: the contact area and the
adhesive over the total force on 128 x 128 elements, the products on each grid, and the largest residual.
"""

import argparse
import functools
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, ".."))
os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402

import contact_normal  # noqa: E402

KAPPA, FEWEST, MOST, SLOPE = 0.25, 4, 16, 0.1
# The displacement, times E*, of a square element of side 1 by a unit pressure on itself (Love 1929).
SELF_INFLUENCE = 4 / np.pi * np.arcsinh(1.0)


@functools.cache
def surface(n, seed=3):
    """Heights with the same waves on any grid, and the elastic energy of full contact per area."""
    draw = np.random.default_rng(seed)
    x, heights, square, energy = np.arange(n) / n, np.zeros((n, n)), 0.0, 0.0
    for ky in range(-MOST, MOST + 1):
        for kx in range(0, MOST + 1):
            phase, number = 2 * np.pi * draw.random(), np.hypot(kx, ky)
            if FEWEST <= number <= MOST and (kx > 0 or ky > 0):
                amplitude, wave = number**-1.8, 2 * np.pi * number
                heights += amplitude * np.cos(2 * np.pi * (kx * x[None, :] + ky * x[:, None]) + phase)
                square += 0.5 * (wave * amplitude) ** 2
                energy += 0.125 * wave * amplitude**2
    factor = SLOPE / np.sqrt(square)
    return factor * heights, factor**2 * energy


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--largest", type=int, default=512)
    sizes = [n for n in (128, 256, 512) if n <= parser.parse_args().largest]
    print("| pressure | w/energy | contact | adhesive/total force | products, " + ", ".join(map(str, sizes)) + " | largest residual |")
    print("|---|---|---|---|---|---|")
    for pressure in (0.001, 0.004):
        for part in (0.003, 0.03, 0.1, 0.3):
            found = [solve(n, pressure, part) for n in sizes]
            first, reports = found[0], [each.report for each in found]
            products = ", ".join(f"{report['work_units']:.0f}" for report in reports)
            adhesive = reports[0]["adhesive_force"] / pressure
            residual = max(report["residual"] for report in reports)
            print(f"| {pressure} | {part} | {(first.contact == 1).mean():.4f} | {adhesive:.2f} | {products} | {residual:.0e} |", flush=True)


def solve(n, pressure, part):
    """Solves the surface on a grid of n x n elements. The range follows from kappa, and so changes with the grid."""
    heights, energy = surface(n)
    work = part * energy
    reach = np.sqrt(work * SELF_INFLUENCE / n / KAPPA)
    adhesion = {"work": work, "range": reach}
    gap = heights.max() - heights
    return contact_normal.solve(gap, 1 / n, 1 / n, mean_pressure=pressure, e_star=1.0, period="xy", adhesion=adhesion)


if __name__ == "__main__":
    main()
