"""Friction that falls as the surfaces get warm: creep forces of a wheel that brakes at 30 m/s. The program iterates its own law: it solves, computes
the flash temperatures by the frictional heat, and sets the coefficients by these. `python3 hot_friction.py [picture.svg]`."""

import sys

import numpy as np

import contact_normal as cn

MX, MY, DX, DY, FORCE, SPEED = 40, 32, 0.36, 0.9, 106700.0, 3e4  # mm, N, s
STEEL = dict(shear_modulus=82000.0, poisson_ratio=0.28)
HEAT = dict(conductivity=50.0, diffusivity=14.0, speed=-SPEED)  # N/(s K), mm^2/s; both surfaces come in at the leading edge, at larger x.
COLD, HOT, BEGINS, RANGE = 0.4, 0.15, 100.0, 500.0  # mu falls from COLD to HOT between a rise of BEGINS and of BEGINS + RANGE.
PART, TURNS, ENOUGH = 0.6, 60, 1e-6


def coefficient(rise):
    return COLD - (COLD - HOT) * np.clip((rise - BEGINS) / RANGE, 0.0, 1.0)


def rolled(solver, h, creepage):
    """Iterates until mu is that of the temperature. Returns the result, the temperature rise, the least mu and the number of iterations."""
    mu = np.full((MY, MX), COLD)
    for turn in range(1, TURNS + 1):
        friction = dict(coefficient=mu, motion="STEADY_ROLLING", creepage=(-creepage, 0.0), continues=turn > 1)
        result = solver.solve(h, force=FORCE, friction=friction, initial_guess="PREVIOUS" if turn > 1 else "NONE", tolerance=1e-7)
        if result.status != cn.OK:
            sys.exit(f"stopped early: {result.message}")
        slides = result.stick_slip == 2
        flux = np.where(slides, np.hypot(*result.traction) * np.hypot(*result.slip), 0.0) * SPEED / DX
        rise = cn.flash_temperature(flux, DX, DY, **HEAT).rise[0]
        change = np.where(result.contact, coefficient(rise) - mu, 0.0)
        if np.abs(change).max() < ENOUGH:
            return result, rise, mu[result.contact].min(), turn
        # More heat means less friction, and this less heat, so whole changes overshoot. Taking a part of each change converges faster.
        mu = mu + PART * change
    sys.exit("turns do not settle")


def draw(picture, found, cold):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    creepages = list(found)
    left.plot(creepages, [cold[creepage] / FORCE for creepage in creepages], marker="o", label="cold")
    left.plot(creepages, [found[creepage][0].tangential_force[0] / FORCE for creepage in creepages], marker="o", label="warmed by its own heat")
    left.set(title="creep force", xlabel="creepage", ylabel="force over load", xscale="log")
    left.set_ylim(0.0, 1.1 * COLD)
    left.legend(fontsize="small")
    for creepage in creepages[::2]:
        result, rise = found[creepage]
        right.plot(result.x, rise[MY // 2], label=f"creepage {creepage:g}")
    right.set(title="surface of the wheel, along the middle", xlabel="x [mm], the wheel rolls to the right", ylabel="rise of the temperature [K]")
    right.legend(fontsize="small")
    figure.savefig(picture)


def main(picture=None):
    x, y = (np.arange(MX) - 0.5 * (MX - 1)) * DX, (np.arange(MY) - 0.5 * (MY - 1)) * DY
    h = 8e-4 * x**2 + 2.8142e-4 * y[:, None] ** 2
    print("creepage  force/(0.4 N)  warmest [K]  least mu  turns")
    found, cold = {}, {}
    with cn.Solver(MY, MX, DX, DY, **STEEL) as solver:
        for creepage in (0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2):
            result, rise, least, turns = rolled(solver, h, creepage)
            force = result.tangential_force[0]
            print(f"{creepage:8.3f}  {force / (COLD * FORCE):13.4f}  {rise.max():11.1f}  {least:8.4f}  {turns:5}")
            found[creepage] = (result, rise)
            if picture:
                friction = dict(coefficient=COLD, motion="STEADY_ROLLING", creepage=(-creepage, 0.0))
                cold[creepage] = solver.solve(h, force=FORCE, friction=friction).tangential_force[0]
    if picture:
        draw(picture, found, cold)


if __name__ == "__main__":
    main(*sys.argv[1:])
