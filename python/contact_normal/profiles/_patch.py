"""The class `ContactPoint`: the place where a wheel touches a rail, with its angle, rolling radius, gap, creepages and forces."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import number
from .._constants import INFEASIBLE
from .._gap import Gap
from .._library import ContactNormalError
from .._time_limit import TimeLimit
from . import _sampling
from ._bodies import Position
from ._curve import Curve

if TYPE_CHECKING:
    from .._arguments import Doubles
    from .._result import Result

# The largest number of steps of Newton's method for a distance along the normal. Each step doubles the number of correct digits. The start has an error only by
# the curvature of the wheel, so that two or three steps suffice in most cases. The last step is one of less than _TIGHT times the radius.
_STEPS, _TIGHT = 8, 1e-13
# The number of places whose distances are computed at a time. Arrays for them have some megabytes.
_BLOCK = 1 << 16
# A grid is made for an approach of _RESERVE times the last one. A grid that was made for more than _LOOSE times the approach is made again, smaller.
_LOOSE, _RESERVE = 1.5, 1.1
# An approach of more than this part of the rolling radius shows mixed units.
_DEEPEST = 0.05
# If the elements of a grid cannot carry the force, the grid is made again for an approach that is larger by this factor.
_DEEPER = 4.0
# The number of elements of a grid on each side of the contact point: at most _FARTHEST, and at first _LEAST.
_FARTHEST = 1024
_LEAST = 8


class _Late(Exception):
    """Raised while a grid is computed if no time is left."""


@dataclass(frozen=True, eq=False)
class Pair:
    """A rail and a wheel in their positions, mirrored for the left side, so that y grows outwards. z is downwards.

    `tread` is the curve of the wheel in coordinates of the wheelset, and `radius` its nominal radius.
    """

    rail: Curve
    tread: Curve
    radius: float
    position: Position
    side: str

    def axle(self) -> Doubles:
        """The middle of the axle, in coordinates of the track."""
        assert self.position.z is not None
        return np.array([0.0, self.position.y, self.position.z - self.radius])


@dataclass(frozen=True, eq=False)
class ContactPoint:
    """A point at which a wheel touches a rail, or comes close to it.

    The contact patch has coordinates whose origin is this point: x is forward along the rail, y along the surface of the rail towards the field side, and the
    normal points from the rail into the wheel. The wheel is body 1, the rail body 2.
    """

    _pair: Pair
    _x: float
    _on_rail: float
    _on_wheel: float
    # The clearance, y and z of the other local minima of the clearance.
    _others: tuple[tuple[float, float, float], ...]
    clearance: float
    """Vertical distance of both surfaces at this point, in mm. It is 0 if they touch, and negative if they overlap in the given position."""

    def __repr__(self) -> str:
        x, y, z = self.place
        return (f"<ContactPoint of the {self._pair.side} wheel: place ({x:.4g}, {y:.6g}, {z:.4g}) mm, angle {self.angle:.4g} rad, "
                f"rolling radius {self.rolling_radius:.6g} mm, clearance {self.clearance:.2g} mm>")

    @property
    def place(self) -> tuple[float, float, float]:
        """The coordinates of this point on the rail, in mm: x forward, y to the right, z downwards, from the middle of the track at the top of the rails."""
        y, z, _, _ = (float(value) for value in self._pair.rail.at(self._on_rail))
        return self._x, (y if self._pair.side == "right" else -y), z

    @property
    def position(self) -> Position:
        """The position of the wheelset, with the height that was found."""
        seen = self._pair.position
        return seen if self._pair.side == "right" else Position(-seen.y, seen.z, -seen.roll, -seen.yaw)

    @property
    def angle(self) -> float:
        """The contact angle in rad: the angle by which the surface of the rail rises towards the field side. At the flange it is large and positive."""
        _, _, dy, dz = self._pair.rail.at(self._on_rail)
        return float(np.arctan2(-dz, dy))

    @property
    def rolling_radius(self) -> float:
        """Distance of this point on the wheel from the axle, in mm."""
        return float(self._pair.tread.at(self._on_wheel)[1])

    def _axes(self) -> Doubles:
        """The unit vectors x, y and normal of the patch as rows, in coordinates of the track, which are mirrored for the left side."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, -s, -c]])

    def distance(self, x: Any, y: Any) -> Doubles:
        """Computes the undeformed distance along the normal at places of the patch, in mm.

        It is positive where the wheel is above the rail, and inf beside the rail or the wheel.

        Parameters
        ----------
        x, y : array_like, (mx,) and (my,)
            Coordinates of the places in the patch, in mm.

        Returns
        -------
        ndarray, (my, mx)
        """
        return self._distance(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64), lambda: False)

    def _distance(self, x: Doubles, y: Doubles, is_over: Callable[[], bool]) -> Doubles:
        """Computes `distance`; raises `_Late` between two blocks of rows if `is_over()`."""
        pair, (_, ey, normal) = self._pair, self._axes()
        origin = np.array([self._x, *(float(value) for value in pair.rail.at(self._on_rail)[:2])])
        # The rail is uniform along x.
        along = (ey[1], ey[2])
        on_rail = pair.rail.where(y + along[0] * origin[1] + along[1] * origin[2], along, self._on_rail)
        rail_y, rail_z, _, _ = pair.rail.at(np.where(np.isnan(on_rail), 0.0, on_rail))
        rail = (rail_y - origin[1]) * normal[1] + (rail_z - origin[2]) * normal[2]
        found, count = np.empty((len(y), len(x))), max(1, _BLOCK // max(len(x), 1))
        for rows in (slice(first, first + count) for first in range(0, len(y), count)):
            if is_over():
                raise _Late
            found[rows] = self._to_wheel(origin - pair.axle(), x, y[rows]) - rail[rows, None]
        found[np.isnan(on_rail), :] = np.inf
        return found

    def _to_wheel(self, origin: Doubles, x: Doubles, y: Doubles) -> Doubles:
        """The distance n along the normal at which origin + x ex + y ey + n normal lies on the surface of the wheel, by Newton's method; inf beside the wheel.

        `origin` is the origin of the patch relative to the middle of the axle. On the surface the distance from the axle equals the radius of the wheel there.
        """
        pair, (ex, ey, normal) = self._pair, self._axes()
        turned = pair.position.rotation()
        base = (origin + x[None, :, None] * ex + y[:, None, None] * ey) @ turned
        step = normal @ turned
        n = np.zeros(base.shape[:2])
        for _ in range(_STEPS):
            at = base + n[:, :, None] * step
            on_wheel = pair.tread.where(at[:, :, 1], near=self._on_wheel)
            _, radius, dy, dz = pair.tread.at(np.where(np.isnan(on_wheel), self._on_wheel, on_wheel))
            from_axle = np.hypot(at[:, :, 0], at[:, :, 2])
            slope = (at[:, :, 0] * step[0] + at[:, :, 2] * step[2]) / from_axle - dz / dy * step[1]
            change = (from_axle - radius) / slope
            n -= change
            if not (np.abs(change) > _TIGHT * pair.radius).any(where=~np.isnan(on_wheel)):
                break
        n[np.isnan(on_wheel)] = np.inf
        return n

    def gap(self, dx: float, dy: float, depth: float) -> Gap:
        """Returns the undeformed distance on a grid that is large enough for any contact with an approach of `depth`. Lengths are in mm.

        The elements are dx by dy large, and the contact point is the centre of one of them. Pressures >= 0 cause displacements u >= 0, so that contact,
        h - approach + u = 0, requires h <= approach. Therefore an element whose distance exceeds the least one by more than `depth` cannot touch. The grid has
        one row and one column of such elements on each side.
        """
        return self._gap(dx, dy, depth, lambda: False)

    def _gap(self, dx: float, dy: float, depth: float, is_over: Callable[[], bool]) -> Gap:
        """Computes `gap`; raises `_Late` if `is_over()`."""
        dx, dy, depth = number("dx", dx), number("dy", dy), number("depth", depth)
        for name, value in (("dx", dx), ("dy", dy), ("depth", depth)):
            if not 0.0 < value < np.inf:
                raise ValueError(f"{name} is {value}; it must be positive and finite")
        reach = _LEAST
        while True:
            if reach > _FARTHEST:
                raise ValueError(f"depth is {depth}: the grid would need more than {2 * _FARTHEST} elements of {dx} x {dy} in a direction")
            k = np.arange(-reach, reach + 1)
            x, y = np.asarray(k * dx, dtype=np.float64), np.asarray(k * dy, dtype=np.float64)
            # The distances along both axes are computed first, because they show most grids that are too small.
            ahead, aside = self._distance(x, np.zeros(1), is_over)[0], self._distance(np.zeros(1), y, is_over)[:, 0]
            if min(ahead[0], ahead[-1], aside[0], aside[-1]) >= min(ahead.min(), aside.min()) + depth:
                h = self._distance(x, y, is_over)
                is_near = h < h.min() + depth
                if not (is_near[[0, -1]].any() or is_near[:, [0, -1]].any()):
                    break
            reach *= 2
        rows, columns = (slice(near[0] - 1, near[-1] + 2) for near in (np.nonzero(is_near.any(axis=axis))[0] for axis in (1, 0)))
        middle = (float(k[columns][[0, -1]].mean()) * dx, float(k[rows][[0, -1]].mean()) * dy)
        return Gap(np.ascontiguousarray(h[rows, columns]), dx, dy, middle, units=("mm", "N"))

    def press(
        self, force: float, dx: float, dy: float, *, depth: float = 0.01, friction: dict[str, Any] | None = None, **scene: Any
    ) -> tuple[Gap, Result]:
        """Presses wheel and rail together by a force along the normal. Returns the gap, on a grid as large as needed, and the result.

        There is a warning if the wheel would also touch at another place, which is not in the grid, and another one if the points of the profiles are too few
        or too noisy to determine the pressures to 5 %.

        Parameters
        ----------
        force : float
            Normal force, in N.
        dx, dy : float
            Element sizes, in mm.
        depth : float
            First guess of the approach, in mm. The grid is made again until it is made for 1 to 1.5 times the approach that is found.
        friction : dict, optional
            As that of `contact_normal.solve`. By default the spin turns about the contact point. The problem with friction is solved last.
        **scene
            Elastic constants, effects and options of `contact_normal.solve`. `max_seconds` limits the time of all grids and solves together; only the first
            grid is always finished. A solve that is cancelled, or ended by this limit, is the result, and no other one follows. If no time is left for the next
            solve, the last result is returned, with the `status` `ITERATION_LIMIT` and a `message` on what is missing.
        """
        may_shrink, limit = True, TimeLimit(scene)
        gap = self.gap(dx, dy, depth)
        while True:
            try:
                result = gap.solve(force=force, **{**scene, **limit.left})
            except ContactNormalError as error:
                # With a pressure_limit the force may be too large for the elements of a grid that is too small.
                deeper = _DEEPER * depth
                if error.status != INFEASIBLE or "pressure_limit" not in scene or deeper > _DEEPEST * self.rolling_radius:
                    raise
                try:
                    gap, depth = self._gap(dx, dy, deeper, limit.is_over), deeper
                except (_Late, ValueError):
                    raise error from None
                continue
            if limit.ended(result):
                return gap, result
            approach = result.approach - float(gap.h.min())
            if approach > _DEEPEST * self.rolling_radius:
                raise ValueError(f"wheel and rail approach by {approach:.3g} mm, more than {_DEEPEST:g} of the rolling radius: "
                                 "forces are in N, moduli in N/mm2")
            if not approach > depth:
                # A grid is made smaller only once, because a smaller grid may lack a second patch that carries a part of the force.
                if not may_shrink or not depth > _LOOSE * approach > 0.0:
                    break
                may_shrink = False
            # On a grid that is too small the approach is too large, so that a grid for this approach is large enough.
            try:
                anew = self._gap(dx, dy, _RESERVE * approach, limit.is_over)
            except _Late:
                anew = gap
            if limit.leaves_none(result, f"on a grid for an approach of {depth:.3g} mm; the approach is {approach:.3g} mm"):
                return gap, result
            gap, depth = anew, _RESERVE * approach
        self._warn_of_others(gap, approach)
        bodies = _sampling.Body("rail", self._pair.rail, self._on_rail), _sampling.Body("wheel", self._pair.tread, self._on_wheel)
        _sampling.warn(bodies, gap.y, result, stacklevel=2)
        if friction is not None and not limit.leaves_none(result, "before friction was solved"):
            centre = (-gap.middle[0], -gap.middle[1])
            result = gap.solve(force=force, friction={"spin_centre": centre, **friction}, **{**scene, **limit.left})
        return gap, result

    def _warn_of_others(self, gap: Gap, approach: float) -> None:
        """Warns if the wheel would also touch at another place, which is not in the grid."""
        (_, ey, _), (y0, z0) = self._axes(), (float(value) for value in self._pair.rail.at(self._on_rail)[:2])
        for clearance, y, z in self._others:
            along = (y - y0) * ey[1] + (z - z0) * ey[2]
            if clearance - self.clearance < approach and not gap.y[0] <= along <= gap.y[-1]:
                warnings.warn(f"the wheel also touches the rail {along:.1f} mm beside this patch, where it is {clearance - self.clearance:.3g} mm "
                              f"farther off and the approach is {approach:.3g} mm: a part of the force is carried there", stacklevel=3)

    def creepages(
        self, speed: float, *, pitch_rate: float | None = None, yaw_rate: float = 0.0, roll_rate: float = 0.0,
        lateral_speed: float = 0.0, vertical_speed: float = 0.0,
    ) -> tuple[float, float, float]:
        """Computes the creepages xi, eta and the spin phi at this point: the velocity of the wheel relative to the rail, divided by `speed`.

        xi is along x of the patch, eta along y, and phi, in rad/mm, turns x towards y. They can be used as `friction` of `contact_normal.solve` for
        `STEADY_ROLLING`: `dict(creepage=(xi, eta), spin=phi)`.

        Parameters
        ----------
        speed : float
            Forward speed of the wheelset, in mm/s.
        pitch_rate : float, optional
            Rate of rotation about the axle, in rad/s, positive for forward rolling; by default that of pure rolling on the nominal radius.
        yaw_rate, roll_rate : float
            Rates of change of the yaw and the roll of the position, in rad/s.
        lateral_speed, vertical_speed : float
            Speeds of the middle of the axle to the right and downwards, in mm/s.
        """
        if not number("speed", speed) > 0.0:
            raise ValueError(f"speed is {speed}; it must be positive")
        pair, (ex, ey, _) = self._pair, self._axes()
        sign = 1.0 if pair.side == "right" else -1.0
        turned, seen = pair.position.rotation(), pair.position
        ahead = np.array([np.cos(seen.yaw), np.sin(seen.yaw), 0.0])
        rate = speed / pair.radius if pitch_rate is None else number("pitch_rate", pitch_rate)
        # z is downwards, so a wheel that rolls forward turns about y in the negative direction.
        spin = -rate * turned[:, 1] + sign * (number("roll_rate", roll_rate) * ahead + number("yaw_rate", yaw_rate) * np.array([0.0, 0.0, 1.0]))
        axle_speed = np.array([speed, sign * number("lateral_speed", lateral_speed), number("vertical_speed", vertical_speed)])
        place = np.array([self._x, *(float(value) for value in pair.rail.at(self._on_rail)[:2])])
        slip = axle_speed + np.cross(spin, place - pair.axle())
        xi, eta, phi = float(slip @ ex / speed), float(slip @ ey / speed), float(spin @ np.cross(ex, ey) / speed)
        if max(abs(xi), abs(eta)) > 1.0:
            warnings.warn(f"the creepages are {xi:.3g} and {eta:.3g}, parts of the speed: speeds are in mm/s and rates in rad/s", stacklevel=2)
        return xi, eta, phi

    def force_on_wheel(self, result: Result) -> tuple[float, float, float]:
        """The components of the contact force of a result on the wheel, in N: forward, to the right, downwards."""
        if isinstance(result, tuple):
            raise TypeError("result is a tuple; it must be a Result, the second one of what press(...) returns: gap, result = point.press(...)")
        x, y = result.tangential_force
        found = np.array([x, y, result.force]) @ self._axes()
        return float(found[0]), float(found[1] if self._pair.side == "right" else -found[1]), float(found[2])
