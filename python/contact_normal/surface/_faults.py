"""Finds faults of measured heights: holes, fill values that mean "not measured", spikes."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import number
from .._short import Short
from ._heights import Heights, refuse_others
from ._neighbours import all_but_single, neighbours_median, said_by_neighbours

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from .._arguments import Doubles

# A fill value occurs at least this often; a single extreme value is a spike.
_OFTEN = 2
# If heights have fewer distinct values, fill values cannot be distinguished from steps of the surface.
_DISTINCT = 8
# An estimate from elements at twice the distance has an error by the curvature that is larger by this factor.
_FAR = 4.0
# The standard deviation of a normal distribution is this factor times the median of the absolute values.
_DEVIATIONS = 1.0 / 0.6744897501960817


@dataclass(frozen=True, eq=False, repr=False)
class Faults(Short):
    """The faults of measured heights.

    Attributes
    ----------
    heights : Heights
        The heights as measured.
    holes : ndarray of bool, (my, mx)
        Elements that were not measured.
    fills : ndarray of bool, (my, mx)
        Elements with a fill value, which means "not measured".
    fill_values : tuple of float
        The fill values that were found.
    spikes : ndarray of bool, (my, mx)
        Single elements whose heights differ much from those of their neighbours.
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
    """The fill values of an array, by the rule of `faults`.

    Such a value is the smallest or the largest one, occurs more than once, and is farther from the next value than any two values between the extremes are from
    each other.
    """
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
    """Warns of probable fill values. They would move a least-squares plane, or carry the load."""
    told = [f"{np.count_nonzero(heights.z == value)} elements have the value {value:g}" for value in _fill_values(heights.z)]
    if told:
        warnings.warn(f"{' and '.join(told)}, which seems to stand for 'not measured': heights(..., fill=) or faults(...).removed makes them holes",
                      stacklevel=stacklevel + 1)


def _noise(z: Doubles, period: str | None, away: Doubles) -> float:
    """The standard deviation of the absolute differences `away` of heights from the medians of their neighbours, estimated from the median of `away`."""
    deviation = _DEVIATIONS * float(np.median(away))
    others = away[away > 0.0]
    if deviation > 0.0 or not len(others) or all_but_single(z, period):
        return deviation
    # More than half of the differences are 0, as with quantised heights or on a plateau. Then the noise is estimated from the steps between distinct heights,
    # or from the other differences.
    step, other = float(np.median(np.diff(np.unique(z[np.isfinite(z)])))), float(np.median(others))
    # On a plane the only steps are those of its spikes, which are no measure of the noise.
    return min(step, _DEVIATIONS * other) if other <= step else _DEVIATIONS * other


def faults(heights: Heights, spike: float = 10.0) -> Faults:
    """Finds fill values and spikes of measured heights.

    A fill value is the smallest or the largest value, and occurs at least twice. Its distance from the next value exceeds the distance of any two values
    between the extremes.

    A spike differs from the median of its neighbours by more than `spike` standard deviations of these differences. It differs as much from the mean of each
    pair of opposite neighbours, so that crests along a lay are no spikes. If more than half of the heights equal their neighbours, as with quantised or clipped
    heights, the standard deviation is estimated from the steps between distinct heights, or from the other differences.

    The corners of a surface with steps, and crests and edges of grooves that are oblique to the grid, may count as spikes: check them with `Faults.plot`.

    Parameters
    ----------
    heights : Heights
        The measured heights.
    spike : float
        The limit in standard deviations, which are estimated from the median. Heights of smooth or self-affine surfaces are far below 10.
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
        limit = spike * _noise(z, heights.period, away[known])
        spikes[known] = away[known] > limit
        # At a border, or beside a hole, another spike or a crest, the median differs because of the slope. Such an element, or the neighbour of a spike, is no
        # spike if some of its neighbours give its height. In the second pass the spikes that are left do not count as neighbours.
        for is_again in (False, True):
            at = np.nonzero(spikes)
            said = said_by_neighbours(np.where(spikes & is_again, np.nan, z), heights.period, at, z[at], only_between=not is_again)
            spikes[at] = ~(np.abs(z[at] - said) <= limit)
        # An element all of whose neighbours are holes, as the middle of dust whose rim was removed, is compared with the elements at a distance of two. These
        # give its height less exactly.
        at = np.nonzero(np.isfinite(z) & ~known)
        spikes[at] = np.abs(z[at] - said_by_neighbours(z, heights.period, at, z[at], reach=2)) > _FAR * limit
    return Faults(heights, heights.holes, fills, tuple(values), spikes)
