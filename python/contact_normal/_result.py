"""What a solve found."""

from __future__ import annotations

from collections.abc import Iterable
from ctypes import c_int32
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import doubles, integers, pointer
from ._constants import (
    INITIAL_GUESS_GIVEN,
    INITIAL_GUESS_NONE,
    PRESCRIBED_APPROACH,
    WARNING_BORDER,
    WARNING_ERROR_UNKNOWN,
    WARNING_ONE_ELEMENT,
    WARNING_SPIKE,
)
from ._library import initialised, library
from ._structs import LedgerRow, names

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._arguments import Doubles
    from ._scene import Scene
    from ._stress import SubsurfaceStress

_WARNINGS = {
    "BORDER": WARNING_BORDER,
    "ONE_ELEMENT": WARNING_ONE_ELEMENT,
    "SPIKE": WARNING_SPIKE,
    "ERROR_UNKNOWN": WARNING_ERROR_UNKNOWN,
}
# The groups of a report.
_GROUPS = ("normal", "tangential", "accuracy", "statistics")
# Members of the tangential group that have the name of one of the normal problem.
_ALSO_NORMAL = ("force", "moment", "residual", "gap")
_ROW = [name for name in names(LedgerRow) if name not in ("struct_size", "reserved")]
_LEDGER_ROOM = 32  # one row per grid, each with half the elements in a direction: mx and my are 32-bit


class Ledger(list[dict[str, float]]):
    """What was known on each grid and what it had cost: one dict per grid, coarsest first.

    `estimated` is what "error_force" speaks of: "force", or "approach" where the force is prescribed.

    The keys are the members of `contact_normal_ledger_row`: "mx", "my", "cycles", "seconds", "work_units", "residual", "approach",
    "force", "max_pressure", "contact_area", "error_force", ... Estimated errors are absolute; a negative one is not known.
    """

    def __init__(self, rows: Iterable[dict[str, float]] = (), estimated: str = "force") -> None:
        super().__init__(rows)
        self.estimated = estimated

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the estimated error of every grid over the seconds it took.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Where to draw; by default the axes of a new figure.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, to add to or to save: `axes.figure.savefig("ledger.png")`.
        """
        from ._plot import plot_ledger

        return plot_ledger(self, self.estimated, axes)


class Result:
    """What a solve found.

    Attributes
    ----------
    status : int
        0 (OK): the contact conditions hold to the tolerance. > 0: stopped early, the arrays hold the best iterate. < 0 (batches
        only): refused, the arrays mean nothing.
    message : str
        Why, if the status is not OK.
    pressure, deformed_distance, displacement : ndarray of float, (my, mx)
        p, e and u.
    contact : ndarray of bool, (my, mx)
        The contact area, with the elements at the pressure limit.
    at_limit : ndarray of bool, (my, mx)
        The elements at the pressure limit.
    traction, slip : ndarray of float, (2, my, mx)
        With friction: q on body 1 and the slip of body 1 over body 2 in the step, in x and y; else zeros.
    stick_slip : ndarray of int, (my, mx)
        With friction: 0 exterior, 1 stick, 2 slip.
    dx, dy : float
        Element sizes.
    report : dict
        The numbers of `contact_normal_report`, of all its groups: "cycles", "residual", "max_pressure", "contact_area", "error_force", ...
    ledger : Ledger
        One dict per grid.
    """

    def __init__(self, status: int, message: str, outputs: Outputs, report: Any, scene: Scene) -> None:
        self.status, self.message = status, message
        self.pressure, self.deformed_distance, self.displacement = outputs.doubles
        self._scene, self._outputs, self._report = scene, outputs, report
        self.dx: float = scene.struct.dx
        self.dy: float = scene.struct.dy

    # What follows is made when it is first asked for: small problems take no longer than that would.
    @cached_property
    def contact(self) -> npt.NDArray[np.bool_]:
        """The contact area, with the elements at the pressure limit."""
        of_any_kind: npt.NDArray[np.bool_] = self._outputs.contact != 0
        return of_any_kind

    @cached_property
    def at_limit(self) -> npt.NDArray[np.bool_]:
        """The elements at the pressure limit."""
        at_limit: npt.NDArray[np.bool_] = self._outputs.contact == 2
        return at_limit

    @cached_property
    def traction(self) -> Doubles:
        """q on body 1, in x and y; zeros without friction."""
        return self._outputs.traction if self._outputs.traction is not None else np.zeros((2, *self.pressure.shape))

    @cached_property
    def slip(self) -> Doubles:
        """The slip of body 1 over body 2 in the step, in x and y; zeros without friction."""
        return self._outputs.slip if self._outputs.slip is not None else np.zeros((2, *self.pressure.shape))

    @cached_property
    def stick_slip(self) -> npt.NDArray[np.int32]:
        """0 exterior, 1 stick, 2 slip; zeros without friction."""
        stick_slip = self._outputs.stick_slip
        return stick_slip if stick_slip is not None else np.zeros(self.pressure.shape, dtype=np.int32)

    @cached_property
    def report(self) -> dict[str, Any]:
        """The numbers of `contact_normal_report`."""
        return reported(self._report)

    @cached_property
    def ledger(self) -> Ledger:
        """One dict per grid."""
        rows = self._outputs.rows[: min(self._report.ledger_rows, _LEDGER_ROOM)]
        estimated = "force" if self._scene.struct.load == PRESCRIBED_APPROACH else "approach"
        return Ledger(({name: getattr(row, name) for name in _ROW} for row in rows), estimated)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """What to look at, even where the status is OK: "BORDER", "ONE_ELEMENT", "SPIKE", "ERROR_UNKNOWN"."""
        return tuple(name for name, bit in _WARNINGS.items() if self._report.warnings & bit)

    @property
    def approach(self) -> float:
        """Approach of the bodies."""
        return float(self.report["approach"])

    @property
    def force(self) -> float:
        """Normal force: the sum of p dx dy."""
        return float(self.report["force"])

    def __repr__(self) -> str:
        my, mx = self.pressure.shape
        status = library.contact_normal_status_text(self.status).decode()
        warned = f", warnings: {', '.join(self.warnings)}" if self.warnings else ""
        return f"<Result: {status}; {mx} x {my} elements, force {self.force:.6g}, approach {self.approach:.6g}{warned}>"

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the pressures and the outline of the contact area, seen from above.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Where to draw; by default the axes of a new figure.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, to add to or to save: `axes.figure.savefig("pressure.png")`.
        """
        from ._plot import plot_pressure

        return plot_pressure(self, axes)

    def plot_traction(self, axes: Axes | None = None) -> Axes:
        """Draws the tractions as arrows over the stick and slip areas, seen from above.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Where to draw; by default the axes of a new figure.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, to add to or to save.
        """
        from ._plot import plot_traction

        return plot_traction(self, axes)

    def subsurface(
        self,
        depths: npt.ArrayLike,
        *,
        traction: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
        body: int = 1,
        principal: bool = False,
        threads: int = 1,
    ) -> SubsurfaceStress:
        """The stresses below the surface of one body, from these pressures.

        Parameters
        ----------
        depths : array_like, (n,)
            Depths into the body, in any order.
        traction : (array_like (my, mx), array_like (my, mx)), optional
            Tractions that act on this body, in x and in y; by default those that `friction` found, if any.
        body : {1, 2}
            Which one: its Poisson ratio matters.
        principal : bool
            Whether principal stresses and their directions are wanted, too.
        threads : int
            0: all cores.

        Returns
        -------
        SubsurfaceStress

        Examples
        --------
        >>> import numpy as np, contact_normal
        >>> x = (np.arange(64) - 31.5) * 0.05
        >>> h = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 50.0)
        >>> result = contact_normal.solve(h, 0.05, 0.05, force=1000.0, shear_modulus=82000.0, poisson_ratio=0.3)
        >>> stress = result.subsurface(np.linspace(0.0, 2.0, 41))
        >>> round(stress.largest_shear["value"] / result.report["max_pressure"], 2)
        0.31
        """
        from ._stress import subsurface

        if traction is None and self.traction.any():
            sign = 1.0 if body == 1 else -1.0
            traction = (sign * self.traction[0], sign * self.traction[1])
        return subsurface(self._scene, self.pressure, depths, traction, body, principal, threads)


