"""Solves scenes of one of three groups by the library of CONTACT_NORMAL_LIBRARY: `scenes.py normal|friction|adhesion`.

Prints JSON: for each scene the number of products, the status, and force, approach, tangential forces and creepages."""

import json
import sys
import warnings

import numpy as np

import contact_normal as cn

LIKE = dict(shear_modulus=(1.0, 1.0), poisson_ratio=(0.3, 0.3))
UNLIKE = dict(shear_modulus=(1.0, 9.0), poisson_ratio=(0.1, 0.3))
LOAD = 0.02


def places(n):
    """x and y of the centres of n x n elements of a square of side 1."""
    x = (np.arange(n) + 0.5) / n - 0.5
    return np.meshgrid(x, x)


def rough(n, seed, lowest=1):
    """Self-affine heights with a Hurst exponent of 0.8 and an rms slope of 0.1."""
    k = np.fft.fftfreq(n, 1 / n)
    wave = np.hypot(*np.meshgrid(k, k))
    amplitude = np.where((wave >= lowest) & (wave <= n // 4), np.maximum(wave, 1) ** -1.8, 0)
    heights = np.fft.ifft2(amplitude * np.exp(2j * np.pi * np.random.default_rng(seed).random((n, n)))).real
    slope = np.hypot(*np.gradient(heights, 1 / n))
    return 0.1 * heights / np.sqrt((slope**2).mean())


def solved(call, h, dx, dy, tolerance=None, **scene):
    """Solves a scene, and returns the numbers that are compared: products, status, force, approach, and with friction forces and creepages."""
    try:
        r = call(h, dx, dy, **scene, **({} if tolerance is None else {"tolerance": tolerance}))
    except cn.ContactNormalError as error:
        return [0, -1, str(error)[:80]]
    products = float(r.report["work_units"]) + float(r.report["tangential_products"])
    found = [products, int(r.status), float(r.force), float(r.approach)]
    if "friction" in scene:
        found += [*map(float, r.tangential_force), *(float(x) for k in sorted(r.report) if "creepage" in k for x in np.ravel(r.report[k]))]
    return found


def normal():
    """Solves normal problems: smooth, rough and noisy surfaces, punches, spikes, holes, pressure limits, line contacts, coatings; steps in time."""
    scenes = []

    def add(name, h, dx, dy, **scene):
        scenes.append((name, h, dx, dy, scene))

    for n in (31, 64, 100, 128):
        (x, y), d = places(n), 1 / n
        add(f"ball{n}", (x**2 + y**2) / 2, d, d, approach=0.06)
        add(f"ballF{n}", (x**2 + 4 * y**2) / 2, d, d, force=LOAD)
        add(f"cone{n}", np.hypot(x, y) * 0.3, d, d, force=0.01)
        add(f"punch{n}", np.where(np.maximum(abs(x), abs(y)) < 0.3, 0.0, 1.0), d, d, approach=0.01)
        add(f"noise{n}", np.random.default_rng(n).random((n, n)) * 0.1, d, d, approach=0.05)
        add(f"noiseF{n}", np.random.default_rng(n + 1).random((n, n)) * 0.1, d, d, force=LOAD)
    for n in (64, 128):
        d = 1 / n
        for seed in range(3):
            h = rough(n, seed)
            h = h - h.min()
            add(f"rough{n}.{seed}", h, d, d, force=0.01 * (seed + 1))
            add(f"roughP{n}.{seed}", h, d, d, mean_pressure=0.01 * 10 ** (seed - 1), period="xy")
            top = cn.solve(h, d, d, **LIKE, mean_pressure=0.02, period="xy").pressure.max() if n == 64 else 0.3
            for part in (0.5, 0.2):
                add(f"limit{n}.{seed}.{part:g}", h, d, d, mean_pressure=0.02, period="xy", pressure_limit=top * part)
                add(f"limitA{n}.{seed}.{part:g}", h, d, d, approach=0.03, pressure_limit=top * part)
        h = rough(n, 9)
        h = h - h.min()
        spikes, holes = h.copy(), h.copy()
        spikes.flat[:: n * 3 + 7] -= 0.2
        holes[np.random.default_rng(2).random((n, n)) < 0.3] = np.inf
        add(f"spikes{n}", spikes - spikes.min(), d, d, force=0.01)
        add(f"spikesA{n}", spikes - spikes.min(), d, d, approach=0.23)
        add(f"holes{n}", holes, d, d, approach=0.05)
        add(f"pads{n}", np.where(np.add.outer(np.arange(n) // 8, np.arange(n) // 8) % 2 == 0, 0.0, 0.5), d, d, force=0.3)
    for m in (200, 1000):
        x = (np.arange(m) + 0.5) / m - 0.5
        lines = {"cyl": x**2 / 2, "wavy": 0.002 * (1 - np.cos(40 * x)), "nz": 0.01 * np.random.default_rng(m).random(m)}
        for name, h in lines.items():
            add(f"line{name}{m}", h[None, :], 1 / m, 1.0, force=0.01, period="y")
            add(f"lineA{name}{m}", h[None, :], 1 / m, 1.0, approach=0.01 if name != "cyl" else 0.03)
            add(f"lineP{name}{m}", h[None, :], 1 / m, 1.0, mean_pressure=0.01, period="xy")
    x, y = places(64)
    ball, d = (x**2 + y**2) / 2, 1 / 64
    add("coat", ball, d, d, force=LOAD, coating=((0.02, 0.2, 0.3), None))
    add("hard", ball, d, d, force=LOAD, coating=((0.02, 20, 0.3), None))
    add("layer", ball, d, d, force=LOAD, layer=0.01)
    add("long", (x**2 + y**2 / 200) / 2, d, 4 * d, force=0.05)
    found = {}
    for name, h, dx, dy, scene in scenes:
        for tolerance in (1e-6,) if "1000" in name or "128" in name else (1e-6, 1e-10):
            found[f"{name}{tolerance:g}"] = solved(cn.solve, h, dx, dy, tolerance, **LIKE, **scene)
    for kind, amount in (("approach", 0.04), ("force", 0.015)):
        with cn.Solver(64, 64, d, d, **LIKE) as solver:
            products = 0.0
            for k in range(20):
                h = ((x - 0.01 * k) ** 2 + y**2) / 2 + 0.002 * np.cos(30 * x + 0.2 * k)
                r = solver.solve(h, **{kind: amount})
                products += r.report["work_units"]
            found["steps" + kind] = [products, int(r.status), float(r.force), float(r.approach)]
    return found


def motions(n, mu):
    """The friction arguments of shifts and rolling, by creepage and by force, with and without spin; some near full slip."""
    most = mu * LOAD
    return {
        "shift": dict(motion="SHIFT", creepage=(0.6 * mu * 0.05, 0.2 * mu * 0.05)),
        "shiftF": dict(motion="SHIFT", force=(0.6 * most, -0.3 * most)),
        "shiftFs": dict(motion="SHIFT", force=(0.5 * most, 0), spin=0.1 * mu),
        "near": dict(motion="SHIFT", force=(0.97 * most, 0)),
        "roll": dict(motion="STEADY_ROLLING", creepage=(0.05 * mu, 0.02 * mu), spin=0.2 * mu),
        "rollF": dict(motion="STEADY_ROLLING", force=(0.5 * most, 0.2 * most)),
        "rollFs": dict(motion="STEADY_ROLLING", force=(0.5 * most, 0.0), spin=0.5 * mu),
        "rollnear": dict(motion="STEADY_ROLLING", force=(0.95 * most, 0)),
        "trans": dict(motion="TRANSIENT_ROLLING", creepage=(0.05 * mu, 0), rolling_distance=1 / n),
    }


def friction():
    """Solves problems with friction: equal and different elastic constants, smooth and rough surfaces, little and much friction; laws; larger grids."""
    found = {}

    def add(name, h, **scene):
        d = 1 / len(h)
        found[name] = solved(cn.solve, h, d, d, 1e-6, force=LOAD, **scene)

    for n, bodies, of in ((32, LIKE, "like"), (24, UNLIKE, "unlike")):
        x, y = places(n)
        ball = (x**2 + y**2) / 2
        for surface, h in (("ball", ball), ("rough", ball + 0.3 * rough(n, 5))):
            for mu in (0.3, 1e-3, 1.5):
                for name, motion in motions(n, mu).items():
                    if not (of == "unlike" and mu == 1.5 and name in ("near", "rollnear", "rollFs")):
                        add(f"{of}.{surface}.{mu:g}.{name}", h, **bodies, friction=dict(coefficient=mu, **motion))
    x, y = places(40)
    ball = (x**2 + y**2) / 2
    for speed in (1e-3, 1e-2, 1e-1):
        law = dict(kind="LINEAR", kinetic=0.12, speed=speed, time_step=1.0)
        for motion in ("SHIFT", "STEADY_ROLLING"):
            for given in (dict(creepage=(0.02, 0.005)), dict(force=(0.003, 0.001))):
                add(f"law{speed:g}{motion}{list(given)}", ball, **LIKE, friction=dict(coefficient=0.2, motion=motion, law=law, **given))
        law = dict(kind="EXPONENTIAL", kinetic=0.14, falling=0.19, half_speed=speed, speed=1.0, memory_distance=0.02, memory_speed=0.01)
        for given in (dict(creepage=(0.02, 0.005)), dict(force=(0.003, 0.001)), dict(creepage=(0.01, 0), spin=0.1)):
            rolled = dict(coefficient=0.33, motion="STEADY_ROLLING", compliance=0.01, law=law, **given)
            add(f"lawx{speed:g}{list(given)}", ball, **LIKE, friction=rolled)
    for n in (64, 128):
        x, y = places(n)
        ball = (x**2 + y**2) / 2
        add(f"big{n}", ball, **LIKE, friction=dict(coefficient=0.3, motion="SHIFT", creepage=(0.01, 0.003)))
        add(f"bigroll{n}", ball, **LIKE, friction=dict(coefficient=0.3, motion="STEADY_ROLLING", creepage=(0.01, 0.003), spin=0.1))
        add(f"bigF{n}", ball, **LIKE, friction=dict(coefficient=0.3, motion="STEADY_ROLLING", force=(0.003, 0.001)))
    return found


def adhesion():
    """Solves problems with adhesion: five surfaces, three works of adhesion, three ranges, two laws; given pulls and pull-off forces."""
    found = {}
    for n in (24, 48):
        (x, y), d = places(n), 1 / n
        ball, periodic = (x**2 + y**2) / 2, rough(n, 7, lowest=2)
        surfaces = {
            "ball": ball,
            "ell": (x**2 + 3 * y**2) / 2,
            "rough": 0.3 * rough(n, 4) + ball,
            "per": periodic - periodic.min(),
            "worn": np.maximum(ball - 0.005, 0),
        }
        for surface, h in surfaces.items():
            period = {"period": "xy"} if surface == "per" else {}
            loads = (dict(mean_pressure=0.005),) if period else (dict(approach=0.01), dict(force=0.003))
            laws = [(length, law) for length in (0.0, 0.003, 0.05) for law in ("EXPONENTIAL", "DUGDALE") if (length, law) != (0.0, "DUGDALE")]
            for work in (1e-5, 1e-3, 3e-2):
                for length, law in laws:
                    if n == 48 and (surface in ("worn", "ell") or length == 0.05):
                        continue
                    for load in loads:
                        of = dict(work=work, law=law, range=length)
                        name = f"{surface}{n}.{work:g}.{length:g}.{law[:3]}.{list(load)[0][:3]}"
                        found[name] = solved(cn.solve, h, d, d, 1e-6, **LIKE, **load, **period, adhesion=of)
            if n == 24 and not period:
                for length in (0.0, 0.01):
                    of = dict(work=1e-3, law="EXPONENTIAL", range=length)
                    found[f"pull{surface}.0.001.{length:g}"] = solved(cn.pull_off, h, d, d, **LIKE, adhesion=of)
                    found[f"force{surface}.0.001.{length:g}"] = solved(cn.solve, h, d, d, 1e-6, **LIKE, force=-0.001, adhesion=of)
    return found


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    json.dump({"normal": normal, "friction": friction, "adhesion": adhesion}[sys.argv[1]](), sys.stdout)
