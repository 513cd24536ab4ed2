"""Solves the material of the contact-mechanics challenge (Müser et al. 2017) on self-affine surfaces that this script makes.

    adhesion_challenge.py [--largest 2048] [picture.png]

E* = 25 MPa, a work of adhesion of 50 mJ/m^2, the exponential law, a mean pressure of 250 kPa. The surfaces are 0.1 mm x 0.1 mm large, with two
periods, a Hurst exponent of 0.8 and an rms slope of 1, with waves from 20 um down to 4 elements. The range of the challenge, 2.071 nm, needs
elements of about 2 nm; on coarser elements the range is the shortest that they resolve. Prints one line per grid: range, kappa, contact area,
adhesive over total force, products, bytes per element, seconds.
"""

import argparse
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, ".."))
os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402

import contact_normal  # noqa: E402

MODULUS, WORK, PRESSURE, SIDE = 25.0, 50e-3, 0.25, 100.0  # lengths in um, pressures in MPa, so that works of adhesion are in N/m
LONGEST, HURST, RANGE = 20.0, 0.8, 2.071e-3  # um


def surface(n, seed=1):
    """Heights in um, whose spectrum is flat for waves longer than LONGEST, and self-affine for shorter ones down to four elements."""
    k = np.fft.fftfreq(n, SIDE / n)
    number = np.hypot(k[:, None], k[None, :])
    inside = (number > 0) & (number <= n / (4 * SIDE))
    amplitude = np.where(inside, np.maximum(number, 1 / LONGEST), 1.0) ** (-1 - HURST) * inside
    heights = np.fft.ifft2(amplitude * np.exp(2j * np.pi * np.random.default_rng(seed).random((n, n)))).real
    slopes = [np.fft.ifft2(2j * np.pi * axis * np.fft.fft2(heights)).real for axis in (k[:, None], k[None, :])]
    return heights / np.sqrt(sum((slope**2).mean() for slope in slopes))


def main():
    """Prints the table, and draws the result on the largest grid."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--largest", type=int, default=2048)
    parser.add_argument("picture", nargs="?")
    given = parser.parse_args()
    print("| elements | element [nm] | range [nm] | kappa | kappa of 2.071 nm | contact | adhesive/total force | products | bytes/element | seconds |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for n in (512, 1024, 2048):
        if n > given.largest:
            break
        heights, d = surface(n), SIDE / n
        began = time.perf_counter()
        found = contact_normal.solve(heights.max() - heights, d, d, mean_pressure=PRESSURE, e_star=MODULUS, period="xy", adhesion={"work": WORK})
        seconds = time.perf_counter() - began
        report = found.report
        own = report["resolution"] * report["range"] ** 2 / RANGE**2
        force = PRESSURE * SIDE**2
        print(
            f"| {n} x {n} | {1e3 * d:.0f} | {1e3 * report['range']:.0f} | {report['resolution']:.2f} | {own:.0f} | {(found.contact == 1).mean():.4f} | "
            f"{report['adhesive_force'] / force:.3f} | {report['work_units']:.0f} | {report['bytes'] / n**2:.0f} | {seconds:.1f} |",
            flush=True,
        )
    if given.picture:
        draw(found, given.picture)


def draw(found, picture):
    """Draws the pressures of the whole surface and of a part: positive where the bodies press, negative where they pull at each other."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (whole, part) = pyplot.subplots(1, 2, figsize=(6.8, 3.3), layout="constrained")
    pull = WORK / found.report["range"]
    x, y, width = 60, 8, 25
    for axes in (whole, part):
        image = axes.imshow(found.pressure, origin="lower", extent=(0, SIDE, 0, SIDE), cmap="RdBu_r", vmin=-pull, vmax=pull, interpolation="nearest")
        axes.set(xlabel="x [µm]", ylabel="y [µm]")
    whole.add_patch(pyplot.Rectangle((x, y), width, width, fill=False, linewidth=1))
    part.set(xlim=(x, x + width), ylim=(y, y + width))
    figure.colorbar(image, ax=(whole, part), label="pressure [MPa], negative where they pull", extend="max")
    figure.savefig(picture)


if __name__ == "__main__":
    main()
