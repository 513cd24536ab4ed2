"""A track and a wheelset: where their profiles are, and how the wheelset stands on the track."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._arguments import number
from ._curve import Curve
from ._profile import Profile

if TYPE_CHECKING:
    from .._arguments import Doubles

# Rails are inclined by 1/20 or less, in rad: larger numbers are 40 for 1/40, or degrees.
_STEEPEST = 0.5


@dataclass(frozen=True)
class Position:
    """Where a wheelset stands. x forward, y to the right, z downwards; the origin is at the top of the rails in the middle of the track.

    Attributes
    ----------
    y : float
        Shift of the middle of the axle to the right, in mm.
    z : float or None
        How much lower the axle is than the nominal radius above the top of the rails, in mm. None: the wheelset is lowered until the wheel of
        interest touches.
    roll, yaw : float
        Angles about x (the right side moves down) and about z (the right side moves back), in rad. The wheelset is rolled first.
    """

    y: float = 0.0
    z: float | None = None
    roll: float = 0.0
    yaw: float = 0.0

    def __post_init__(self) -> None:
        for name in ("y", "roll", "yaw"):
            number(name, getattr(self, name))
        if self.z is not None:
            number("z", self.z)

    def seen_from(self, side: str) -> Position:
        """The same, mirrored for the left side, so that y grows outwards."""
        if side not in ("left", "right"):
            raise ValueError(f'side is {side!r}; it must be "left" or "right"')
        return self if side == "right" else Position(-self.y, self.z, -self.roll, -self.yaw)

    def rotation(self) -> Doubles:
        """Turns vectors of the wheelset into those of the track."""
        c, s = np.cos([self.roll, self.yaw]), np.sin([self.roll, self.yaw])
        roll = np.array([[1.0, 0.0, 0.0], [0.0, c[0], -s[0]], [0.0, s[0], c[0]]])
        yaw = np.array([[c[1], -s[1], 0.0], [s[1], c[1], 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(yaw @ roll)


@dataclass(frozen=True)
class Track:
    """Two equal rails.

    Attributes
    ----------
    rail : Profile
        Of the right rail.
    gauge : float
        Distance of the gauge points of both rails, in mm.
    gauge_height : float
        How far the gauge points are below the top of the rails, in mm.
    inclination : float
        Angle in rad by which the profile is still to be inclined towards the track, as 1/40. 0: the profile has its inclination.
    """

    rail: Profile
    gauge: float = 1435.0
    gauge_height: float = 14.0
    inclination: float = 0.0

    def __post_init__(self) -> None:
        _refuse_unless("rail", self.rail)
        width = float(np.ptp(self.rail.y))
        if not number("gauge", self.gauge) > width:
            raise ValueError(f"gauge is {self.gauge}; it must be larger than the rail is wide, {width:.4g} mm: lengths are in mm")
        if not abs(number("inclination", self.inclination)) <= _STEEPEST:
            raise ValueError(f"inclination is {self.inclination}; it is an angle in rad of at most {_STEEPEST}, as 1/40")
        if not number("gauge_height", self.gauge_height) >= 0.0:
            raise ValueError(f"gauge_height is {self.gauge_height}; it must not be negative: it is measured downwards from the top of the rail")

    def placed(self) -> Profile:
        """The right rail in its place: its top at z = 0, its gauge point at half of the gauge."""
        rail = self.rail.rotated(self.inclination)
        curve = rail.curve()
        rail = rail.moved(z=-float(curve.at(curve.between(20))[1].min()))
        top = int(np.argmin(rail.z))
        below = np.nonzero(rail.z[: top + 1] >= self.gauge_height)[0]
        if not len(below):
            raise ValueError(f"gauge_height is {self.gauge_height}; the rail ends {rail.z[:top + 1].max():.3g} mm below its top at this side")
        k = below[-1]
        part = (rail.z[k] - self.gauge_height) / (rail.z[k] - rail.z[k + 1])
        return rail.moved(y=0.5 * self.gauge - (rail.y[k] + part * (rail.y[k + 1] - rail.y[k])))


@dataclass(frozen=True)
class Wheelset:
    """Two equal wheels on an axle.

    Attributes
    ----------
    wheel : Profile
        Of the right wheel; its z is 0 where the radius is `radius`.
    radius : float
        Radius at z = 0 of the profile, in mm.
    flange_back : float
        Distance of the flange backs of both wheels, in mm.
    flange_back_at : float or None
        The profile's y of the flange back, in mm; None: its smallest y.
    """

    wheel: Profile
    radius: float = 460.0
    flange_back: float = 1360.0
    flange_back_at: float | None = None

    def __post_init__(self) -> None:
        _refuse_unless("wheel", self.wheel)
        above = float(np.ptp(self.wheel.z))
        if not number("radius", self.radius) > above:
            raise ValueError(f"radius is {self.radius}; it must be larger than the profile is high, {above:.4g} mm: lengths are in mm")
        width = float(np.ptp(self.wheel.y))
        if not number("flange_back", self.flange_back) > width:
            raise ValueError(f"flange_back is {self.flange_back}; it must be larger than the wheel is wide, {width:.4g} mm: lengths are in mm")

    @property
    def origin(self) -> float:
        """Distance of the profile's origin from the middle of the axle, in mm."""
        at = float(self.wheel.y.min()) if self.flange_back_at is None else self.flange_back_at
        return 0.5 * self.flange_back - at

    def tread(self) -> Curve:
        """The right wheel in its place: y from the middle of the axle, and z is the radius."""
        return self.wheel.moved(y=self.origin, z=self.radius).curve()


def _refuse_unless(kind: str, profile: Profile) -> None:
    """Refuses what is not a profile of this kind."""
    if not isinstance(profile, Profile):
        raise TypeError(f"{kind} is a {type(profile).__name__}; it must be a Profile, as profiles.read(...) returns it")
    if profile.kind != kind:
        raise ValueError(f'{kind} is a {profile.kind}; it must be a profile of kind "{kind}"')
