"""Fits tilt or form of a surface by least squares, and removes them."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ._faults import warn_of_fill_values
from ._heights import Heights, blocks, refuse_others

if TYPE_CHECKING:
    from .._arguments import Doubles

# Normal equations count as singular if the ratio of their smallest and largest eigenvalue is round-off: 2^-52 times a million terms.
_SINGULAR = 1e-10

# The powers (of x, of y) of the terms of each form.
FORMS = {
    "mean": ((0, 0),),
    "plane": ((0, 0), (1, 0), (0, 1)),
    "quadric": ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)),
}


@dataclass(frozen=True, eq=False)
class Form:
    """A polynomial in x and y, relative to the middle of the grid, fitted to heights.

    Attributes
    ----------
    kind : {"mean", "plane", "quadric"}
        The terms of the polynomial.
    coefficients : tuple of float
        Coefficients of 1; of x and y; of x^2, x y and y^2, as far as the kind has these terms.
    rms : float
        Root mean square of the heights that remain without the form.
    """

    kind: str
    coefficients: tuple[float, ...]
    rms: float

    @property
    def tilt(self) -> tuple[float, float]:
        """Slopes in x and y at the middle of the grid."""
        _, x, y = (*self.coefficients, 0.0, 0.0)[:3]
        return x, y

    @property
    def radii(self) -> tuple[float, float]:
        """Radii of curvature in x and y at the middle of the grid, positive for a ball, inf for a plane."""
        square = (*self.coefficients, *[0.0] * 6)[3:6]
        rx, ry = (np.inf if c == 0.0 else -0.5 / c for c in (square[0], square[2]))
        return float(rx), float(ry)

    def values(self, heights: Heights) -> Doubles:
        """The heights of the form at the centres of the elements of `heights`."""
        x, y = heights.x[None, :], heights.y[:, None]
        zero = np.zeros(heights.z.shape)
        return np.asarray(sum((c * x**i * y**j for c, (i, j) in zip(self.coefficients, FORMS[self.kind])), zero))


def form(heights: Heights, kind: str = "plane") -> Form:
    """Fits a form to the measured heights by least squares.

    Parameters
    ----------
    heights : Heights
        Heights without spikes and fill values, because each counts with its square.
    kind : {"mean", "plane", "quadric"}
        A mean height; a plane; a plane and curvatures. For a line scan "plane" is a straight line and "quadric" a parabola along the line.
    """
    refuse_others(heights=heights)
    if kind not in FORMS:
        raise ValueError(f"kind is {kind!r}; it must be one of {', '.join(FORMS)}")
    powers = _powers(kind, heights.z.shape)
    # Coordinates are scaled to [-1, 1], where the normal equations of these monomials are well conditioned.
    scales = 0.5 * heights.dx * heights.z.shape[1], 0.5 * heights.dy * heights.z.shape[0]
    count, matrix, right = 0, np.zeros((len(powers), len(powers))), np.zeros(len(powers))
    for rows in blocks(heights.z.shape):
        z = heights.z[rows]
        known = np.isfinite(z)
        x, y = (np.broadcast_to(places, z.shape)[known] for places in (heights.x[None, :] / scales[0], heights.y[rows, None] / scales[1]))
        columns = np.stack([x**i * y**j for i, j in powers])
        count, matrix, right = count + x.size, matrix + columns @ columns.T, right + columns @ z[known]
    sizes = np.linalg.eigvalsh(matrix)
    if not sizes[0] > _SINGULAR * sizes[-1]:
        line = " along a line" if min(heights.z.shape) == 1 else ""
        raise ValueError(f"a {kind} has {len(powers)} unknowns{line}; {count} heights of the {heights.z.shape} elements do not determine them")
    scaled = dict(zip(powers, np.linalg.solve(matrix, right)))
    coefficients = [scaled.get((i, j), 0.0) / (scales[0] ** i * scales[1] ** j) for i, j in FORMS[kind]]
    found = Form(kind, tuple(map(float, coefficients)), 0.0)
    return dataclasses.replace(found, rms=float(np.sqrt(np.nanmean((heights.z - found.values(heights)) ** 2))))


def _powers(kind: str, shape: tuple[int, ...]) -> tuple[tuple[int, int], ...]:
    """The powers of x and y of the terms that are fitted. Terms along a direction with one element, as across a line scan, are left out."""
    return tuple((i, j) for i, j in FORMS[kind] if (i == 0 or shape[1] > 1) and (j == 0 or shape[0] > 1))


def level(heights: Heights, kind: str = "plane") -> Heights:
    """Subtracts the tilt or form of heights, fitted by least squares.

    A least-squares plane is a convention of metrology. A body that is free to tilt takes another tilt under load: see `balance`. Of periodic heights only the
    mean can be removed, because a plane or a quadric would break the period.

    Parameters
    ----------
    heights : Heights
        Heights without spikes and fill values.
    kind : {"mean", "plane", "quadric"}
        See `form`. "quadric" also removes the curvature. If the ideal form is a part of the contact, as that of a ball, add its own gap afterwards.
    """
    refuse_others(heights=heights)
    is_tilted = {"x": heights.z.shape[1] > 1, "y": heights.z.shape[0] > 1}
    if kind != "mean" and any(is_tilted[axis] for axis in heights.period or ""):
        raise ValueError(f"the surface repeats itself in {heights.period}: a {kind} would break the period; level it with period None, or by its mean")
    warn_of_fill_values(heights, stacklevel=2)
    return dataclasses.replace(heights, z=heights.z - form(heights, kind).values(heights))


def border_jumps(heights: Heights) -> tuple[float, float]:
    """Computes, in x and in y, the ratio of two steps of the heights: from the last element to the first one, and between neighbours, both as rms.

    The ratio is about 1 if the grid is a period of the surface, and much larger if it is not, or if a tilt remains. It is NaN if no two neighbours, inside or
    across the border, were both measured.
    """

    refuse_others(heights=heights)

    def mean_square(steps: Doubles) -> float:
        known = steps[np.isfinite(steps)]
        return float(np.mean(known**2)) if known.size else float("nan")

    def ratio(z: Doubles) -> float:
        inside, across = mean_square(np.diff(z, axis=1)), mean_square(z[:, 0] - z[:, -1])
        if inside == 0.0:
            return float("inf") if across > 0.0 else across
        return float(np.sqrt(across / inside))

    return ratio(heights.z), ratio(heights.z.T)
