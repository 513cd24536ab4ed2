"""The place where a wheel touches a rail: angle, rolling radius, gap, creepages, forces."""

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

# Most steps of Newton's method for a distance along the normal. Each step doubles the digits. The start has an error by the curvature of the wheel only, so two
# or three steps suffice in most cases. A step of less than _TIGHT of the radius is the last one.
_STEPS, _TIGHT = 8, 1e-13
# Places that are computed at a time: some megabytes.
_BLOCK = 1 << 16
# A grid is made for _RESERVE times the approach, and made again if it was made for more than _LOOSE times the approach.
_LOOSE, _RESERVE = 1.5, 1.1
# A larger approach, relative to the rolling radius, shows mixed units.
_DEEPEST = 0.05
# A grid that cannot carry the force is made again for an approach that is larger by this factor.
_DEEPER = 4.0
# The grid of a patch has at most this many elements on each side of the contact point; the first one that is tried.
_FARTHEST = 1024
_LEAST = 8


class _Late(Exception):
    """No time is left."""


@dataclass(frozen=True, eq=False)
class Pair:
    """A rail and a wheel in their places, mirrored for the left side: y outwards, z downwards."""

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
    """Where a wheel touches a rail.

    The patch has coordinates of its own, whose origin is this point: x forward along the rail, y along the surface of the rail towards the field
    side, and the normal from the rail into the wheel. The wheel is body 1, the rail body 2.
    """

    _pair: Pair
    _x: float
    _on_rail: float
    _on_wheel: float
    # Clearance, y and z of the other places where the wheel is close to the rail.
    _others: tuple[tuple[float, float, float], ...]
    clearance: float
    """Vertical distance of both surfaces here, in mm. It is 0 if they touch, and negative if the position lets them overlap."""

    def __repr__(self) -> str:
        x, y, z = self.place
        return (f"<ContactPoint of the {self._pair.side} wheel: place ({x:.4g}, {y:.6g}, {z:.4g}) mm, angle {self.angle:.4g} rad, "
                f"rolling radius {self.rolling_radius:.6g} mm, clearance {self.clearance:.2g} mm>")

    @property
    def place(self) -> tuple[float, float, float]:
        """x forward, y to the right, z downwards, in mm, from the top of the rails in the middle of the track; on the rail."""
        y, z, _, _ = (float(value) for value in self._pair.rail.at(self._on_rail))
        return self._x, (y if self._pair.side == "right" else -y), z

    @property
    def position(self) -> Position:
        """Where the wheelset stands, with the height that was found."""
        seen = self._pair.position
        return seen if self._pair.side == "right" else Position(-seen.y, seen.z, -seen.roll, -seen.yaw)

    @property
    def angle(self) -> float:
        """The contact angle in rad, by which the surface of the rail rises towards the field side. At the flange it is large and positive."""
        _, _, dy, dz = self._pair.rail.at(self._on_rail)
        return float(np.arctan2(-dz, dy))

    @property
    def rolling_radius(self) -> float:
        """Distance of the point of the wheel from the axle, in mm."""
        return float(self._pair.tread.at(self._on_wheel)[1])

    def _axes(self) -> Doubles:
        """The unit vectors of the patch, in coordinates of the track that are mirrored for the left side: x, y, normal."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, -s, -c]])

    def distance(self, x: Any, y: Any) -> Doubles:
        """The undeformed distance along the normal at places of the patch, in mm: positive where the wheel is above the rail, inf beside one of them.

        Parameters
        ----------
        x, y : array_like, (mx,) and (my,)
            Places in coordinates of the patch, in mm.

        Returns
        -------
        ndarray, (my, mx)
        """
        return self._distance(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64), lambda: False)

    def _distance(self, x: Doubles, y: Doubles, is_over: Callable[[], bool]) -> Doubles:
        """The same; raises _Late between two blocks of rows once no time is left."""
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
        """The n at which origin + x ex + y ey + n normal lies on the wheel's surface, whose distance from the axle is the radius there."""
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
        """The undeformed distance on a grid of elements of dx by dy, in mm, as large as a contact with an approach of `depth` can need.

        Pressures >= 0 displace by u >= 0, so h - approach + u = 0 needs h <= approach: an element whose distance exceeds the least one by more than
        `depth` cannot touch. The grid has one row and one column of such elements on each side. The contact point is the centre of an element.
        """
        return self._gap(dx, dy, depth, lambda: False)

    def _gap(self, dx: float, dy: float, depth: float, is_over: Callable[[], bool]) -> Gap:
        """The same; raises _Late once no time is left."""
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
            # Both axes first: they show most grids that are too small.
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
        """Presses wheel and rail together by a force along the normal: the gap, on a grid as large as needed, and the result.

        Parameters
        ----------
        force : float
            Normal force, in N.
        dx, dy : float
            Element sizes, in mm.
        depth : float
            First guess of the approach, in mm. The grid is made anew until `depth` is 1 to 1.5 times the approach that is found.
            A warning tells if the wheel would also touch at another place, which is not in the grid, and if the points of the profiles are too few or
            too noisy to tell the pressures to 5 %.
        friction : dict, optional
            As that of `contact_normal.solve`. Its spin is about the contact point.
        **scene
            Elastic constants, effects and options of `contact_normal.solve`. `max_seconds` is the limit of all grids and solves together, except
            that the first grid is always finished. The solve of friction is the last one. A solve that is cancelled, or ended by this limit, is the
            result, and no other one follows. If no time is left for the next solve, the one before is the result. Its `status` is then
            `ITERATION_LIMIT`, and its `message` says what is missing.
        """
        may_shrink, limit = True, TimeLimit(scene)
        gap = self.gap(dx, dy, depth)
        while True:
            try:
                result = gap.solve(force=force, **{**scene, **limit.left})
            except ContactNormalError as error:
                # With a pressure_limit the elements of a grid that is too small cannot carry the force.
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
                # Once is enough: a smaller grid may lack a second patch that carried a part of the force.
                if not may_shrink or not depth > _LOOSE * approach > 0.0:
                    break
                may_shrink = False
            # A grid that is too small finds a larger approach than there is.
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
        """Creepages xi, eta and the spin phi at this point: the velocity of the wheel relative to the rail over `speed`.

        xi is along x of the patch, eta along y, and phi in rad/mm turns x towards y, as `friction` of `contact_normal.solve` takes them for
        `STEADY_ROLLING`: `dict(creepage=(xi, eta), spin=phi)`.

        Parameters
        ----------
        speed : float
            Forward speed of the wheelset, in mm/s.
        pitch_rate : float, optional
            Rate of rotation about the axle, in rad/s, positive; by default that of pure rolling on the nominal radius.
        yaw_rate, roll_rate : float
            Rates of the angles of the position, in rad/s.
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
        # z is downwards: a wheel that rolls forward turns from z to x, backwards about y.
        spin = -rate * turned[:, 1] + sign * (number("roll_rate", roll_rate) * ahead + number("yaw_rate", yaw_rate) * np.array([0.0, 0.0, 1.0]))
        axle_speed = np.array([speed, sign * number("lateral_speed", lateral_speed), number("vertical_speed", vertical_speed)])
        place = np.array([self._x, *(float(value) for value in pair.rail.at(self._on_rail)[:2])])
        slip = axle_speed + np.cross(spin, place - pair.axle())
        xi, eta, phi = float(slip @ ex / speed), float(slip @ ey / speed), float(spin @ np.cross(ex, ey) / speed)
        if max(abs(xi), abs(eta)) > 1.0:
            warnings.warn(f"the creepages are {xi:.3g} and {eta:.3g}, parts of the speed: speeds are in mm/s and rates in rad/s", stacklevel=2)
        return xi, eta, phi

    def force_on_wheel(self, result: Result) -> tuple[float, float, float]:
        """The force of a result on the wheel, in N: forward, to the right, downwards."""
        if isinstance(result, tuple):
            raise TypeError("result is a tuple; it must be a Result, the second one of what press(...) returns: gap, result = point.press(...)")
        x, y = result.tangential_force
        found = np.array([x, y, result.force]) @ self._axes()
        return float(found[0]), float(found[1] if self._pair.side == "right" else -found[1]), float(found[2])
