"""The result of a solve."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ._bill import omissions
from ._constants import PRESCRIBED_APPROACH, WARNING_BORDER, WARNING_ONE_ELEMENT
from ._ledger import Ledger
from ._outputs import LEDGER_ROOM, Outputs
from ._solved import Solved
from ._structs import LedgerRow, names
from ._units import in_pascal, with_unit

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._scene import Scene

# Linear elasticity is for small strains: a largest pressure above this part of E* is a reason to warn. A ball reaches about this part when the width of its
# contact is 0.6 of its radius (Hertz: p0/E* = 2 a/(pi R)).
_STRAINED = 0.2

# E* of solids in pascal, from gels to a rigid body on diamond.
_SOLIDS = 1e3, 2e12

# A contact of at most this many elements across is too narrow: the largest pressure of a line contact then has a relative error of up to 3/4. With three
# elements across it is up to 1/5.
_FEW = 2

_ROW = [name for name in names(LedgerRow) if name not in ("struct_size", "reserved")]


class Result(Solved):
    """The result of a solve.

    Attributes
    ----------
    status : int
        0 (OK): the contact conditions hold to the tolerance. > 0: the solve stopped early, and the arrays hold the best iterate. < 0 (batches only): the
        problem was refused, and the arrays have no meaning.
    message : str
        The reason for a status that is not OK, and further remarks.
    pressure : ndarray of float, (my, mx)
        The pressures p.
    deformed_distance : ndarray of float, (my, mx)
        The deformed distance e: the gap under load.
    displacement : ndarray of float, (my, mx)
        The normal displacements u = A p of both bodies together, with the compression of a layer.
    contact : ndarray of bool, (my, mx)
        The contact area, including the elements at the pressure limit.
    at_limit : ndarray of bool, (my, mx)
        The elements at the pressure limit.
    traction : ndarray of float, (2, my, mx)
        With friction: tractions q on body 1, in x and y; otherwise zeros.
    slip : ndarray of float, (2, my, mx)
        With friction: the slip of body 1 over body 2 in the step, in x and y; otherwise zeros.
    stick_slip : ndarray of int, (my, mx)
        With friction: 0 exterior, 1 stick, 2 slip, 3 slip in a plastic layer.
    friction_coefficient, yield_limit : ndarray of float, (my, mx)
        With a law of friction or a plastic layer: the state of the particles of the interface after the step; otherwise zeros.
    contact_pressure, attraction : ndarray of float, (my, mx)
        With adhesion: the contact pressure q >= 0 and the attraction sigma >= 0, with p = q - sigma. Without adhesion: p, and zeros.
    x : ndarray of float, (mx,)
        x of the centres of the elements, relative to the middle of the grid.
    y : ndarray of float, (my,)
        y of the centres of the elements, relative to the middle of the grid.
    dx, dy : float
        Element sizes.
    approach : float
        Approach of the bodies.
    force : float
        Normal force, the sum of p dx dy.
    mean_pressure : float
        The normal force over the area of the grid.
    max_pressure : float
        The largest pressure.
    contact_area : float
        The area of the elements in contact.
    mean_gap : float
        The mean of the deformed distance, over the elements with a surface.
    warnings : tuple of str
        Names of the warnings, also if the status is OK. Those of the library are "BORDER", "ONE_ELEMENT", "SPIKE", "ERROR_UNKNOWN", "RANGE", "ATTRACTION" and
        "LAW". This package adds "STRAIN" if the largest pressure is more than a fifth of E*, "MODULUS" if no solid has this E* in the named units, and "NARROW"
        if the contact is at most two elements wide, on a grid with more columns or rows.
    tangential_force : (float, float)
        With friction: the tangential force on body 1, in x and y; otherwise zeros.
    units : (str, str) or None
        Names of the units of lengths and forces, for pictures and files. The caller may set them.
    report : dict
        The values of all groups of `contact_normal_report`: "cycles", "residual", "error_force", ... The page of the Python reference has all keys.
    ledger : Ledger
        The results and costs on each grid, one dict per grid.
    """

    def __init__(self, status: int, message: str, outputs: Outputs, report: Any, scene: Scene, units: Any = None) -> None:
        super().__init__(status, message, outputs, report, scene, units)
        _, self.deformed_distance, self.displacement = outputs.doubles
        self._rows = outputs.rows
        part = report.normal.max_pressure / scene.bodies.e_star if scene.has_half_space else 0.0
        self._is_strained = part > _STRAINED
        if self._is_strained:
            told = (f"the largest pressure is {part:.2g} E*, and linear elasticity is for small strains: are moduli, forces and lengths in one system of units? "
                    "Else a hardness limits pressures (pressure_limit)")
            self._add(told)
        pascal = scene.bodies.e_star * (in_pascal(units) or np.nan) if scene.has_half_space else np.nan
        self._is_no_solid = bool(pascal < _SOLIDS[0] or pascal > _SOLIDS[1])
        if self._is_no_solid:
            self._add(f"E* is {pascal:.3g} Pa in the units {units!r}, and solids have {_SOLIDS[0]:g} to {_SOLIDS[1]:g} Pa")
        if report.warnings & WARNING_BORDER and (ends := self._ends_in_contact()):
            self._add(f"contact is at the ends of the grid in {ends}")
        narrow = "" if report.warnings & WARNING_ONE_ELEMENT else self._narrow()
        self._is_narrow = bool(narrow)
        if narrow:
            self._add(f"contact is at most {_FEW} elements wide in {narrow}: take smaller elements there. Are moduli, forces and lengths in one system of units?")
        self._estimated = "force" if scene.struct.load == PRESCRIBED_APPROACH else "approach"

    def _add(self, told: str) -> None:
        """Adds a line to the message."""
        self.message = "\n".join(text for text in (self.message, told) if text)

    def _narrow(self) -> str:
        """The directions in which the contact is at most `_FEW` elements wide, although more elements have surfaces."""
        touches = self._contact != 0
        found = [(name, axis) for name, axis in (("x", 0), ("y", 1)) if 0 < np.count_nonzero(touches.any(axis)) <= _FEW < touches.shape[1 - axis]]
        return " and ".join(name for name, axis in found if np.count_nonzero(np.isfinite(self.deformed_distance).any(axis)) > _FEW)

    def _ends_in_contact(self) -> str:
        """The directions without a period in which the contact reaches an end of the grid."""
        period = self._scene.period
        ends = {"x": self._contact[:, [0, -1]], "y": self._contact[[0, -1]]}
        return " and ".join(name for name, elements in ends.items() if name not in period and elements.any())

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in {**super().__getstate__(), "ledger": self.ledger}.items() if name != "_rows"}

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Names of the warnings of the library and of this package, also if the status is OK."""
        return (*super().warnings, *("STRAIN",) * self._is_strained, *("MODULUS",) * self._is_no_solid, *("NARROW",) * self._is_narrow)

    @cached_property
    def at_limit(self) -> npt.NDArray[np.bool_]:
        """The elements at the pressure limit."""
        at_limit: npt.NDArray[np.bool_] = self._contact == 2
        return at_limit

    @cached_property
    def ledger(self) -> Ledger:
        """The results and costs on each grid, one dict per grid."""
        rows = self._rows[: min(self._report.ledger_rows, LEDGER_ROOM)]
        return Ledger(({name: getattr(row, name) for name in _ROW} for row in rows), self._estimated)

    @property
    def neglected(self) -> tuple[str, ...]:
        """The effects that the option `neglect_below` left out. `neglected_error` is the error that this causes."""
        return omissions(int(self.report["neglected"]))

    @property
    def neglected_error(self) -> float:
        """The relative error by leaving out `neglected`: the largest change of a quantity, its error included; 0 if nothing is left out."""
        return float(self.report["neglected_error"])

    @property
    def approach(self) -> float:
        """Approach of the bodies."""
        return float(self.report["approach"])

    @property
    def mean_gap(self) -> float:
        """The mean of the deformed distance over the elements with a surface; nan without any."""
        known = self.deformed_distance[np.isfinite(self.deformed_distance)]
        return float(known.mean()) if known.size else float("nan")

    def _numbers(self) -> list[str]:
        force, *others = super()._numbers()
        return [force, with_unit(f"approach {self.approach:.6g}", "length", self.units), *others, f"residual {self.report['residual']:.1e}"]

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the pressures and the outline of the contact area, in a view from above.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            The axes to draw on; by default those of a new figure.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, for additions or for saving: `axes.figure.savefig("pressure.png")`.
        """
        from ._plot_above import plot_pressure

        return plot_pressure(self, axes)

    def plot_section(self, x: float | None = None, y: float | None = None, axes: Axes | None = None) -> Axes:
        """Draws the pressures along a row or a column of elements, with dotted lines at the edge of the contact area.

        The column is at `x`, or the row at `y`; by default it is the row in the middle of the grid. `axes` is as for `Result.plot`.
        """
        from ._plot_lines import plot_section

        return plot_section(self, x, y, axes)


class TangentialResult(Solved):
    """The result of `solve_tangential`: the tractions for given pressures. It has the methods of `Result` except `plot` and `plot_section`.

    Attributes
    ----------
    status : int
        0 (OK): the conditions of friction hold to the tolerance. > 0: the solve stopped early.
    message : str
        The reason for a status that is not OK, and further remarks.
    pressure : ndarray of float, (my, mx)
        The given pressures, where those that are not positive are set to 0.
    contact : ndarray of bool, (my, mx)
        The elements with a positive pressure.
    traction, slip, stick_slip, x, y, dx, dy, units
        As those of `Result`.
    force, mean_pressure, max_pressure, contact_area : float
        Quantities of the given pressures, as those of `Result`.
    tangential_force : (float, float)
        The tangential force on body 1, in x and y.
    report : dict
        The values of `contact_normal_report`; those of the normal problem have no meaning.
    """
