"""Finds the grid of a list of points, x y z per line, that are at places of a grid."""

from __future__ import annotations

import warnings
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._not_a_map import EVEN, levels, rises_evenly

if TYPE_CHECKING:
    from .._arguments import Doubles

# A list of points has at most MOST_COLUMNS columns (x y z, colours, intensities) and at least _LINES lines.
MOST_COLUMNS, _LINES = 8, 6

# Points are those of a grid if at least this part of its places has a point.
_LEAST = 0.5

# A grid has at most this many times as many rows, or columns, as there are distinct coordinates in the list.
_WIDEST = 2.0


class Lattice(NamedTuple):
    """Heights z[iy, ix], and the coordinates of columns and rows."""

    z: Doubles
    x: Doubles
    y: Doubles


def may_be_list(shape: tuple[int, int]) -> bool:
    """Whether an array of this shape may be a list of points."""
    return 3 <= shape[1] <= MOST_COLUMNS and shape[0] >= _LINES


def lattice_of(values: Any) -> Lattice | None:
    """Finds the grid of a list of points in any order, with at most one point per place.

    Returns None if there is no grid, or if more than two columns may be coordinates. The first of the two columns of coordinates is x. The heights are in the
    column after them, or in the only other one. Columns that count points are ignored; other columns are ignored with a warning. Places without a point, up to
    half of all, are NaN, with a warning.
    """
    if not may_be_list(values.shape):
        return None
    lines, columns = values.shape
    places = {k: rungs(values[:, k]) for k in range(columns)}
    parts = {(a, b): _part(places[a], places[b]) for a, b in combinations(range(columns), 2)}
    pairs = [pair for pair, part in parts.items() if part == 1.0] or [pair for pair, part in parts.items() if part >= _LEAST]
    # The heights of a tilted plane seem to be coordinates, too. Of three columns the first two are then taken for x and y.
    if columns == 3 and (0, 1) in pairs:
        pairs = [(0, 1)]
    if len(pairs) != 1:
        return None
    (a, b) = pairs[0]
    others = [k for k in range(columns) if k not in (a, b) and not rises_evenly(values[:, k])]
    if len(others) != 1 and not (others and others[0] == b + 1):
        return None
    if len(others) > 1:
        warnings.warn(f"of {columns} columns, numbers {a + 1} and {b + 1} are read as x and y, and number {others[0] + 1} as the heights", stacklevel=5)
    (x, ix), (y, iy) = places[a], places[b]
    z = np.full((len(y), len(x)), np.nan)
    z[iy, ix] = values[:, others[0]]
    if parts[a, b] < 1.0:
        warnings.warn(f"{z.size - lines} of {z.size} places of the grid of {len(y)} x {len(x)} have no point: they are holes, where no surface is",
                      stacklevel=5)
    return Lattice(z, x, y)


def rungs(values: Any) -> tuple[Doubles, Any]:
    """The evenly spaced coordinates whose values a column has, including those between that are missing, and the index of the coordinate of each line.

    The coordinates are empty if the values are not evenly spaced.
    """
    found, which = levels(values)
    if len(found) < 2:
        return np.zeros(0), which
    steps = np.diff(found)
    count = np.concatenate([[0], np.cumsum(np.round(steps / steps.min()))]).astype(int)
    if count[-1] > _WIDEST * len(found):
        return np.zeros(0), which
    places = np.linspace(found[0], found[-1], count[-1] + 1)
    if np.abs(places[count] - found).max() > EVEN * (places[1] - places[0]):
        return np.zeros(0), which
    return places, count[which]


def _part(one: tuple[Doubles, Any], other: tuple[Doubles, Any]) -> float:
    """The part of the places of a grid that have a point, if two columns are its coordinates; 0 if a place occurs twice, or if there is no grid."""
    (x, ix), (y, iy) = one, other
    if min(len(x), len(y)) < 2 or len(np.unique(iy * len(x) + ix)) < len(ix):
        return 0.0
    return float(len(ix) / (len(x) * len(y)))
