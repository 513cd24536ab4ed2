"""Stresses below the surface beside tamaas: `build/peers/bin/python benches/peers/stress.py`, after `make bench-peers` or with the
packages of `requirements.txt`. Prints the table of docs/stress.md.

Both have the pressures of a ball on 128 x 128 elements that repeat themselves, and tractions of a quarter of them, at 32 depths, with one
thread. Both have the arrays that they write before the clock runs. tamaas multiplies waves at its nodes; contact-normal has pressures that are
constant on elements. So tamaas is given the nodes' values and, for the agreement, the same load: each wave times what a mean over elements makes
of it.
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
RADIUS = 32 * D  # of the contact area
DEPTHS = np.linspace(0.0, 62.0 * D, LAYERS)
# tamaas has the same order, xx yy zz xy xz yz, and shear times the square root of 2 (Mandel's notation).
FACTORS = [1.0, 1.0, 1.0, 0.5**0.5, 0.5**0.5, 0.5**0.5]


def load():
    """p, [y][x], and tractions along x."""
    x = (np.arange(M) + 0.5 - 0.5 * M) * D
    p = np.sqrt(np.maximum(0.0, 1.0 - (x[None, :] ** 2 + x[:, None] ** 2) / RADIUS**2))
    return p, 0.25 * p


def ours(p, q, periodic, stress):
    """The six components by the C ABI, and nothing else; `stress` is `[6][z][y][x]`."""
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
    """A model with its operators, set up once; arrays are [z][x][y]."""

    def __init__(self):
        tamaas.initialize(1)
        tamaas.set_log_level(tamaas.LogLevel.error)
        self.model = tamaas.Model(tamaas.model_type.volume_2d, [DEPTHS[-1], M * D, M * D], [LAYERS, M, M])
        self.model.E, self.model.nu = 1.0, NU
        tamaas.ModelFactory.registerVolumeOperators(self.model)
        self.strain, self.stress = (np.zeros((LAYERS, M, M, 6)) for _ in range(2))

    def __call__(self, p, q):
        traction = np.zeros((M, M, 3))
        # Its z goes into the body, too; a traction that presses is positive.
        traction[..., 2] = p.T
        if q is not None:
            traction[..., 0] = q.T
        began = time.perf_counter()
        self.model.operators["boussinesq_gradient"](traction, self.strain)
        self.model.operators["hooke"](self.strain, self.stress)
        seconds = time.perf_counter() - began
        return seconds, np.stack([factor * self.stress[..., c].transpose(0, 2, 1) for c, factor in enumerate(FACTORS)])


def means_over_elements(field):
    """Each wave times the mean of a wave over an element."""
    along = np.sinc(np.fft.fftfreq(M))
    return np.fft.ifft2(np.fft.fft2(field) * along[:, None] * along[None, :]).real


def apart(one, other, first):
    """Largest difference of a component from the depth `first` on, without means over a depth: those are conventions."""
    difference = one[:, first:] - other[:, first:]
    return np.abs(difference - difference.mean(axis=(2, 3), keepdims=True)).max()


def main():
    p, q = load()
    tamaas_stress, mine = Tamaas(), np.full((6, LAYERS, M, M), np.nan)
    same = [means_over_elements(field) for field in (p, q)]
    print(f"tamaas {tamaas.__version__}, contact-normal {contact_normal.__version__}; {M} x {M} elements, {LAYERS} depths, {RUNS} runs in turns\n")
    print("| loads | tamaas, s | contact-normal, s | ratio | half-space without periods, s |")
    print("|---|---:|---:|---:|---:|")
    for name, loads in (("p", (p, None)), ("p, qx", (p, q))):
        calls = [lambda: tamaas_stress(*loads)[0], lambda: ours(*loads, True, mine), lambda: ours(*loads, False, mine)]
        seconds = [[] for _ in calls]
        for _ in range(RUNS):
            for call, taken in zip(calls, seconds):
                taken.append(call())
        peer, periodic, free = map(median, seconds)
        print(f"| {name} | {peer:.3f} | {periodic:.3f} | {peer / periodic:.1f} | {free:.3f} |")
    ours(p, q, True, mine)
    nodes, elements = tamaas_stress(p, q)[1].copy(), tamaas_stress(*same)[1]
    print("\n| from this depth on, elements | values at nodes | the same load |\n|---:|---:|---:|")
    for first in (0, 1, 2, 4, 8):
        print(f"| {DEPTHS[first]:.0f} | {apart(mine, nodes, first):.1e} | {apart(mine, elements, first):.1e} |")


if __name__ == "__main__":
    main()
