"""Computes frictional work and the depth of wear of each element, from tractions and slips."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ._arguments import doubles, number, pointer
from ._calls import called
from ._library import check, initialised, library
from ._short import told

if TYPE_CHECKING:
    import numpy.typing as npt


class FrictionalWear(NamedTuple):
    """Frictional work and wear.

    Attributes
    ----------
    work : array, (my, mx)
        Frictional work per area of each element, an energy per area.
    depth : array, (my, mx)
        The depth of wear of each element, a length.
    passage : array, (my,), or None
        The depth of wear of a point of a surface that rolls along x, after one passage through the contact; None without a rolling distance.
    total_work : float
        The frictional work of all elements, an energy.
    volume : float
        The volume of worn material.
    largest_depth : float
        The largest value of `depth`.
    at : (float, float)
        The coordinates (x, y) of the largest depth, relative to the middle of the grid.
    """

    work: npt.NDArray[np.float64]
    depth: npt.NDArray[np.float64]
    passage: npt.NDArray[np.float64] | None
    total_work: float
    volume: float
    largest_depth: float
    at: tuple[float, float]

    def __repr__(self) -> str:
        return told(self, self._fields)


def frictional_wear(
    traction: npt.ArrayLike,
    slip: npt.ArrayLike,
    dx: float,
    dy: float,
    *,
    coefficient: float | npt.ArrayLike = 0.0,
    hardness: float = 1.0,
    pressure: npt.ArrayLike | None = None,
    steps: float = 1.0,
    rolling_distance: float | None = None,
) -> FrictionalWear:
    """Computes the frictional work and the depth of wear (Archard) of each element, from the result of a solve with friction.

    The depth is K/H times the frictional work per area, -(q . s), where q are the tractions and s the slips. If pressures are given, the depth is instead K/H
    times the pressure times the length of s.

    Parameters
    ----------
    traction, slip : array_like, (2, my, mx)
        Tractions on body 1, and slips of a step, as in a result.
    dx, dy : float
        Element sizes.
    coefficient : float or array_like, (my, mx)
        K, the wear coefficient; by default 0: only the work is computed.
    hardness : float
        H, a pressure. With 1 (default) `coefficient` stands for K/H, a volume per energy.
    pressure : array_like, (my, mx), optional
        Pressures. If they are given, the depth follows from pressure times distance, as above.
    steps : float
        The number by which the work and the depth of one step are multiplied: L/dq for a length L that is rolled in steps of dq. With V/dq for a speed V the
        work becomes a power, and the depth a rate.
    rolling_distance : float, optional
        dq, the length of a step of rolling along x. It is needed for `passage`.

    Returns
    -------
    FrictionalWear

    Examples
    --------
    >>> import numpy as np, contact_normal
    >>> traction, slip = np.zeros((2, 8, 8)), np.zeros((2, 8, 8))
    >>> traction[0, 2:6, 2:6], slip[0, 2:6, 2:6] = 100.0, -0.01
    >>> found = contact_normal.frictional_wear(traction, slip, 0.1, 0.1, coefficient=1e-4, hardness=2000.0)
    >>> round(found.total_work, 12), round(found.largest_depth, 15)
    (0.16, 5e-08)
    """
    shape = np.shape(traction)
    if len(shape) != 3 or shape[0] != 2:
        raise ValueError(f"traction has the shape {shape}; it must be (2, my, mx)")
    q, s = doubles("traction", traction, shape, "(2, my, mx)"), doubles("slip", slip, shape, "(2, my, mx)")
    wear, worn = initialised("wear"), initialised("worn")
    (wear.my, wear.mx), elements = shape[1:], shape[1:]
    wear.dx, wear.dy = number("dx", dx), number("dy", dy)
    for k in range(2):
        wear.traction[k], wear.slip[k] = pointer(q[k]), pointer(s[k])
    keep = [q, s]
    if np.ndim(coefficient) == 0:
        wear.coefficient = number("coefficient", coefficient)
    else:
        keep.append(doubles("coefficient", coefficient, elements))
        wear.coefficients = pointer(keep[-1])
    if pressure is not None:
        keep.append(doubles("pressure", pressure, elements))
        wear.pressure = pointer(keep[-1])
    wear.hardness, wear.steps = number("hardness", hardness), number("steps", steps)
    passage = None
    if rolling_distance is not None:
        wear.rolling_distance = number("rolling_distance", rolling_distance)
        passage = np.empty(elements[0])
    work, depth = np.empty(elements), np.empty(elements)
    outputs = (pointer(work), pointer(depth), None if passage is None else pointer(passage))
    keep += [work, depth] if passage is None else [work, depth, passage]
    check(*called(library.contact_normal_frictional_wear, ctypes.byref(wear), *outputs, ctypes.byref(worn), keep=tuple(keep)))
    return FrictionalWear(work, depth, passage, worn.work, worn.volume, worn.largest_depth, (worn.x, worn.y))
