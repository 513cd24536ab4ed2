"""What a curve through smoothed points leaves open: by the decimals of a file, by noise, and by the form that smoothing removes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._smoothing import smoothing_splines

if TYPE_CHECKING:
    from .._arguments import Doubles

# Files have so many decimals, in units of mm and inches, or more; finer ones are of no account.
_DECIMALS, _UNITS = range(5), (1.0, 25.4)
# A lattice is met to this part of its step.
_MET = 1e-6

# Where a lattice may have lain, in parts of its step: that of y and that of z.
_SHIFTS = (0.625, 0.125, 0.875, 0.375), (0.125, 0.375, 0.625, 0.875)
SAMPLES = 4

# The median of the size of normal noise is its standard deviation over this.
_MEDIAN = 1.4826


def _step_of(values: Doubles) -> float:
    """The step of the decimals that a file had, if it had few; else 0."""
    beyond = values - values[0]
    for step in sorted((unit * 10.0**-decimals for unit in _UNITS for decimals in _DECIMALS), reverse=True):
        if np.abs(beyond / step - np.round(beyond / step)).max() < _MET:
            return step
    return 0.0


def _noise_of(y: Doubles, z: Doubles) -> float:
    """The standard deviation of noise in z: how far points are off the cubic through two neighbours on either side, in the median."""
    if len(y) < 5:
        return 0.0
    places = [y[:-4], y[1:-3], y[3:-1], y[4:]]
    weights = [np.prod([(y[2:-2] - other) / (place - other) for other in places if other is not place], axis=0) for place in places]
    off = z[2:-2] - sum(weight * z[k : len(z) - 4 + k] for weight, k in zip(weights, (0, 1, 3, 4)))
    return _MEDIAN * float(np.median(np.abs(off) / np.sqrt(1.0 + sum(weight**2 for weight in weights))))


def left_open(before: Doubles, measured: Doubles, smooth: Doubles, wave_length: float) -> Doubles:
    """How far a curve that was smoothed may lie off, along its normal: the form that smoothing has removed, and samples of what errors leave.

    Of the form, smoothing once more removes about the same.

    Parameters
    ----------
    before : ndarray, (1 + SAMPLES, n)
        The same of the points before they were smoothed.
    measured, smooth : ndarray, (2, n)
        Points before and after.

    Returns
    -------
    ndarray, (1 + SAMPLES, n)
    """
    slopes = np.gradient(smooth[1]) / np.gradient(smooth[0])
    along = 1.0 / np.hypot(1.0, slopes)
    normals = np.stack([-slopes * along, along])
    found = smoothing_splines(before + np.vstack([np.zeros(len(slopes)), _errors(measured, smooth, normals)]), measured, wave_length)
    found[0] += ((smooth - smoothing_splines(smooth, measured, wave_length)) * normals).sum(axis=0)
    return found


def _errors(measured: Doubles, smooth: Doubles, normals: Doubles) -> Doubles:
    """Samples of how far points that are measured lie off a curve, along its normal.

    Where the file had few decimals, points of the smooth curve are rounded as the file was, with the lattice in other places: where a profile is level, such
    errors are waves of many points, which smoothing leaves. Else there is noise of the size that the points show.
    """
    steps, random = [_step_of(values) for values in measured], np.random.default_rng(1)
    if steps[1] == 0.0:
        return np.asarray(_noise_of(*measured) * normals[1] * random.standard_normal((SAMPLES, len(normals[1]))))
    # Places of a finer lattice than that of z are noise, or exact; those of a coarser one were chosen.
    steps[0] = steps[0] if steps[0] <= steps[1] else 0.0
    found = np.zeros((SAMPLES, len(normals[1])))
    for values, normal, step, shifts in zip(smooth, normals, steps, _SHIFTS):
        if step > 0.0:
            at = values / step + np.array(shifts)[:, None]
            found += step * normal * (np.round(at) - at)
    return found