_ROWS = LedgerRow * _LEDGER_ROOM


def _value(value: Any) -> Any:
    """A number, or a tuple of those of an array."""
    return value if isinstance(value, (int, float)) else tuple(value)


def reported(report: Any) -> dict[str, Any]:
    """The numbers of all groups of a report: "force" is normal.force, "tangential_force" is tangential.force."""
    found: dict[str, Any] = {"ledger_rows": report.ledger_rows, "warnings": report.warnings}
    for group in _GROUPS:
        members = getattr(report, group)
        for name in names(type(members)):
            if name != "reserved":
                key = f"tangential_{name}" if group == "tangential" and name in _ALSO_NORMAL else name
                found[key] = _value(getattr(members, name))
    return found


class Outputs:
    """New arrays for one problem and the structs that point to them; `pressure` and `contact` are the initial guess. Those of friction
    only where there is friction: to clear and write them takes some .25 ms of 10 on 256 x 256 elements."""

    traction: Doubles | None = None
    slip: Doubles | None = None
    stick_slip: npt.NDArray[np.int32] | None = None

    def __init__(self, shape: tuple[int, int], pressure: Any, contact: Any, options: Any, has_friction: bool) -> None:
        self.doubles: list[Doubles] = [np.zeros(shape) for _ in range(3)]
        self.contact = np.zeros(shape, dtype=np.int32)
        if pressure is not None:
            self.doubles[0][:] = doubles("pressure", pressure, shape)
            if contact is None:
                self.contact[:] = self.doubles[0] > 0
        if contact is not None:
            self.contact[:] = integers("contact", contact, shape)
        if pressure is not None and options.initial_guess == INITIAL_GUESS_NONE:
            options.initial_guess = INITIAL_GUESS_GIVEN
        self.fields, self.report = initialised("fields"), initialised("report")
        self.fields.pressure, self.fields.deformed_distance, self.fields.displacement = map(pointer, self.doubles)
        self.fields.contact = pointer(self.contact, c_int32)
        if has_friction:
            self._hold_friction(shape)
        self.rows = _ROWS(initialised("ledger_row"))
        self.report.ledger, self.report.ledger_capacity = self.rows, _LEDGER_ROOM

    def _hold_friction(self, shape: tuple[int, int]) -> None:
        """Arrays of what friction finds."""
        self.traction, self.slip = np.zeros((2, *shape)), np.zeros((2, *shape))
        self.stick_slip = np.zeros(shape, dtype=np.int32)
        for k in range(2):
            self.fields.traction[k], self.fields.slip[k] = pointer(self.traction[k]), pointer(self.slip[k])
        self.fields.stick_slip = pointer(self.stick_slip, c_int32)
