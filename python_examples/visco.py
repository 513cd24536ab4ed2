"""A ball pressed into a polymer and drawn back, beside Ting (1966): `python3 visco.py [picture.png]`. mm, N, s."""

import sys

import numpy as np

import contact_normal as cn

# The relaxation modulus is G(t) = 1 + 4 exp(-t/0.3) + 3 exp(-t/3) N/mm2: 8 N/mm2 at t = 0, and 1 N/mm2 in the end.
G, MODULI, TIMES = 8.0, np.array([4.0, 3.0]), np.array([0.3, 3.0])
RADIUS, SPEED, TURN = 10.0, 0.2, 1.0
M, HALF_WIDTH = 64, 3.0
NODES, WEIGHTS = np.polynomial.legendre.leggauss(100)


def modulus(t):
    return G - np.sum(MODULI * (1 - np.exp(-np.asarray(t)[..., None] / TIMES)), axis=-1)


def approach(t):
    return SPEED * np.where(t <= TURN, t, 2 * TURN - t)


def integral(a, b, f):
    return 0.5 * (b - a) * np.sum(WEIGHTS * f(0.5 * (a + b) + 0.5 * (b - a) * NODES))


def ting(t):
    """The force at the time t by Ting's solution. While the ball goes back, the contact is as large as it was at an earlier time t1."""
    t1 = t
    if t > TURN:
        def left(s):
            return integral(s, TURN, lambda x: modulus(t - x)) - integral(TURN, t, lambda x: modulus(t - x))
        if left(0.0) < 0:
            return 0.0
        low, high = 0.0, TURN
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if left(middle) > 0 else (low, middle)
        t1 = low
    # The integral over the time s, with the substitution s = v^2.
    return 16 * np.sqrt(RADIUS) / 3 * integral(0, np.sqrt(t1), lambda v: modulus(t - v * v) * 3 * SPEED**1.5 * v * v)


def cycle(step, form="AUTO"):
    """Solves all steps by one solver. Returns their times, forces and estimated errors."""
    d = 2 * HALF_WIDTH / M
    x = (np.arange(M) - 0.5 * (M - 1)) * d
    h = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * RADIUS)
    found = [(0.0, 0.0, 0.0)]
    branches = {"modulus": (None, MODULI), "time": (None, TIMES)}
    with cn.Solver(M, M, d, d, shear_modulus=(np.inf, G), poisson_ratio=(0.0, 0.5), visco=branches) as solver:
        for k in range(round(1.8 / step)):
            now = {"time_step": step, "form": form, "continues": k > 0}
            result = solver.solve(h, approach=float(approach((k + 1) * step)), visco=now)
            found.append((result.report["time"], result.force, result.report["time_error"]))
    return np.array(found).T


def draw(found, picture):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots()
    times = np.linspace(0, 1.8, 181)
    exact = [ting(t) for t in times]
    axes.plot(approach(times), exact, "-", color="0.5", linewidth=1.2, label="Ting")
    for (name, (time, force, _)), style in zip(found.items(), ("o", "x")):
        axes.plot(approach(time), force, style, markersize=5, label=name)
    elastic = 16 / 3 * G * np.sqrt(RADIUS) * approach(times[times <= TURN]) ** 1.5
    axes.plot(approach(times[times <= TURN]), elastic, ":", color="0.5", linewidth=1.2, label="elastic, G at once")
    axes.set(xlabel="approach [mm]", ylabel="force [N]", xlim=(0, 0.21), ylim=(0, 1.2 * max(exact)))
    axes.legend()
    figure.savefig(picture)


found = {"steps of 0.1 s": cycle(0.1), "steps of 0.1 s, backward Euler": cycle(0.1, "BACKWARD_EULER")}
print("  time  approach     force      Ting  time error  backward Euler")
(times, forces, errors), (_, euler, _) = found.values()
for time, force, error, first_order in zip(times, forces, errors, euler):
    print(f"{time:6.2f} {float(approach(time)):9.3f} {force:9.3f} {ting(time):9.3f} {error:11.1e} {first_order:15.3f}")
if len(sys.argv) > 1:
    draw(found, sys.argv[1])
