"""Two wheels with the same rubber tread on steel roll on each other and drive: creep forces by the thickness of the tread, from a thin one, which is nearly
a bed of springs, to wheels that are all rubber. `python3 coated_wheels.py [picture.svg]`."""

import sys

import numpy as np

import contact_normal as cn

M, D, RADIUS, FORCE, MU = 64, 0.4, 100.0, 60.0, 0.6  # mm, N
STEEL = dict(shear_modulus=80000.0, poisson_ratio=0.3)  # N/mm2
RUBBER = dict(shear_modulus=1.0, poisson_ratio=0.47)
CREEPAGES = (0.002, 0.01, 0.03, 0.1)


def rolled(h, tread, creepage):
    """Solves steady rolling at a creepage, with the derivatives of the force. If `tread` is None, the whole wheels are rubber."""
    bodies = RUBBER if tread is None else STEEL
    layer = None if tread is None else (tread, RUBBER["shear_modulus"], RUBBER["poisson_ratio"])
    friction = dict(coefficient=MU, motion="STEADY_ROLLING", creepage=(-creepage, 0.0), sensitivities=True)
    result = cn.solve(h, D, D, force=FORCE, coating=(layer, layer), friction=friction, tolerance=1e-7, **bodies)
    if result.status != cn.OK:
        raise SystemExit(f"stopped early: {result.message}")
    return result


def of_springs(result, tread):
    """The slope of the force of two treads as beds of springs, with the compliance 2 t/G: tractions grow linearly behind the leading edge."""
    lengths = result.contact.sum(axis=1) * D
    return 0.5 * RUBBER["shear_modulus"] / (2 * tread) * (lengths * (lengths + D)).sum() * D


def draw(picture, forces):
    """Draws the creep curves, one for each tread."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.8, 4.2), layout="constrained")
    for tread, curve in forces.items():
        axes.plot(CREEPAGES, curve, "o-", label="rubber wheels" if tread is None else f"a tread of {tread:g} mm")
    axes.set(xscale="log", xlabel="creepage", ylabel="tangential force/(mu N)")
    axes.legend(fontsize="small")
    figure.savefig(picture)


def main(picture=None):
    x = (np.arange(M) - 0.5 * (M - 1)) * D
    h = (x**2 + x[:, None] ** 2) / RADIUS  # of two wheels with crowned treads
    print("tread [mm]  contact [mm2]  force/(mu N) at a creepage of", *(f"{creepage:6.3f}" for creepage in CREEPAGES), "  slope [N]  of springs [N]")
    curves = {}
    for tread in (0.1, 1.0, 4.0, 16.0, None):
        results = [rolled(h, tread, creepage) for creepage in CREEPAGES]
        start = rolled(h, tread, 0.0)
        slope = -start.report["sensitivities"][0]
        springs = "-" if tread is None else f"{of_springs(start, tread):.0f}"
        curves[tread] = [result.tangential_force[0] / (MU * FORCE) for result in results]
        forces = (f"{force:6.3f}" for force in curves[tread])
        name = "rubber" if tread is None else f"{tread:.1f}"
        print(f"{name:>10}  {start.contact.sum() * D * D:13.1f}  {'':28}", *forces, f"{slope:11.0f}  {springs:>14}")
    if picture:
        draw(picture, curves)


if __name__ == "__main__":
    main(*sys.argv[1:])
