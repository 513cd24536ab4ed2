"""Estimates how uncertain pressures are because of the points of a profile: their noise, the decimals of the file, and their number."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ._curve import Curve

if TYPE_CHECKING:
    from collections.abc import Callable

    from .._arguments import Doubles
    from .._result import Result

# Curves are compared at this number of places across the contact.
_PLACES = 256

# There is a warning if pressures are uncertain by more than this part of the largest pressure.
_TOLD = 0.05

# A contact with fewer points than this has too few. If it has more and pressures are uncertain, the points have noise.
_FEW = 8

# There is a warning if the contact point is uncertain by more than _MOVED mm. An uncertainty above _MANY mm is not given as a number. Slopes are compared
# _BESIDE mm on either side of the contact point.
_MOVED, _MANY, _BESIDE = 1.0, 10.0, 1.0

# The number of points on each side of the contact point that are used for the uncertainty of its slope.
_AROUND = 24


@dataclass(frozen=True)
class Body:
    """A body of a contact: its name in messages, the curve of its profile, and the parameter t of the contact point on the curve."""

    name: str
    curve: Curve
    t: float


def warn(bodies: tuple[Body, ...], y: Doubles, result: Result, stacklevel: int) -> None:
    """Warns if pressures depend on the choice of points of the profiles, or on smoothing.

    Let e2 be the change of a curve through every second point only, and e4 that of a curve through every fourth point only. If points are dense enough, e4 is
    several times e2, and the error with all points is about e2^2/e4. Errors by noise do not fall like this.

    The changes are converted to pressures: to flatten a wave cos(k y) of the undeformed distance takes pressures of E* k/2 times its height. E* follows from
    F = 4/3 E* a d, Hertz's force for an approach d and a contact area of pi a^2.

    Smoothed points show no noise. Therefore the curve of a smoothed profile has samples of the remaining errors, and the removed form (`Curve.open`).

    Parameters
    ----------
    y : ndarray, (my,)
        Coordinates of the rows of elements, relative to the contact point.
    """
    rows = y[result.contact.any(axis=1)]
    if not (len(rows) and result.approach > 0.0 and result.max_pressure > 0.0):
        return
    step = y[1] - y[0] if len(y) > 1 else 0.0
    along = np.linspace(rows[0] - step, rows[-1] + step, _PLACES)
    e_star = 0.75 * result.force / (result.approach * np.sqrt(result.contact.sum() * result.dx * result.dy / np.pi))
    parts = np.array([_open_pressures(body, along, e_star) for body in bodies]) / result.max_pressure
    part = float(np.linalg.norm(parts))
    if part > _TOLD:
        which, cause = np.unravel_index(np.argmax(parts), parts.shape)
        body = bodies[which]
        inside = int(((body.curve.t > body.t + along[0]) & (body.curve.t < body.t + along[-1])).sum())
        width = f"The {body.name} has {inside} of its points across the contact, which is {along[-1] - along[0]:.2g} mm wide"
        amount = f"{part:.0%}" if part < 1.0 else "100 % or more"
        warnings.warn(f"pressures are uncertain by some {amount}: {_CAUSES[cause]}. {width}: {_cure(body, inside, int(cause))}", stacklevel=stacklevel + 1)


_CAUSES = ("so much they depend on which points of the profiles are taken", "so much is left of noise, or of the few decimals of the points",
           "so much form smoothing has removed")


def _cure(body: Body, inside: int, cause: int) -> str:
    """The advice in a warning on uncertain pressures, for the body and the cause (an index of `_CAUSES`) of the largest part."""
    if cause == 2:
        return "use a shorter wave_length"
    if inside < _FEW:
        return "give more points"
    if cause == 1 or body.curve.open is not None:
        return "a longer wave_length of smoothed(...) removes more"
    return "noise, or few decimals, which smoothed(wave_length) removes, with 2 to 5 mm in most cases"


def _open_pressures(body: Body, along: Doubles, e_star: float) -> tuple[float, float, float]:
    """The uncertainties of pressures by a body, as root mean squares: by the choice of points, by errors of smoothed points, and by the removed form."""

    def of_every(every: int) -> float:
        return sum(_pressure(_difference(body, along, start, every), along, e_star) for start in range(every)) / every

    by_choice = _by_choice(of_every)
    if body.curve.open is None:
        return by_choice, 0.0, 0.0
    lost, *samples = (_pressure(np.interp(body.t + along, body.curve.t, off), along, e_star) for off in body.curve.open)
    return by_choice, _rms(samples), lost


def _by_choice(of_every: Callable[[int], float]) -> float:
    """The uncertainty e2 min(1, e2/e4) by the choice of points, where e2 = `of_every(2)` and e4 = `of_every(4)`; see `warn`."""
    second = of_every(2)
    return second * min(1.0, second / of_every(4)) if second > 0.0 else 0.0


def _rms(values: list[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def warn_of_place(bodies: tuple[Body, Body], stacklevel: int) -> None:
    """Warns if the contact point of a rail and a wheel depends on the choice of points of their profiles, or on noise that smoothing leaves.

    At the contact point both curves have equal slopes. If the slopes are uncertain by s, the point is uncertain by s over the difference of the curvatures.
    """
    of_rail, of_wheel = ((_slope(body.curve, body.t + _BESIDE) - _slope(body.curve, body.t - _BESIDE)) / (2.0 * _BESIDE) for body in bodies)
    parts = [_open_slope(body) for body in bodies]
    moved = float(np.linalg.norm(parts)) / max(of_rail - of_wheel, 1e-9)
    if moved > _MOVED:
        body = bodies[int(np.argmax(parts))]
        k = min(max(int(np.searchsorted(body.curve.t, body.t)), 1), len(body.curve.t) - 1)
        amount = f"{moved:.2g} mm" if moved < _MANY else f"{_MANY:g} mm or more"
        warnings.warn(f"the contact point is uncertain by some {amount} along the profiles: so much it depends on which points of the {body.name} are taken, "
                      f"which are {body.curve.t[k] - body.curve.t[k - 1]:.2g} mm apart there: give more points, or, where they are noisy, "
                      "smoothed(wave_length)", stacklevel=stacklevel + 1)


def _slope(curve: Curve, t: float) -> float:
    """The angle of a curve from the direction of y at a parameter t, in rad."""
    _, _, dy, dz = curve.at(np.clip(t, curve.t[0], curve.t[-1]))
    return float(np.arctan2(dz, dy))


def _open_slope(body: Body) -> float:
    """The uncertainty of the angle at the contact point in rad, by the choice of points and by the noise that smoothing leaves."""
    curve, at_point = body.curve, int(np.searchsorted(body.curve.t, body.t))
    # Far points have hardly any effect on a spline.
    first, last = max(0, at_point - _AROUND), min(at_point + _AROUND, len(curve.y) - 1)

    def of_every(every: int) -> float:
        found = []
        for start in range(every):
            chosen = np.unique(np.concatenate([[first], np.arange(first + start, last, every), [last]]))
            coarse = Curve(curve.y[chosen], curve.z[chosen])
            at = float(coarse.where(float(curve.at(body.t)[0]), near=float(np.interp(body.t, curve.t[chosen], coarse.t))))
            found.append(0.0 if np.isnan(at) else _slope(coarse, at) - _slope(curve, body.t))
        return _rms(found)

    by_choice = _by_choice(of_every)
    if curve.open is None:
        return by_choice
    ends = np.clip([body.t - _BESIDE, body.t + _BESIDE], curve.t[0], curve.t[-1])
    slopes = [float(np.diff(np.interp(ends, curve.t, off))[0]) / float(ends[1] - ends[0]) for off in curve.open[1:]]
    return float(np.hypot(by_choice, _rms(slopes)))


def _difference(body: Body, along: Doubles, start: int, every: int) -> Doubles:
    """The distance along the normal between two curves: that through the points `start`, `start + every`, ... and both ends, and that through all points."""
    curve, last = body.curve, len(body.curve.y) - 1
    chosen = np.unique(np.concatenate([[0], np.arange(start, last, every), [last]]))
    coarse = Curve(curve.y[chosen], curve.z[chosen])
    y, z, dy, dz = curve.at(np.clip(body.t + along, curve.t[0], curve.t[-1]))
    at = coarse.where(y, near=float(np.interp(y[len(y) // 2], coarse.y, coarse.t)))
    off = (coarse.at(np.where(np.isnan(at), 0.0, at))[1] - z) * dy / np.hypot(dy, dz)
    return np.where(np.isnan(at), 0.0, off)


def _pressure(off: Doubles, along: Doubles, e_star: float) -> float:
    """The root mean square of the pressures that flatten the heights `off` at the places `along`.

    The least-squares line of the heights is subtracted, and they are continued mirror-symmetrically, so that they are periodic.
    """
    level = off - np.polyval(np.polyfit(along, off, 1), along)
    both = np.concatenate([level, level[::-1]])
    k = 2.0 * np.pi * np.fft.rfftfreq(len(both), along[1] - along[0])
    return float(np.sqrt(np.mean(np.fft.irfft(0.5 * e_star * k * np.fft.rfft(both)) ** 2)))
