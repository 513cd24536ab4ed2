"""Lists of points, x y z a line, that are all places of a grid: the grid."""

from __future__ import annotations

import warnings
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._not_a_map import levels, rises_evenly

if TYPE_CHECKING:
    from .._arguments import Doubles

# Lists have so few columns: x y z, colours, intensities.
_COLUMNS = 8


class Lattice(NamedTuple):
    """Heights z[iy, ix], and the coordinates of columns and rows."""

    z: Doubles
    x: Doubles
    y: Doubles


def lattice_of(values: Any) -> Lattice | None:
    """The grid of a list of points in any order, each place of the grid once; None if it is none, or if several columns may be coordinates.

    Of two columns that name all places the first one is x. Heights are in the column behind them, or in the only other one; columns that count are
    left out, others with a warning.
    """
    lines, columns = values.shape
    if not (3 <= columns <= _COLUMNS and lines >= 6):
        return None
    places = {k: levels(values[:, k]) for k in range(columns)}
    pairs = [(a, b) for a, b in combinations(range(columns), 2) if _is_grid(places[a], places[b])]
    # A tilted plane over x and y is a coordinate, too.
    if columns == 3 and (0, 1) in pairs:
        pairs = [(0, 1)]
    if len(pairs) != 1:
        return None
    (a, b) = pairs[0]
    others = [k for k in range(columns) if k not in (a, b) and not rises_evenly(values[:, k])]
    if len(others) != 1 and not (others and others[0] == b + 1):
        return None
    if len(others) > 1:
        warnings.warn(f"of {columns} columns, numbers {a + 1} and {b + 1} are read as x and y, and number {others[0] + 1} as the heights", stacklevel=4)
    (x, ix), (y, iy) = places[a], places[b]
    z = np.empty((len(y), len(x)))
    z[iy, ix] = values[:, others[0]]
    return Lattice(z, x, y)


def _is_grid(one: tuple[Doubles, Any], other: tuple[Doubles, Any]) -> bool:
    """Whether two columns, as levels and the level of each line, name each place of a grid once."""
    (x, ix), (y, iy) = one, other
    if min(len(x), len(y)) < 2 or len(x) * len(y) != len(ix):
        return False
    is_even = all(len(places) < 4 or rises_evenly(places) for places in (x, y))
    return bool(is_even and len(np.unique(iy * len(x) + ix)) == len(ix))
