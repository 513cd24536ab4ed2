"""Judges searches for an accuracy, their error estimates and their prices, for each kind of surface. The truth is a grid four times finer.

    run.py [--seeds N] [--first S] [--kinds "a;b"] [--list]

Two of three seeds have a pressure limit that no element reaches. Prints a table in Markdown.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from surfaces import KINDS, Surface

import contact_normal

TARGETS = (1e-2, 3e-3, 1e-3)
#: The ratio of the elements of a grid and of one with elements twice as large.
DOUBLING = 4
#: Estimates of a quantity are judged if the contact is at least this number of elements wide: docs/accuracy.md.
ENOUGH = {"force": 6, "max_pressure": 12, "corrected_area": 32}
#: Predictions of products and of seconds count as good within these factors.
PRODUCTS, SECONDS = 1.3, 1.5
#: The largest number of elements of a grid that is solved for the truth.
FINEST = 2**22


@dataclass
class Tally:
    """The results of all searches, estimates and prices for one kind of surface."""

    searches: int = 0
    not_reached: int = 0
    misses: list[float] = field(default_factory=list)
    elements: list[float] = field(default_factory=list)
    estimates: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in ENOUGH})
    unknown: dict[str, int] = field(default_factory=lambda: dict.fromkeys(ENOUGH, 0))
    #: Ratios of predicted to counted products, and of predicted seconds to the least ones of three solves.
    products: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Adds the results for another kind of surface."""
        self.searches += other.searches
        self.not_reached += other.not_reached
        for name in ("misses", "elements", "products", "seconds"):
            getattr(self, name).extend(getattr(other, name))
        for name in ENOUGH:
            self.estimates[name] += other.estimates[name]
            self.unknown[name] += other.unknown[name]


class Judged:
    """A surface with a load, and the solutions on its grids."""

    def __init__(self, surface: Surface, load: dict[str, float], limit: float | None) -> None:
        self.surface, self.load, self.limit = surface, load, limit
        self._solved: dict[int, contact_normal.Result] = {}

    def scene(self) -> dict[str, float]:
        scene = {"e_star": 1.0, **self.load}
        return scene if self.limit is None else {**scene, "pressure_limit": self.limit}

    def solved(self, doublings: int, **options: float) -> contact_normal.Result:
        h, element = self.surface.distance(doublings), self.surface.element(doublings)
        return contact_normal.solve(h, **element, **self.scene(), **options)

    def on(self, doublings: int) -> contact_normal.Result:
        """The solution on a grid. It is computed once for each grid."""
        if doublings not in self._solved:
            self._solved[doublings] = self.solved(doublings, tolerance=1e-8)
        return self._solved[doublings]

    def value(self, result: contact_normal.Result) -> float:
        return float(result.approach if "force" in self.load else result.force)

    def doublings(self, mx: int) -> int:
        return int(np.log2(mx / self.surface.shape[1]) + 0.5)

    def finest(self) -> int:
        """The number of doublings of the finest grid that is solved for the truth."""
        return int(np.log2(FINEST / (self.surface.shape[0] * self.surface.shape[1])) / 2)


def across(contact: np.ndarray) -> int:
    """The width of the contact in elements, in the direction in which it is smaller."""
    lines = [np.flatnonzero(contact.any(axis=axis)) for axis in (0, 1)]
    return min(int(line[-1] - line[0] + 1) if len(line) else 0 for line in lines)


def cases(kind: str, seed: int) -> Iterator[Judged]:
    """Yields the surface of a seed with a given approach, and with the force that this approach causes."""
    surface = KINDS[kind](np.random.default_rng([seed, list(KINDS).index(kind)]))
    plain = Judged(surface, {"approach": surface.approach}, None)
    found = plain.on(2 if callable(surface.h) else 0)
    limit = None if seed % 3 == 0 else float("inf") if seed % 3 == 1 else 1e3 * found.max_pressure
    yield Judged(surface, plain.load, limit)
    yield Judged(surface, {"force": found.force}, limit)


def search(judged: Judged, target: float) -> contact_normal.AccurateResult:
    surface = judged.surface
    shape = {"shape": surface.shape} if callable(surface.h) else {}
    return contact_normal.solve_to_accuracy(
        surface.h, **surface.element(0), **shape, **judged.scene(), target=target, max_elements=surface.most
    )


def is_reached(result: contact_normal.AccurateResult, tally: Any, what: str, say: bool) -> bool:
    """Whether a search has reached its target. Counts the search, and those that have not."""
    tally.searches += 1
    if result.status == 0:
        return True
    tally.not_reached += 1
    if say:
        print(f"  not reached: {what}: {result.message}")
    return False


