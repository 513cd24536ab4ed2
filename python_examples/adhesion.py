"""A sphere that sticks: loading and unloading beside JKR, Maugis and DMT: `python3 adhesion.py [picture.png]`."""

import sys

import numpy as np

import contact_normal as cn

# Units of Johnson, Kendall and Roberts: R = 1, w = 1/pi, K = 4/3 E* = 1: forces in pi w R, approaches in (pi^2 w^2 R/K^2)^(1/3).
WORK, E_STAR, TABOR = 1 / np.pi, 0.75, 3.0
RANGE = (WORK / E_STAR) ** (2 / 3) / TABOR
M, HALF_WIDTH = 128, 2.0


def jkr():
    """Approach and force by the radius of contact."""
    a = np.linspace(0.31, 1.9, 200)
    return a**2 - 2 / 3 * np.sqrt(6 * a), a**3 - a * np.sqrt(6 * a)


def dmt():
    """The same: Hertz, less 2 pi w R."""
    a = np.linspace(0.0, 1.1, 50)
    return a**2, a**3 - 2


def maugis(strength):
    """The same of a constant attraction, sharp at its end; strength: 2 sigma(0)."""
    points = []
    for a in np.linspace(0.05, 1.9, 120):
        def condition(m):
            mu = np.sqrt(m * m - 1)
            t = np.arctan(mu)
            return strength * a * a / 2 * (mu + (m * m - 2) * t) + 4 / 3 * strength**2 * a * (mu * t - m + 1) - 1
        low, high = 1.0, 1e6
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if condition(middle) < 0 else (low, middle)
        mu = np.sqrt(low * low - 1)
        points.append((a * a - 4 / 3 * a * strength * mu, a**3 - strength * a * a * (mu + low * low * np.arctan(mu))))
    return np.array(points).T


def loop():
    """Approaches and forces of one handle, first closer, then away."""
    d = 2 * HALF_WIDTH / M
    x = (np.arange(M) - 0.5 * (M - 1)) * d
    h = (x[None, :] ** 2 + x[:, None] ** 2) / 2
    adhesion = {"work": WORK, "range": RANGE, "start": "FROM_APART"}
    closer = np.arange(-12, 11) / 10
    found = []
    with cn.Solver(M, M, d, d, e_star=E_STAR) as solver:
        for k, approach in enumerate([*closer, *closer[-2::-1]]):
            result = solver.solve(h, approach=approach, adhesion=adhesion, initial_guess="PREVIOUS" if k else "NONE")
            found.append((approach, result.force, result.report["jumped"]))
    return np.array(found), len(closer)


def draw(found, closest, picture):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 4.2), dpi=150, layout="constrained")
    for name, (approach, force), style in (("JKR", jkr(), "k-"), ("DMT", dmt(), "k:"), ("Maugis", maugis(2 * WORK / RANGE), "k--")):
        axes.plot(approach, force, style, linewidth=1, label=name)
    axes.plot(*found[:closest, :2].T, "o", color="tab:blue", markersize=4, label="closer")
    axes.plot(*found[closest:, :2].T, "x", color="tab:red", markersize=5, label="away")
    axes.set(xlabel="approach, in $(\\pi^2 w^2 R/K^2)^{1/3}$", ylabel="force, in $\\pi w R$", xlim=(-1.3, 1.1), ylim=(-2.1, 0.4))
    axes.legend(frameon=False)
    figure.savefig(picture)


found, closest = loop()
print("approach     force  jumped")
for approach, force, jumped in found:
    print(f"{approach:8.2f} {force:9.4f} {jumped:7.0f}")
if len(sys.argv) > 1:
    draw(found, closest, sys.argv[1])
