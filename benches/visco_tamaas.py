"""Compares time steps of a viscoelastic body with tamaas (MaxwellViscoelastic, backward Euler): `build/peers/bin/python benches/visco_tamaas.py
[ELEMENTS]`, after `make bench-peers` or with tamaas installed."""

import os
import sys
import time

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402
import tamaas  # noqa: E402

import contact_normal as cn  # noqa: E402

N = int(sys.argv[1]) if len(sys.argv) > 1 else 128
DX, RADIUS, NU = 1.0 / N, 1.0, 0.5
REST, MODULI, TIMES = 1.0, [4.0, 3.0], [0.3, 3.0]
STEP, STEPS, MEAN = 0.2, 10, 0.3
G = REST + sum(MODULI)


def gap():
    x = (np.arange(N) + 0.5) * DX - 0.5
    return (x[None, :] ** 2 + x[:, None] ** 2) / (2 * RADIUS)


def coefficients():
    """The influence coefficients of tamaas: those of points, not of elements, on one period. A wave of pressure p displaces by 2 p/(E* k)."""
    k = 2 * np.pi * np.fft.fftfreq(N, DX)
    k = np.hypot(k[:, None], k[None, :])
    wave = np.where(k > 0, (1 - NU) / G / np.where(k > 0, k, 1), 0)
    places = np.arange(-N, N) % N
    return np.fft.ifft2(wave).real[np.ix_(places, places)]


def own():
    pressures = []
    branches = {"modulus": (None, MODULI), "time": (None, TIMES)}
    with cn.Solver(N, N, DX, DX, shear_modulus=(np.inf, G), poisson_ratio=(0, NU), influence=coefficients(), visco=branches, tolerance=1e-12) as solver:
        for k in range(STEPS):
            step = {"time_step": STEP, "form": "BACKWARD_EULER", "continues": k > 0}
            found = solver.solve(gap(), mean_pressure=MEAN, visco=step, initial_guess="PREVIOUS" if k else "NONE")
            pressures.append(found.pressure)
    return pressures


def theirs():
    tamaas.set_log_level(tamaas.LogLevel.error)
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], [N, N])
    model.nu, model.E = NU, 2 * REST * (1 + NU)
    solver = tamaas.MaxwellViscoelastic(model, -gap(), 1e-12, STEP, MODULI, TIMES)
    solver.max_iter = 5000
    pressures = []
    for _ in range(STEPS):
        solver.solve(MEAN)
        pressures.append(model.traction.reshape(N, N).copy())
    return pressures


seconds, found = [], []
for solve in (own, theirs):
    began = time.perf_counter()
    found.append(solve())
    seconds.append(time.perf_counter() - began)
off = max(np.abs(p - q).max() / q.max() for p, q in zip(*found))
# The largest allowed difference of the pressures, and the least ratio of the times. Both programs have tolerances of 1e-12 for residuals; the pressures
# then agree to 1e-10 on 128 x 128 elements, and less well on more. The time is checked from 128 x 128 on, where the set-up counts little.
AGREE, FASTER = (1e-10, 10.0) if N <= 128 else (1e-9, 10.0)
print(f"{N} x {N} elements, {STEPS} steps: pressures differ by {off:.1e} of the largest; {seconds[0]:.3f} s, tamaas {seconds[1]:.3f} s")
if not off < AGREE:
    sys.exit(f"pressures differ by {off:.1e} of the largest; {AGREE:.0e} is what both tolerances leave")
if N >= 128 and not FASTER * seconds[0] < seconds[1]:
    sys.exit(f"only {seconds[1] / seconds[0]:.1f} times as fast")
