"""Judges searches for an accuracy and their estimates, kind of surface by kind: the truth is a grid four times finer.

    run.py [--seeds N] [--first S] [--kinds a,b] [--list]

Two of three searches by the number of their seed have a pressure limit that no element reaches. Prints a table in Markdown.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from surfaces import KINDS, Surface

import contact_normal

TARGETS = (1e-2, 3e-3, 1e-3)
#: A search that is within so many elements of the cheapest safe grid takes one doubling more at most.
DOUBLING = 4
#: Elements across the contact from which on estimates are believed: docs/accuracy.md.
ENOUGH = {"force": 8, "max_pressure": 12, "corrected_area": 32}
#: Elements of a grid that is solved for the truth, at most.
FINEST = 2**22


@dataclass
class Tally:
    """What one kind of surface has shown."""

    searches: int = 0
    not_reached: int = 0
    misses: list[float] = field(default_factory=list)
    elements: list[float] = field(default_factory=list)
    estimates: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in ENOUGH})
    unknown: dict[str, int] = field(default_factory=lambda: dict.fromkeys(ENOUGH, 0))
    products: list[float] = field(default_factory=list)


class Judged:
    """One surface with one load, and what was solved of it."""

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
        """The solution on a grid, once."""
        if doublings not in self._solved:
            self._solved[doublings] = self.solved(doublings, tolerance=1e-8)
        return self._solved[doublings]

    def value(self, result: contact_normal.Result) -> float:
        return float(result.approach if "force" in self.load else result.force)

    def doublings(self, mx: int) -> int:
        return int(np.log2(mx / self.surface.shape[1]) + 0.5)

    def finest(self) -> int:
        """Doublings of the truth of all grids of a search."""
        return int(np.log2(FINEST / (self.surface.shape[0] * self.surface.shape[1])) / 2)


def across(contact: np.ndarray) -> int:
    """Elements across the contact, in the direction with fewer."""
    lines = [np.flatnonzero(contact.any(axis=axis)) for axis in (0, 1)]
    return min(int(line[-1] - line[0] + 1) if len(line) else 0 for line in lines)


def cases(kind: str, seed: int) -> Iterator[Judged]:
    """The surface of a seed by approach, and by the force that this takes."""
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


def judge(judged: Judged, tally: Tally, what: str, say: bool) -> None:
    """All searches of a surface with a load, and the estimates on all grids that these have used."""
    found = [(target, search(judged, target)) for target in TARGETS]
    finest = max(judged.doublings(result.pressure.shape[1]) for _, result in found)
    truth = judged.value(judged.on(min(finest + 2, judged.finest())))
    errors = [abs(judged.value(judged.on(k)) / truth - 1) for k in range(finest + 1)]
    for target, result in found:
        tally.searches += 1
        if result.status != 0:
            tally.not_reached += 1
            if say:
                print(f"  not reached: {what}, {target:g}: {result.message}")
            continue
        miss = abs(judged.value(result) / truth - 1) / target
        tally.misses.append(miss)
        safe = [k for k in range(finest + 1) if max(errors[k:]) <= target]
        cheapest = judged.surface.shape[0] * judged.surface.shape[1] * 4 ** (safe[0] if safe else finest)
        tally.elements.append(result.pressure.size / cheapest)
        if say and (miss > 1 or tally.elements[-1] > DOUBLING):
            print(f"  {what}, {target:g}: miss {miss:.2f}, {tally.elements[-1]:g} x the elements; {result.message}")
    judge_estimates(judged, tally, finest, what, say)


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


def line(name: str, tally: Tally) -> str:
    beyond = sum(miss > 1 for miss in tally.misses)
    near = sum(ratio <= DOUBLING for ratio in tally.elements)
    low = [percent(sum(r < 0.3 for r in tally.estimates[q]), len(tally.estimates[q])) for q in ENOUGH]
    unknown = [percent(tally.unknown[q], tally.unknown[q] + len(tally.estimates[q])) for q in ENOUGH]
    cells = [
        name, tally.searches, tally.not_reached, f"{beyond}, {max(tally.misses, default=0):.2f}",
        percent(near, len(tally.elements)), *(f"{a} / {b}" for a, b in zip(low, unknown, strict=True)),
    ]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


HEAD = """\
| surface | searches | not reached | beyond the target, worst | within one doubling | force: below 0.3 / unknown | largest pressure | corrected area |
|---|---|---|---|---|---|---|---|"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kinds", default=",".join(kind.replace(",", ";") for kind in KINDS))
    parser.add_argument("--list", action="store_true", help="names what is beyond its target, or expensive")
    given = parser.parse_args()
    whole = Tally()
    print(HEAD)
    for kind in (kind.replace(";", ",") for kind in given.kinds.split(",")):
        tally = Tally()
        for seed in range(given.first, given.first + given.seeds):
            for judged in cases(kind, seed):
                judge(judged, tally, f"{kind} {seed} by {next(iter(judged.load))}, limit {judged.limit}", given.list)
        print(line(kind, tally))
        sys.stdout.flush()
        whole.searches += tally.searches
        whole.not_reached += tally.not_reached
        whole.misses += tally.misses
        whole.elements += tally.elements
        for q in ENOUGH:
            whole.estimates[q] += tally.estimates[q]
            whole.unknown[q] += tally.unknown[q]
    print(line("all", whole))


if __name__ == "__main__":
    main()
