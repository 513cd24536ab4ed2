"""Computes quantities of a scene on several grids, with their errors."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ._arguments import integer
from ._calls import called
from ._constants import OK, PRESCRIBED_APPROACH
from ._given import SceneArguments, scene_and_options
from ._library import ContactNormalError, check, initialised, library
from ._numbered import name_of, names_of
from ._structs import QuantityRow

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._scene import Scene

# The largest number of coarser grids that the library accepts.
_MOST_COARSER = 12
QUANTITY_NAMES = names_of("QUANTITY_")
# The library's number of each quantity, by its name.
QUANTITIES = {name: number for number, name in QUANTITY_NAMES.items()}
LACKS = ("", "no friction", "prescribed", "not with an effect of the scene", "no contact", "singular", "one grid", "unsolved", "not falling yet")


def numbers(name: str, wanted: Sequence[str]) -> Any:
    """The library's numbers of the named quantities, as a C array."""
    if isinstance(wanted, str):
        raise TypeError(f"{name} is {wanted!r}; it must be a sequence of names")
    for each in wanted:
        if each not in QUANTITIES:
            raise ValueError(f"{name} has {each!r}; it must hold some of {', '.join(QUANTITIES)}")
    return (ctypes.c_int32 * len(wanted))(*[QUANTITIES[each] for each in wanted])


def estimated(scene: Scene) -> str:
    """What the quantity "force" of a scene is: "force", or "approach" if the force is prescribed."""
    return "force" if scene.struct.load == PRESCRIBED_APPROACH else "approach"


class Quantity(NamedTuple):
    """The value and the error of a quantity on one grid.

    Attributes
    ----------
    name : str
        The name of the quantity: "force", "max_pressure", ...
    shape : (my, mx)
        The elements of the grid.
    value : float
        The value on this grid; nan: there is none, and `lack` says why.
    error : float
        Estimated error, in the unit of the value; negative: not known, and `lack` says why.
    seconds, work_units : float
        Time of set-up and solve on this grid, and number of products A p on this grid.
    lack : str
        Why the value or the error is missing: "no friction", "prescribed", "not with an effect of the scene", "no contact", "singular" (the quantity grows from
        grid to grid), "one grid", "unsolved", "not falling yet" (one more grid shows whether the quantity converges); "": nothing is missing.
    """

    name: str
    shape: tuple[int, int]
    value: float
    error: float
    seconds: float
    work_units: float
    lack: str

    @classmethod
    def of(cls, row: QuantityRow) -> Quantity:
        """Makes a quantity from a struct of the library."""
        return cls(
            name_of(QUANTITY_NAMES, row.quantity), (row.my, row.mx), row.value, row.error, row.seconds, row.work_units, name_of(LACKS, row.lack),
        )


class Quantities(list[Quantity]):
    """The rows of `quantities`, coarsest grid first.

    Attributes
    ----------
    estimated : str
        What the quantity "force" is: "force", or "approach" if the force is prescribed.
    """

    estimated: str = "force"

    def last(self, name: str) -> Quantity:
        """The row of a quantity on the finest grid."""
        found = [row for row in self if row.name == name]
        if not found:
            names = ", ".join(dict.fromkeys(row.name for row in self))
            raise ValueError(f"name is {name!r}; it must be one of those asked for: {names}")
        return found[-1]

    def __str__(self) -> str:
        lines = [f"{'quantity':18}{'grid':>13}{'value':>16}{'error':>12}{'seconds':>12}"]
        for row in self:
            grid, error = f"{row.shape[1]} x {row.shape[0]}", f"{row.error:.2g}" if row.error >= 0 else "-"
            value = "-" if row.value != row.value else f"{row.value:.8g}"
            lines.append(f"{row.name:18}{grid:>13}{value:>16}{error:>12}{row.seconds:12.2g}  {row.lack}".rstrip())
        if self.estimated != "force" and any(row.name == "force" for row in self):
            lines.append(f"force is that of the {self.estimated}: the force is prescribed")
        return "\n".join(lines)

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the relative error of each quantity over the seconds of each grid; `axes` as for `Result.plot`."""
        from ._plot_accuracy import plot_quantities

        return plot_quantities(self, axes)


def quantities(
    h: npt.ArrayLike,
    dx: float,
    dy: float,
    *,
    names: Sequence[str] = ("force", "max_pressure", "contact_area"),
    coarser: int = 2,
    **given: Unpack[SceneArguments],
) -> Quantities:
    """Computes values and errors of quantities, on the grid of the scene and on coarser ones.

    Parameters
    ----------
    h, dx, dy, **given
        As for `solve`, with effects and options, but without influence coefficients of the caller.
    names : sequence of str
        "force" (which is the approach, if the force is prescribed), "max_pressure", "contact_area", "mean_gap", "stiffness", "tangential_force", "creepage",
        "spin_moment", "stick_area", "max_von_mises", "von_mises_depth", "max_shear".
    coarser : int
        Number of coarser grids, each with half the elements of the next in both directions: 0 to 12. The errors of all but the first three of the quantities
        above are estimated from these grids.

    Returns
    -------
    Quantities
        A list of `Quantity`: for each grid, coarsest first, one for each name.

    Raises
    ------
    ContactNormalError
        If the library refuses the scene or an option, or does not solve it.

    Examples
    --------
    >>> import numpy as np, contact_normal
    >>> x = (np.arange(64) - 31.5) * 0.1
    >>> h = (x[None, :] ** 2 + x[:, None] ** 2) / 100.0
    >>> rows = contact_normal.quantities(h, 0.1, 0.1, names=["force", "max_von_mises"], approach=0.05, e_star=1e5, poisson_ratio=0.3)
    >>> [row.shape for row in rows if row.name == "force"]
    [(16, 16), (32, 32), (64, 64)]
    """
    scene, struct = scene_and_options(h, dx, dy, given)
    wanted, grids = numbers("names", names), integer("coarser", coarser)
    scene.bodies.know_all(names)
    room = max(1, len(wanted) * (max(0, min(grids, _MOST_COARSER)) + 1))
    rows, written = (QuantityRow * room)(initialised("quantity_row")), ctypes.c_int32(0)
    status, message = called(
        library.contact_normal_quantities, ctypes.byref(scene.struct), ctypes.byref(struct), len(wanted), wanted, grids, rows,
        ctypes.byref(written), keep=(scene,), options=struct,
    )
    if check(status, message) != OK:
        raise ContactNormalError(status, message)
    found = Quantities(Quantity.of(row) for row in rows[: written.value])
    found.estimated = estimated(scene)
    return found
