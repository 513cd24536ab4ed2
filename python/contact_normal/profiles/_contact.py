"""Finds where a wheel touches a rail."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import number
from . import _sampling
from ._bodies import Position, Track, Wheelset, warn_of_play
from ._patch import ContactPoint, Pair

if TYPE_CHECKING:
    from .._arguments import Doubles

# The clearance is computed at this number of places from each point of the wheel's curve to the next.
_BETWEEN = 6
# The interval around a minimum is divided into _PARTS parts, and replaced by the two parts at the least value. After _SECTIONS repetitions it is 16^9 times
# shorter.
_SECTIONS, _PARTS = 9, 32
# The largest number of steps of the secant method for the roll. Each step multiplies the number of correct digits by about 1.6.
_ROLLS = 40
# Examples of the arguments of these classes, for messages.
_AS = {Track: "rail", Wheelset: "wheel", Position: "y=4.0"}
# The advice in messages on a wheel that is not above its rail.
_BESIDE = ("look at both by plot(): they are in mm, y grows to the field side and z downwards, and one is a wheel, the other a rail; then at the gauge and "
           "the distance of the flange backs")


def _lowest(pair: Pair, t: Any) -> tuple[Doubles, Doubles, Doubles]:
    """The lowest point of each circle of the wheel: that whose normal has no component along the rail. Returns its x, y and z in coordinates of the track.

    Only there can a wheel touch a rail, which is uniform along x. `t` are the parameters of the circles on the wheel's curve. Let e be the radial direction at
    an angle theta from straight below the axle, r(y) the radius and e_y the direction of the axle. The normal is e - r' e_y. With the first row (a, c, b) of the
    rotation its component along the rail is a sin(theta) + b cos(theta) - c r', whose zero theta is computed.
    """
    y, radius, dy, dz = pair.tread.at(t)
    turned = pair.position.rotation()
    along = turned[0]
    wanted = dz / dy * along[1] / np.hypot(along[0], along[2])
    theta = np.arcsin(np.clip(wanted, -1.0, 1.0)) - np.arctan2(along[2], along[0])
    places = turned @ np.stack([radius * np.sin(theta), y, radius * np.cos(theta)])
    x, y, z = places + pair.axle()[:, None]
    return x, y, z


def _clearance(pair: Pair, t: Any) -> Doubles:
    """The vertical distance of the lowest points of the circles `t` from the rail; inf beside the rail."""
    _, y, z = _lowest(pair, t)
    on_rail = pair.rail.where(y, near=pair.rail.t[np.argmin(pair.rail.z)])
    distance = pair.rail.at(np.where(np.isnan(on_rail), 0.0, on_rail))[1] - z
    return np.asarray(np.where(np.isnan(on_rail), np.inf, distance))


def _minima(pair: Pair) -> list[tuple[float, float]]:
    """The local minima of the clearance along the wheel, as pairs of the clearance and the t on the wheel's curve, the smallest clearance first."""
    t = pair.tread.between(_BETWEEN)
    found = _clearance(pair, t)
    inner = np.nonzero((found[1:-1] <= found[:-2]) & (found[1:-1] < found[2:]) & np.isfinite(found[1:-1]))[0] + 1
    if not len(inner):
        return []
    low, high = t[inner - 1], t[inner + 1]
    for _ in range(_SECTIONS):
        places = low + (high - low) * (np.arange(_PARTS + 1) / _PARTS)[:, None]
        least = np.clip(_clearance(pair, places.ravel()).reshape(places.shape).argmin(axis=0), 1, _PARTS - 1)
        low, high = (np.take_along_axis(places, (least + by)[None], axis=0)[0] for by in (-1, 1))
    middle = 0.5 * (low + high)
    return sorted(zip(_clearance(pair, middle).tolist(), middle.tolist()))


