"""Gaps of rollers and gear teeth from their radii, crowns and profiles: of line contacts, and of crowned contacts.

x runs in the rolling direction, y along the axis of the roller. Two teeth of spur gears touch like two cylinders whose radii are the
radii of curvature of the flanks at the point of contact::

    from contact_normal import rollers
    drop = rollers.logarithmic(length=14.0, force=9000.0, e_star=115385.0)
    gap = rollers.gap((1.2, 14.0), (48, 56), radii=(6.0, 25.0), drop=drop)
    result = gap.solve(force=9000.0, e_star=115385.0)
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import both, integer, number
from ._gap import Gap
from ._grid import centres
from ._units import Units, checked

if TYPE_CHECKING:
    from ._arguments import Doubles

    # The drop of the surface of a roller below its cylinder, as a function of places along its axis.
    Drop = Callable[[Doubles], Doubles]

# The factor of a logarithmic drop, divided by the length of the roller, is some 1e-4 for steel. Below _FLAT or above _DEEP units are probably mixed.
_FLAT = 1e-6
_DEEP = 0.02

# The ends of a grid in y may touch if the drop there is less than this part of the undeformed distance at the sides of the grid in x.
_TOUCHED = 0.25

# The factor of the drop of ISO/TS 16281:2008, divided by the diameter of the roller.
_ISO = 0.00035

__all__ = ["crown", "gap", "iso_16281", "logarithmic", "no_drop"]


def _positive(name: str, value: Any) -> float:
    found = number(name, value)
    if not (found > 0.0 and np.isfinite(found)):
        raise ValueError(f"{name} is {found}; it must be positive and finite")
    return found


def _several(name: str, radii: Any) -> tuple[float, ...]:
    """One radius for each body."""
    if np.ndim(radii) != 1:
        raise TypeError(f"{name} is {radii!r}; it must have one radius for each body: inf for a flat one")
    found = tuple(number(name, radius) for radius in radii)
    if len(found) > 2:
        raise ValueError(f"{name} are {found}: two bodies have two radii at most")
    if not all(found) or any(map(np.isnan, found)):
        raise ValueError(f"{name} are {found}; none may be 0 or nan: inf is a flat body")
    return found


def _drops(drop: Any) -> list[Any]:
    """The drop functions of the bodies that have one, as a list."""
    drops = list(drop) if isinstance(drop, (list, tuple)) else [drop]
    if not all(callable(one) for one in drops):
        raise TypeError("drop has a number; it must be a function of places y, as rollers.crown(...) returns, or one for each body")
    if len(drops) > 2:
        raise ValueError(f"drop has {len(drops)} functions; two bodies have two at most")
    return drops


def _dropped(drop: Drop, y: Doubles) -> Doubles:
    """The drop at places y. The values are checked, because `drop` may be a function of the caller."""
    found = np.asarray(drop(y), dtype=np.float64)
    if found.shape not in ((), y.shape) or np.isnan(found).any():
        what = f"nan at y = {y[np.isnan(found)][0]:g}" if found.shape == y.shape else f"the shape {found.shape}"
        raise ValueError(f"drop has {what}; it must be a number for each of {len(y)} places y, and inf where there is no surface")
    if np.isneginf(found).any():
        raise ValueError("drop is -inf; it is positive where the roller is thinner, and inf where there is no surface")
    return found


# The largest tilt, in rad. The gap is assumed to grow by the tilt times y, which holds for small angles only.
_STEEPEST = 0.3


def circle(x: Any, radius: float) -> Doubles:
    """The distance of a circle from its tangent at the distance x from their common point; inf beyond the radius.

    It is exact, not the parabola. A negative radius is that of a hollow, and gives negative distances.
    """
    x, r = np.asarray(x, dtype=np.float64), abs(radius)
    if np.isinf(r):
        return np.zeros_like(x)
    inside = np.abs(x) <= r
    # r - sqrt(r^2 - x^2) without cancellation.
    rise = x**2 / (r + np.sqrt(np.maximum(r**2 - x**2, 0.0)))
    return np.where(inside, np.copysign(rise, radius), np.inf)


@dataclass(frozen=True)
class _OfRoller:
    """The drop along a roller of length 2 `half`, as a function of y that can be pickled. `shape` computes it from y, `half` and `sizes`."""

    half: float
    shape: Callable[..., Doubles]
    sizes: tuple[float, ...] = ()

    def __call__(self, y: Any) -> Doubles:
        return self.shape(y, self.half, *self.sizes)


def _sharp(y: Any, half: float) -> Doubles:
    return np.where(np.abs(y) <= half, 0.0, np.inf)


def _crowned(y: Any, half: float, half_straight: float, radius: float) -> Doubles:
    return np.where(np.abs(y) <= half, circle(np.maximum(np.abs(y) - half_straight, 0.0), radius), np.inf)


def _logarithm(y: Any, half: float, relief: float) -> Doubles:
    inside = np.abs(y) < half
    return np.where(inside, -relief * np.log1p(-((np.where(inside, y, 0.0) / half) ** 2)), np.inf)


def no_drop(length: float) -> Drop:
    """Returns the drop of a cylinder with sharp ends. The pressures at its ends grow without bound on finer grids."""
    half = 0.5 * _positive("length", length)
    return _OfRoller(half, _sharp)


def crown(length: float, radius: float, straight: float = 0.0) -> Drop:
    """Returns the drop of a roller that is crowned by a circular arc.

    Parameters
    ----------
    length : float
        Length of the roller.
    radius : float
        Radius of the crown, along the axis.
    straight : float
        Length of the cylindrical part in the middle.
    """
    half, r, flat = 0.5 * _positive("length", length), _positive("radius", radius), number("straight", straight)
    if not 0.0 <= flat < 2.0 * half:
        raise ValueError(f"straight is {flat}; it must lie between 0 and the length {2.0 * half}")
    if r < (half - 0.5 * flat) * (1.0 - 1e-9):
        warnings.warn(f"radius is {r:g}, and the crowned part is {half - 0.5 * flat:g} long on each side: its surface ends before the roller does. Radius and length must be "
                      "in one unit", stacklevel=2)
    return _OfRoller(half, _crowned, (0.5 * flat, r))


def logarithmic(length: float, force: float, e_star: float) -> Drop:
    """Returns the drop of the logarithmic profile of Lundberg (1939). Under its design force the pressure is nearly uniform along the roller.

    drop(y) = force/(pi length E*) ln(1/(1 - (2 y/length)^2))

    Parameters
    ----------
    length : float
        Length of the roller.
    force : float
        The design force of the profile.
    e_star : float
        E* of both bodies.
    """
    whole = _positive("length", length)
    relief = _positive("force", force) / (np.pi * whole * _positive("e_star", e_star))
    if not _FLAT * whole <= relief <= _DEEP * whole:
        warnings.warn(f"the drop is {relief:.2g} ln(1/(1 - (2 y/length)^2)), and the length {whole:g}: force, length and e_star must be in one system of units, as N, mm "
                      "and N/mm2", stacklevel=2)
    return _OfRoller(0.5 * whole, _logarithm, (relief,))


def iso_16281(length: float, diameter: float) -> Drop:
    """Returns the drop of the profile that ISO/TS 16281:2008 assumes for rollers at most 2.5 times as long as their diameter.

    drop(y) = 0.00035 diameter ln(1/(1 - (2 y/length)^2)). This is Lundberg's profile for a largest pressure of some 3000 N/mm2 between bodies of steel.
    """
    whole, thick = _positive("length", length), _positive("diameter", diameter)
    if whole > 2.5 * thick:
        raise ValueError(f"length is {whole}; this profile is for lengths of up to 2.5 times the diameter, {2.5 * thick}")
    return _OfRoller(0.5 * whole, _logarithm, (_ISO * thick,))


def _warn_of_ends(along: Doubles, cut: float | None, half: float, across: Doubles) -> None:
    """Warns of two probable mistakes: the grid ends inside the roller, at y = +-`cut`, where it may touch; the gap is smaller at both ends than in the middle.

    `along` is the undeformed distance along the axis of the roller, `across` that in the rolling direction, and 2 `half` the length of the roller.
    """
    middle = along[(len(along) - 1) // 2 : len(along) // 2 + 1].min()
    if cut is not None and min(along[0], along[-1]) - middle < _TOUCHED * across.max():
        warnings.warn(f"the grid is {2.0 * cut:g} long in y, and the roller {2.0 * half:g}: nothing touches beyond the grid, whose ends are those of a shorter roller with sharp ends. "
                      "size, length and radii must be in one unit", stacklevel=3)
    # A roller with a groove for a retainer has no surface in the middle.
    if np.isfinite(middle) and max(along[0], along[-1]) < middle:
        warnings.warn(f"the drop at the ends is {max(along[0], along[-1]) - middle:.3g} beside the middle: it is positive where the roller is thinner", stacklevel=3)


def gap(
    size: tuple[float, float],
    elements: tuple[int, int],
    radii: Sequence[float],
    *,
    drop: Drop | Sequence[Drop] = (),
    crown_radii: Sequence[float] = (),
    tilt: float = 0.0,
    units: Units = None,
) -> Gap:
    """Returns the gap of two rollers, or of a roller and a raceway, on a grid around the point of first contact.

    Parameters
    ----------
    size : (float, float)
        Size of the grid in x, the rolling direction, and in y, along the axis.
    elements : (int, int)
        Elements in x and in y.
    radii : sequence of float
        Radius of each body in the rolling direction; negative: a hollow, as an outer raceway; inf: flat.
    drop : function of an array, or sequence of them
        The drop of the surface below its cylinder as a function of places y, for one roller or for each. It comes from `crown`, `logarithmic`, `iso_16281` or
        `no_drop`, or is a function of the caller. It returns inf where there is no surface.
    crown_radii : sequence of float
        Radii of the bodies along the axis, instead of `drop`; negative: a hollow.
    tilt : float
        Misalignment of the axes, in rad: the gap grows by tilt y.
    units : (str, str), optional
        Names of the units of lengths and forces.

    Returns
    -------
    Gap
    """
    (lx, ly), (mx, my) = both("size", size), both("elements", elements)
    lx, ly, mx, my = _positive("size[0]", lx), _positive("size[1]", ly), integer("elements[0]", mx), integer("elements[1]", my)
    if mx < 1 or my < 1:
        raise ValueError(f"elements are {mx} and {my}; they must be positive")
    dx, dy = lx / mx, ly / my
    x, y = centres(mx, dx), centres(my, dy)
    radii, crown_radii = _several("radii", radii), _several("crown_radii", crown_radii)
    for name, several in (("radii", radii), ("crown_radii", crown_radii)):
        curvature = sum(1.0 / radius for radius in several)
        # Straight rollers have no curvature along their axes.
        if curvature < 0.0 or (curvature == 0.0 and name == "radii"):
            raise ValueError(f"{name} are {several}: their curvatures add up to {curvature}; the sum must be positive")
    drops = _drops(drop)
    if drops and len(crown_radii):
        raise TypeError("give either drop or crown_radii")
    across = sum((circle(x, radius) for radius in radii), np.zeros(mx))
    along = sum([*(_dropped(one, y) for one in drops), *(circle(y, radius) for radius in crown_radii)], np.zeros(my))
    if not abs(number("tilt", tilt)) < _STEEPEST:
        raise ValueError(f"tilt is {tilt}; it is an angle in rad, and must be below {_STEEPEST:g}")
    half = min((getattr(one, "half", np.inf) for one in drops), default=np.inf)
    _warn_of_ends(along, 0.5 * ly if half > 0.501 * ly and np.isfinite(half) else None, half, across)
    h = across[None, :] + (along + tilt * y)[:, None]
    if not np.isfinite(h).any():
        raise ValueError("no element has a surface: the drop is inf, or the grid beyond a radius, everywhere")
    return Gap(np.ascontiguousarray(h), dx, dy, units=checked(units))
