"""The gap of two surfaces, and the tilt of a free body under a load."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import number, two
from .._gap import Gap
from .._time_limit import TimeLimit
from .._units import same_length
from ._faults import warn_of_fill_values
from ._heights import Heights, refuse_others
from ._rest import resting

if TYPE_CHECKING:
    from .._arguments import Both, Doubles
    from .._result import Result

# The largest number of steps of a search for a tilt. Each takes one solve, or several if the step must be shortened.
_STEPS = 60
# The first trial of a tilt moves the surfaces by this part of the approach over the length of the grid.
_TRIAL = 0.1
# A combination of tilts that moves the centre of pressures less than this part of the most effective one counts as without effect.
_SINGULAR = 1e-9
# A step is halved until the centre of pressures comes nearer to its aim, down to this fraction.
_SHORTEST = 1.0 / 64.0


def gap(lower: Heights, upper: Heights | None = None, *, turned: str = "y") -> Gap:
    """Returns the gap of a surface and a plane, or of two facing surfaces.

    The undeformed distance is 0 at the point of first contact, and +inf at holes of either surface, which carry no pressure.

    Parameters
    ----------
    lower : Heights
        The heights of one surface, positive out of the material.
    upper : Heights, optional
        The heights of the other surface, measured in the same way from outside. None: a plane.
    turned : {"y", "x", ""}
        The axis about which the upper body is turned over to lie on the lower one. "": its array already has the layout of the lower one.
    """
    refuse_others(lower=lower, **({} if upper is None else {"upper": upper}))
    for one in (lower, upper):
        if one is not None:
            warn_of_fill_values(one, stacklevel=2)
    z, period, units = lower.z, lower.period, lower.units
    if upper is not None:
        if upper.z.shape != z.shape or not np.allclose((upper.dx, upper.dy), (lower.dx, lower.dy), rtol=1e-9, atol=0.0):
            sides = [f"{side.z.shape} elements of {side.dx} x {side.dy}" for side in (lower, upper)]
            raise ValueError(f"the surfaces have {sides[0]} and {sides[1]}; grids must be equal")
        if upper.period != period:
            raise ValueError(f"the periods are {period!r} and {upper.period!r}; they must be equal")
        if units and upper.units and not same_length(units[0], upper.units[0]):
            raise ValueError(f"the units are {units!r} and {upper.units!r}; heights must be in one unit of length")
        units = units or upper.units
        z = z + (upper.turned_over(turned) if turned else upper).z
    if np.isnan(z).all():
        raise ValueError("no element was measured on both surfaces")
    h = np.nanmax(z) - z
    h[np.isnan(h)] = np.inf
    return Gap(h, lower.dx, lower.dy, period=period, units=units)


def e_star(young_modulus: Both, poisson_ratio: Both) -> float:
    """Returns E* of two bodies: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (Johnson, Contact Mechanics, 1985, section 4.2).

    One value of an argument stands for both bodies. A Young's modulus of inf is that of a rigid body.
    """
    sum_of = 0.0
    for body in range(2):
        young, nu = (number(name, value if np.ndim(value) == 0 else two(name, value)[body])
                     for name, value in (("young_modulus", young_modulus), ("poisson_ratio", poisson_ratio)))
        if not young > 0.0 or not -1.0 <= nu <= 0.5:
            raise ValueError(f"young_modulus is {young} and poisson_ratio {nu}; they must be positive, and between -1 and 0.5")
        sum_of += (1.0 - nu**2) / young
    return 1.0 / sum_of if sum_of > 0.0 else float("inf")


@dataclass(frozen=True, eq=False)
class Balanced:
    """The result of `balance`. If `result.status` is not `OK`, the search was ended, and this is its last state.

    Attributes
    ----------
    gap : Gap
        The gap of the tilted body.
    tilt : (float, float)
        The slopes in x and y that were subtracted from the undeformed distance.
    result : Result
        The result of the solve of this gap.
    centre : (float, float)
        The centre of the pressures, in coordinates of the gap.
    """

    gap: Gap
    tilt: tuple[float, float]
    result: Result
    centre: tuple[float, float]


def _tilted(gap: Gap, tilt: Doubles) -> Gap:
    h = gap.h - tilt[0] * gap.x[None, :] - tilt[1] * gap.y[:, None]
    return dataclasses.replace(gap, h=h - h.min())


def _start(gap: Gap) -> Doubles:
    """The tilt with which the search begins: the slopes of the least-squares plane if the undeformed distance is mainly this plane, otherwise 0."""
    iy, ix = np.nonzero(np.isfinite(gap.h))
    if len(iy) < 3:
        return np.zeros(2)
    h, terms = gap.h[iy, ix], np.stack([gap.x[ix], gap.y[iy], np.ones(len(iy))], axis=1)
    plane = np.linalg.lstsq(terms, h, rcond=None)[0]
    return np.asarray(plane[:2] if 2.0 * np.ptp(h - terms @ plane) < np.ptp(h) else np.zeros(2))


def _centre(gap: Gap, result: Result) -> Doubles:
    """The centre of the pressures, in coordinates of the gap."""
    total = result.pressure.sum()
    # A solve that was ended at once has no pressures; its centre is NaN.
    weights = result.pressure / (total if total != 0.0 else np.nan)
    return np.array([weights.sum(axis=0) @ gap.x, weights.sum(axis=1) @ gap.y])


def _checked(gap: Gap, force: float, at: tuple[float, float], tolerance: float, scene: dict[str, Any]) -> Doubles:
    """Checks the arguments of `balance`, and returns the point at which the force acts."""
    if not isinstance(gap, Gap):
        raise TypeError(f"gap is a {type(gap).__name__}; it must be a Gap: surface.gap(heights)")
    if period := scene.get("period", gap.period):
        raise ValueError(f"the gap repeats itself in {period}: a body with a period cannot tilt")
    if number("force", force) == 0.0:
        raise ValueError("force is 0; a body that nothing presses takes no tilt")
    aim = np.array(two("at", at))
    if not np.isfinite(aim).all():
        raise ValueError(f"at is {at}; it must be finite")
    if not number("tolerance", tolerance) > 0.0:
        raise ValueError(f"tolerance is {tolerance}; it must be positive")
    return aim


def balance(gap: Gap, force: float, at: tuple[float, float] = (0.0, 0.0), tolerance: float = 1e-4, **scene: Any) -> Balanced:
    """Finds the tilt of a body that is free to tilt and that a force presses at a point: the moments of the pressures about this point are 0.

    The tilt depends on the load, unlike that of a least-squares plane, because a body rests on its summits. It minimises a convex energy and is therefore
    unique. It is found by Newton's method with Broyden's updates: in four to ten solves for smooth bodies, in some tens if few elements of a rough body carry
    the force. If the search from the tilt of the surface fails, it begins again from the tilt at which a rigid body would rest. The body is not tilted in a
    direction in which the elements with a surface have no extent, as across one row.

    Parameters
    ----------
    gap : Gap
        A gap without a period, because a periodic body cannot tilt.
    force : float
        Normal force; not 0.
    at : (float, float)
        The point at which the force acts, in coordinates of the gap.
    tolerance : float
        Tolerance of the centre of the pressures, relative to the length of the grid in each direction.
    **scene
        Elastic constants, effects and options of `contact_normal.solve`. `max_seconds` is the limit of all solves together.

    Returns
    -------
    Balanced
        The balanced state. If a solve was cancelled, or `max_seconds` is over, it is the state of the last solve, with the reason in `result.status`.

    Raises
    ------
    ValueError
        If no tilt balances the force, because `at` is not between elements that can carry it.
    """
    aim = _checked(gap, force, at, tolerance, scene)
    limit, last = TimeLimit(scene), list[Balanced]()

    def solved(tilt: Doubles) -> tuple[Result, Doubles]:
        if last and limit.leaves_none(last[-1].result, "before a tilt was found that balances the force"):
            raise _Ended(last[-1])
        result = _tilted(gap, tilt).solve(force=force, **{**scene, **limit.left})
        off = _centre(gap, result) - aim
        last[:] = [_balanced(gap, tilt, result, off + aim)]
        if limit.ended(result):
            raise _Ended(last[-1])
        return result, off

    try:
        found, is_balanced = _search(gap, aim, tolerance, solved, _start(gap), False)
        if not is_balanced and (tilt := resting(gap, aim)) is not None:
            found, is_balanced = _search(gap, aim, tolerance, solved, tilt, True)
    except _Ended as ended:
        return ended.so_far
    if not is_balanced:
        off = tuple((np.array(found.centre) - aim).tolist())
        raise ValueError(f"no tilt was found that brings the centre of the pressures to {tuple(aim.tolist())}: it stays {off} away; "
                         "are there elements all around it?")
    return found


class _Ended(Exception):
    """Ends a search because a solve was cancelled or no time is left. `so_far` is the state of the last solve."""

    def __init__(self, so_far: Balanced) -> None:
        super().__init__()
        self.so_far = so_far


def _balanced(gap: Gap, tilt: Doubles, result: Result, centre: Doubles) -> Balanced:
    (x, y), (along_x, along_y) = centre.tolist(), tilt.tolist()
    return Balanced(_tilted(gap, tilt), (along_x, along_y), result, (x, y))


def _search(gap: Gap, aim: Doubles, tolerance: float, solved: Callable[[Doubles], tuple[Result, Doubles]], tilt: Doubles, rests: bool) -> tuple[Balanced, bool]:
    """Searches the tilt whose pressures have their centre at `aim`, from a first `tilt` on. Returns the last state, and whether it is balanced.

    `solved` returns for a tilt the result, and the offset of its centre of pressures from `aim`. With `rests` a rigid body would rest at the first tilt; then
    the trial tilts are scaled by the approach, however small it is.
    """
    sizes = np.array([gap.h.shape[1] * gap.dx, gap.h.shape[0] * gap.dy])
    result, off = solved(tilt)
    begun = _tilted(gap, tilt).h
    least = 0.0 if rests and result.approach > 0.0 else 1e-3 * float(np.ptp(begun[np.isfinite(begun)]))
    trial = _TRIAL * max(result.approach, least) / sizes
    slopes, known = np.eye(2), np.isfinite(gap.h)
    # Trial tilts in x and y give the derivatives of the offset. If all elements are in one line along an axis, the other tilt cannot move the centre.
    for k in (k for k in range(2) if np.count_nonzero(known.any(axis=k)) > 1):
        step = np.where(np.arange(2) == k, trial * -np.sign(off + 1e-300), 0.0)
        slopes[:, k] = (solved(tilt + step)[1] - off) / step[k]
    for _ in range(_STEPS):
        if np.abs(off / sizes).max() <= tolerance:
            return _balanced(gap, tilt, result, off + aim), True
        # If all elements are in one line oblique to the grid, one combination of tilts has no effect; least squares ignores it. Lengths are relative to those
        # of the grid, so that the effect along its short side is not taken for round-off.
        relative = slopes / np.outer(sizes, sizes)
        unit = np.abs(relative).max()
        if not (np.isfinite(unit) and unit > 0.0):
            break
        step = -np.linalg.lstsq(relative / unit, off / sizes, rcond=_SINGULAR)[0] / sizes / unit
        if not (np.isfinite(step).all() and step.any()):
            break
        part = 1.0
        while True:
            moved, there = solved(tilt + part * step)
            if np.abs(there / sizes).max() < np.abs(off / sizes).max() or part < _SHORTEST:
                break
            part *= 0.5
        # A search from the tilt at which a rigid body rests goes on with the shortest step, because no other search follows it.
        if part < _SHORTEST and not rests:
            break
        step = part * step
        slopes += np.outer(there - off - slopes @ step, step) / (step @ step)
        tilt, result, off = tilt + step, moved, there
    return _balanced(gap, tilt, result, off + aim), False
