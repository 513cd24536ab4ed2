"""The effects layer, pressure_limit, period, patches, row_tables and coating, one after the other: `python3 effects.py [pictures]`, the folder of pictures
(effects_layer.png, ...), those of docs/effects.md."""

import sys

import numpy as np

import contact_normal as cn

STEEL = dict(shear_modulus=82000.0, poisson_ratio=0.28)  # N/mm2
M = 64


def ball(radius, d):
    """Undeformed distance of a ball on a plane, and the distances of a row of elements from its axis."""
    x = (np.arange(M) - 0.5 * (M - 1)) * d
    return (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius), x


def layers():
    h, x = ball(500.0, 0.1)
    print("compliance   approach  max pressure  contact area")
    for c in (0.0, 1e-6, 1e-5, 1e-4):  # mm per N/mm2: thickness over elastic modulus
        found = cn.solve(h, 0.1, 0.1, force=1000.0, layer=c, **STEEL)
        print(f"{c:10.0e} {found.approach:10.6f} {found.report['max_pressure']:13.2f} {found.report['contact_area']:13.2f}")
        yield f"c = {c:g} mm$^3$/N", x, found.pressure[M // 2]


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
        # What a pressure displaces along another normal is the cosine of what it would be in a plane.
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


def draw(folder, layered, limited, periodic, patched, tabled, coated):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 4))
    for name, x, p in layered:
        axes.plot(x, p, label=name)
    axes.set(xlabel="x [mm]", ylabel="pressure [N/mm$^2$]", title="A ball on a coated plate, 1000 N")
    axes.legend()
    figure.savefig(f"{folder}/effects_layer.png", dpi=100, bbox_inches="tight")

    figure, axes = plt.subplots(figsize=(7, 4))
    for name, x, p in coated:
        axes.plot(x, p, label=name, color="black" if name == "no coating" else None)
    axes.set(xlabel="x [mm]", ylabel="pressure [N/mm$^2$]", title="A ball on a plate with an elastic coating, 100 N")
    axes.legend(title="shear modulus, thickness", fontsize="small")
    figure.savefig(f"{folder}/effects_coating.png", dpi=100, bbox_inches="tight")

    figure, axes = plt.subplots(figsize=(7, 4))
    for name, x, p in patched:
        axes.plot(x, p, label=name)
    axes.set(xlabel="x [mm]", ylabel="pressure [N/mm$^2$]", title="Two balls side by side, 1000 N together")
    axes.legend(loc="upper center")
    figure.savefig(f"{folder}/effects_patches.png", dpi=100, bbox_inches="tight")

    figure, axes = plt.subplots(figsize=(7, 4))
    for name, y, p in tabled:
        axes.plot(y, p, label=name)
    axes.set(xlabel="y along the section [mm]", ylabel="pressure [N/mm$^2$]", title="A roller in a groove, 20 kN")
    axes.legend(loc="lower center")
    figure.savefig(f"{folder}/effects_row_tables.png", dpi=100, bbox_inches="tight")

    figure, (top, bottom) = plt.subplots(2, 1, figsize=(7, 6), sharex=True)
    for name, x, p, e in limited:
        top.plot(x, p, label=name)
        bottom.plot(x, 1000 * e, label=name)
    top.set(ylabel="pressure [N/mm$^2$]", title="A ball on a surface of hardness 1200 N/mm$^2$")
    bottom.set(xlabel="x [mm]", ylabel="deformed distance [$\\mu$m]", ylim=(-4, 6))
    top.legend()
    figure.savefig(f"{folder}/effects_pressure_limit.png", dpi=100, bbox_inches="tight")

    figure, each = plt.subplots(1, len(periodic), figsize=(13, 3.4))
    for axes, (name, p) in zip(each, periodic):
        # Three by three periods; white where nothing touches.
        tiles = np.tile(np.where(p > 0, p, np.nan), (3, 3))
        picture = axes.imshow(tiles, origin="lower", extent=(0, 3, 0, 3), cmap="viridis")
        axes.set(title=name, xlabel="x/L", xticks=range(4), yticks=range(4))
        figure.colorbar(picture, ax=axes, shrink=0.7)
    figure.suptitle("A wavy surface in x and y: pressures [N/mm$^2$]")
    figure.tight_layout()
    figure.savefig(f"{folder}/effects_period.png", dpi=100, bbox_inches="tight")


if __name__ == "__main__":
    found = [list(effect()) for effect in (layers, pressure_limits, periods, patches, row_tables, coatings)]
    if len(sys.argv) > 1:
        draw(sys.argv[1], *found)
