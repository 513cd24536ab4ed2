"""Stresses below the surface: under a ball, under a sliding ball, and under a wheel on a rail, with where each is largest.
`python3 subsurface.py [wheel_rail_case.txt [pictures]]`: the folder of pictures gets stress_depth.png, stress_sliding.png and
stress_wheel_rail.png, those of docs/stress.md."""

import sys
from pathlib import Path

import numpy as np

import contact_normal as cn

STEEL = dict(shear_modulus=82000.0, poisson_ratio=0.3)  # N/mm2
M, D, RADIUS = 129, 0.02, 50.0
CASE = Path(__file__).resolve().parent.parent / "data/wheel_rail/y4_82kN.txt"


def ball():
    x = (np.arange(M) - M // 2) * D
    return cn.solve((x[None, :] ** 2 + x[:, None] ** 2) / (2 * RADIUS), D, D, force=1000.0, units=("mm", "N"), **STEEL)


def wheel_on_rail(path):
    """Solves a measured contact (see data/wheel_rail): the wheel, body 1, rolls along x with creepages and spin; the friction coefficient is 0.3."""
    rows = [line for line in Path(path).read_text().splitlines() if not line.startswith("#")]
    mx, my, dx, dy, _, force, modulus, ratio = (float(word) for word in rows[0].split())
    h = np.array([float(word) for row in rows[1:] for word in row.split()[:1]]).reshape(int(my), int(mx))
    rolling = dict(coefficient=0.3, motion="STEADY_ROLLING", creepage=(-1e-3, 5e-4), spin=-2e-4)
    return cn.solve(h, dx, dy, force=force, shear_modulus=modulus, poisson_ratio=ratio, friction=rolling, units=("mm", "N"))


def finer(result, coarse):
    """Refines the largest von Mises stress: computes the stresses again at depths between the neighbours of the depth that has it."""
    k, depths = int(coarse.largest_von_mises["depth"]), coarse.depths
    between = np.linspace(depths[max(k - 1, 0)], depths[min(k + 1, len(depths) - 1)], 21)
    return result.subsurface(between).largest_von_mises


def say(name, stress, unit):
    for what, at in (("von Mises", stress.largest_von_mises), ("shear", stress.largest_shear)):
        print(f"{name}: largest {what} {at['value'] / unit:.3f} p0 at x = {at['x']:.2f}, y = {at['y']:.2f}, z = {at['z']:.2f} mm")


def main(case=CASE, folder=None):
    rolled = ball()
    p0, depths = rolled.report["max_pressure"], np.linspace(0.0, 1.2, 61)
    a = cn.hertz(0.5 / RADIUS, 0.5 / RADIUS, force=1000.0, **STEEL).semi_axis_x
    print(f"ball: p0 = {p0:.0f} N/mm2, a = {a:.3f} mm")
    still = rolled.subsurface(depths)
    say("ball", still, p0)
    sliding = rolled.subsurface(depths, traction=(0.25 * rolled.pressure, 0 * rolled.pressure))
    say("sliding ball", sliding, p0)
    wheel = wheel_on_rail(case)
    p0, (fx, fy) = wheel.report["max_pressure"], wheel.report["tangential_force"]
    print(f"wheel on rail: p0 = {p0:.0f} N/mm2, tangential force ({fx / 1000:.1f}, {fy / 1000:.1f}) kN, "
          f"{(wheel.stick_slip == 1).sum() / wheel.contact.sum():.0%} of the contact area sticks")
    below = wheel.subsurface(np.linspace(0.0, 8.0, 41))  # of body 1, the wheel, with the tractions that were found
    say("wheel on rail", below, p0)
    at = finer(wheel, below)
    print(f"wheel on rail: largest von Mises between these depths {at['value'] / p0:.4f} p0 at z = {at['z']:.2f} mm")
    if folder:
        import matplotlib

        matplotlib.use("Agg")
        at = below.largest_von_mises
        ending = matplotlib.rcParams["savefig.format"]
        for axes, name in (
            (still.plot_depth(), "depth"),
            (sliding.plot_section(y=0.0), "sliding"),
            (below.plot_section(x=at["x"]), "wheel_rail"),
        ):
            axes.figure.savefig(f"{folder}/stress_{name}.{ending}")


if __name__ == "__main__":
    main(*sys.argv[1:])
