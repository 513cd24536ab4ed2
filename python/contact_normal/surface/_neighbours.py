"""Estimates the height of an element from the heights of its neighbours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._heights import blocks

if TYPE_CHECKING:
    import numpy.typing as npt

    from .._arguments import Doubles

# An element with at least this number of the four pairs of opposite neighbours needs no estimates by lines and planes.
_PAIRS = 3


def _padded(z: Doubles, period: str | None, width: int = 1) -> Doubles:
    """The array with `width` more elements on each side: NaN, or along a period the elements of the other side.

    In a direction with one element these are NaN, so that the element is not its own neighbour.
    """
    padded, inner = np.pad(z, width, constant_values=np.nan), slice(width, -width)
    if period in ("x", "xy") and z.shape[1] > width:
        padded[inner, :width], padded[inner, -width:] = z[:, -width:], z[:, :width]
    if period in ("y", "xy") and z.shape[0] > width:
        padded[:width], padded[-width:] = padded[-2 * width : -width], padded[width : 2 * width]
    return padded


def _nearest(said: Doubles, height: Doubles) -> Doubles:
    """For each column the estimate in `said` that is nearest to the height of the column's element; NaN if there is no estimate."""
    off = np.where(np.isnan(said), np.inf, np.abs(said - height))
    return np.asarray(np.take_along_axis(said, off.argmin(axis=0)[None], axis=0)[0])


def _around(z: Doubles, period: str | None, at: Any, reach: int) -> Doubles:
    """For each element of `at` the heights of the eight elements at a distance of `reach` along the axes and diagonals; NaN where there is none."""
    padded, (rows, columns) = _padded(z, period, reach), at
    return np.stack([padded[rows + reach * j, columns + reach * i] for j in range(3) for i in range(3) if (j, i) != (1, 1)])


def _said_around(z: Doubles, period: str | None, at: Any, reach: int, only_between: bool) -> Doubles:
    """Estimates of the heights of the elements `at` of a map: the means of pairs of opposite neighbours.

    If most pairs are missing, there are also the extrapolations of two elements on one side along an axis, and planes through three neighbours.
    """
    around = _around(z, period, at, reach)
    means = 0.5 * (around[:4] + around[:3:-1])
    if only_between:
        return means
    on_axes = [1, 3, 4, 6]
    lines = 2.0 * around[on_axes] - _around(z, period, at, 2 * reach)[on_axes]
    # For each plane two neighbours on the axes and the diagonal neighbour between them, by their indices among the eight.
    planes = np.stack([around[one] + around[other] - around[between] for one, other, between in ((1, 3, 0), (1, 4, 2), (6, 3, 5), (6, 4, 7))])
    return np.concatenate([means, np.where(np.isfinite(means).sum(axis=0) < _PAIRS, np.concatenate([planes, lines]), np.nan)])


def _said_along(z: Doubles, is_period: bool, at: npt.NDArray[np.intp], only_between: bool) -> Doubles:
    """Estimates of the heights of the elements `at` of a line scan.

    These are the interpolation between the next heights on both sides, and the extrapolation of two heights on each side. At an end of the line, where the
    interpolation is missing, the next height itself is an estimate, too.
    """
    count = len(z)
    places = np.flatnonzero(np.isfinite(z))
    if is_period:
        places = np.concatenate([places - count, places, places + count])
    if not len(places):
        return np.full((1, len(at)), np.nan)
    heights = z[places % count]

    def one(k: npt.NDArray[np.intp]) -> tuple[Any, Any]:
        inside = (k >= 0) & (k < len(places))
        k = np.clip(k, 0, len(places) - 1)
        return places[k].astype(float), np.where(inside, heights[k], np.nan)

    def line(first: tuple[Any, Any], second: tuple[Any, Any]) -> Any:
        apart = second[0] - first[0]
        return first[1] + (second[1] - first[1]) * (at - first[0]) / np.where(apart == 0.0, np.nan, apart)

    left, right = np.searchsorted(places, at, "left") - 1, np.searchsorted(places, at, "right")
    between = line(one(left), one(right))
    if only_between:
        return np.asarray(between[None], dtype=np.float64)
    sides = np.stack([line(one(left), one(left - 1)), line(one(right), one(right + 1))])
    ends = np.where(np.isnan(between), np.stack([one(left)[1], one(right)[1]]), np.nan)
    return np.concatenate([between[None], sides, ends])


def said_by_neighbours(z: Doubles, period: str | None, at: Any, height: Doubles, reach: int = 1, only_between: bool = False) -> Doubles:
    """For each element of `at` the estimate from its neighbours that is nearest to its `height`; NaN without neighbours.

    On a crest or a step the pair of neighbours along it gives the height, but for a spike no pair does. On a map the neighbours are at a distance of `reach`
    elements. With `only_between` only pairs on both sides are used, because a plane or a line from one side through another spike may give the height of a
    spike.
    """
    if 1 not in z.shape:
        return _nearest(_said_around(z, period, at, reach, only_between), height)
    along = 1 if z.shape[0] == 1 else 0
    return _nearest(_said_along(z.ravel(), period is not None and "yx"[along] in period, at[along], only_between), height)


def neighbours_median(z: Doubles, period: str | None) -> Doubles:
    """The median of the heights of the up to eight neighbours of each element; NaN without any."""
    padded = _padded(z, period)
    median = np.empty(z.shape)
    for rows in blocks(z.shape):
        around = padded[rows.start : rows.stop + 2]
        shifted = [around[j : j + rows.stop - rows.start, i : i + z.shape[1]] for j in range(3) for i in range(3) if (j, i) != (1, 1)]
        stacked = np.sort(np.stack(shifted), axis=0)  # NaN comes last
        count = np.isfinite(stacked).sum(axis=0)
        low, high = np.maximum((count - 1) // 2, 0), np.minimum(count // 2, 7)
        pick = [np.take_along_axis(stacked, k[None], axis=0)[0] for k in (low, high)]
        median[rows] = np.where(count > 0, 0.5 * (pick[0] + pick[1]), np.nan)
    return median


def all_but_single(z: Doubles, period: str | None) -> bool:
    """Whether all heights are equal except those of single elements, no two of which are neighbours or equal."""
    known = np.isfinite(z)
    others = known & (z != np.median(z[known]))
    padded = _padded(others.astype(float), period) == 1.0
    rows, columns = np.nonzero(others)
    beside = sum(padded[rows + j, columns + i] for j in range(3) for i in range(3) if (j, i) != (1, 1))
    return not np.any(beside) and len(np.unique(z[others])) == len(rows)
