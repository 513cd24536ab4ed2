"""Solves many tangential problems of one scene, one for each entry of a table of creepages or forces."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from ctypes import c_int32, c_int64
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import Both, SolveOptions, doubles, options, pointer
from ._callbacks import Progress, Watched
from ._library import check, initialised, library
from ._solved import reported
from ._structs import names
from ._tangential import with_pressures
from ._units import WithUnits, checked

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._arguments import Doubles
    from ._handle import Handle
    from ._scene import Scene


class FrictionBatch(WithUnits):
    """The results of `friction_batch`: forces, moment and creepages of each entry, and its fields if they are wanted.

    Attributes
    ----------
    status : ndarray of int, (n,)
        Status of each entry: 0: solved; > 0: stopped early (`CANCELLED`: not solved); < 0: refused. The values of entries that are not solved are NaN.
    message : str
        A line "entry 3: ..." for each entry that is not solved, then warnings, then remarks on values that may be in a wrong unit.
    force, creepage : ndarray, (n, 2)
        The tangential forces on body 1, and the creepages; one of them is prescribed in each direction, and the other one computed.
    moment : ndarray, (n,)
        The moment of the tractions about the centre of spin.
    residual, gap, products : ndarray, (n,)
        The residual, the gap and the number of products of each entry, as `tangential_residual`, `tangential_gap` and `tangential_products` of a report.
    stick_count, slip_count : ndarray of int, (n,)
        Numbers of elements that stick and that slip.
    traction, slip : ndarray, (n, 2, my, mx), or None
        With `fields=True`: tractions on body 1 and slips, in x and y.
    stick_slip : ndarray of int, (n, my, mx), or None
        With `fields=True`: 0 exterior, 1 stick, 2 slip, 3 slip in a plastic layer.
    friction_coefficient, yield_limit : ndarray, (n, my, mx), or None
        With `fields=True`: the state of the particles of the interface, with a law of friction or a plastic layer; otherwise zeros.
    report : dict
        The report of the normal problem, as `Result.report`.
    units : (str, str) or None
        Names of the units of lengths and forces. The caller may set them.
    """

    traction: npt.NDArray[np.float64] | None = None
    slip: npt.NDArray[np.float64] | None = None
    stick_slip: npt.NDArray[np.int32] | None = None
    friction_coefficient: npt.NDArray[np.float64] | None = None
    yield_limit: npt.NDArray[np.float64] | None = None

    def __init__(self, count: int, shape: tuple[int, int], fields: bool) -> None:
        self.message = ""
        self.report: dict[str, Any] = {}
        self.force, self.creepage = np.full((count, 2), np.nan), np.full((count, 2), np.nan)
        self.moment, self.residual = np.full(count, np.nan), np.full(count, np.nan)
        self.gap, self.products = np.full(count, np.nan), np.full(count, np.nan)
        self.stick_count, self.slip_count = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
        self.status = np.zeros(count, dtype=np.int32)
        if fields:
            self.traction, self.slip = np.full((count, 2, *shape), np.nan), np.full((count, 2, *shape), np.nan)
            self.stick_slip = np.zeros((count, *shape), dtype=np.int32)
            self.friction_coefficient, self.yield_limit = np.full((count, *shape), np.nan), np.full((count, *shape), np.nan)

    def __repr__(self) -> str:
        solved = int((self.status == 0).sum())
        message = f"; {self.message.splitlines()[0]}" if self.message else ""
        largest = f", largest residual {np.nanmax(self.residual):.1e}" if solved else ""
        return f"<FrictionBatch: {solved} of {len(self.status)} entries solved{largest}{message}>"

    def plot(self, over: str | None = None, axes: Axes | None = None) -> Axes:
        """Draws the tangential forces over the creepage `over`, "x" or "y", by default the one that varies more; `axes` as for `Result.plot`."""
        from ._plot_lines import plot_creep_curve

        return plot_creep_curve(self, over, axes)

    def _results(self) -> Any:
        """A `contact_normal_friction_results` that points to the arrays of this object."""
        results = initialised("friction_results")
        kinds = {"stick_count": c_int64, "slip_count": c_int64, "status": c_int32, "stick_slip": c_int32}
        for name in names(type(results))[1:]:
            array = getattr(self, name)
            if array is not None:
                setattr(results, name, pointer(array, kinds.get(name, ctypes.c_double)))
        return results


def friction_batch(
    h: npt.ArrayLike | None,
    dx: float,
    dy: float,
    entries: npt.ArrayLike,
    *,
    friction: Mapping[str, Any],
    shear_modulus: Both | None = None,
    poisson_ratio: Both | None = None,
    young_modulus: Both | None = None,
    approach: float | None = None,
    force: float | None = None,
    mean_pressure: float | None = None,
    pressure: npt.ArrayLike | None = None,
    influence: Any = None,
    layer: npt.ArrayLike | None = None,
    pressure_limit: npt.ArrayLike | None = None,
    coating: Any = None,
    adhesion: Mapping[str, Any] | None = None,
    fields: bool = False,
    units: tuple[str, str] | None = None,
    progress: Callable[[Progress], Any] | bool | None = None,
    **given: Unpack[SolveOptions],
) -> FrictionBatch:
    """Solves many tangential problems of one scene: each entry has its own creepages (or forces) and spin.

    The normal problem is solved once, or not at all if pressures are given. With n threads n entries are solved at a time. Neighbours in the list should have
    similar motions, because an entry that differs little from the one before starts from the tractions of that entry.

    Parameters
    ----------
    h : array_like, (my, mx), or None
        Undeformed distance; None if `pressure` is given.
    dx, dy : float
        Element sizes.
    entries : array_like, (n, 3)
        For each entry the prescribed values in x and in y, and the spin.
    friction : mapping
        As for `solve`, but the values of "creepage", "force" and "spin" are not used. In a direction whose "force" is not None, the entries are forces. If
        "motion" is "SHIFT", the default, creepages are lengths and spins are angles.
    approach, force, mean_pressure : float
        Exactly one of them, unless there is a `pressure`.
    pressure : array_like, (my, mx), optional
        The pressures of a normal problem that is already solved.
    fields : bool
        Whether the arrays of tractions, slips and stick and slip areas of each entry are wanted.
    progress : callable or bool, optional
        A callable gets a `Progress` about once for each entry, whose `cycles` is the number of finished entries, and cancels the call if it returns a true
        value. True draws a bar on stderr.
    shear_modulus, poisson_ratio, young_modulus, influence, layer, pressure_limit, coating, adhesion, units, **given
        As for `solve`. With `influence` the entry "influence" of `friction` is needed, too.

    Returns
    -------
    FrictionBatch

    Raises
    ------
    ContactNormalError
        If the whole call is refused. If only an entry is refused, its `status` is negative.
    """
    struct, units = options(given), checked(units)
    scene, pressures = with_pressures(
        h, pressure, dx, dy, {"approach": approach, "force": force, "mean_pressure": mean_pressure}, shear_modulus=shear_modulus,
        poisson_ratio=poisson_ratio, young_modulus=young_modulus,
        effects={"influence": influence, "layer": layer, "pressure_limit": pressure_limit, "coating": coating, "friction": friction,
                 "adhesion": adhesion},
    )
    return table_of(scene, pressures, entries, struct, progress, fields, None, units)


def table_of(
    scene: Scene, pressures: Doubles | None, entries: Any, struct: Any, progress: Callable[[Progress], Any] | bool | None, fields: bool,
    handle: Handle | None, units: Any = None,
) -> FrictionBatch:
    """Solves the tangential problems of a table of entries, with the handle of a solver or without."""
    table = doubles("entries", entries, dimensions="(n, 3)")
    if table.shape[1] != 3:
        raise ValueError(f"entries has shape {table.shape}; it must be (n, 3)")
    watched = Watched(progress, struct, scene, len(table))
    found = FrictionBatch(len(table), scene.shape, fields)
    results, report = found._results(), initialised("report")
    untouched = -(2**31)
    found.status[:] = untouched
    no_handle = [] if handle else [None]
    status, message = watched.call(
        library.contact_normal_solve_tangential, *no_handle, ctypes.byref(scene.struct), None if pressures is None else pointer(pressures),
        ctypes.byref(struct), len(table), pointer(table), ctypes.byref(results), ctypes.byref(report), handle=handle,
        keep=(scene, pressures, table, found), report=report,
    )
    if not len(table) or untouched in found.status:
        check(status, message)
    remark = scene.remarks.of_entries(table) if scene.remarks else ""
    found.message = "\n".join(text for text in (message, remark) if text)
    found.units = units
    found.report = reported(report)
    return found
