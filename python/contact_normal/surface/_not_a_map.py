"""Recognises arrays of numbers that are no map of heights: lists of points, and tables with coordinates beside the heights."""

from __future__ import annotations

from typing import Any

import numpy as np

# Steps count as even if they differ from their mean by at most this part. The coordinates of a measuring stage have noise.
EVEN = 0.01

# A list of points usually has at most _COLUMNS, rarely up to _MANY columns, and at least _LINES lines.
_COLUMNS, _MANY, _LINES = 4, 8, 8

# The ranges of the columns of a strip of heights differ by less than this factor.
_ALIKE = 3.0

# Coordinates are multiples of half a step, up to this part of the step.
_MULTIPLE = 1e-3

# A map with few columns is a strip. Strips with at least this many lines per column are rare.
_LONG = 25

_PLACES = "places of a grid, at least half of them and none twice, and no size is given"
_INSTEAD = ("others must be interpolated on a grid (scipy.interpolate.griddata) and given to surface.heights. If this is a strip of heights, give "
            "its array to surface.heights")


def why(values: Any, steps: tuple[float | None, float | None] = (None, None)) -> str | None:
    """The reason why these numbers are no map of heights; None if there is none. `steps`: the distances of columns and of lines, as far as known."""
    lines, columns = values.shape
    if _are_points(values):
        return (f"has x, y and z of {lines} points, which are read where they are {_PLACES}; {_INSTEAD}")
    if 1 < columns <= _MANY and lines >= max(_LINES, 2 * columns + 1):
        found = [k for k in range(columns) if rises_evenly(values[:, k]) or _has_even_levels(values[:, k])]
        # Heights with few digits may have even levels as well. Therefore, with more than _COLUMNS columns two of them must look like coordinates.
        if len(found) > (columns > _COLUMNS):
            return (f"has {lines} lines of {columns} numbers, of which number {found[0] + 1} is a coordinate or a count: a list of points. Lists are read where "
                    f"their points are {_PLACES}; {_INSTEAD}")
    if 1 < columns <= _COLUMNS and lines >= _LONG * columns and not _is_strip(values):
        return (f"has {lines} lines of {columns} numbers: a list of points, it seems. Lists are read where their points are {_PLACES}; "
                f"{_INSTEAD}")
    straight = _straight_firsts(values)
    for name, rows in straight:
        if not _lies_among(rows) and (len(straight) == 2 or _goes_by(rows, steps[name == "column"])):
            return f"has coordinates in its first {name}; it must hold heights alone: leave that {name} out, and give dx and dy"
    return None


def doubt(values: Any) -> str | None:
    """The text of a warning if these numbers may be something else than a map; None otherwise."""
    lines, columns = values.shape
    for name, _ in _straight_firsts(values):
        return f"has a straight first {name}, which is read as heights: if these are coordinates, leave it out"
    if lines >= _LINES and (columns <= _COLUMNS or (columns <= _MANY and lines >= 8 * columns)):
        return f"is read as a map of {lines} x {columns} heights, a row of the grid a line, and not as a list of points"
    return None


def _straight_firsts(values: Any) -> list[tuple[str, Any]]:
    """The first line, or first column, that rises evenly while no other one does: the candidates for coordinates.

    Returns pairs of the name, "line" or "column", and the array whose first row is this line or column.
    """
    if min(values.shape) <= _COLUMNS:
        return []
    both = (("line", values), ("column", values.T))
    return [(name, rows) for name, rows in both if rises_evenly(rows[0, 1:]) and not any(map(rises_evenly, rows[1:, 1:]))]


def _lies_among(rows: Any) -> bool:
    """Whether a straight first row may have heights, as a faulty line of a scan.

    Its values must be near the range of the others. Coordinates begin at a multiple of half a step, or are far from this range. A line of heights that was
    levelled alone has the mean 0.
    """
    if not np.isfinite(rows[1:, 1:]).any():
        return False
    first, (low, high) = rows[0, 1:], (np.nanmin(rows[1:, 1:]), np.nanmax(rows[1:, 1:]))
    halves = 2.0 * first[0] / np.diff(first).mean()
    among = low - (high - low) <= first.min() and first.max() <= high + (high - low)
    is_level = abs(first.mean()) <= _MULTIPLE * np.ptp(first)
    return bool(among and (is_level or abs(halves - round(halves)) > _MULTIPLE))


def _goes_by(rows: Any, step: float | None) -> bool:
    """Whether the first row may have coordinates with this step, in the same unit or a power of ten of it, or counts."""
    mean = abs(np.diff(rows[0, 1:]).mean())
    if step is None or abs(mean - round(mean)) <= _MULTIPLE and mean > 0.5:
        return True
    digits = np.log10(mean / step)
    return bool(abs(digits - round(digits)) <= EVEN)


def _is_strip(values: Any) -> bool:
    """Whether all of four columns are heights: their ranges are similar and overlap. The ranges of coordinates are larger, or elsewhere."""
    if values.shape[1] != _COLUMNS or not (np.isfinite(values).sum(0) > 1).all():
        return False
    low, middle, high = np.nanquantile(np.where(np.isfinite(values), values, np.nan), [0.05, 0.5, 0.95], axis=0)
    return bool((high - low).max() <= _ALIKE * (high - low).min() and middle.max() <= high.min() and middle.min() >= low.max())


def rises_evenly(values: Any) -> bool:
    """Whether the steps between the values are equal and not 0. At least three steps are needed."""
    with np.errstate(invalid="ignore"):
        steps = np.diff(values)
    mean = steps.mean() if len(steps) > 2 else 0.0
    return bool(mean != 0.0 and (np.abs(steps - mean) <= EVEN * abs(mean)).all())


def levels(values: Any) -> tuple[Any, Any]:
    """Groups close values into levels. Returns the levels in increasing order, and the index of the level of each value.

    There are no levels if a value is not finite, or if all values are equal.
    """
    if not np.isfinite(values).all() or np.ptp(values) == 0.0:
        return np.zeros(0), np.zeros(0, dtype=int)
    order = np.argsort(values, kind="stable")
    between = np.diff(values[order])
    parts = np.split(order, np.flatnonzero(between > 0.1 * between.max()) + 1)
    which = np.empty(len(values), dtype=int)
    for k, part in enumerate(parts):
        which[part] = k
    return np.array([values[part].mean() for part in parts]), which


def _has_even_levels(values: Any) -> bool:
    """Whether the values are on few levels with even steps, on average at least twice on each."""
    places, which = levels(values)
    if not (len(places) > 2 and len(values) >= 2 * len(places) and rises_evenly(places)):
        return False
    return bool(np.abs(values - places[which]).max() <= EVEN * np.diff(places).mean())


def _are_points(values: Any) -> bool:
    """Whether three columns are x, y and z of points: the first two are the coordinates of at least half of the places of a grid, each at most once."""
    if values.shape[1] != 3 or len(values) < 4 or not np.isfinite(values[:, :2]).all():
        return False
    counts = [len(np.unique(values[:, k])) for k in range(2)]
    return min(counts) > 1 and 2 * len(values) >= counts[0] * counts[1] and len(np.unique(values[:, :2], axis=0)) == len(values)
