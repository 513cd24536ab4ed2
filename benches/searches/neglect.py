"""Judges `neglect_below` on random scenes: compares each result with a solve that has all effects and a hundredth of the tolerance.

    neglect.py [--scenes 200] [--first 0] [--elements 64] [--list]

The sizes of the effects are drawn so that about half of them matter. Prints one line for each target, and with --list the scenes beyond it.
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np
from surfaces import rough

import contact_normal

TARGETS = (1e-1, 1e-2, 1e-3)
Random = np.random.Generator


def surface(random: Random, m: int) -> np.ndarray:
    """The undeformed distance of a paraboloid, a paraboloid with waves, or a rough plane, over a square of side 1."""
    x = (np.arange(m) + 0.5) / m - 0.5
    kind = random.integers(3)
    if kind == 2:
        z = 5e-3 * rough(random, m)
        return z.max() - z
    a, b, (x0, y0) = random.uniform(0.5, 2), random.uniform(0.5, 4), random.uniform(-0.05, 0.05, 2)
    waves = 5e-3 * kind * np.cos(2 * np.pi * random.integers(2, 6) * x)[None, :]
    h = a * (x - x0)[None, :] ** 2 + b * (x - y0)[:, None] ** 2 + waves
    return h - h.min()


def about(random: Random, low: float, high: float) -> float:
    """A random number between `low` and `high` whose logarithm is uniformly distributed."""
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def scene(random: Random, m: int) -> tuple[np.ndarray, dict[str, Any]]:
    """A random surface, and the arguments of a solve with random effects. G is 0.5 and E* about 0.7."""
    h = surface(random, m)
    bodies: dict[str, Any] = {"shear_modulus": 0.5, "poisson_ratio": 0.3}
    plain = contact_normal.solve(h, 1 / m, 1 / m, approach=about(random, 0.02, 0.1), **bodies)
    load = {"force": plain.force} if random.integers(2) else {"approach": plain.approach}
    pressure, radius = plain.max_pressure, np.sqrt(plain.contact_area / np.pi)
    effects: dict[str, Any] = {}
    if random.integers(2):
        effects["layer"] = about(random, 1e-5, 1e-1) * plain.approach / pressure
    if random.integers(2):
        effects["pressure_limit"] = about(random, 0.5, 3) * pressure
    if random.integers(2):
        thickness, stiffer = about(random, 1e-4, 1e-1) * radius, about(random, 0.3, 3)
        effects["coating"] = ((thickness, 0.5 * stiffer, 0.3), None)
    elif random.integers(3) == 0:
        effects["period"] = "xy" if random.integers(2) else "y"
    # Friction is not solved together with a coating or a period.
    if not {"coating", "period"} & set(effects):
        effects["friction"] = {
            "coefficient": 0.3, "motion": "SHIFT" if random.integers(2) else "STEADY_ROLLING",
            "creepage": (about(random, 1e-4, 1e-2), 0.0), "spin": about(random, 1e-6, 1e-1),
        }
        if random.integers(2):
            bodies = {"shear_modulus": (0.5, 0.5 * about(random, 1.001, 3)), "poisson_ratio": (0.3, 0.3)}
    return h, {**bodies, **load, **effects}


def numbers(result: contact_normal.Result, given: dict[str, Any]) -> dict[str, float]:
    """The quantities whose change by an omission `neglect_below` limits."""
    found = {"approach": result.approach, "force": result.force, "max_pressure": result.max_pressure}
    found["contact_area"] = result.report["corrected_area"]
    if "friction" in given:
        found["tangential_force"] = float(np.hypot(*result.tangential_force))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--elements", type=int, default=64, help="of the scene in a direction")
    parser.add_argument("--list", action="store_true")
    given = parser.parse_args()
    d = 1 / given.elements
    beyond = dict.fromkeys(TARGETS, 0)
    with_omissions, worst, refused = dict.fromkeys(TARGETS, 0), dict.fromkeys(TARGETS, 0.0), 0
    for seed in range(given.first, given.first + given.scenes):
        h, whole = scene(np.random.default_rng([seed, 7]), given.elements)
        try:
            results = {target: contact_normal.solve(h, d, d, **whole, neglect_below=target) for target in TARGETS}
            truth = numbers(contact_normal.solve(h, d, d, **whole, tolerance=1e-8), whole)
        except contact_normal.ContactNormalError as error:
            refused += 1
            if given.list:
                print(f"  {seed}: refused: {error}")
            continue
        for target, result in results.items():
            with_omissions[target] += bool(result.neglected)
            found = numbers(result, whole)
            off = {name: abs(found[name] / exact - 1) if exact else 0.0 for name, exact in truth.items()}
            name = max(off, key=off.__getitem__)
            worst[target] = max(worst[target], off[name] / target)
            beyond[target] += off[name] > target
            if given.list and off[name] > target:
                promised = result.report["neglected_error"]
                print(f"  {seed}, {target:g}: {name} off by {off[name]:.1e}, promised {promised:.1e}; without {', '.join(result.neglected)}")
    solved = given.scenes - refused
    print("| target | scenes | something left out | within the target | worst over target |\n|---|---|---|---|---|")
    for target in TARGETS:
        within = 100 * (solved - beyond[target]) / solved
        print(f"| {target:g} | {solved} | {with_omissions[target]} | {within:.1f} % | {worst[target]:.2f} |")


if __name__ == "__main__":
    main()
