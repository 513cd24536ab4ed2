"""A rough surface on a plane: where it touches, how the area grows with the load, and how large the pressures are.
`python3 rough_surface.py [picture]`."""

import os
import sys

import numpy as np

import contact_normal as cn

WAVES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "rough", "self_affine.txt")
M, SIDE = 256, 1.0  # elements, and mm, along each side
E_STAR = 1.0e3  # N/mm2
# The mean pressures over E*. Up to a fifth of the surface is in contact.
LOADS = (0.001, 0.002, 0.004, 0.007, 0.01)


def heights():
    """The self-affine surface of data/rough, with an rms height of 0.002 of the side, in mm."""
    spectrum = np.zeros((M, M), dtype=complex)
    for ky, kx, re, im in np.loadtxt(WAVES):
        spectrum[int(ky) % M, int(kx) % M] += re + 1j * im
    # The heights are those at the centres of the elements, so the waves are shifted by half an element.
    k = np.fft.fftfreq(M, 1.0 / M)
    half = np.exp(1j * np.pi * (k[:, None] + k[None, :]) / M)
    return SIDE * 2.0 * M * M * np.fft.ifft2(spectrum * half).real


def main(picture=None):
    z = heights()
    slopes = np.gradient(z, SIDE / M, axis=1), np.gradient(z, SIDE / M, axis=0)
    slope = np.sqrt(np.mean(slopes[0] ** 2 + slopes[1] ** 2))
    print(f"rms height {1000.0 * z.std():.2f} um, rms slope {slope:.3f}, {M} x {M} elements, E* = {E_STAR:g} N/mm2")
    # kappa is the part of the area in contact times the rms slope, over the mean pressure/E*. Theories for small loads give constants: Persson
    # sqrt(8/pi) = 1.6, Bush, Gibson and Thomas sqrt(2 pi) = 2.5.
    print(f"{'mean pressure/E*':>16}{'area [%]':>10}{'p max/E*':>10}{'kappa':>8}")
    results = []
    for load in LOADS:
        result = cn.solve(z.max() - z, SIDE / M, SIDE / M, mean_pressure=load * E_STAR, e_star=E_STAR, units=("mm", "N"))
        if result.status != cn.OK:
            sys.exit(f"stopped early: {result.message}")
        results.append(result)
        share = result.contact.mean()
        print(f"{load:16.3f}{100.0 * share:10.1f}{result.max_pressure / E_STAR:10.3f}{share * slope / load:8.2f}")
    if picture:
        draw(picture, results)


def draw(picture, results):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(2, 2, figsize=(8.6, 7.8), layout="constrained")
    shown = results[-2]
    shown.plot(panels[0, 0])
    shown.plot_section(axes=panels[0, 1])
    shown.plot_histogram(axes=panels[1, 0])
    cn.plot_contact_area(results, panels[1, 1])
    figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
