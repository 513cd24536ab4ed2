"""Estimates the errors of a curve through smoothed points: by the few decimals of a file, by noise, and by the form that smoothing removes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._smoothing import smoothing_splines

if TYPE_CHECKING:
    from .._arguments import Doubles

# The numbers of decimals of files for which rounding matters, and the units of files, mm and inches, in mm.
_DECIMALS, _UNITS = range(5), (1.0, 25.4)
# Values are on a lattice of multiples of a step if they differ from it by at most this part of the step.
_MET = 1e-6

# For each sample of rounding errors the offsets of the lattices of y and of z, in parts of their steps.
_SHIFTS = (0.625, 0.125, 0.875, 0.375), (0.125, 0.375, 0.625, 0.875)
SAMPLES = 4

# The standard deviation of normal noise is this factor times the median of its absolute values.
_MEDIAN = 1.4826


def _step_of(values: Doubles) -> float:
    """The step of the last decimal of the values of a file, if they have few decimals; otherwise 0."""
    beyond = values - values[0]
    for step in sorted((unit * 10.0**-decimals for unit in _UNITS for decimals in _DECIMALS), reverse=True):
        if np.abs(beyond / step - np.round(beyond / step)).max() < _MET:
            return step
    return 0.0


def _noise_of(y: Doubles, z: Doubles) -> float:
    """The standard deviation of noise in z, from the median distance of points from the cubic through two neighbours on either side."""
    if len(y) < 5:
        return 0.0
    places = [y[:-4], y[1:-3], y[3:-1], y[4:]]
    weights = [np.prod([(y[2:-2] - other) / (place - other) for other in places if other is not place], axis=0) for place in places]
    off = z[2:-2] - sum(weight * z[k : len(z) - 4 + k] for weight, k in zip(weights, (0, 1, 3, 4)))
    return _MEDIAN * float(np.median(np.abs(off) / np.sqrt(1.0 + sum(weight**2 for weight in weights))))


def left_open(before: Doubles, measured: Doubles, smooth: Doubles, wave_length: float) -> Doubles:
    """Possible errors of a smoothed curve along its normal: the form that smoothing has removed, and samples of the remaining errors.

    The removed form is estimated by a second smoothing, which removes about as much of the form as the first one.

    Parameters
    ----------
    before : ndarray, (1 + SAMPLES, n)
        The possible errors of the points before they were smoothed.
    measured, smooth : ndarray, (2, n)
        y and z of the points before and after smoothing.

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
    """Samples of the errors that measured points may have relative to a curve, along its normal.

    If the file has few decimals, the samples are rounding errors: the points of the smooth curve are rounded as in the file, with other offsets of the lattice.
    Where a profile is level, such errors are waves over many points, which smoothing does not remove. Otherwise the samples are random noise with the standard
    deviation of the points.
    """
    steps, random = [_step_of(values) for values in measured], np.random.default_rng(1)
    if steps[1] == 0.0:
        return np.asarray(_noise_of(*measured) * normals[1] * random.standard_normal((SAMPLES, len(normals[1]))))
    # Values of y on a coarser lattice than those of z were chosen, and have no rounding errors.
    steps[0] = steps[0] if steps[0] <= steps[1] else 0.0
    found = np.zeros((SAMPLES, len(normals[1])))
    for values, normal, step, shifts in zip(smooth, normals, steps, _SHIFTS):
        if step > 0.0:
            at = values / step + np.array(shifts)[:, None]
            found += step * normal * (np.round(at) - at)
    return found
