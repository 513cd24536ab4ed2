"""The plane on which a rigid body rests, found by a simplex method."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .._arguments import Doubles
    from .._gap import Gap

# A point that is no element is so many ranges of the heights above all elements, so that no body rests on it if it can rest on elements.
_HIGH = 1e6
# Elements that the plane is turned to, one after another; some tens of them suffice for maps of a million elements.
_TURNS = 200
# Round-off of a height above the plane, and of a weight, relative to the range of the heights and to 1.
_ROUND_OFF, _NO_WEIGHT = 1e-12, 1e-14


def resting(gap: Gap, aim: Doubles) -> Doubles | None:
    """Slopes of the plane below the undeformed distance that is highest at `aim`: a rigid body rests on it, on three elements around this place, or on two
    of one line. None where no elements are around it."""
    iy, ix = np.nonzero(np.isfinite(gap.h))
    sizes = np.array([gap.h.shape[1] * gap.dx, gap.h.shape[0] * gap.dy])
    places = (np.stack([gap.x[ix], gap.y[iy]], axis=1) - aim) / sizes
    extends = np.ptp(places, axis=0) > 0.0
    points = np.column_stack([places[:, extends], np.ones(len(places))])
    count, heights = points.shape[1], gap.h[iy, ix] - gap.h.min()
    span = float(heights.max()) or 1.0
    heights /= span
    # Corners around `aim`, far away and far up.
    corners = np.column_stack([27.0 * np.eye(count)[:, :-1] - 9.0, np.ones(count)])
    at, inside = np.full(count, _HIGH), np.zeros(count, dtype=bool)
    for _ in range(_TURNS):
        plane = np.linalg.solve(corners, at)
        above = heights - points @ plane
        lowest = int(np.argmin(above))
        if above[lowest] >= -_ROUND_OFF:
            break
        # The corner whose weight ends first as that of the lowest element grows makes room for it.
        weights, changes = np.linalg.solve(corners.T, np.column_stack([np.eye(count)[-1], points[lowest]])).T
        ratios = np.full(count, np.inf)
        np.divide(weights, changes, out=ratios, where=changes > _NO_WEIGHT)
        out = int(np.argmin(ratios))
        corners[out], at[out], inside[out] = points[lowest], heights[lowest], True
    if count == 1 or not inside.all():
        return None
    slopes = np.zeros(2)
    slopes[extends] = span * plane[:-1] / sizes[extends]
    return slopes
