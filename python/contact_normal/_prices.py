"""Predicts, before a solve, what an accuracy costs."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ._arguments import AccuracyOptions, Both, doubles, options, relative
from ._calls import called
from ._library import check, initialised, library
from ._numbered import name_of
from ._quantities import QUANTITIES, estimated
from ._refined import limits, on_any_grid
from ._structs import Price as PriceStruct
from ._units import checked

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

OBSTACLES = ("", "singular", "below round-off", "too many elements", "too much memory", "too long", "too long a step")


class Price(NamedTuple):
    """The predicted costs of one accuracy.

    Attributes
    ----------
    target : float
        The wanted relative error.
    shape : (my, mx)
        Elements of the coarsest grid on which the wanted accuracy is reached; (0, 0): not known.
    tolerance : float
        The tolerance that a solve on this grid needs.
    error : float
        Predicted relative error with this grid and tolerance; negative: not known.
    seconds, seconds_one_thread : float
        Predicted time of the solve with the threads of the options, and with one thread; negative: not known.
    bytes : int
        Predicted memory of the solver; 0: not known.
    obstacle : str
        The reason for which the accuracy is out of reach: "singular", "below round-off", "too many elements", "too much memory", "too long", "too long a step";
        "": none.
    time_error : float
        For viscoelastic bodies: the relative error by the length of the time step. It is the same on any grid, and adds to `error`. Otherwise 0.
    work_units : float
        Predicted number of products A p, as "work_units" of a report; 0: not known. It depends little on the machine.
    """

    target: float
    shape: tuple[int, int]
    tolerance: float
    error: float
    seconds: float
    seconds_one_thread: float
    bytes: int
    obstacle: str
    time_error: float = 0.0
    work_units: float = 0.0

    @classmethod
    def of(cls, row: PriceStruct) -> Price:
        """Makes a price from a struct of the library."""
        return cls(
            row.target, (row.my, row.mx), row.tolerance, row.error, row.seconds, row.seconds_one_thread, row.bytes,
            name_of(OBSTACLES, row.obstacle), row.time_error, row.work_units,
        )


class Prices(list[Price]):
    """The rows of `cost_of_accuracy`: one `Price` for each target.

    Attributes
    ----------
    quantity : str
        The quantity whose errors are predicted.
    estimated : str
        What the quantity "force" is: "force", or "approach" if the force is prescribed.
    message : str
        The reason why prices are missing, if a limit ended the call or no grid was solved; otherwise "".
    """

    def __init__(self, rows: Iterable[Price], quantity: str, estimated: str = "force", message: str = "") -> None:
        super().__init__(rows)
        self.quantity, self.estimated, self.message = quantity, estimated, message

    def __str__(self) -> str:
        head = f"{'relative error':>14} {'elements':>13} {'tolerance':>10} {'seconds':>9} {'MB':>8}"
        return "\n".join([head, *(_line(price) for price in self), *([self.message] if self.message else [])])

    def plot(self, axes: Axes | None = None, measured: Sequence[tuple[float, float]] = ()) -> Axes:
        """Draws predicted errors over seconds with the elements of each grid, and `measured` points (seconds, error). `axes` is as for `Result.plot`."""
        from ._plot_accuracy import plot_prices

        return plot_prices(self, axes, measured)


def _line(price: Price) -> str:
    """One line of the printed table. A dash stands for a value that is not known."""
    my, mx = price.shape
    elements = f"{mx} x {my}" if mx else "-"
    seconds = f"{price.seconds:.2g}" if price.seconds >= 0.0 else "-"
    memory = f"{price.bytes / 1e6:.3g}" if price.bytes else "-"
    return f"{price.target:14.1e} {elements:>13} {price.tolerance:10.0e} {seconds:>9} {memory:>8}  {price.obstacle}".rstrip()


def cost_of_accuracy(
    h: npt.ArrayLike | Callable[[Any, Any], Any],
    dx: float,
    dy: float,
    *,
    targets: Sequence[float] = (1e-2, 1e-3, 1e-4),
    quantity: str = "force",
    max_seconds: float = 0.0,
    max_bytes: float = 0,
    max_elements: float = 0,
    shape: tuple[int, int] | None = None,
    corner: tuple[float, float] | None = None,
    approach: float | None = None,
    force: float | None = None,
    mean_pressure: float | None = None,
    shear_modulus: Both | None = None,
    poisson_ratio: Both | None = None,
    young_modulus: Both | None = None,
    e_star: float | None = None,
    layer: npt.ArrayLike | None = None,
    pressure_limit: npt.ArrayLike | None = None,
    period: str | None = None,
    patches: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    coating: Any = None,
    friction: Mapping[str, Any] | None = None,
    adhesion: Mapping[str, Any] | None = None,
    visco: Mapping[str, Any] | None = None,
    units: tuple[str, str] | None = None,
    **given: Unpack[AccuracyOptions],
) -> Prices:
    """Predicts which grid, tolerance, time and memory a relative error needs. Only small grids are solved for this.

    Parameters
    ----------
    h, dx, dy, shape, corner, approach, force, mean_pressure, shear_modulus, poisson_ratio, young_modulus, e_star, units, **given
        As for `solve_to_accuracy`, with the same effects. `units` have no effect.
    visco : mapping, optional
        Viscoelastic bodies, as for `solve`: a step from rest. Each price then has the `time_error` of the step.
    targets : sequence of float
        The wanted relative errors, one row each.
    quantity : str
        The quantity of the errors: "force" (the approach, if the force is prescribed), or another one of `contact_normal.quantities`.
    max_seconds, max_bytes : number
        Limits of the costs; 0: no limit. A row that exceeds a limit has it as its `obstacle`, and still has its costs.
    max_elements : int
        Limit of the elements of a grid; 0: 4096 x 4096.

    Returns
    -------
    Prices
        A list of `Price`, which can be drawn.

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
    effects = {"layer": layer, "pressure_limit": pressure_limit, "period": period, "patches": patches, "coating": coating, "friction": friction,
               "adhesion": adhesion, "visco": visco}
    struct = options(given)
    checked(units)
    scene, surface, _ = on_any_grid(
        h, dx, dy, shape, corner, effects, approach=approach, force=force, mean_pressure=mean_pressure, shear_modulus=shear_modulus,
        poisson_ratio=poisson_ratio, young_modulus=young_modulus, e_star=e_star,
    )
    scene.bodies.know_all([quantity])
    accuracy = limits(max_seconds, max_bytes, max_elements, surface)
    errors = doubles("targets", targets, dimensions="n")
    n = len(errors)
    wanted, rows = (ctypes.c_double * n)(*(relative(f"targets[{k}]", error) for k, error in enumerate(errors))), (PriceStruct * n)(*[initialised("price")][:n])
    status, message = called(
        library.contact_normal_cost_of_accuracy, ctypes.byref(scene.struct), ctypes.byref(struct), ctypes.byref(accuracy),
        QUANTITIES[quantity], n, wanted, rows, keep=(scene, surface), options=struct, asks=surface is not None,
    )
    if surface:
        surface.finish()
    check(status, message)
    return Prices((Price.of(row) for row in rows), quantity, estimated(scene), message)

