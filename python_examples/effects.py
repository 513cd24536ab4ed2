"""The effects layer, pressure_limit, period, patches, row_tables and coating, one after the other: `python3 effects.py [pictures]`, the folder of pictures
(effects_layer.png, ...), those of docs/effects.md."""

import sys

import numpy as np

import contact_normal as cn

STEEL = dict(shear_modulus=82000.0, poisson_ratio=0.28)  # N/mm2
M = 64


def ball(radius, d):
    """The undeformed distance of a ball on a plane with elements of size d, and the coordinates of the elements of a row."""
    x = (np.arange(M) - 0.5 * (M - 1)) * d
    return (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius), x


def layers():
    h, x = ball(500.0, 0.1)
    print("compliance   approach  max pressure  contact area")
    for c in (0.0, 1e-6, 1e-5, 1e-4):  # mm per N/mm2: thickness over elastic modulus
        found = cn.solve(h, 0.1, 0.1, force=1000.0, layer=c, **STEEL)
        print(f"{c:10.0e} {found.approach:10.6f} {found.report['max_pressure']:13.2f} {found.report['contact_area']:13.2f}")
        yield f"c = {c:g} mm³/N", x, found.pressure[M // 2]


def pressure_limits():
    h, x = ball(50.0, 0.05)
    print("   force  max pressure  contact area  at the limit      dent")
    for force in (500.0, 2000.0, 4000.0):
        found = cn.solve(h, 0.05, 0.05, force=force, pressure_limit=1200.0, **STEEL)
        dent = max(0.0, -found.deformed_distance[found.at_limit].min(initial=0.0))
        area = found.at_limit.sum() * 0.05**2
        print(f"{force:8.0f} {found.report['max_pressure']:13.2f} {found.report['contact_area']:13.4f} {area:13.4f} {dent:9.5f}")
        yield f"{force:g} N", x, found.pressure[M // 2], found.deformed_distance[M // 2]


def periods():
    d, x = 0.001, (np.arange(M) + 0.5) / M  # the grid is one period of 1 mm
    h = d * (1 - np.outer(np.cos(2 * np.pi * x), np.cos(2 * np.pi * x)))
    full = np.sqrt(2.0) * np.pi * 82000.0 / (1 - 0.28) * d
    print("mean pressure/p*  part in contact  approach/d")
    for share in (0.01, 0.1, 0.5, 0.9, 1.1):
        found = cn.solve(h, 1.0 / M, 1.0 / M, force=share * full, period="xy", **STEEL)
        print(f"{share:16.2f} {found.report['contact_area']:16.4f} {found.approach / d:11.4f}")
        yield f"{share:g} p*", found.pressure


def patches():
    d, x = 0.1, (np.arange(M) - 0.5 * (M - 1)) * 0.1
    left = x < 0
    h = (np.where(left, x + 1.2, x - 1.2)[None, :] ** 2 + x[:, None] ** 2) / 1000.0  # two balls of radius 500 mm
    patch = np.broadcast_to(np.where(left, 0, 1), (M, M))
    print("factor  approach  max pressure  contact area")
    for factor in (0.0, 0.5, 1.0):
        found = cn.solve(h, d, d, force=1000.0, patches=(patch, [[1.0, factor], [factor, 1.0]]), **STEEL)
        print(f"{factor:6.1f} {found.approach:9.6f} {found.report['max_pressure']:13.2f} {found.report['contact_area']:13.2f}")
        yield f"factor {factor:g}", x, found.pressure[M // 2]


def row_tables():
    dx, dy = 0.2, 0.32  # a steel roller in a groove: y runs along the section of the groove, a part of a circle
    x, y = ((np.arange(M) - 0.5 * (M - 1)) * d for d in (dx, dy))
    h = 0.002 * x[None, :] ** 2 + 0.0003 * y[:, None] ** 2
    plane = cn.influence_half_space(M, M, dx, dy, **STEEL)
    apart = np.arange(M)[None, :] - np.arange(M)[:, None]  # iy - jy
    print("curvature  approach  max pressure  contact area")
    for curvature in (0.0, 0.05, 0.1):
        # The displacement along a normal at an angle is that on a plane times the cosine of the angle.
        tables = np.cos(apart * dy * curvature)[:, :, None] * plane[apart + M]
        found = cn.solve(h, dx, dy, force=20000.0, row_tables=tables, **STEEL)
        print(f"{curvature:9.2f} {found.approach:9.6f} {found.report['max_pressure']:13.1f} {found.report['contact_area']:13.2f}")
        yield f"normals turn by {curvature * y[-1]:.1f} rad to either side" if curvature else "a plane", y, found.pressure[:, M // 2]


def coatings():
    h, x = ball(10.0, 0.012)  # a steel ball on a coated steel plate
    plain = dict(force=100.0, shear_modulus=80000.0, poisson_ratio=0.3)
    print("G of coating  thickness  approach  max pressure  contact area")
    for modulus, thickness in ((80000.0, 0.0), (8000.0, 0.05), (8000.0, 0.2), (400000.0, 0.05), (400000.0, 0.2)):
        found = cn.solve(h, 0.012, 0.012, coating=(None, (thickness, modulus, 0.3)), **plain)
        print(f"{modulus:12.0f} {thickness:10.2f} {found.approach:9.6f} {found.report['max_pressure']:13.1f} {found.report['contact_area']:13.4f}")
        yield f"{modulus / 80000:g} G, {thickness:g} mm" if thickness else "no coating", x, found.pressure[M // 2]


def curves(path, text, lines, across="x [mm]", quantity="pressure [N/mm²]", **of_legend):
    """Draws pressures along a line of elements, one curve for each (name, coordinates, pressures) in `lines`."""
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(layout="constrained")
    for name, places, p in lines:
        axes.plot(places, p, label=name)
    axes.set(xlabel=across, ylabel=quantity, title=text)
    axes.legend(**of_legend)
    figure.savefig(path)


def draw_limits(path, limited):
    from matplotlib import pyplot

    figure, (top, bottom) = pyplot.subplots(2, 1, figsize=(6.8, 6.0), sharex=True, layout="constrained")
    for name, x, p, e in limited:
        top.plot(x, p, label=name)
        bottom.plot(x, 1000 * e, label=name)
    top.set(ylabel="pressure [N/mm²]", title="A ball on a surface of hardness 1200 N/mm²")
    bottom.set(xlabel="x [mm]", ylabel="deformed distance [µm]", ylim=(-4, 6))
    top.legend()
    figure.savefig(path)


def draw_periods(path, periodic):
    """Draws three by three periods at each load. Elements without contact have no colour."""
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(2, 3, figsize=(8.6, 6.2), layout="constrained")
    for axes, (name, p) in zip(panels.flat, periodic):
        tiles = np.tile(np.where(p > 0, p / p.max(), np.nan), (3, 3))
        picture = axes.imshow(tiles, origin="lower", extent=(0, 3, 0, 3), vmin=0, vmax=1)
        axes.set(title=f"{name}: at most {p.max():.0f} N/mm²", xlabel="x [mm]", ylabel="y [mm]", xticks=range(4), yticks=range(4))
    panels.flat[-1].set_axis_off()
    figure.colorbar(picture, ax=panels.flat[-1], location="left", fraction=0.5, label="pressure / largest pressure")
    figure.savefig(path)


def draw(folder, layered, limited, periodic, patched, tabled, coated):
    import matplotlib

    matplotlib.use("Agg")
    ending = matplotlib.rcParams["savefig.format"]
    curves(f"{folder}/effects_layer.{ending}", "A ball on a plate with a thin compliant layer, 1000 N", layered, title="compliance")
    curves(f"{folder}/effects_coating.{ending}", "A ball on a plate with an elastic coating, 100 N", coated, title="shear modulus, thickness")
    curves(f"{folder}/effects_patches.{ending}", "Two balls side by side, 1000 N together", patched, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3)
    # The differences from the pressures on a plane, the first case, are small, so these are drawn instead of the pressures.
    _, y, plane = tabled[0]
    curves(f"{folder}/effects_row_tables.{ending}", f"A roller in a groove, 20 kN; in a plane the largest pressure is {plane.max():.0f} N/mm²",
           [(name, y, p - plane) for name, y, p in tabled[1:]], across="y, along the section of the groove [mm]", quantity="pressure less that in a plane [N/mm²]")
    draw_limits(f"{folder}/effects_pressure_limit.{ending}", limited)
    draw_periods(f"{folder}/effects_period.{ending}", periodic)


if __name__ == "__main__":
    found = [list(effect()) for effect in (layers, pressure_limits, periods, patches, row_tables, coatings)]
    if len(sys.argv) > 1:
        draw(sys.argv[1], *found)
