"""Computes the smoothing splines of Reinsch (1967) through the points of a curve, in a time proportional to their number."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._pentadiagonal import solve

if TYPE_CHECKING:
    from .._arguments import Doubles


def smoothing_splines(rows: Doubles, places: Doubles, wave_length: float) -> Doubles:
    """Smooths rows of values at the points of a curve: returns the rows without waves that are shorter than `wave_length`.

    To smooth the points themselves, each coordinate is a row. Smoothing of z over y alone would bend a steep face, whose slope changes fast.

    Parameters
    ----------
    rows : ndarray, (m, n)
        Values at the points, in their order.
    places : ndarray, (2, n)
        y and z of the points. Neighbours must not be equal.
    """
    d = np.hypot(*np.diff(places))
    # The smoothing spline f of values z is f = z - c W^-1 Q g with (R + c Q' W^-1 Q) g = Q' z, where g = f'' = R^-1 Q' f at the inner points. The diagonal of W
    # has the length of the curve that belongs to each point: half of the lengths to both neighbours.
    before, after = 1.0 / d[:-1], 1.0 / d[1:]
    at = -before - after
    w = 1.0 / np.convolve(np.concatenate([d[:1], d, d[-1:]]), [0.5, 0.5], "valid")
    c = (wave_length / (2.0 * np.pi)) ** 4
    diagonal = (d[:-1] + d[1:]) / 3.0 + c * (before**2 * w[:-2] + at**2 * w[1:-1] + after**2 * w[2:])
    first = d[1:-1] / 6.0 + c * (at[:-1] * before[1:] * w[1:-2] + after[:-1] * at[1:] * w[2:-1])
    second = c * after[:-2] * before[2:] * w[2:-2]
    smooth = rows.copy()
    for values in smooth:
        bend = solve(diagonal, first, second, before * values[:-2] + at * values[1:-1] + after * values[2:])
        spread = np.zeros(len(values))
        spread[:-2] += before * bend
        spread[1:-1] += at * bend
        spread[2:] += after * bend
        values -= c * w * spread
    return smooth
