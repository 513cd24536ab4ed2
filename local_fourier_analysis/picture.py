"""Draws docs/pictures/local_fourier_analysis.svg from the tables in local_fourier_analysis/results, which `make analysis` writes:

    cargo run --release -p local_fourier_analysis FOLDER
    python3 local_fourier_analysis/picture.py --keep FOLDER      # the tables, with three digits
    python3 local_fourier_analysis/picture.py docs/pictures/local_fourier_analysis.svg
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

RESULTS = Path(__file__).resolve().parent / "results"
TABLES = "waves", "sizes", "relaxation"


def keep(folder):
    """Copies the tables with three digits, as many as a picture shows, and the waves without their frequencies, which are those of a grid."""
    RESULTS.mkdir(exist_ok=True)
    for name in TABLES:
        head, *rows = (Path(folder) / f"{name}.csv").read_text().split()
        first = 2 if name == "waves" else 0
        rows = [",".join(f"{float(value):.3g}" for value in row.split(",")[first:]) for row in rows]
        (RESULTS / f"{name}.csv").write_text("\n".join([",".join(head.split(",")[first:]), *rows, ""]))


def table(name):
    return np.genfromtxt(RESULTS / f"{name}.csv", delimiter=",", names=True)


def wave_map(axes, waves, name, title, label, **style):
    """A field over the frequencies from -pi to pi. The square contains the frequencies that the next grid resolves."""
    side = int(round(len(waves) ** 0.5))
    field = np.roll(waves[name].reshape(side, side), (side // 2, side // 2), (0, 1))
    image = axes.imshow(field, origin="lower", extent=(-1, 1, -1, 1), **style)
    axes.plot([-0.5, 0.5, 0.5, -0.5, -0.5], [-0.5, -0.5, 0.5, 0.5, -0.5], color="white", linewidth=1)
    ticks = [-1, -0.5, 0, 0.5, 1]
    axes.set(title=title, xlabel=r"frequency $t_x/\pi$", ylabel=r"frequency $t_y/\pi$", xticks=ticks, yticks=ticks)
    axes.figure.colorbar(image, ax=axes, label=label, fraction=0.046, pad=0.03)


def over_size(axes, sizes):
    for name, label, marker in [
        ("red_black", "red-black", "s"),
        ("gauss_seidel", "Gauss-Seidel", "o"),
        ("jacobi", "Jacobi", "^"),
        ("fft", "FFT", "v"),
    ]:
        axes.semilogx(sizes["across"], sizes[name], marker=marker, label=label)
    axes.semilogx(sizes["across"], sizes["two_grids"], "--", color=plt.rcParams["text.color"], label="Gauss-Seidel, two grids")
    axes.set(title="Smoothing factors, relaxation 0.8", xlabel="elements across the contact area", ylabel="factor per sweep", ylim=(0, 1.05))
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.18))


def over_relaxation(axes, relaxation):
    for m, colour in [(64, "C0"), (256, "C1")]:
        rows = relaxation[relaxation["m"] == m]
        axes.plot(rows["omega"], rows["three_grids"], color=colour, label=f"{m}: analysis, 3 grids")
        axes.plot(rows["omega"], rows["measured"], "o", color=colour, label=f"{m}: measured, all grids")
        axes.plot(rows["omega"], rows["table_1"], ":", marker="x", color=colour, label=f"{m}: as in table 1")
    axes.set(title="Gauss-Seidel, V(1,1), the paper's ellipse", xlabel="relaxation", ylabel="factor per cycle", ylim=(0, 0.68))
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.18))


def draw(path):
    waves = table("waves")
    figure, axes = plt.subplots(3, 2, figsize=(8.6, 12.0), layout="constrained", height_ratios=(1.0, 1.0, 1.1))
    figure.get_layout_engine().set(w_pad=0.12, wspace=0.04)
    wave_map(axes[0, 0], waves, "symbol", "Symbol of A", "A(t)/c(0, 0)", norm=LogNorm(), cmap="viridis")
    for panel, name, title in [(axes[0, 1], "gauss_seidel", "Gauss-Seidel, relaxation 0.8"), (axes[1, 0], "red_black", "Red-black, relaxation 0.8")]:
        wave_map(panel, waves, name, title, "left by a sweep", vmin=0, vmax=1, cmap="magma")
    wave_map(axes[1, 1], waves, "jacobi", "Jacobi, relaxation 0.8", "left by a sweep", norm=LogNorm(0.1, 30), cmap="magma")
    over_size(axes[2, 0], table("sizes"))
    over_relaxation(axes[2, 1], table("relaxation"))
    figure.savefig(path)


if __name__ == "__main__":
    if sys.argv[1] == "--keep":
        keep(sys.argv[2])
    else:
        draw(sys.argv[1])
