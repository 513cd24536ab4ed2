"""A roller wears: it rolls with a creepage and a spin over a harder one, 100 times some turns. `python3 wear.py [picture]`. mm, N, s."""

import sys

import numpy as np

import contact_normal as cn

MX, MY, DX, DY, FORCE = 80, 80, 0.025, 0.03, 1500.0
STEEL = dict(shear_modulus=82000.0, poisson_ratio=0.28)
RADIUS, ACROSS = 50.0, 40.0  # Of the roller that wears, and how much both are curved across the track.
ROLLING = dict(coefficient=0.3, motion="STEADY_ROLLING", creepage=(-0.002, 0.0), spin=0.0008)
WEAR = dict(coefficient=1e-3, hardness=2000.0 * 0.3)  # K/H by the work: H times the friction coefficient.
TURNS, STEPS, SHOWN = 40.0, 100, (1, 20, 50, 100)


def wear():
    """Repeats: solves, and removes from each row of the roller the depth of wear of a point in some turns."""
    x, y = (np.arange(MX) - 0.5 * (MX - 1)) * DX, (np.arange(MY) - 0.5 * (MY - 1)) * DY
    worn = np.zeros(MY)
    shown, volume = {}, 0.0
    with cn.Solver(MY, MX, DX, DY, **STEEL) as solver:
        for step in range(1, STEPS + 1):
            h = x**2 / (2 * RADIUS) + y[:, None] ** 2 / (2 * ACROSS) + worn[:, None]
            result = solver.solve(h, force=FORCE, friction=ROLLING)
            if result.status != cn.OK:
                sys.exit(f"stopped early: {result.message}")
            found = cn.frictional_wear(result.traction, result.slip, DX, DY, rolling_distance=DX, **WEAR)
            if step in SHOWN:
                shown[step] = (result, found, worn.copy())
            worn += TURNS * found.passage
            volume += TURNS * 2 * np.pi * RADIUS * DY * found.passage.sum()
    return y, worn, volume, shown


def draw(picture, y, worn, shown):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for step, (result, _, before) in shown.items():
        left.plot(y, 1e3 * before, label=f"{(step - 1) * TURNS:.0f} turns")
        right.plot(y, result.pressure.max(axis=1), label=f"{(step - 1) * TURNS:.0f} turns")
    left.set(title="what is worn off the roller", xlabel="y, across the track [mm]", ylabel="depth [µm]")
    left.invert_yaxis()
    left.legend(fontsize="small")
    right.set(title="largest pressure of each row", xlabel="y, across the track [mm]", ylabel="pressure [N/mm²]")
    right.legend(fontsize="small")
    figure.savefig(picture)


def main(picture=None):
    y, worn, volume, shown = wear()
    print("turns  elements  largest p  deepest um  work per mm  force x creepage")
    for step, (result, found, before) in shown.items():
        moment = DX * DY * (result.x * result.traction[1] - y[:, None] * result.traction[0]).sum()
        put_in = -result.tangential_force[0] * ROLLING["creepage"][0] - moment * ROLLING["spin"]
        print(f"{(step - 1) * TURNS:5.0f} {(result.pressure > 0).sum():9d} {result.pressure.max():10.0f} {1e3 * before.max():11.3f}", end="")
        print(f"{found.total_work / DX:13.5f} {put_in:20.5f}")
    print(f"after {STEPS * TURNS:.0f} turns: {1e3 * worn.max():.3f} um deep, {volume:.3f} mm3")
    if picture:
        draw(picture, y, worn, shown)


if __name__ == "__main__":
    main(*sys.argv[1:])
