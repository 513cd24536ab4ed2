"""Friction that falls with the slip velocity: creep curves of a wheel on a rail at 10 m/s. `python3 laws.py [picture]`: with a picture it draws them, and
what particles of the interface carry through the contact."""

import sys

import numpy as np

import contact_normal as cn

MX, MY, DX, DY, FORCE = 48, 44, 0.289, 0.6304, 106700.0  # mm, N
STEEL = dict(shear_modulus=82000.0, poisson_ratio=0.28)
ROLLING = dict(coefficient=0.33, motion="STEADY_ROLLING", compliance=1.25 / 8200.0)  # A third body of 1.25 mm.
LAW = dict(kind="EXPONENTIAL", kinetic=0.14, falling=0.19, half_speed=1250.0, speed=1e4, memory_distance=0.003, memory_speed=1.0)
FRICTIONS = {
    "one coefficient": {},
    "falls with the slip velocity": dict(law=LAW),
    "and a layer that yields": dict(law=LAW, layer=dict(yield_limit=100.0)),
}
CREEPAGES = np.array([0.5, 1, 2, 4, 6, 8, 12, 16, 20, 30, 50, 75, 100]) * 1e-3


def rolled(creepage, friction):
    x, y = (np.arange(MX) - 0.5 * (MX - 1)) * DX, (np.arange(MY) - 0.5 * (MY - 1)) * DY
    h = 8e-4 * x**2 + 2.8142e-4 * y[:, None] ** 2
    result = cn.solve(h, DX, DY, force=FORCE, friction=dict(ROLLING, creepage=(-creepage, 0.0), **friction), **STEEL)
    if result.status != cn.OK:
        sys.exit(f"stopped early: {result.message}")
    return result


def draw(picture, curves, across):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name, forces in curves.items():
        left.plot(1e3 * CREEPAGES, forces, "o-", markersize=4, label=name)
    left.set(title="creep force of a wheel on a rail", xlabel="creepage −ξ [0.001]", ylabel="force $F_x/(0.33 N)$", ylim=(0.0, 1.1))
    left.legend(loc="lower right", fontsize="small")
    middle = MY // 2
    touches = across.stick_slip[middle] > 0
    bound = 0.33 * across.pressure[middle]
    right.plot(across.x[touches], bound[touches], "--", color="0.5", label="0.33 p")
    right.plot(across.x[touches], across.friction_coefficient[middle, touches] * across.pressure[middle, touches], label="what friction has fallen to")
    right.plot(across.x[touches], across.traction[0, middle, touches], "o", markersize=4, label="traction")
    right.set(title="creepage −0.016, the middle row", xlabel="x, rolling to the right [mm]", ylabel="traction [N/mm²]")
    right.legend(loc="lower center", fontsize="small")
    figure.savefig(picture)


def main(picture=None):
    curves = {name: [] for name in FRICTIONS}
    print("creepage" + "".join(f"{name:>30}" for name in FRICTIONS))
    for creepage in CREEPAGES:
        for name, friction in FRICTIONS.items():
            curves[name].append(rolled(creepage, friction).tangential_force[0] / (0.33 * FORCE))
        print(f"{creepage:8.4f}" + "".join(f"{forces[-1]:30.4f}" for forces in curves.values()))
    if picture:
        draw(picture, curves, rolled(0.016, dict(law=LAW)))


if __name__ == "__main__":
    main(*sys.argv[1:])
