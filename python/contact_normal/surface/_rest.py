"""Finds the plane on which a rigid body rests, by a simplex method."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .._arguments import Doubles
    from .._gap import Gap

# The height of the first corners, in ranges of the heights. These corners are no elements. They are so high that a body which can rest on elements does not
# rest on them.
_HIGH = 1e6
# The largest number of steps of the simplex method. Maps of a million elements need some tens of steps.
_MOST_STEPS = 200
# Heights above the plane, relative to the range of the heights, and weights of corners count as 0 if they are smaller.
_ROUND_OFF, _NO_WEIGHT = 1e-12, 1e-14


def resting(gap: Gap, aim: Doubles) -> Doubles | None:
    """Returns the slopes of the plane on which a rigid body rests under a force at `aim`; None if no elements surround `aim`.

    Among all planes below the undeformed distance this plane is the highest at `aim`. It touches three elements around `aim`, or two elements of a line.
    """
    iy, ix = np.nonzero(np.isfinite(gap.h))
    sizes = np.array([gap.h.shape[1] * gap.dx, gap.h.shape[0] * gap.dy])
    places = (np.stack([gap.x[ix], gap.y[iy]], axis=1) - aim) / sizes
    extends = np.ptp(places, axis=0) > 0.0
    points = np.column_stack([places[:, extends], np.ones(len(places))])
    count, heights = points.shape[1], gap.h[iy, ix] - gap.h.min()
    span = float(heights.max()) or 1.0
    heights /= span
    # The first corners of the simplex are far away around `aim`, and far up.
    corners = np.column_stack([27.0 * np.eye(count)[:, :-1] - 9.0, np.ones(count)])
    at, inside = np.full(count, _HIGH), np.zeros(count, dtype=bool)
    for _ in range(_MOST_STEPS):
        plane = np.linalg.solve(corners, at)
        above = heights - points @ plane
        lowest = int(np.argmin(above))
        if above[lowest] >= -_ROUND_OFF:
            break
        # The weights of the corners carry a unit force at `aim`. The weight of the lowest element grows until the weight of a corner is 0, which it replaces.
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
