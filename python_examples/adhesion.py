"""A sphere with adhesion, loaded and unloaded, compared with the theories JKR, Maugis and DMT; a rough surface from weak to strong adhesion.
`python3 adhesion.py [FOLDER]`: the folder gets the pictures."""

import sys

import numpy as np

import contact_normal as cn

# Units of Johnson, Kendall and Roberts: with R = 1, w = 1/pi and K = 4/3 E* = 1, forces are in pi w R, and approaches in (pi^2 w^2 R/K^2)^(1/3).
WORK, E_STAR, TABOR = 1 / np.pi, 0.75, 3.0
RANGE = (WORK / E_STAR) ** (2 / 3) / TABOR
M, HALF_WIDTH = 128, 2.0
# The rough surface: elements along a side, mean pressures over E*, works of adhesion over the elastic energy of full contact.
N, MEANS, PARTS = 128, (0.0005, 0.001, 0.002, 0.004, 0.006, 0.008), (0.0, 0.03, 0.1, 0.2, 0.4)


def jkr():
    """The approaches and forces of the theory JKR for several contact radii."""
    a = np.linspace(0.31, 1.9, 200)
    return a**2 - 2 / 3 * np.sqrt(6 * a), a**3 - a * np.sqrt(6 * a)


def dmt():
    """The approaches and forces of the theory DMT: those of Hertz, less the force 2 pi w R."""
    a = np.linspace(0.0, 1.1, 50)
    return a**2, a**3 - 2


def maugis(strength):
    """The approaches and forces of Maugis' theory for an attraction that is constant up to its range; `strength` is 2 sigma(0)."""
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
    """The approaches and forces of steps of one solver: first the bodies come closer, then they go apart."""
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


def rough():
    """Heights on a periodic unit square, waves of random phases with an rms slope of 0.1, and the energy per area that flattens them."""
    k = np.fft.fftfreq(N, 1 / N)
    number = np.hypot(k[:, None], k[None, :])
    inside = (number >= 4) & (number <= 16)
    waves = np.where(inside, number, 1.0) ** -1.8 * inside * np.exp(2j * np.pi * np.random.default_rng(3).random((N, N)))
    heights = np.fft.ifft2(waves).real
    slopes = [np.fft.ifft2(2j * np.pi * axis * np.fft.fft2(heights)).real for axis in (k[:, None], k[None, :])]
    heights *= 0.1 / np.sqrt(sum((slope**2).mean() for slope in slopes))
    # To flatten a wave of amplitude a and wave number q takes the energy E* q a^2/8 per area: E* q/4 times its mean square a^2/2.
    wave = 2 * np.pi * number
    return heights, 0.25 * (wave * np.abs(np.fft.fft2(heights)) ** 2).sum() / N**4


def weak_to_sticky():
    """The contact area for several mean pressures and works of adhesion, from none to a large part of the energy that flattens the surface."""
    heights, full = rough()
    table = {}
    for part in PARTS:
        with cn.Solver(N, N, 1 / N, 1 / N, e_star=1.0, period="xy") as solver:
            adhesion = {"work": part * full, "range": np.sqrt(part * full * 4 / N * np.arcsinh(1) / np.pi / 0.25)} if part else None
            found = [solver.solve(heights.max() - heights, force=mean, adhesion=adhesion) for mean in MEANS]
        table[part] = [(result.contact == 1).mean() for result in found]
    return table


def draw_loop(found, closest, picture):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots()
    for name, (approach, force), style in (("JKR", jkr(), "-"), ("DMT", dmt(), ":"), ("Maugis", maugis(2 * WORK / RANGE), "--")):
        axes.plot(approach, force, style, color="0.5", linewidth=1.2, label=name)
    axes.plot(*found[:closest, :2].T, "o", markersize=4, label="closer")
    axes.plot(*found[closest:, :2].T, "x", markersize=6, label="away")
    axes.set(xlabel="approach, in $(\\pi^2 w^2 R/K^2)^{1/3}$", ylabel="force, in $\\pi w R$", xlim=(-1.3, 1.1), ylim=(-2.1, 0.4))
    axes.legend()
    figure.savefig(picture)


def draw_rough(table, picture):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots()
    for part, areas in reversed(table.items()):
        axes.plot(1e3 * np.array(MEANS), np.array(areas), "o-", markersize=4, label=f"{part:g}" if part else "none")
    axes.set(xlabel="mean pressure, in $10^{-3} E^*$", ylabel="contact area, a part of all", xlim=(0, None), ylim=(0, None))
    axes.legend(title="work of adhesion, of the\nenergy that flattens it", title_fontsize=10)
    figure.savefig(picture)


found, closest = loop()
print("approach     force  jumped")
for approach, force, jumped in found:
    print(f"{approach:8.2f} {force:9.4f} {jumped:7.0f}")
table = weak_to_sticky()
print("contact area of a rough surface, in per cent, by mean pressure and work of adhesion")
print("p/E*     " + "".join(f"{f'w {part:g}':>9}" for part in PARTS))
for k, mean in enumerate(MEANS):
    print(f"{mean:<9g}" + "".join(f"{100 * areas[k]:9.1f}" for areas in table.values()))
if len(sys.argv) > 1:
    draw_loop(found, closest, f"{sys.argv[1]}/adhesion_loop")
    draw_rough(table, f"{sys.argv[1]}/adhesion_rough")
