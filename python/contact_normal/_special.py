"""Solutions and coefficients that need no solve: the contact of Hertz, tables of influence coefficients, the compliance of a coating."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arguments import Both, integer, number, pointer, real, two
from ._bodies import bodies, load
from ._calls import called
from ._library import check, initialised, library
from ._scene import coating_of
from ._visco import visco as named_visco

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy.typing as npt

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
    shear_modulus: Both | None = None,
    poisson_ratio: Both | None = None,
    young_modulus: Both | None = None,
    e_star: float | None = None,
) -> HertzSolution:
    """Computes the exact solution of Hertz for the undeformed distance h = curvature_x x^2 + curvature_y y^2.

    Parameters
    ----------
    curvature_x, curvature_y : float
        Coefficients of x^2 and y^2, one over a length, positive. A ball of radius R on a plane has 1/(2 R).
    approach, force : float
        Exactly one of them: the approach of the bodies, or the normal force.
    shear_modulus, poisson_ratio, young_modulus, e_star
        As for `solve`.

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
    constants = bodies(shear_modulus, poisson_ratio, young_modulus, e_star)
    solution = initialised("hertz_solution")
    check(
        library.contact_normal_hertz(
            number("curvature_x", curvature_x),
            number("curvature_y", curvature_y),
            constants.shear_modulus,
            constants.poisson_ratio,
            which,
            amount,
            ctypes.byref(solution),
        )
    )
    return HertzSolution(*(getattr(solution, name) for name in HertzSolution._fields))


