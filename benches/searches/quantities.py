"""Judges searches for quantities other than force, pressure and area, their error estimates and their prices. The truth is a grid four times finer.

    quantities.py [--seeds N] [--first S] [--names "a;b"] [--list]

The surfaces are those of surfaces.py that are smooth or end smoothly. The effect is drawn at random: none, a pressure limit, or friction of bodies
with equal or different elastic constants in one of the motions. Prints a table in Markdown.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from run import DOUBLING, PRODUCTS, SECONDS, is_reached, percent, within
from surfaces import KINDS, Surface

import contact_normal

TARGETS = (3e-2, 1e-2)
NORMAL = ("mean_gap", "stiffness", "max_von_mises", "von_mises_depth", "max_shear")
TANGENTIAL = ("tangential_force", "creepage", "spin_moment", "stick_area")
#: Estimates are judged if the contact on the finest of three grids is at least this number of elements wide (otherwise 16): docs/accuracy.md.
ENOUGH = {"stick_area": 32}
#: The surfaces that do not end within the contact. Where they do, stresses are infinite.
SURFACES = ("superellipsoid", "finite roller", "two balls", "torus", "worn", "elements to 20:1")
#: The largest number of elements of a grid of a search, and of the truth.
MOST, FINEST = 2**16, 2**18
FIRST = 16
#: Shorter times, in seconds, are not compared, because the call from Python is a large part of them.
SHORT = 1e-3


class Tally:
    """The results of all searches, estimates and prices of one quantity."""

    def __init__(self) -> None:
        self.searches = self.not_reached = self.unknown = 0
        self.misses: list[float] = []
        self.elements: list[float] = []
        self.estimates: list[float] = []
        self.products: list[float] = []
        self.seconds: list[float] = []

    def line(self, name: str) -> str:
        beyond, near = sum(miss > 1 for miss in self.misses), sum(ratio <= DOUBLING for ratio in self.elements)
        low, known = sum(ratio < 0.3 for ratio in self.estimates), len(self.estimates)
        median = f"{np.median(self.estimates):.1f}" if known else ""
        cells = [
            name, self.searches, self.not_reached, f"{beyond}, {max(self.misses, default=0):.2f}", percent(near, len(self.elements)),
            f"{percent(low, known)} / {percent(self.unknown, self.unknown + known)}", median,
            within(self.products, PRODUCTS), within(self.seconds, SECONDS),
        ]
        return "| " + " | ".join(str(cell) for cell in cells) + " |"


HEAD = """\
| quantity | searches | not reached | beyond the target, worst | within one doubling | below 0.3 / unknown | estimate over error, median \
| products within 1.3, median | seconds within 1.5, median |
|---|---|---|---|---|---|---|---|---|"""


def effects(random: np.random.Generator, name: str, pressure: float, approach: float) -> dict[str, Any]:
    """Random elastic constants with an E* of about 1, and a random effect or none, as arguments of a solve."""
    unlike = name in TANGENTIAL and random.integers(2) == 1
    scene: dict[str, Any] = {"shear_modulus": (0.5, 0.9) if unlike else 0.7, "poisson_ratio": (0.3, 0.25) if unlike else 0.3}
    if name not in TANGENTIAL and random.integers(2):
        return scene
    if name not in TANGENTIAL and random.integers(2):
        return {**scene, "pressure_limit": random.uniform(0.4, 0.8) * pressure}
    motion = ("SHIFT", "STEADY_ROLLING", "TRANSIENT_ROLLING")[random.integers(3)]
    slip = 0.3 * pressure * (approach if motion == "SHIFT" else 1.0)
    friction: dict[str, Any] = {"coefficient": 0.3, "motion": motion, "creepage": tuple(slip * random.uniform(0.1, 0.6, 2))}
    friction["spin"] = slip * random.uniform(0.5, 2)
    if motion == "TRANSIENT_ROLLING":
        friction["rolling_distance"] = random.uniform(0.02, 0.1)
    if name == "creepage":
        # The scene gets half of the force that this creepage causes; see `scenes`.
        friction |= {"spin": 0.0, "half": True}
    if random.integers(3) == 0:
        scene["pressure_limit"] = random.uniform(0.4, 0.8) * pressure
    return {**scene, "friction": friction}


class Judged:
    """A surface with a scene, and one quantity that is judged."""

    def __init__(self, surface: Surface, scene: dict[str, Any], name: str) -> None:
        self.surface, self.scene, self.name = surface, scene, name
        self._rows: dict[int, Any] = {}

    def row(self, doublings: int) -> Any:
        """The quantity on a grid, with the error from two coarser ones. It is computed once for each grid."""
        if doublings not in self._rows:
            h, element = self.surface.distance(doublings), self.surface.element(doublings)
            found = contact_normal.quantities(h, **element, names=[self.name], coarser=min(doublings, 2), tolerance=1e-7, **self.scene)
            self._rows[doublings] = found[-1]
        return self._rows[doublings]

    def across(self, doublings: int) -> int:
        scene = {name: value for name, value in self.scene.items() if name != "friction"}
        contact = contact_normal.solve(self.surface.distance(doublings), **self.surface.element(doublings), **scene).contact
        return min(int(contact.any(axis).sum()) for axis in (0, 1))

    def doublings(self, mx: int) -> int:
        return int(np.log2(mx / self.surface.shape[1]) + 0.5)

    def finest(self) -> int:
        return int(np.log2(FINEST / (self.surface.shape[0] * self.surface.shape[1])) / 2)


def scenes(name: str, seeds: range) -> Iterator[tuple[str, Judged]]:
    for kind in SURFACES:
        for seed in seeds:
            random = np.random.default_rng([seed, list(KINDS).index(kind), [*NORMAL, *TANGENTIAL].index(name)])
            surface = KINDS[kind](random)
            surface.most = MOST * max(surface.shape) // FIRST
            plain = contact_normal.solve(surface.distance(2), **surface.element(2), approach=surface.approach, e_star=1.0)
            load = {"force": plain.force} if random.integers(2) else {"approach": surface.approach}
            scene = {**load, **effects(random, name, plain.max_pressure, surface.approach)}
            if scene.get("friction", {}).pop("half", False):
                found = contact_normal.solve(surface.distance(2), **surface.element(2), **scene)
                scene["friction"] |= {"force": (0.5 * found.tangential_force[0], None)}
            what = ", ".join([kind, str(seed), *load, *(key for key in scene if key in ("friction", "pressure_limit"))])
            if "friction" in scene:
                what += f" {scene['friction']['motion']}" + (" unlike" if isinstance(scene["shear_modulus"], tuple) else "")
            yield what, Judged(surface, scene, name)


def judge(judged: Judged, tally: Tally, what: str, say: bool) -> None:
    """Judges the searches for all targets, the estimates on their grids, and the price list."""
    surface, name = judged.surface, judged.name
    found = []
    for target in TARGETS:
        limits = {"max_elements": surface.most, "target": 0.5, "targets": {name: target}}
        found.append((target, contact_normal.solve_to_accuracy(surface.h, **surface.element(0), shape=surface.shape, **judged.scene, **limits)))
    finest = min(max(judged.doublings(result.pressure.shape[1]) for _, result in found), judged.finest() - 1)
    truth = judged.row(min(finest + 2, judged.finest())).value
    errors = [abs(judged.row(k).value - truth) for k in range(finest + 1)]
    for target, result in found:
        if not is_reached(result, tally, f"{what}, {target:g}", say):
            continue
        at = judged.doublings(result.pressure.shape[1])
        miss = abs(judged.row(at).value - truth) / (target * abs(truth) or np.inf)
        tally.misses.append(miss)
        safe = [k for k in range(finest + 1) if max(errors[k:]) <= target * abs(truth)]
        tally.elements.append(4.0 ** (at - (safe[0] if safe else finest)))
        if say and miss > 1:
            print(f"  beyond: {what}, {target:g} on {result.pressure.shape}: {miss:.2f}")
    for k in range(2, finest + 1):
        row = judged.row(k)
        if judged.across(k) < ENOUGH.get(name, 16):
            continue
        if row.error < 0:
            tally.unknown += 1
            continue
        true = max(errors[k], 1e-6 * abs(row.value))
        # The depth of the largest stress may be 0 on each grid, without an error.
        if true == 0:
            continue
        tally.estimates.append(row.error / true)
        if say and row.error < 0.3 * true:
            print(f"  low: {what}, on {row.shape}: {row.error / true:.2f} of {true:.1e}")
    judge_prices(judged, tally, what, say)


def judge_prices(judged: Judged, tally: Tally, what: str, say: bool) -> None:
    """Compares the rows of a price list with the costs of solves on their grids with their tolerances, stresses and stiffness included."""
    surface = judged.surface
    rows = contact_normal.cost_of_accuracy(
        surface.h, **surface.element(0), shape=surface.shape, **judged.scene, targets=TARGETS, quantity=judged.name, threads=1
    )
    for row in rows:
        if row.obstacle or row.shape[0] * row.shape[1] > surface.most or row.shape[1] < surface.shape[1]:
            continue
        k, least = judged.doublings(row.shape[1]), float("inf")
        h, element = surface.distance(k), surface.element(k)
        for _ in range(3):
            began = time.perf_counter()
            found = contact_normal.quantities(h, **element, names=[judged.name], coarser=0, tolerance=row.tolerance, threads=1, **judged.scene)
            least = min(least, time.perf_counter() - began)
        counted = found[0].work_units
        tally.products.append(row.work_units / counted)
        if least > SHORT:
            tally.seconds.append(row.seconds_one_thread / least)
        if say and not 1 / PRODUCTS <= tally.products[-1] <= PRODUCTS:
            print(f"  products: {what}, {row.target:g} on {row.shape}: {row.work_units:.1f} predicted, {counted:.1f} counted")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--names", default=";".join((*NORMAL, *TANGENTIAL)))
    parser.add_argument("--list", action="store_true", help="names what is beyond its target, too low, or not within 1.3")
    given = parser.parse_args()
    print(HEAD)
    for name in given.names.split(";"):
        tally = Tally()
        for what, judged in scenes(name, range(given.first, given.first + given.seeds)):
            try:
                judge(judged, tally, what, given.list)
            except contact_normal.ContactNormalError as error:
                print(f"  refused: {name}, {what}: {error}", file=sys.stderr)
        print(tally.line(name))
        sys.stdout.flush()


if __name__ == "__main__":
    main()
