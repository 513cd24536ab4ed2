"""Compares solves with adhesion with tamaas: periodic rough surfaces under a mean pressure, with the exponential law.

`build/peers/bin/python benches/peers/adhesion.py [--largest 512]` after `make bench-peers`, or with numpy and tamaas. Prints a table. Both
programs have the same heights, E*, work of adhesion and range, and one thread. For tamaas the loosest tolerance, in decades, is chosen with which
its pressures and gap meet the law outside the contact to 1e-6; contact-normal has a tolerance of 1e-6 for the same measure. Calls are repeated in
turns; times are medians of processor times.
"""

import argparse
import os
import sys
import time
import warnings
from statistics import median

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402
import tamaas  # noqa: E402

import contact_normal  # noqa: E402

LAW_RESIDUAL = 1e-6
REPEATS, LONG = 3, 20.0  # a call of more than LONG seconds is not repeated
KAPPA = 0.25
# Each scene: the mean pressure over E*, and the work of adhesion over the elastic energy of full contact.
SCENES = [(0.001, 0.003), (0.001, 0.1), (0.004, 0.03), (0.004, 0.3)]


def rough(n, seed=3, longest=4, shortest=16, hurst=0.8):
    """Heights with an rms slope of 0.1 on a unit square: waves of random phases with wave numbers from `longest` to `shortest`."""
    k = np.fft.fftfreq(n, 1 / n)
    number = np.hypot(k[:, None], k[None, :])
    inside = (number >= longest) & (number <= shortest)
    # Each wave has its phase, whatever the grid is, so that the surface is the same on every grid.
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, (2 * shortest + 1, 2 * shortest + 1))
    index = np.clip(k.astype(int), -shortest, shortest) + shortest
    waves = np.where(inside, number, 1.0) ** (-1 - hurst) * inside * np.exp(1j * phases[np.ix_(index, index)])
    heights = np.fft.ifft2(waves).real * n * n
    slopes = [np.fft.ifft2(2j * np.pi * axis * np.fft.fft2(heights)).real for axis in (k[:, None], k[None, :])]
    return 0.1 * heights / np.sqrt(sum((slope**2).mean() for slope in slopes))


def scene(heights, adhesion_over_elastic):
    """The work of adhesion and the range of a scene with E* = 1."""
    n = len(heights)
    wave = 2 * np.pi * np.hypot(np.fft.fftfreq(n, 1 / n)[:, None], np.fft.rfftfreq(n, 1 / n)[None, :])
    pressures = np.fft.irfft2(np.fft.rfft2(heights) * wave / 2, s=heights.shape)
    work = adhesion_over_elastic * 0.5 * (heights * pressures).mean()
    self_influence = 4 / n * np.arcsinh(1) / np.pi  # the displacement of an element by a unit pressure on itself
    return work, np.sqrt(work * self_influence / KAPPA)


def ours(heights, mean, work, reach):
    """Makes one whole call of contact-normal. Returns its seconds, the contact area and the residual of the law."""
    n = len(heights)
    began = time.process_time()
    found = contact_normal.solve(
        heights.max() - heights, 1 / n, 1 / n, force=mean, e_star=1.0, period="xy", tolerance=LAW_RESIDUAL, threads=1,
        adhesion={"work": work, "range": reach},
    )
    return time.process_time() - began, (found.contact == 1).mean(), found.report["law_residual"]


def theirs(heights, mean, work, reach, tolerance):
    """Makes the same call of tamaas, which minimises over gaps as in its example. Returns the same values."""
    began = time.process_time()
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], list(heights.shape))
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, heights, tolerance, tamaas.PolonskyKeerRey.gap, tamaas.PolonskyKeerRey.pressure)
    law = tamaas.ExponentialAdhesionFunctional(heights)
    law.parameters = {"rho": reach, "surface_energy": work}
    solver.addFunctionalTerm(law)
    solver.max_iter = 5000
    solver.solve(mean)
    seconds = time.process_time() - began
    gap, pressure = np.array(model["gap"]), np.array(model.traction)
    inside = gap <= 1e-12 * reach
    left = (pressure + work / reach * np.exp(-np.maximum(gap, 0) / reach))[~inside]
    is_true = abs(pressure.mean() - mean) < 1e-3 * mean
    return seconds, inside.mean(), np.sqrt((left**2).sum() / (pressure**2).sum()) if is_true else np.inf


def tolerance_of_peer(heights, mean, work, reach):
    """The loosest tolerance with which tamaas meets the law, and the seconds of its call; None if there is no such tolerance."""
    for tolerance in 10.0 ** -np.arange(3, 9):
        seconds, _, left = theirs(heights, mean, work, reach, tolerance)
        if left <= 1.1 * LAW_RESIDUAL:
            return tolerance, seconds
    return None, None


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--largest", type=int, default=512)
    largest = parser.parse_args().largest
    warnings.simplefilter("ignore")
    tamaas.set_log_level(tamaas.LogLevel.error)
    print("| elements | mean pressure/E* | w/elastic energy | contact | contact-normal | tamaas, tolerance | its contact | times slower |")
    print("|---|---|---|---|---|---|---|---|")
    for n in (128, 256, 512):
        if n > largest:
            break
        heights = rough(n)
        for mean, part in SCENES:
            work, reach = scene(heights, part)
            tolerance, once = tolerance_of_peer(heights, mean, work, reach)
            repeats = 1 if once is None or once > LONG else REPEATS
            times, peers = [], []
            for _ in range(REPEATS):
                times.append(ours(heights, mean, work, reach))
                if tolerance is not None and len(peers) < repeats:
                    peers.append(theirs(heights, mean, work, reach, tolerance))
            seconds = median(one[0] for one in times)
            start = f"| {n} x {n} | {mean} | {part} | {times[0][1]:.4f} | {1e3 * seconds:.1f} ms"
            if not peers:
                print(f"{start} | not reached | | |", flush=True)
                continue
            peer = median(one[0] for one in peers)
            print(f"{start} | {1e3 * peer:.0f} ms, {tolerance:.0e} | {peers[0][1]:.4f} | {peer / seconds:.0f} |", flush=True)


if __name__ == "__main__":
    main()