def influence_half_space(
    cx: int,
    cy: int,
    dx: float,
    dy: float,
    *,
    shear_modulus: Both | None = None,
    poisson_ratio: Both | None = None,
    young_modulus: Both | None = None,
    e_star: float | None = None,
) -> Doubles:
    """Computes the influence coefficients of the half-space, as a table for the argument `influence` of `solve`.

    Parameters
    ----------
    cx, cy : int
        The table covers the offsets -cx..cx-1 by -cy..cy-1.
    dx, dy : float
        Element sizes.
    shear_modulus, poisson_ratio, young_modulus, e_star
        As for `solve`.

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
    # Invalid sizes are left to the library, which has a message for them.
    table = np.zeros((2 * max(cy, 0), 2 * max(cx, 0)))
    constants = bodies(shear_modulus, poisson_ratio, young_modulus, e_star)[:2]
    size = number("dx", dx), number("dy", dy)
    check(*called(library.contact_normal_influence_half_space, cx, cy, *size, *constants, pointer(table), keep=table))
    return table


def influence_rolling(
    cx: int,
    cy: int,
    dx: float,
    dy: float,
    *,
    shear_modulus: Both,
    poisson_ratio: Both,
    visco: Mapping[str, Any],
    speed: float,
) -> Doubles:
    """Computes the influence coefficients of viscoelastic bodies in steady rolling, as a table for the argument `influence` of `solve`.

    Parameters
    ----------
    cx, cy : int
        The table covers the offsets -cx..cx-1 by -cy..cy-1.
    dx, dy : float
        Element sizes.
    shear_modulus, poisson_ratio
        As for `solve`; the moduli are the instantaneous ones.
    visco : mapping
        "modulus" and "time" of the branches, as for `solve`.
    speed : float
        The velocity at which the bodies roll towards +x; < 0: towards -x.

    Returns
    -------
    ndarray, (2 cy, 2 cx)
        Displacements per unit pressure. They are not even in x.

    Examples
    --------
    >>> import contact_normal
    >>> branches = {"modulus": (4.0, 4.0), "time": (0.01, 0.01)}
    >>> table = contact_normal.influence_rolling(8, 4, 0.1, 0.1, shear_modulus=8.0, poisson_ratio=0.4, visco=branches, speed=100.0)
    >>> bool(table[4, 4] > table[4, 12])  # behind the element, and ahead of it
    True
    """
    return _rolling_table(library.contact_normal_influence_rolling, (), (cx, cy, dx, dy), (shear_modulus, poisson_ratio, visco, speed))


def influence_rolling_tangential(
    cx: int,
    cy: int,
    dx: float,
    dy: float,
    *,
    shear_modulus: Both,
    poisson_ratio: Both,
    visco: Mapping[str, Any],
    speed: float,
) -> Doubles:
    """Computes the tangential influence coefficients of viscoelastic bodies in steady rolling, for `friction=dict(influence=(xx, yy, xy), ...)`.

    Parameters
    ----------
    cx, cy, dx, dy, shear_modulus, poisson_ratio, visco, speed
        As for `influence_rolling`. The bodies must be alike, both instantaneously and in relaxation. The tables must cover all offsets within the grid, and
        those within the contact area plus a step.

    Returns
    -------
    ndarray, (3, 2 cy, 2 cx)
        xx, yy and xy: displacements per unit traction. They are not even in x.

    Examples
    --------
    >>> import contact_normal
    >>> branches = {"modulus": (4.0, 4.0), "time": (0.01, 0.01)}
    >>> xx, yy, xy = contact_normal.influence_rolling_tangential(8, 4, 0.1, 0.1, shear_modulus=8.0, poisson_ratio=0.4, visco=branches, speed=100.0)
    >>> bool(xx[4, 4] > xx[4, 12]), bool(abs(xy[4]).max() == 0)
    (True, True)
    """
    return _rolling_table(
        library.contact_normal_influence_rolling_tangential, (3,), (cx, cy, dx, dy), (shear_modulus, poisson_ratio, visco, speed)
    )


def _rolling_table(
    function: Any, components: tuple[int, ...], sizes: tuple[int, int, float, float], of_bodies: tuple[Both, Both, Mapping[str, Any], float]
) -> Doubles:
    """The table (*components, 2 cy, 2 cx) that a function of the library computes for rolling bodies."""
    (cx, cy, dx, dy), (shear_modulus, poisson_ratio, visco, speed) = sizes, of_bodies
    cx, cy = integer("cx", cx), integer("cy", cy)
    table = np.zeros((*components, 2 * max(cy, 0), 2 * max(cx, 0)))
    constants = bodies(shear_modulus, poisson_ratio, None, None)[:2]
    size = number("dx", dx), number("dy", dy)
    effect, arrays = named_visco(visco)
    check(*called(function, cx, cy, *size, *constants, ctypes.byref(effect), number("speed", speed), pointer(table), keep=(table, effect, arrays)))
    return table


def coating_compliance(
    thickness: float, shear_modulus: float, poisson_ratio: float, wave_number: npt.ArrayLike, *, below: tuple[float, float]
) -> Doubles:
    """Computes the compliance of a coated body to a sinusoidal pressure: the amplitude of the displacement over that of the pressure.

    The compliance serves to compare a coating with other formulas. Without a coating it is (1 - nu)/(G k) at the wave number k.

    Parameters
    ----------
    thickness, shear_modulus, poisson_ratio : float
        Constants of the coating, as in the effect `coating` of `solve`.
    wave_number : array_like
        2 pi over the wave's length, > 0.
    below : (shear_modulus, poisson_ratio)
        Constants of the substrate.

    Returns
    -------
    ndarray
        Compliances, lengths per pressure, with the shape of `wave_number`.

    Examples
    --------
    A wave much shorter than the thickness of the coating depends on the coating only, a much longer one on the substrate only:

    >>> import contact_normal
    >>> short, long = contact_normal.coating_compliance(1.0, 4.0, 0.3, [1e3, 1e-4], below=(1.0, 0.3)) * [1e3, 1e-4]
    >>> float(round(short, 4)), float(round(long, 3))
    (0.175, 0.7)
    """
    coating = coating_of((thickness, shear_modulus, poisson_ratio))
    body, numbers = two("below", below), real("wave_number", wave_number)
    found, one = np.zeros(numbers.shape), ctypes.c_double()
    for place, wave in np.ndenumerate(numbers):
        check(library.contact_normal_coating_compliance(ctypes.byref(coating), *body, float(wave), ctypes.byref(one)))
        found[place] = one.value
    return found
