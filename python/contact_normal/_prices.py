"""What accuracies cost, before they are paid for."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arguments import AccuracyOptions, Both, integer, options
from ._callbacks import Surface
from ._constants import QUANTITY_CONTACT_AREA, QUANTITY_FORCE, QUANTITY_MAX_PRESSURE
from ._library import check, initialised, library
from ._scene import Scene
from ._structs import Price as PriceStruct

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack

QUANTITIES = {"force": QUANTITY_FORCE, "max_pressure": QUANTITY_MAX_PRESSURE, "contact_area": QUANTITY_CONTACT_AREA}
OBSTACLES = ("", "singular", "below round-off", "too many elements", "too much memory", "too long")


class Price(NamedTuple):
    """What one accuracy costs; all of it is predicted.

    Attributes
    ----------
    target : float
        The relative error that is wanted.
    shape : (my, mx)
        Elements of the coarsest grid that does; (0, 0): not known.
    tolerance : float
        The tolerance to ask for.
    error : float
        Relative error that this grid and tolerance leave; negative: not known.
    seconds, seconds_one_thread : float
        With the threads of the options, and with one; negative: not known.
    bytes : int
        Held by the solver; 0: not known.
    obstacle : str
        What keeps the accuracy from being had: "singular", "below round-off", "too many elements", "too much memory", "too long"; "": none.
    """

    target: float
    shape: tuple[int, int]
    tolerance: float
    error: float
    seconds: float
    seconds_one_thread: float
    bytes: int
    obstacle: str

    @classmethod
    def of(cls, row: PriceStruct) -> Price:
        """The row of the library."""
        return cls(
            row.target, (row.my, row.mx), row.tolerance, row.error, row.seconds, row.seconds_one_thread, row.bytes,
            OBSTACLES[row.obstacle],
        )


def cost_of_accuracy(
    h: npt.ArrayLike | Callable[[Any, Any], Any],
    dx: float,
    dy: float,
    *,
    targets: Sequence[float] = (1e-2, 1e-3, 1e-4),
    quantity: str = "force",
    max_seconds: float = 0.0,
    max_bytes: int = 0,
    max_elements: int = 0,
    shape: tuple[int, int] | None = None,
    corner: tuple[float, float] | None = None,
    approach: float | None = None,
    force: float | None = None,
    shear_modulus: Both,
    poisson_ratio: Both,
    **given: Unpack[AccuracyOptions],
) -> list[Price]:
    """Predicts what relative errors cost: grid, tolerance, seconds and bytes, from solves on small grids only.

    Parameters
    ----------
    h, dx, dy, shape, corner, approach, force, shear_modulus, poisson_ratio, **given
        As for `solve_to_accuracy`.
    targets : sequence of float
        Relative errors; one row each.
    quantity : str
        Of what: "force" (of the approach, if the force is prescribed), "max_pressure" or "contact_area".
    max_seconds, max_bytes, max_elements : number
        Limits: a row beyond one says so in its `obstacle`, and what it would take; 0: no limit.

    Returns
    -------
    list of Price

    Raises
    ------
    ContactNormalError
        If the library refuses the scene, a target or an option.

    Examples
    --------
    >>> import contact_normal
    >>> rows = contact_normal.cost_of_accuracy(lambda x, y: 0.002 * (x**2 + y**2), 0.5, 0.5, shape=(32, 32),
    ...                                        force=1000.0, shear_modulus=82000.0, poisson_ratio=0.28)
    >>> [row.obstacle for row in rows], rows[0].seconds <= rows[2].seconds
    (['', '', ''], True)
    """
    if quantity not in QUANTITIES:
        raise ValueError(f"quantity is {quantity!r}; it must be one of {', '.join(QUANTITIES)}")
    surface = None
    if callable(h):
        if shape is None:
            raise TypeError("shape (my, mx) of the first grid is needed where h is a callable")
        my, mx = (integer("shape", m) for m in shape)
        surface = Surface(h, (-0.5 * mx * dx, -0.5 * my * dy) if corner is None else corner)
        h = np.zeros((my, mx))  # not read
    scene = Scene(h, dx, dy, approach, force, shear_modulus, poisson_ratio, {})
    struct, accuracy = options(given), initialised("accuracy")
    accuracy.max_seconds = max_seconds
    accuracy.max_bytes, accuracy.max_elements = integer("max_bytes", max_bytes, 64), integer("max_elements", max_elements, 64)
    if surface:
        accuracy.surface = surface.callback
    n = len(targets)
    wanted, rows = (ctypes.c_double * n)(*targets), (PriceStruct * n)(*[initialised("price")][:n])
    status = library.contact_normal_cost_of_accuracy(
        ctypes.byref(scene.struct), ctypes.byref(struct), ctypes.byref(accuracy), QUANTITIES[quantity], n, wanted, rows
    )
    if surface:
        surface.finish()
    check(status)
    return [Price.of(row) for row in rows]

