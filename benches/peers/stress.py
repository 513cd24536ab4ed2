"""Compares stresses below the surface with tamaas: `build/peers/bin/python benches/peers/stress.py`, after `make bench-peers` or with the
packages of `requirements.txt`. Prints the tables for docs/stress.md.

Both programs compute the stresses at 32 depths, on one thread, for Hertz's pressures of a ball on 128 x 128 elements, continued periodically:
without tractions, and with tractions along x of a quarter of the pressures. Output arrays are allocated before the time is taken.

tamaas multiplies the Fourier coefficients of values at nodes by its kernel; the pressures of contact-normal are constant on elements. In the
timed runs tamaas gets the values at nodes. For the comparison of the stresses it also gets the same load as contact-normal: each Fourier
coefficient times sinc(kx/M) sinc(ky/M), the mean of a wave over an element.
"""

import ctypes
import os
import sys
import time
from statistics import median

os.environ["OMP_NUM_THREADS"] = "1"
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402
import tamaas  # noqa: E402

import contact_normal  # noqa: E402
from contact_normal._library import check, initialised, library  # noqa: E402

M, LAYERS, D, NU, RUNS = 128, 32, 1.0, 0.3, 9
RADIUS = 32 * D  # the radius of the contact area
DEPTHS = np.linspace(0.0, 62.0 * D, LAYERS)
# The factors by which the components of tamaas are multiplied. It has the same order, xx yy zz xy xz yz, but its shear stresses contain the square
# root of 2 (Mandel's notation).
FACTORS = [1.0, 1.0, 1.0, 0.5**0.5, 0.5**0.5, 0.5**0.5]


def load():
    """Returns the pressures p of a ball, `[y][x]`, and the tractions along x."""
    x = (np.arange(M) + 0.5 - 0.5 * M) * D
    p = np.sqrt(np.maximum(0.0, 1.0 - (x[None, :] ** 2 + x[:, None] ** 2) / RADIUS**2))
    return p, 0.25 * p


def ours(p, q, periodic, stress):
    """Computes the six components by the C ABI into `stress`, `[6][z][y][x]`. Returns the seconds of the call."""
    scene, outputs = initialised("scene"), initialised("stress_outputs")
    period = initialised("period")
    period.x = period.y = 1
    scene.mx = scene.my = M
    scene.dx = scene.dy = D
    scene.poisson_ratio[0] = NU
    if periodic:
        scene.period = ctypes.pointer(period)
    pointer = lambda array: array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))  # noqa: E731
    for c in range(6):
        outputs.stress[c] = pointer(stress[c])
    given = [None if array is None else pointer(array) for array in (p, q, None)]
    began = time.perf_counter()
    check(library.contact_normal_subsurface_stress(ctypes.byref(scene), 1, *given, pointer(DEPTHS), LAYERS, None, ctypes.byref(outputs)))
    return time.perf_counter() - began


class Tamaas:
    """tamaas with its model and operators, which are set up once. A call returns its seconds and the stresses, `[6][z][y][x]`.

    Arrays of tamaas are [z][x][y].
    """

    def __init__(self):
        tamaas.initialize(1)
        tamaas.set_log_level(tamaas.LogLevel.error)
        self.model = tamaas.Model(tamaas.model_type.volume_2d, [DEPTHS[-1], M * D, M * D], [LAYERS, M, M])
        self.model.E, self.model.nu = 1.0, NU
        tamaas.ModelFactory.registerVolumeOperators(self.model)
        self.strain, self.stress = (np.zeros((LAYERS, M, M, 6)) for _ in range(2))

    def __call__(self, p, q):
        traction = np.zeros((M, M, 3))
        # As here, tamaas' z axis points into the body, so a pressure is a positive traction along z.
        traction[..., 2] = p.T
        if q is not None:
            traction[..., 0] = q.T
        began = time.perf_counter()
        self.model.operators["boussinesq_gradient"](traction, self.strain)
        self.model.operators["hooke"](self.strain, self.stress)
        seconds = time.perf_counter() - began
        return seconds, np.stack([factor * self.stress[..., c].transpose(0, 2, 1) for c, factor in enumerate(FACTORS)])


def means_over_elements(field):
    """Multiplies each Fourier coefficient of a field by the mean of its wave over an element, `sinc(k/M)` in each direction."""
    sinc = np.sinc(np.fft.fftfreq(M))
    return np.fft.ifft2(np.fft.fft2(field) * sinc[:, None] * sinc[None, :]).real


def largest_difference(one, other, first):
    """The largest difference of any component at the depths with the indices `first`, `first + 1`, ...

    The mean of each depth is removed: the stress by the mean load of a periodic half-space is a convention of each program.
    """
    difference = one[:, first:] - other[:, first:]
    return np.abs(difference - difference.mean(axis=(2, 3), keepdims=True)).max()


def main():
    p, q = load()
    tamaas_stress, our_stress = Tamaas(), np.full((6, LAYERS, M, M), np.nan)
    element_means = [means_over_elements(field) for field in (p, q)]
    print(f"tamaas {tamaas.__version__}, contact-normal {contact_normal.__version__}; {M} x {M} elements, {LAYERS} depths, {RUNS} runs in turns\n")
    print("| loads | tamaas, s | contact-normal, s | ratio | half-space without periods, s |")
    print("|---|---:|---:|---:|---:|")
    for name, loads in (("p", (p, None)), ("p, qx", (p, q))):
        calls = [lambda: tamaas_stress(*loads)[0], lambda: ours(*loads, True, our_stress), lambda: ours(*loads, False, our_stress)]
        seconds = [[] for _ in calls]
        for _ in range(RUNS):
            for call, taken in zip(calls, seconds):
                taken.append(call())
        peer, periodic, free = map(median, seconds)
        print(f"| {name} | {peer:.3f} | {periodic:.3f} | {peer / periodic:.1f} | {free:.3f} |")
    ours(p, q, True, our_stress)
    tamaas_of_nodes, tamaas_of_means = tamaas_stress(p, q)[1].copy(), tamaas_stress(*element_means)[1]
    print("\n| depth and below, in elements | difference, values at nodes | difference, the same load |\n|---:|---:|---:|")
    for first in (0, 1, 2, 4, 8):
        differences = [largest_difference(our_stress, theirs, first) for theirs in (tamaas_of_nodes, tamaas_of_means)]
        print(f"| {DEPTHS[first]:.0f} | {differences[0]:.1e} | {differences[1]:.1e} |")


if __name__ == "__main__":
    main()
