"""Draws docs/local_fourier_analysis.png: `make analysis`, or

    cargo run --release -p local_fourier_analysis FOLDER
    python3 local_fourier_analysis/picture.py FOLDER docs/local_fourier_analysis.png
"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm


def table(folder, name):
    return np.genfromtxt(os.path.join(folder, name), delimiter=",", names=True)


def wave_map(axes, waves, name, title, **style):
    """A field over the frequencies, from -pi to pi; the square is what the next grid sees."""
    side = int(round(len(waves) ** 0.5))
    field = np.roll(waves[name].reshape(side, side), (side // 2, side // 2), (0, 1))
    image = axes.imshow(field, origin="lower", extent=(-1, 1, -1, 1), **style)
    axes.plot([-0.5, 0.5, 0.5, -0.5, -0.5], [-0.5, -0.5, 0.5, 0.5, -0.5], color="white", linewidth=1)
    ticks = [-1, -0.5, 0, 0.5, 1]
    axes.set(title=title, xlabel="tx / pi", ylabel="ty / pi", xticks=ticks, yticks=ticks)
    axes.figure.colorbar(image, ax=axes, shrink=0.8)


def over_size(axes, sizes):
    for name, label, marker in [
        ("red_black", "red-black", "s"),
        ("gauss_seidel", "Gauss-Seidel", "o"),
        ("jacobi", "Jacobi", "^"),
        ("fft", "FFT", "v"),
    ]:
        axes.semilogx(sizes["across"], sizes[name], marker=marker, label=label)
    axes.semilogx(sizes["across"], sizes["two_grids"], "k--", label="Gauss-Seidel, two grids")
    axes.set(title="Smoothing factors, omega = 0.8", xlabel="elements across", ylim=(0, 1.05))
    axes.legend(fontsize=8, loc="lower left", ncols=2)


def over_relaxation(axes, relaxation):
    for m, colour in [(64, "tab:blue"), (256, "tab:red")]:
        rows = relaxation[relaxation["m"] == m]
        axes.plot(rows["omega"], rows["three_grids"], color=colour, label=f"{m}: analysis, 3 grids")
        axes.plot(rows["omega"], rows["measured"], "o", color=colour, label=f"{m}: measured, all grids")
        axes.plot(rows["omega"], rows["table_1"], ":", marker="x", color=colour, label=f"{m}: as in table 1")
    axes.set(title="Gauss-Seidel, V(1,1), the paper's ellipse", xlabel="omega", ylabel="factor per cycle", ylim=(0, 0.68))
    axes.legend(fontsize=8, loc="lower left", ncols=2)


def main(folder, path):
    waves = table(folder, "waves.csv")
    figure, axes = plt.subplots(2, 3, figsize=(15, 9), layout="constrained")
    wave_map(axes[0, 0], waves, "symbol", "A(t) / c(0,0)", norm=LogNorm(), cmap="viridis")
    for panel, name, title in [
        (axes[0, 1], "gauss_seidel", "left by a sweep of Gauss-Seidel, omega 0.8"),
        (axes[0, 2], "red_black", "left by a red-black sweep, omega 0.8"),
    ]:
        wave_map(panel, waves, name, title, vmin=0, vmax=1, cmap="magma")
    wave_map(axes[1, 0], waves, "jacobi", "left by a sweep of Jacobi, omega 0.8", norm=LogNorm(0.1, 30), cmap="magma")
    over_size(axes[1, 1], table(folder, "sizes.csv"))
    over_relaxation(axes[1, 2], table(folder, "relaxation.csv"))
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    main(*sys.argv[1:])
