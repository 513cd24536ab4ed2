"""Closed forms: the contact of Hertz, and the influence coefficients of the half-space."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ._arguments import Both, integer, pair, pointer
from ._library import check, initialised, library
from ._scene import load

if TYPE_CHECKING:
    from ._arguments import Doubles


class HertzSolution(NamedTuple):
    """The exact solution of Hertz: semi-axes and area of the contact ellipse, largest pressure, approach and force."""

    semi_axis_x: float
    semi_axis_y: float
    max_pressure: float
    approach: float
    force: float
    area: float


def hertz(
    curvature_x: float,
    curvature_y: float,
    *,
    approach: float | None = None,
    force: float | None = None,
    shear_modulus: Both,
    poisson_ratio: Both,
) -> HertzSolution:
    """The exact solution for h = curvature_x x^2 + curvature_y y^2.

    Parameters
    ----------
    curvature_x, curvature_y : float
        1/length, positive. A ball of radius R on a plane has 1/(2 R).
    approach, force : float
        Exactly one of them.
    shear_modulus, poisson_ratio : float or pair of floats
        Of both bodies, or of each.

    Returns
    -------
    HertzSolution

    Examples
    --------
    >>> import contact_normal
    >>> contact_normal.hertz(0.01, 0.01, force=1000.0, shear_modulus=82000.0, poisson_ratio=0.28).semi_axis_x < 1.0
    True
    """
    which, amount = load(approach, force)
    solution = initialised("hertz_solution")
    check(
        library.contact_normal_hertz(
            curvature_x,
            curvature_y,
            pair("shear_modulus", shear_modulus),
            pair("poisson_ratio", poisson_ratio),
            which,
            amount,
            ctypes.byref(solution),
        )
    )
    return HertzSolution(*(getattr(solution, name) for name in HertzSolution._fields))


def influence_half_space(
    cx: int, cy: int, dx: float, dy: float, *, shear_modulus: Both, poisson_ratio: Both
) -> Doubles:
    """The influence coefficients of the half-space, as a table that `influence` takes.

    Parameters
    ----------
    cx, cy : int
        The table covers the offsets -cx..cx-1 by -cy..cy-1.
    dx, dy : float
        Element sizes.
    shear_modulus, poisson_ratio : float or pair of floats
        Of both bodies, or of each.

    Returns
    -------
    ndarray, (2 cy, 2 cx)
        Displacements per unit pressure.

    Examples
    --------
    >>> import contact_normal
    >>> contact_normal.influence_half_space(8, 4, 0.1, 0.1, shear_modulus=82000.0, poisson_ratio=0.28).shape
    (8, 16)
    """
    cx, cy = integer("cx", cx), integer("cy", cy)
    # Sizes that are no sizes are left to the library, whose message says so.
    table = np.zeros((2 * max(cy, 0), 2 * max(cx, 0)))
    bodies = pair("shear_modulus", shear_modulus), pair("poisson_ratio", poisson_ratio)
    check(library.contact_normal_influence_half_space(cx, cy, dx, dy, *bodies, pointer(table)))
    return table
