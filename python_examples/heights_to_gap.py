"""From measured heights to a gap, and what seven mistakes cost. `python3 heights_to_gap.py [folder [gap]]`: the folder gets the pictures of
docs/heights_to_gap.md, and `gap` is a file for c_examples/gap.c and fortran_examples/gap.f90.

The heights are those of data/heights/ground.npy, made by `ground()` as an instrument would give them: x is the first index, some places were not
measured and have the value -9999, there are two spikes, and the specimen lay askew."""

import os
import sys
import warnings

import numpy as np

import contact_normal as cn
from contact_normal import surface

HEIGHTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "heights", "ground.npy")
SIZE = (0.128, 0.096)  # mm, of 64 x 48 elements
UNITS = ("mm", "N")
STEEL = surface.e_star(210e3, 0.3)  # N/mm2
LOAD = {"mean_pressure": 100.0, "e_star": STEEL}  # N/mm2


def ground(mx=64, my=48, d=0.002, seed=11):
    """Makes the heights of a ground face in mm, values[ix, iy]: scratches along x of some 0.15 um, faults and a tilt."""
    rng = np.random.default_rng(seed)
    kx, ky = np.fft.fftfreq(2 * mx, d)[:, None], np.fft.fftfreq(2 * my, d)[None, :]
    k = np.hypot(3.0 * kx, ky)
    amplitudes = np.where((k > 8.0) & (k < 90.0), np.maximum(k, 8.0) ** -1.8, 0.0)
    z = np.fft.ifft2(np.fft.fft2(rng.normal(size=(2 * mx, 2 * my))) * amplitudes).real[:mx, :my]
    z *= 1.5e-4 / z.std()
    x, y = (np.arange(mx) + 0.5) * d, (np.arange(my) + 0.5) * d
    z += 0.02 * x[:, None] - 0.01 * y[None, :]
    for ix, iy, height in ((20, 30, 0.004), (45, 12, 0.006)):
        z[ix, iy] += height
    z[50:58, 30:36] = -9999.0
    return np.round(z, 8)


def measured():
    """Step 1: reads the array, and gives it the order of its indices and the size of an element."""
    return surface.heights(np.load(HEIGHTS), size=SIZE, axes="xy", units=UNITS)


def mistakes():
    """Solves the same load several times, each time with one mistake."""
    values, right = np.load(HEIGHTS), measured()
    found = surface.faults(right)
    level = surface.level(found.removed)
    transposed = surface.heights(values, size=SIZE, units=UNITS)
    short = surface.heights(values, span=SIZE, axes="xy", units=UNITS)
    upside_down = surface.heights(-level.z, level.dx, level.dy)
    with_spikes = right.without(found.fills)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the package warns of -9999, which stands here on purpose
        filled = surface.gap(surface.level(right.without(found.spikes))).solve(**LOAD)
    return {
        "none": surface.gap(level).solve(**LOAD),
        "the array is transposed": surface.gap(surface.level(surface.faults(transposed).removed)).solve(**LOAD),
        "the size is taken for that of n - 1 elements": surface.gap(surface.level(surface.faults(short).removed)).solve(**LOAD),
        "-9999 is taken for a height": filled,
        "the spikes are left": surface.gap(surface.level(with_spikes)).solve(**LOAD),
        "the tilt is left": surface.gap(found.removed).solve(**LOAD),
        "the heights are upside down": surface.gap(upside_down).solve(**LOAD),
        "the grid is taken for a period": surface.gap(level).solve(**LOAD, period="xy"),
    }


def draw(folder):
    """Draws the pictures of docs/heights_to_gap.md."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    def axes_of(size, count=1):
        return pyplot.subplots(1, count, figsize=size, layout="constrained")

    made = measured()
    found = surface.faults(made)
    clean, level = found.removed, surface.level(found.removed)
    gap = surface.gap(level)
    pictures = {}

    pictures["array"], axes = axes_of((8.4, 2.7), 2)
    transposed = surface.heights(np.load(HEIGHTS), size=SIZE, units=UNITS)
    for one, heights, title in zip(axes, (transposed, made), ('axes="yx": transposed', 'axes="xy": as it lies')):
        surface.faults(heights).removed.plot(one)
        one.set_title(title)

    pictures["faults"], axes = axes_of((7.2, 4.6))
    found.plot(axes)
    axes.set_title("red: spikes, and elements of the value -9999")

    pictures["level"], axes = axes_of((7.2, 3.4))
    row = 24
    axes.plot(made.x, 1e3 * clean.z[row], label="measured")
    axes.plot(made.x, 1e3 * (clean.z - level.z)[row], "--", label="plane of least squares")
    axes.plot(made.x, 1e3 * level.z[row], label="levelled")
    axes.set(xlabel="x [mm]", ylabel="height z [µm]", title=f"the row at y = {made.y[row]:.3f} mm")
    axes.legend()

    pictures["gap"], axes = axes_of((7.2, 4.6))
    gap.plot(axes)
    axes.set_title("undeformed distance; empty: +inf, no surface")

    pictures["pressures"], axes = axes_of((8.4, 2.9), 2)
    balanced = surface.balance(gap, made.force(LOAD["mean_pressure"]), e_star=STEEL)
    for one, result, title in zip(axes, (gap.solve(**LOAD), balanced.result), ("levelled by least squares", "free to tilt: balanced")):
        result.plot(one)
        one.locator_params(axis="x", nbins=4)
        p = result.pressure / result.pressure.sum()
        one.plot(p.sum(axis=0) @ result.x, p.sum(axis=1) @ result.y, "x", color="tab:orange", markersize=9, markeredgewidth=2.5)
        one.set_title(f"{title}: area {result.contact_area / made.area:.1%}\ncross: centre of the pressures", fontsize=10)

    for name, figure in pictures.items():
        figure.savefig(f"{folder}/heights_to_gap_{name}", dpi=150)


def main(folder=None, gap_file=None):
    made = measured()
    print(f"{made.z.shape[1]} x {made.z.shape[0]} elements of {made.dx * 1e3:g} um x {made.dy * 1e3:g} um")
    found = surface.faults(made)
    print(found)
    fitted = surface.form(found.removed)
    print(f"tilt removed: {fitted.tilt[0]:.4f} and {fitted.tilt[1]:.4f}; roughness left: {fitted.rms * 1e3:.3f} um")
    gap = surface.gap(surface.level(found.removed))
    force = made.force(LOAD["mean_pressure"])
    print(f"E* = {STEEL:.0f} N/mm2; {LOAD['mean_pressure']:g} N/mm2 on {made.area:.6f} mm2 are {force:.4f} N")
    balanced = surface.balance(gap, force, e_star=STEEL)
    print(f"free to tilt: {balanced.tilt[0]:.1e} and {balanced.tilt[1]:.1e} more, contact on {balanced.result.contact_area / made.area:.1%}")
    print(f"{'mistake':46}{'contact area':>13}{'largest pressure':>19}{'approach':>13}")
    for name, result in mistakes().items():
        if result.status != cn.OK:
            sys.exit(f"{name}: stopped early: {result.message}")
        whole = result.pressure.size * result.dx * result.dy
        print(f"{name:46}{result.contact_area / whole:12.1%}{result.max_pressure:13.0f} N/mm2{1e3 * result.approach:10.3f} um")
    if folder:
        draw(folder)
    if gap_file:
        gap.write(gap_file, "heights of data/heights/ground.npy, levelled; lengths in mm")


if __name__ == "__main__":
    main(*sys.argv[1:])
