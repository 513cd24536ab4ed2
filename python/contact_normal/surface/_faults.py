"""Faults of a measurement: holes, values that stand for "not measured", spikes."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import number
from .._short import Short
from ._heights import Heights, blocks, refuse_others

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from .._arguments import Doubles

# A value that stands for "not measured" occurs at least so often; one alone is a spike.
_OFTEN = 2
# Of fewer distinct values none can be told from a step of the surface.
_DISTINCT = 8
# Of the four pairs of opposite neighbours so many can do without planes.
_PAIRS = 3
# Standard deviations of a normal distribution in a median of absolute values.
_DEVIATIONS = 1.0 / 0.6744897501960817


@dataclass(frozen=True, eq=False, repr=False)
class Faults(Short):
    """What is wrong with measured heights.

    Attributes
    ----------
    heights : Heights
        As they were measured.
    holes : ndarray of bool, (my, mx)
        Not measured.
    fills : ndarray of bool, (my, mx)
        A value that stands for "not measured".
    fill_values : tuple of float
        These values.
    spikes : ndarray of bool, (my, mx)
        Single elements far from their neighbours.
    """

    heights: Heights
    holes: npt.NDArray[np.bool_]
    fills: npt.NDArray[np.bool_]
    fill_values: tuple[float, ...]
    spikes: npt.NDArray[np.bool_]

    @property
    def removed(self) -> Heights:
        """The heights with holes in the place of fill values and spikes."""
        return self.heights.without(self.fills | self.spikes)

    def __str__(self) -> str:
        count = self.heights.z.size
        lines = [f"{self.holes.sum()} of {count} elements ({self.holes.sum() / count:.2%}) were not measured"]
        for value in self.fill_values:
            lines.append(f"{(self.heights.z == value).sum()} elements have the value {value:g}, which seems to stand for 'not measured'")
        places = np.argwhere(self.spikes)
        first = ", ".join(str((int(iy), int(ix))) for iy, ix in places[:5])
        where = f", the first ones at (iy, ix) = {first}" if len(places) > 1 else f", at (iy, ix) = {first}" if first else ""
        lines.append(f"{len(places)} spike{'' if len(places) == 1 else 's'}{where}")
        return "\n".join(lines)

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the heights with fill values and spikes in red; holes are white."""
        axes = self.removed.plot(axes, marked=self.fills | self.spikes)
        axes.set_title(f"red: {self.spikes.sum()} spikes, {self.fills.sum()} fill values; white: {self.holes.sum()} not measured", fontsize=10)
        return axes


def _fill_values(z: Doubles) -> list[float]:
    """Extreme values that occur more than once and are further from the next value than all values between the extremes are from each other."""
    found: list[float] = []
    while True:
        values, counts = np.unique(z[np.isfinite(z) & ~np.isin(z, found)], return_counts=True)
        if len(values) < _DISTINCT:
            return found
        between = values[-2] - values[1]
        for extreme, inner in ((0, 1), (-1, -2)):
            if counts[extreme] >= _OFTEN and abs(values[extreme] - values[inner]) > between:
                found.append(float(values[extreme]))
                break
        else:
            return found


def warn_of_fill_values(heights: Heights, stacklevel: int) -> None:
    """Warns of values that seem to stand for "not measured": they move a plane of least squares, or carry the load."""
    told = [f"{np.count_nonzero(heights.z == value)} elements have the value {value:g}" for value in _fill_values(heights.z)]
    if told:
        warnings.warn(f"{' and '.join(told)}, which seems to stand for 'not measured': heights(..., fill=) or faults(...).removed makes them holes",
                      stacklevel=stacklevel + 1)


def _padded(z: Doubles, period: str | None) -> Doubles:
    """With one more element on each side: NaN, or with a period those of the other side."""
    padded = np.pad(z, 1, constant_values=np.nan)
    if period in ("x", "xy"):
        padded[1:-1, 0], padded[1:-1, -1] = z[:, -1], z[:, 0]
    if period in ("y", "xy"):
        padded[0], padded[-1] = padded[-2], padded[1]
    return padded


def _between_neighbours(z: Doubles, period: str | None, at: Any) -> Doubles:
    """Of some elements the height that their neighbours say without the slope: the median of the means of opposite neighbours, and of the planes
    through three neighbours where most opposite ones lack. NaN where neither is."""
    padded = _padded(z, period)
    rows, columns = at
    around = np.stack([padded[rows + j, columns + i] for j in range(3) for i in range(3) if (j, i) != (1, 1)])
    means = 0.5 * (around[:4] + around[:3:-1])
    # Two neighbours on the axes and the one between them, by their places among the eight.
    planes = np.stack([around[one] + around[other] - around[between] for one, other, between in ((1, 3, 0), (1, 4, 2), (6, 3, 5), (6, 4, 7))])
    said = np.concatenate([means, np.where(np.isfinite(means).sum(axis=0) < _PAIRS, planes, np.nan)])
    heights = np.full(len(rows), np.nan)
    known = np.isfinite(said).any(axis=0)
    heights[known] = np.nanmedian(said[:, known], axis=0)
    return heights


def neighbours_median(z: Doubles, period: str | None) -> Doubles:
    """The median of the up to eight neighbours of each element; NaN where there are none."""
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


def faults(heights: Heights, spike: float = 10.0) -> Faults:
    """Finds values that stand for "not measured", and spikes.

    A fill value is the smallest or the largest value, occurs at least twice, and is further from the next one than all between the extremes are
    from each other. A spike differs from the median of its neighbours by more than `spike` standard deviations of these differences, and as
    much from what opposite neighbours say without the slope. Where more than half of quantised heights equal their neighbours, the steps of the heights stand for the deviation. The edges of a surface with steps may
    count as spikes: look at them (`Faults.plot`).

    Parameters
    ----------
    heights : Heights
        What was measured.
    spike : float
        How many standard deviations, by their median: 10 is far beyond what smooth or self-affine surfaces have.
    """
    refuse_others(heights=heights)
    if not number("spike", spike) > 0.0:
        raise ValueError(f"spike is {spike}; it must be positive")
    values = _fill_values(heights.z)
    fills = np.isin(heights.z, values)
    z = np.where(fills, np.nan, heights.z)
    away: Any = np.abs(z - neighbours_median(z, heights.period))
    known = np.isfinite(away)
    spikes = np.zeros(z.shape, dtype=bool)
    if known.any():
        deviation = _DEVIATIONS * float(np.median(away[known]))
        steps = np.diff(np.unique(z[np.isfinite(z)]))
        # Of quantised heights more than half of the differences may be 0: then the steps are the noise.
        quantum = float(np.median(steps)) if deviation == 0.0 and len(steps) else 0.0
        limit = spike * max(deviation, quantum)
        spikes[known] = away[known] > limit
        # At a border, beside a hole or another spike a slope moves the median: it is no spike.
        at = np.nonzero(spikes)
        spikes[at] = ~(np.abs(z[at] - _between_neighbours(z, heights.period, at)) <= limit)
    return Faults(heights, heights.holes, fills, tuple(values), spikes)
