"""The class `Solved`: the fields and values that results of normal and of tangential problems share."""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ._grid import centres
from ._library import library
from ._numbered import names_of
from ._structs import names
from ._units import WithUnits, with_unit

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._arguments import Doubles
    from ._outputs import Outputs
    from ._scene import Scene
    from ._stress import SubsurfaceStress

# The members of `contact_normal_report` that are structs of values.
_GROUPS = ("normal", "tangential", "accuracy", "statistics", "adhesion", "visco")
_WARNINGS = names_of("WARNING_")
# Members of the tangential group whose names the group of the normal problem has too.
_ALSO_NORMAL = ("force", "moment", "residual", "gap", "update")


def report_key(group: str, name: str) -> str:
    """The key of `Result.report` for a member of a group: its name, or `tangential_` and the name where the normal problem has the name too."""
    return f"tangential_{name}" if group == "tangential" and name in _ALSO_NORMAL else name


def reported(report: Any) -> dict[str, Any]:
    """The dict of `Result.report`: the values of all groups by `report_key`, with arrays as tuples."""
    found: dict[str, Any] = {"ledger_rows": report.ledger_rows, "warnings": report.warnings}
    for group in _GROUPS:
        members = getattr(report, group)
        for name in names(type(members)):
            if not name.startswith("reserved"):
                value = getattr(members, name)
                found[report_key(group, name)] = value if isinstance(value, (int, float)) else tuple(value)
    return found


