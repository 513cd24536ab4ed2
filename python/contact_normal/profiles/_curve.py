"""The class `Curve`: a smooth curve through the points of a profile, by natural cubic splines of y and z over the length of the polygon."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .._arguments import Doubles

# The number of steps of Newton's method in `Curve.where`. Each doubles the number of correct digits; the start, on the polygon, has about three.
_STEPS = 4


def second_derivatives(t: Doubles, values: Doubles) -> Doubles:
    """The second derivatives at the knots `t` of the natural cubic spline through `values`, by elimination in a tridiagonal system."""
    n, d = len(t), np.diff(t)
    found = np.zeros(n)
    if n < 3:
        return found
    right = 6.0 * np.diff(np.diff(values) / d)
    diagonal = 2.0 * (d[:-1] + d[1:])
    for k in range(1, n - 2):
        factor = d[k] / diagonal[k - 1]
        diagonal[k] -= factor * d[k]
        right[k] -= factor * right[k - 1]
    found[n - 2] = right[-1] / diagonal[-1]
    for k in range(n - 4, -1, -1):
        found[k + 1] = (right[k] - d[k + 1] * found[k + 2]) / diagonal[k]
    return found


class Curve:
    """A smooth curve (y, z) whose parameter t is the length along the polygon of its points. y grows strictly from point to point.

    Attributes
    ----------
    t, y, z : ndarray, (n,)
        The parameters and the coordinates of the points.
    open : ndarray, (m, n), or None
        If the points were smoothed: possible errors of the points along the normal. The first row is the form that smoothing removed, the others are samples of
        the remaining errors.
    """

    def __init__(self, y: Doubles, z: Doubles, is_open: Doubles | None = None) -> None:
        self.y, self.z, self.open = y, z, is_open
        self.t = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
        self._bends = second_derivatives(self.t, y), second_derivatives(self.t, z)

    def between(self, count: int) -> Doubles:
        """Parameters t that divide each interval between two points into `count` parts."""
        n = len(self.t)
        return np.asarray(np.interp(np.arange((n - 1) * count + 1) / count, np.arange(n), self.t))

    def at(self, t: Any) -> tuple[Doubles, Doubles, Doubles, Doubles]:
        """Returns y, z and their derivatives by t at the parameters `t`."""
        k = np.clip(np.searchsorted(self.t, t, side="right") - 1, 0, len(self.t) - 2)
        d = self.t[k + 1] - self.t[k]
        a, b = (self.t[k + 1] - t) / d, (t - self.t[k]) / d
        out = []
        for values, bends in zip((self.y, self.z), self._bends):
            out.append(a * values[k] + b * values[k + 1] + ((a**3 - a) * bends[k] + (b**3 - b) * bends[k + 1]) * d**2 / 6.0)
        for values, bends in zip((self.y, self.z), self._bends):
            out.append((values[k + 1] - values[k]) / d + ((3.0 * b**2 - 1.0) * bends[k + 1] - (3.0 * a**2 - 1.0) * bends[k]) * d / 6.0)
        return out[0], out[1], out[2], out[3]

    def where(self, along: Any, direction: tuple[float, float] = (1.0, 0.0), near: float = 0.0) -> Doubles:
        """Returns the t at which the scalar product of `direction` and (y, z) is `along`, by Newton's method from the polygon; NaN if there is none.

        Only a part of the curve is searched: that around the point at t = `near` on which this product grows from point to point.
        """
        wanted = np.asarray(along, dtype=np.float64)
        places = direction[0] * self.y + direction[1] * self.z
        first, last = growing(places, int(np.argmin(np.abs(self.t - near))))
        t = np.interp(wanted, places[first : last + 1], self.t[first : last + 1], left=np.nan, right=np.nan)
        for _ in range(_STEPS):
            y, z, dy, dz = self.at(np.where(np.isnan(t), self.t[first], t))
            moved = t - (direction[0] * y + direction[1] * z - wanted) / (direction[0] * dy + direction[1] * dz)
            t = np.clip(moved, self.t[first], self.t[last])
        return np.asarray(t)


def growing(places: Doubles, middle: int) -> tuple[int, int]:
    """The first and the last index of the longest range around the index `middle` in which each value is larger than the one before."""
    stops = np.flatnonzero(~(np.diff(places) > 0.0))
    k = int(np.searchsorted(stops, middle))
    first = int(stops[k - 1]) + 1 if k > 0 else 0
    last = int(stops[k]) if k < len(stops) else len(places) - 1
    return first, last
