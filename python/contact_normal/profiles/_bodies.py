"""The classes `Track`, `Wheelset` and `Position`: where the profiles of rails and wheels are, and how the wheelset stands on the track."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._arguments import number
from ._curve import Curve
from ._profile import Profile

if TYPE_CHECKING:
    from .._arguments import Doubles

# The largest angle in rad. Rails are inclined by at most 1/20, and wheelsets yaw less. A larger number is a mistake, as 40 for 1/40, or an angle in degrees.
_STEEPEST = 0.5

# All lengths are in mm, and all of one scale, which may be that of a model. Ratios of lengths outside these ranges show mixed units: in one unit, for example,
# a gauge is 6 to 20 times the width of a rail.
_GAUGE_OVER_RAIL = 3.5, 100.0
_BACKS_OVER_WHEEL = (2.0, 80.0)
_RADIUS_OVER_WHEEL = 0.8
_HEIGHT_OVER_GAUGE = 0.002
# Both sides of a rail's head are compared at depths from _SIDES[0] to _SIDES[1] below its top, in mm. A rail that leans to the field side by more than _LEANS,
# in rad, is probably mirrored.
_SIDES, _LEANS = (16.0, 32.0), 0.012
# The largest distance of the tread from z = 0, in mm, and that of the flange back from the smallest y of a profile: _BACK with a flange, _BACK_OF_TREAD
# without.
_TREAD = 20.0
_BACK, _BACK_OF_TREAD = 40.0, 120.0

# From its tip to its back a flange falls by more than _FALLS of its height. The radius of a wheel is measured _TAPE mm from the back, where |z| is at most
# _OFF_TAPE mm because wear is less. This is checked for wheels whose flange is _FULL mm high (least, largest).
_FALLS, _TAPE, _OFF_TAPE, _FULL = 0.2, 70.0, 6.0, (20.0, 45.0)
# Wheels that are narrower than this, in mm, are those of models.
_WHOLE = 40.0
# The height of a rail, or of its head, is less than this multiple of its width.
_SLENDER = 1.8

# Flanges are measured at _FACE times the radius below the tread, 10 mm for a radius of 460 mm. The play of a wheelset in the track is some mm, and less than
# _PLAY times the gauge.
_FACE, _PLAY = 10.0 / 460.0, 0.05

_UNITS = "lengths are in mm, those of profiles, gauges and radii; profiles.read takes scale=, as 25.4 for a file in inches"


@dataclass(frozen=True)
class Position:
    """The position of a wheelset on a track. x is forward, y to the right, z downwards; the origin is in the middle of the track, at the top of the rails.

    Attributes
    ----------
    y : float
        Shift of the middle of the axle to the right, in mm.
    z : float or None
        Distance in mm by which the axle is lower than its nominal height, which is one radius above the top of the rails. None: the wheelset is lowered until
        the wheel of interest touches its rail.
    roll, yaw : float
        Angles in rad about x (a positive roll moves the right side down) and about z (a positive yaw moves the right side back). The roll is applied first.
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
        for name in ("roll", "yaw"):
            if not abs(getattr(self, name)) <= _STEEPEST:
                raise ValueError(f"{name} is {getattr(self, name)}; it is an angle in rad of at most {_STEEPEST}")

    def seen_from(self, side: str) -> Position:
        """This position for the right side, its mirror image for the left side. So y grows outwards in both cases."""
        if side not in ("left", "right"):
            raise ValueError(f'side is {side!r}; it must be "left" or "right"')
        return self if side == "right" else Position(-self.y, self.z, -self.roll, -self.yaw)

    def rotation(self) -> Doubles:
        """The matrix that converts the components of a vector along the axes of the wheelset to those along the axes of the track."""
        c, s = np.cos([self.roll, self.yaw]), np.sin([self.roll, self.yaw])
        roll = np.array([[1.0, 0.0, 0.0], [0.0, c[0], -s[0]], [0.0, s[0], c[0]]])
        yaw = np.array([[c[1], -s[1], 0.0], [s[1], c[1], 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(yaw @ roll)


@dataclass(frozen=True)
class Track:
    """A track of two equal rails.

    Attributes
    ----------
    rail : Profile
        The profile of the right rail.
    gauge : float
        Distance between the gauge points of both rails, in mm.
    gauge_height : float
        How far the gauge points are below the top of the rails, in mm.
    inclination : float
        Angle in rad by which the profile is rotated towards the middle of the track, for example 1/40. 0: the profile is already drawn inclined.
    """

    rail: Profile
    gauge: float = 1435.0
    gauge_height: float = 14.0
    inclination: float = 0.0

    def __post_init__(self) -> None:
        _refuse_unless("rail", self.rail)
        width = float(np.ptp(self.rail.y))
        least, most = _GAUGE_OVER_RAIL
        if not least * width < number("gauge", self.gauge) < most * width:
            raise ValueError(f"gauge is {self.gauge}; it must be {least} to {most:g} times as large as the rail is wide, {width:.4g}: {_UNITS}")
        if not abs(number("inclination", self.inclination)) <= _STEEPEST:
            raise ValueError(f"inclination is {self.inclination}; it is an angle in rad of at most {_STEEPEST}, as 1/40")
        if not number("gauge_height", self.gauge_height) > 0.0:
            raise ValueError(f"gauge_height is {self.gauge_height}; it must be positive: it is measured downwards from the top of the rail")
        if self.gauge_height < _HEIGHT_OVER_GAUGE * self.gauge:
            raise ValueError(f"gauge_height is {self.gauge_height}; beside a gauge of {self.gauge} it must be at least {_HEIGHT_OVER_GAUGE * self.gauge:.2g}, "
                             f"as 14 mm: {_UNITS}")

        if (height := float(np.ptp(self.rail.z))) > _SLENDER * width:
            warnings.warn(f"the rail is {height:.4g} high and {width:.4g} wide: are y and z in one unit? {_UNITS}", stacklevel=3)
        drawn = _lean(self.rail)
        lean = drawn + self.inclination
        if lean < -_LEANS:
            warnings.warn(f"the rail leans to the field side by {-lean:.2g} rad: one that is inclined leans to the track. mirror=True turns a profile that is drawn "
                          "from the other side; inclination is positive", stacklevel=3)
        elif min(drawn, self.inclination) > _LEANS:
            warnings.warn(f"the profile of the rail leans to the track by {drawn:.2g} rad, and inclination={self.inclination:.2g} is added: leave it out if the profile "
                          "has its inclination", stacklevel=3)

    def placed(self) -> Profile:
        """The profile of the right rail in coordinates of the track: the top is at z = 0, and the gauge point at half of the gauge."""
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


def _lean(rail: Profile) -> float:
    """The angle in rad by which a rail leans towards the middle of the track; 0 if the profile lacks a side of the head.

    It is the slope over the depth of the middle between both sides of the head.
    """
    top = int(np.argmin(rail.z))
    sides = (rail.y[: top + 1][::-1], rail.z[: top + 1][::-1]), (rail.y[top:], rail.z[top:])
    deepest = min(float(z.max()) for _, z in sides) - float(rail.z[top])
    depths = np.linspace(_SIDES[0], min(deepest, _SIDES[1]), 20)
    if deepest < sum(_SIDES) / 2.0 or any((np.diff(z) < 0.0).any() for _, z in sides):
        return 0.0
    inner, outer = (np.interp(depths + rail.z[top], z, y) for y, z in sides)
    return float(np.polyfit(depths, 0.5 * (inner + outer), 1)[0])


@dataclass(frozen=True)
class Wheelset:
    """A wheelset of two equal wheels on an axle.

    Attributes
    ----------
    wheel : Profile
        The profile of the right wheel. Its z is 0 where the radius of the wheel is `radius`.
    radius : float
        Radius of the wheel at z = 0 of the profile, in mm.
    flange_back : float
        Distance between the flange backs of both wheels, in mm.
    flange_back_at : float or None
        The y of the flange back in the profile, in mm; None: the smallest y of the profile.
    """

    wheel: Profile
    radius: float = 460.0
    flange_back: float = 1360.0
    flange_back_at: float | None = None

    def __post_init__(self) -> None:
        _refuse_unless("wheel", self.wheel)
        number("radius", self.radius)
        number("flange_back", self.flange_back)
        width, low, high = float(np.ptp(self.wheel.y)), *_BACKS_OVER_WHEEL
        if not max(_RADIUS_OVER_WHEEL * width, float(np.ptp(self.wheel.z))) < self.radius:
            raise ValueError(f"radius is {self.radius}; it must be larger than {_RADIUS_OVER_WHEEL} times the width of the wheel, {width:.4g}, and than its "
                             f"height: {_UNITS}")
        if not low * width < self.flange_back < high * width:
            raise ValueError(f"flange_back is {self.flange_back}; it must be {low:g} to {high:g} times as large as the wheel is wide, {width:.4g}: {_UNITS}")
        tread = self.wheel.z[self.wheel.y >= 0.5 * (self.wheel.y[0] + self.wheel.y[-1])]
        if tread.min() > _TREAD or tread.max() < -_TREAD:
            raise ValueError(f"the tread of the wheel has z = {tread.min():.4g} to {tread.max():.4g}, and radius is that at z = 0: wheel.moved(z=...) puts the "
                             "origin on the tread")
        self._check_back()
        self._warn_of_back()
        self._warn_of_origin()

    def _warn_of_back(self) -> None:
        """Warns if the smallest y of the profile is taken for the flange back, but seems to be another point."""
        if self.flange_back_at is not None:
            return
        tip, end = float(self.wheel.z.max()), float(self.wheel.z[0])
        if np.ptp(self.wheel.y) < _WHOLE:
            return
        if not self.wheel.has_flange():
            told = "has no flange"
        elif tip - end < _FALLS * (tip - float(np.median(self.wheel.z))):
            told = f"ends on the tip of its flange, at z = {end:.4g} of {tip:.4g}"
        else:
            return
        warnings.warn(f"the profile of the wheel {told}, and its smallest y, {self.wheel.y[0]:.4g}, is taken for the flange back: give flange_back_at, the y of the "
                      "back. Profiles are in mm", stacklevel=4)

    def _warn_of_origin(self) -> None:
        """Warns if the tread is far from z = 0, so that `radius` is not the radius of the tread."""
        at = (float(self.wheel.y[0]) if self.flange_back_at is None else self.flange_back_at) + _TAPE
        if not (self.wheel.y[0] < at < self.wheel.y[-1] and self.wheel.has_flange()):
            return
        tread = float(np.interp(at, self.wheel.y, self.wheel.z))
        if _FULL[0] <= float(self.wheel.z.max()) - tread <= _FULL[1] and abs(tread) > _OFF_TAPE:
            warnings.warn(f"the tread of the wheel, {_TAPE:g} mm from the back, has z = {tread:.4g}, and radius is that at z = 0: the wheel has {self.radius + tread:.4g} mm there. "
                          "wheel.moved(z=...) puts the origin on the tread", stacklevel=4)

    def _check_back(self) -> None:
        """Raises an error if the given flange back is far from the smallest y of the profile."""
        if self.flange_back_at is None:
            return
        at, end = number("flange_back_at", self.flange_back_at), float(self.wheel.y.min())
        farthest = _BACK if self.wheel.has_flange() else _BACK_OF_TREAD
        if not end - farthest <= at <= end + _BACK:
            raise ValueError(f"flange_back_at is {at:g}; it is the y of the back in the profile, whose smallest y is {end:.4g}: {_UNITS}")

    def across_flanges(self) -> float | None:
        """Distance between the outer faces of both flanges, a little below the tread, in mm; None without flanges."""
        tip = int(np.argmax(self.wheel.z))
        behind = np.flatnonzero(self.wheel.z[tip:] < _FACE * self.radius)
        if not self.wheel.has_flange() or not len(behind):
            return None
        return 2.0 * (self.origin + float(self.wheel.y[tip + behind[0]]))

    @property
    def origin(self) -> float:
        """Distance of the profile's origin from the middle of the axle, in mm."""
        at = float(self.wheel.y.min()) if self.flange_back_at is None else self.flange_back_at
        return 0.5 * self.flange_back - at

    def tread(self) -> Curve:
        """The curve of the right wheel in coordinates of the wheelset: y is the distance from the middle of the axle, and z the radius."""
        return self.wheel.moved(y=self.origin, z=self.radius).curve()


def warn_of_play(track: Track, wheelset: Wheelset, stacklevel: int) -> None:
    """Warns of a wheelset that does not fit between the rails, or has too much play."""
    across = wheelset.across_flanges()
    if across is None:
        return
    play = track.gauge - across
    if not 0.0 <= play <= _PLAY * track.gauge:
        told = f"a play of {play:.3g} mm" if play > 0.0 else f"{-play:.3g} mm too little room"
        warnings.warn(f"the wheelset, {across:.5g} mm across its flanges, has {told} in a gauge of {track.gauge:g}: look at gauge, flange_back={wheelset.flange_back:g} and "
                      "flange_back_at", stacklevel=stacklevel + 1)


def _refuse_unless(kind: str, profile: Profile) -> None:
    """Raises an error unless the argument is a profile of this kind."""
    if not isinstance(profile, Profile):
        raise TypeError(f"{kind} is a {type(profile).__name__}; it must be a Profile, as profiles.read(...) returns it")
    if profile.kind != kind:
        raise ValueError(f'{kind} is a {profile.kind}; it must be a profile of kind "{kind}"')