class Solved(WithUnits):
    """The base class of `Result` and `TangentialResult`, whose docstrings describe the attributes."""

    def __init__(self, status: int, message: str, outputs: Outputs, report: Any, scene: Scene, units: Any = None) -> None:
        self.status, self.message = status, "\n".join(text for text in (message, scene.remark) if text)
        self.pressure = outputs.doubles[0]
        self._contact, self._report, self._scene = outputs.contact, report, scene
        self._of_effects = outputs.of_effects
        self.dx: float = scene.struct.dx
        self.dy: float = scene.struct.dy
        self._centre = 0.0, 0.0
        self.units = units

    def __getstate__(self) -> dict[str, Any]:
        # The report is pickled and copied as a dict of numbers, because a struct of the library holds addresses.
        return {name: value for name, value in {**self.__dict__, "report": self.report}.items() if name != "_report"}

    # The following attributes are computed when they are first used: together they would take as long as a small solve.
    @cached_property
    def contact(self) -> npt.NDArray[np.bool_]:
        """The contact area: True where elements touch, also at the pressure limit."""
        touches: npt.NDArray[np.bool_] = self._contact != 0
        return touches

    def _field(self, name: str, *pair: int, kind: Any = float) -> npt.NDArray[Any]:
        """The array `name` that an effect writes, (*pair, my, mx); zeros if the scene has no such effect."""
        written = self._of_effects.get(name)
        return np.zeros((*pair, *self.pressure.shape), kind) if written is None else written

    @cached_property
    def traction(self) -> Doubles:
        """The tractions q on body 1, in x and y; zeros without friction."""
        return self._field("traction", 2)

    @cached_property
    def slip(self) -> Doubles:
        """The slip of body 1 over body 2 in the step, in x and y; zeros without friction."""
        return self._field("slip", 2)

    @cached_property
    def stick_slip(self) -> npt.NDArray[np.int32]:
        """0 exterior, 1 stick, 2 slip, 3 slip in a plastic layer; zeros without friction."""
        return self._field("stick_slip", kind=np.int32)

    @cached_property
    def friction_coefficient(self) -> Doubles:
        """With a law of friction or a plastic layer: mu of the particles of the interface after the step; otherwise zeros."""
        return self._field("friction_coefficient")

    @cached_property
    def yield_limit(self) -> Doubles:
        """With a plastic layer: the yield limits of the particles after the step; otherwise zeros."""
        return self._field("yield_limit")

    @cached_property
    def contact_pressure(self) -> Doubles:
        """The contact pressure: with adhesion p + sigma in contact, and 0 outside; without adhesion p."""
        return self._of_effects.get("contact_pressure", self.pressure)

    @cached_property
    def attraction(self) -> Doubles:
        """The attraction sigma(e) across the gap; zeros without adhesion."""
        return self._field("attraction")

    @cached_property
    def report(self) -> dict[str, Any]:
        """The values of all groups of `contact_normal_report` by name."""
        return reported(self._report)

    @property
    def x(self) -> Doubles:
        """x of the centres of the elements, (mx,), relative to the middle of the grid."""
        return centres(self.pressure.shape[1], self.dx, self._centre[0])

    @property
    def y(self) -> Doubles:
        """y of the centres of the elements, (my,), relative to the middle of the grid."""
        return centres(self.pressure.shape[0], self.dy, self._centre[1])

    @property
    def force(self) -> float:
        """Normal force: the sum of p dx dy."""
        return float(self.report["force"])

    @property
    def mean_pressure(self) -> float:
        """The normal force over the area of the grid."""
        return self.force / (self.pressure.size * self.dx * self.dy) if self.pressure.size else 0.0

    @property
    def max_pressure(self) -> float:
        """The largest pressure."""
        return float(self.report["max_pressure"])

    @property
    def contact_area(self) -> float:
        """The area of the elements in contact."""
        return float(self.report["contact_count"]) * self.dx * self.dy

    @property
    def has_friction(self) -> bool:
        """Whether the scene has friction."""
        return "traction" in self._of_effects

    @property
    def tangential_force(self) -> tuple[float, float]:
        """The tangential force on body 1, in x and y; zeros without friction."""
        x, y = self.report["tangential_force"]
        return x, y

    def _numbers(self) -> list[str]:
        """The quantities that `repr` shows, as texts with units."""
        my, mx = self.pressure.shape
        share = self.contact_area / (my * mx * self.dx * self.dy) if self.pressure.size else 0.0
        told = [
            with_unit(f"force {self.force:.6g}", "force", self.units),
            with_unit(f"max_pressure {self.max_pressure:.5g}", "pressure", self.units),
            with_unit(f"contact_area {self.contact_area:.5g}", "area", self.units) + f" ({100.0 * share:.3g} % of the grid)",
        ]
        if self.has_friction:
            x, y = self.tangential_force
            told.append(with_unit(f"tangential_force ({x:.5g}, {y:.5g})", "force", self.units))
        return told

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Names of the warnings, also if the status is OK: "BORDER", "ONE_ELEMENT", "SPIKE", "ERROR_UNKNOWN", "RANGE", "ATTRACTION", "LAW"."""
        return tuple(name.upper() for bit, name in _WARNINGS.items() if self.report["warnings"] & bit)

    def __repr__(self) -> str:
        my, mx = self.pressure.shape
        status = library.contact_normal_status_text(self.status).decode()
        told = "" if self.status < 0 else ", " + ", ".join(self._numbers())
        warned = f", warnings: {', '.join(self.warnings)}" if self.warnings else ""
        message = f"; {self.message}" if self.message else ""
        return f"<{type(self).__name__}: {status}; {mx} x {my} elements{told}{warned}{message}>"

    def plot_traction(self, axes: Axes | None = None) -> Axes:
        """Draws the tractions as arrows over the stick and slip areas, in a view from above; `axes` as for `Result.plot`."""
        from ._plot_above import plot_traction

        return plot_traction(self, axes)

    def plot_histogram(self, bins: int = 40, axes: Axes | None = None) -> Axes:
        """Draws the share of the contact area over `bins` ranges of pressure; `axes` as for `Result.plot`."""
        from ._plot_lines import plot_histogram

        return plot_histogram(self, bins, axes)

    def _tractions_on(self, body: int, traction: Any) -> Any:
        """The tractions that load a body below its surface: the given ones, else those of friction with their sign on this body; None without any."""
        if traction is None and self.has_friction and self.traction.any():
            sign = 1.0 if body == 1 else -1.0
            return sign * self.traction[0], sign * self.traction[1]
        return traction

    def subsurface(
        self,
        depths: npt.ArrayLike,
        *,
        traction: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
        body: int = 1,
        components: Iterable[str] | None = None,
        principal: bool = False,
        threads: int = 1,
    ) -> SubsurfaceStress:
        """Computes the stresses below the surface of one body by the pressures of this result.

        Parameters
        ----------
        depths : array_like, (n,)
            Depths into the body, in any order.
        traction : (array_like (my, mx), array_like (my, mx)), optional
            Tractions on this body, in x and in y; by default those of the result, with their sign on this body.
        body : {1, 2}
            The body whose stresses are computed, with its Poisson ratio.
        components : sequence of str, optional
            The wanted ones of "xx", "yy", "zz", "xy", "xz", "yz", "von_mises", "maximum_shear"; by default all. The others are None in the result.
        principal : bool
            Whether principal stresses and their directions are also wanted.
        threads : int
            Number of threads; 0: all cores.

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
        >>> round(stress.largest_shear["value"] / result.max_pressure, 2)
        0.31
        """
        from ._stress import warn_of_depths
        from ._subsurface import subsurface

        found = subsurface(self._scene, self.pressure, depths, self._tractions_on(body, traction), body, components, principal, threads)
        found._place(self._centre, self.units)
        warn_of_depths(found, 2.0 * self.contact_area**0.5)
        return found

    def stress_at_points(
        self,
        points: npt.ArrayLike,
        *,
        traction: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
        body: int = 1,
        threads: int = 1,
    ) -> Doubles:
        """Computes the stresses at single points of one body by the pressures of this result.

        Parameters
        ----------
        points : array_like, (n, 3)
            x and y in the coordinates of the result, and the depth. At depth 0 no point may be on the edge of an element.
        traction, body, threads
            As for `subsurface`.

        Returns
        -------
        ndarray, (n, 6)
            xx, yy, zz, xy, xz, yz of each point, positive in tension.
        """
        from ._subsurface import at_points

        return at_points(self._scene, self.pressure, points, self._tractions_on(body, traction), body, threads, self._centre)

    def to_xarray(self) -> Any:
        """Returns all fields as an `xarray.Dataset` with coordinates, names and, if `units` are known, units. Needs xarray."""
        from ._datasets import of_result

        return of_result(self)

    def to_netcdf(self, path: str | os.PathLike[str]) -> None:
        """Writes the dataset of `to_xarray` as a NetCDF file, whole or not at all. Needs xarray and netCDF4."""
        from ._netcdf import write, xarray

        xarray()
        write(path, self.to_xarray())