def _pair(track: Track, wheelset: Wheelset, position: Position, side: str) -> Pair:
    for name, given, kind in (("track", track, Track), ("wheelset", wheelset, Wheelset), ("position", position, Position)):
        if not isinstance(given, kind):
            raise TypeError(f"{name} is a {type(given).__name__}; it must be a {kind.__name__}, as profiles.{kind.__name__}({_AS[kind]})")
    seen = position.seen_from(side)
    height = dataclasses.replace(seen, z=0.0 if seen.z is None else seen.z)
    return Pair(track.placed().curve(), wheelset.tread(), wheelset.radius, height, side)


def contact_points(
    track: Track, wheelset: Wheelset, position: Position = Position(), side: str = "right", within: float = 0.0
) -> list[ContactPoint]:
    """Finds where a wheel touches its rail, or comes closest to it: at the local minima of the vertical clearance.

    Parameters
    ----------
    track, wheelset : Track, Wheelset
        The rails, and the wheels on their axle.
    position : Position
        How the wheelset stands on the track. With z = None the wheelset is lowered until this wheel touches.
    side : {"left", "right"}
        The wheel that is considered.
    within : float
        A length in mm. Other local minima are returned, too, if their clearance exceeds the smallest one by at most this length. Under load the wheel may touch
        there as well, with a contact patch at each of these points.

    Returns
    -------
    list of ContactPoint
        The points in the order of their clearance, the smallest first.

    Raises
    ------
    ValueError
        If the wheel is nowhere above the rail.
    """
    if not number("within", within) >= 0.0:
        raise ValueError(f"within is {within}; it must not be negative")
    pair = _pair(track, wheelset, position, side)
    warn_of_play(track, wheelset, stacklevel=2)
    minima = _minima(pair)
    if not minima:
        raise ValueError(f"the {side} wheel is nowhere above its rail: position.y is {position.y}, the gauge {track.gauge}; {_BESIDE}")
    if position.z is None:
        lowered = minima[0][0]
        pair = dataclasses.replace(pair, position=dataclasses.replace(pair.position, z=lowered))
        minima = [(clearance - lowered, t) for clearance, t in minima]
    x, y, z = _lowest(pair, np.array([t for _, t in minima]))
    on_rail = pair.rail.where(y, near=pair.rail.t[np.argmin(pair.rail.z)])
    places = [(clearance, float(y[k]), float(z[k])) for k, (clearance, _) in enumerate(minima)]
    points = []
    for k, (clearance, t) in enumerate(minima):
        if clearance - minima[0][0] <= within:
            others = tuple(places[:k] + places[k + 1 :])
            _sampling.warn_of_place((_sampling.Body("rail", pair.rail, float(on_rail[k])), _sampling.Body("wheel", pair.tread, t)), stacklevel=2)
            points.append(ContactPoint(pair, float(x[k]), float(on_rail[k]), t, others, clearance))
    return points


def settled(track: Track, wheelset: Wheelset, y: float = 0.0, yaw: float = 0.0) -> Position:
    """Finds the position in which both wheels touch: the height and the roll of a wheelset that is shifted by `y`, in mm, and yawed by `yaw`, in rad.

    At this roll both wheels can be lowered by the same length until they touch. The roll is found by the secant method.
    """

    def lowered(roll: float) -> tuple[float, float]:
        position = Position(y, None, roll, yaw)
        left, right = (_minima(_pair(track, wheelset, position, side)) for side in ("left", "right"))
        if not (left and right):
            raise ValueError(f"y is {y}: one wheel is nowhere above its rail; {_BESIDE}")
        return left[0][0], right[0][0]

    # The first guess of the slope: a roll lowers the right wheel, and lifts the left one, by the roll times half of the distance between the wheels.
    slope, roll = 2.0 * wheelset.origin, 0.0
    left, right = lowered(roll)
    for _ in range(_ROLLS):
        change = (right - left) / slope
        if not abs(change) > 1e-14:
            break
        moved = lowered(roll + change)
        if moved[1] - moved[0] != right - left:
            slope = -((moved[1] - moved[0]) - (right - left)) / change
        roll, (left, right) = roll + change, moved
    return Position(y, 0.5 * (left + right), roll, yaw)