def judge(judged: Judged, tally: Tally, what: str, say: bool) -> None:
    """Judges the searches of a surface with a load for all targets, the estimates on all of their grids, and the price list."""
    found = [(target, search(judged, target)) for target in TARGETS]
    finest = max(judged.doublings(result.pressure.shape[1]) for _, result in found)
    truth = judged.value(judged.on(min(finest + 2, judged.finest())))
    errors = [abs(judged.value(judged.on(k)) / truth - 1) for k in range(finest + 1)]
    for target, result in found:
        if not is_reached(result, tally, f"{what}, {target:g}", say):
            continue
        miss = abs(judged.value(result) / truth - 1) / target
        tally.misses.append(miss)
        safe = [k for k in range(finest + 1) if max(errors[k:]) <= target]
        cheapest = judged.surface.shape[0] * judged.surface.shape[1] * 4 ** (safe[0] if safe else finest)
        tally.elements.append(result.pressure.size / cheapest)
        if say and (miss > 1 or tally.elements[-1] > DOUBLING):
            print(f"  {what}, {target:g}: miss {miss:.2f}, {tally.elements[-1]:g} x the elements; {result.message}")
    judge_estimates(judged, tally, finest, what, say)
    judge_prices(judged, tally, what, say)


def judge_prices(judged: Judged, tally: Tally, what: str, say: bool) -> None:
    """Compares the rows of a price list with the costs of solves on their grids with their tolerances."""
    surface = judged.surface
    shape = {"shape": surface.shape} if callable(surface.h) else {}
    rows = contact_normal.cost_of_accuracy(surface.h, **surface.element(0), **shape, **judged.scene(), targets=TARGETS, threads=1)
    for row in rows:
        if row.obstacle or not 1 <= row.shape[0] * row.shape[1] <= surface.most or row.shape[1] < surface.shape[1]:
            continue
        k, least = judged.doublings(row.shape[1]), float("inf")
        h, element = surface.distance(k), surface.element(k)
        for _ in range(3):
            began = time.perf_counter()
            result = contact_normal.solve(h, **element, **judged.scene(), tolerance=row.tolerance, threads=1)
            least = min(least, time.perf_counter() - began)
        tally.products.append(row.work_units / result.report["work_units"])
        tally.seconds.append(row.seconds_one_thread / least)
        if say and not 1 / PRODUCTS <= tally.products[-1] <= PRODUCTS:
            print(f"  products: {what}, {row.target:g} on {row.shape}: {row.work_units:.1f} predicted, {result.report['work_units']:.1f} counted")


def judge_estimates(judged: Judged, tally: Tally, finest: int, what: str, say: bool) -> None:
    best = judged.on(min(finest + 2, judged.finest()))
    load = "approach" if "force" in judged.load else "force"
    for k in range(finest + 1):
        result = judged.on(k)
        wide = across(result.contact)
        for name, member in (("force", load), ("max_pressure", "max_pressure"), ("corrected_area", "corrected_area")):
            if wide < ENOUGH[name]:
                continue
            value, exact = result.report[member], best.report[member]
            error = result.report[f"error_{name}"]
            if error < 0:
                tally.unknown[name] += 1
                continue
            true = max(abs(value - exact), 1e-8 * abs(exact))
            tally.estimates[name].append(error / true)
            if say and error < 0.3 * true:
                print(f"  low: {what}, {name} on {result.pressure.shape[1]} x {result.pressure.shape[0]}: {error / true:.2f} of {true / exact:.1e}")


def percent(part: float, of: float) -> str:
    return f"{100 * part / of:.0f} %" if of else ""


def within(ratios: list[float], factor: float) -> str:
    """The part of the ratios that are within a factor of 1, and their median, as text."""
    part = percent(sum(1 / factor <= r <= factor for r in ratios), len(ratios))
    return f"{part}, {np.median(ratios):.2f}" if ratios else ""


def line(name: str, tally: Tally) -> str:
    beyond = sum(miss > 1 for miss in tally.misses)
    near = sum(ratio <= DOUBLING for ratio in tally.elements)
    low = [percent(sum(r < 0.3 for r in tally.estimates[q]), len(tally.estimates[q])) for q in ENOUGH]
    unknown = [percent(tally.unknown[q], tally.unknown[q] + len(tally.estimates[q])) for q in ENOUGH]
    cells = [
        name, tally.searches, tally.not_reached, f"{beyond}, {max(tally.misses, default=0):.2f}",
        percent(near, len(tally.elements)), *(f"{a} / {b}" for a, b in zip(low, unknown, strict=True)),
        within(tally.products, PRODUCTS), within(tally.seconds, SECONDS),
    ]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


HEAD = """\
| surface | searches | not reached | beyond the target, worst | within one doubling | force: below 0.3 / unknown | largest pressure | corrected area \
| products within 1.3, median | seconds within 1.5, median |
|---|---|---|---|---|---|---|---|---|---|"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kinds", default=";".join(KINDS))
    parser.add_argument("--list", action="store_true", help="names what is beyond its target, or expensive")
    given = parser.parse_args()
    whole = Tally()
    print(HEAD)
    for kind in given.kinds.split(";"):
        tally = Tally()
        for seed in range(given.first, given.first + given.seeds):
            for judged in cases(kind, seed):
                judge(judged, tally, f"{kind} {seed} by {next(iter(judged.load))}, limit {judged.limit}", given.list)
        print(line(kind, tally))
        sys.stdout.flush()
        whole.add(tally)
    print(line("all", whole))


if __name__ == "__main__":
    main()
