"""Text files of numbers that are no map: lists of points, and tables with coordinates beside the heights."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

# Steps are even if they differ by this part. Coordinates of a stage have noise.
_EVEN = 0.01

# Lists have few columns and many lines.
_COLUMNS, _LINES = 4, 8


def why(values: Any) -> str | None:
    """Why these numbers are no map, if they are none."""
    lines, columns = values.shape
    if _are_points(values):
        return (f"has x, y and z of {lines} points; it must hold a row of the grid a line: reshape the third column, and give x and y to "
                "surface.heights")
    if 1 < columns <= _COLUMNS and lines >= max(_LINES, 2 * columns + 1):
        for k in range(columns):
            if _rises_evenly(values[:, k]) or _has_even_levels(values[:, k]):
                return (f"has {lines} lines of {columns} numbers, of which number {k + 1} is a coordinate or a count: a list of points; it must hold a row of "
                        "the grid a line: reshape the column of the heights, and give x and y to surface.heights")
    if min(lines, columns) > _COLUMNS:
        for name, rows in (("line", values), ("column", values.T)):
            if _rises_evenly(rows[0, 1:]) and not any(map(_rises_evenly, rows[1:, 1:])):
                return f"has coordinates in its first {name}; it must hold heights alone: leave that {name} out, and give dx and dy"
    return None


def has_cut_decimals(lines: list[str]) -> bool:
    """Whether numbers between commas begin with zeros, as 0321: the commas are decimal points."""
    return any(re.search(r"(^|,)\s*0\d+\s*(,|$)", line) for line in lines)


def _rises_evenly(values: Any) -> bool:
    """Whether steps are all the same, and not 0."""
    steps = np.diff(values)
    mean = steps.mean() if len(steps) > 2 else 0.0
    return bool(mean != 0.0 and (np.abs(steps - mean) <= _EVEN * abs(mean)).all())


def _has_even_levels(values: Any) -> bool:
    """Whether these are few values with even steps between, each several times."""
    if not np.isfinite(values).all() or np.ptp(values) == 0.0:
        return False
    ordered = np.sort(values)
    between = np.diff(ordered)
    parts = np.split(ordered, np.flatnonzero(between > 0.1 * between.max()) + 1)
    levels = np.array([part.mean() for part in parts])
    spread = max(float(np.ptp(part)) for part in parts)
    return bool(len(levels) > 2 and len(values) >= 2 * len(levels) and _rises_evenly(levels) and spread <= _EVEN * between.max())


def _are_points(values: Any) -> bool:
    """Whether three columns are x, y and z: the first two name most places of a grid, each once."""
    if values.shape[1] != 3 or len(values) < 4 or not np.isfinite(values[:, :2]).all():
        return False
    counts = [len(np.unique(values[:, k])) for k in range(2)]
    return min(counts) > 1 and 2 * len(values) >= counts[0] * counts[1] and len(np.unique(values[:, :2], axis=0)) == len(values)
