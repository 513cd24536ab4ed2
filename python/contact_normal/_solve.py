"""Solves one scene: on a given grid, or on grids fine enough for an accuracy."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from ._arguments import AccuracyOptions, Both, SolveOptions, options, relative
from ._callbacks import Progress, Watched
from ._calls import called
from ._handle import Handle
from ._library import check, library
from ._outputs import Outputs
from ._refined import limits, on_any_grid, set_targets
from ._result import Result
from ._scene import Scene
from ._units import checked

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack


def solve(
    h: npt.ArrayLike,
    dx: float,
    dy: float,
    *,
    approach: float | None = None,
    force: float | None = None,
    mean_pressure: float | None = None,
    shear_modulus: Both | None = None,
    poisson_ratio: Both | None = None,
    young_modulus: Both | None = None,
    e_star: float | None = None,
    influence: Any = None,
    layer: npt.ArrayLike | None = None,
    pressure_limit: npt.ArrayLike | None = None,
    period: str | None = None,
    patches: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    row_tables: Any = None,
    coating: Any = None,
    friction: Mapping[str, Any] | None = None,
    adhesion: Mapping[str, Any] | None = None,
    visco: Mapping[str, Any] | None = None,
    pressure: npt.ArrayLike | None = None,
    contact: npt.ArrayLike | None = None,
    units: tuple[str, str] | None = None,
    progress: Callable[[Progress], Any] | bool | None = None,
    **given: Unpack[SolveOptions],
) -> Result:
    """Solves one scene: the undeformed distance on a grid and the prescribed approach or force.

    Parameters
    ----------
    h : array_like, (my, mx)
        Undeformed distance, a length; inf or masked: no surface there. Any consistent units: mm, N and N/mm2, or m, N and Pa.
    dx, dy : float
        Element sizes in x (along rows) and y.
    approach, force, mean_pressure : float
        Exactly one of them: the approach of the bodies, the normal force, or the normal force over the area of the grid.
    shear_modulus, young_modulus : float or pair of floats
        One of them, for both bodies or for each; inf: a rigid body.
    poisson_ratio : float or pair of floats
        For both bodies or for each.
    e_star : float
        Instead of either modulus: E* with 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. The Poisson ratio may then be left out without friction and coatings. Both
        bodies are equally compliant.
    influence : array_like, (2 cy, 2 cx), or (array_like, scale), optional
        The caller's influence coefficients in place of those of the half-space. They are multiplied by the scale, if one is given.
    layer : float or array_like, (my, mx), optional
        Compliance of a thin layer between the bodies, a length per pressure.
    pressure_limit : float or array_like, (my, mx), optional
        The largest pressure that an element can carry, as the hardness of the material.
    period : {"x", "y", "xy"}, optional
        The grid is one period of a periodic scene.
    patches : (array_like of int (my, mx), array_like (count, count)), optional
        The number of the patch of each element, from 0 on (-1: nothing touches there), and for each pair of patches the factor of the displacements that one
        causes in the other: 1 as on one half-space, 0 none.
    row_tables : array_like, (my, my, 2 cx), or (array_like, scale), optional
        The caller's influence coefficients, one table for each loaded row: [loaded row, row of the displacement, offset in x].
    coating : (of body 1, of body 2), optional
        For each body None or `(thickness, shear_modulus, poisson_ratio)`: an elastic layer bonded to the body. The elastic constants above are then those of
        the substrate, which may be rigid (inf).
    friction : mapping, optional
        Friction between the bodies. docs/friction.md has the signs. Its entries:

        - "coefficient": mu of all elements, or (my, mx).
        - "motion": "SHIFT" (default), "TRANSIENT_ROLLING" or "STEADY_ROLLING".
        - "creepage": a pair, in x and y; "force": a pair of prescribed tangential forces, None in a direction whose creepage is given.
        - "spin", and "spin_centre", the pair of coordinates about which the spin turns.
        - "rolling_distance", "rolling_direction", "spin_offset": the step of rolling.
        - "previous_traction", "rigid_slip", "initial_traction", "creepage_weight": pairs of (my, mx).
        - "compliance": that of a thin elastic layer between the bodies, one or (my, mx).
        - "law": how the coefficient falls with the slip velocity, a mapping of "kind" ("LINEAR", "RATIONAL", "EXPONENTIAL"), "kinetic", "falling" and
          "half_speed" (one or a pair), "speed" of rolling or "time_step" of a shift, "memory_distance", "memory_speed".
        - "layer": a plastic layer, a mapping of "yield_limit" and "hardening".
        - "previous_coefficient", "previous_yield_limit": (my, mx), the state of the particles of the interface before the step.
        - "branch": which of several solutions, "NEAR", "LOW" or "HIGH" (docs/laws.md).
        - "continues": True starts the step from the last tractions of a `Solver`.
        - "sensitivities": True for the derivatives of both forces and the moment by both creepages and the spin, nine numbers row by row in
          `report["sensitivities"]`.
        - "influence": the caller's tangential coefficients (xx, yy, xy) or (xx, yy, xy, scale), each (2 cy, 2 cx).
        - "influence_cross": with "influence" for unlike bodies, the coefficients (xz, yz) of tangential displacements by a pressure.
        - "row_tables": the caller's tangential coefficients for each loaded row, (xx, yy, xy) or (xx, yy, xy, scale), each (my, my, 2 cx).
    adhesion : mapping, optional
        Attraction across the gap. `force` may then be negative. docs/adhesion.md says how to choose the law and the range. Its entries:

        - "work": the work of adhesion, an energy per area, one or (my, mx).
        - "law": "EXPONENTIAL" (default), "DUGDALE", "CUBIC" or "VAN_DER_WAALS".
        - "range": a length, by default the shortest that the elements resolve.
        - "smear": DUGDALE falls to 0 linearly from (1 - smear) to (1 + smear) ranges.
        - "start": "AUTO" (default), "FROM_CONTACT" or "FROM_APART" chooses one of several states.
        - "stiffness": True for dF/dapproach; "stability": True for the distance of the state from a snap.
        - "shear_strength": a traction that adds to the bound of friction in contact.
    visco : mapping, optional
        Viscoelastic bodies, whose `shear_modulus` is the instantaneous one. docs/visco.md has the equations. `report` has the "time", the "step_error", the
        "time_error" and the "compliance". Its entries:

        - "modulus", "time": pairs (body 1, body 2) of the moduli and the relaxation times of the branches, None for an elastic body.
        - "time_step": the duration of the step, 0 (default) for a jump of the load.
        - "form": the discretisation in time, "AUTO" (default), "RELAXATION", "CREEP" or "BACKWARD_EULER".
        - "continues": True continues from the last step of a `Solver`.
    pressure, contact : array_like, (my, mx), optional
        Initial guess: the pressures, or the contact area (booleans or integers). With `active_set="FIXED"` `contact` is not a guess but the contact area.
    units : (str, str), optional
        Names of the units of lengths and forces, as ("mm", "N"), for pictures and files. They change no value.
    progress : callable or bool, optional
        A callable gets a `Progress` after each cycle, and cancels the solve if it returns a true value. True draws a bar on stderr.
    **given : SolveOptions
        method, tolerance, max_cycles, threads, ...

    Returns
    -------
    Result
        Its `status` is `OK` if the contact conditions hold to the tolerance. Otherwise the status is > 0: the solve stopped early, and `message` says why.

    Raises
    ------
    ContactNormalError
        If the library refuses the scene or an option.
    TypeError, ValueError
        If an argument has a wrong type or shape.

    Examples
    --------
    A steel ball of radius 50 mm, pressed onto a steel plate by 1000 N:

    >>> import numpy as np, contact_normal
    >>> x = (np.arange(64) - 31.5) * 0.05
    >>> h = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 50.0)
    >>> result = contact_normal.solve(h, 0.05, 0.05, force=1000.0, shear_modulus=82000.0, poisson_ratio=0.28)
    >>> result.status, round(result.force), result.pressure.shape
    (0, 1000, (64, 64))
    """
    effects = {"influence": influence, "layer": layer, "pressure_limit": pressure_limit, "period": period, "patches": patches,
               "row_tables": row_tables, "coating": coating, "friction": friction, "adhesion": adhesion, "visco": visco}
    # Options first, so that a misspelt load is refused as an unknown option, not as a missing load.
    struct, units = options(given), checked(units)
    scene = Scene(h, dx, dy, approach, force, shear_modulus, poisson_ratio, effects, mean_pressure=mean_pressure, young_modulus=young_modulus,
                  e_star=e_star)
    outputs = Outputs(scene.shape, pressure, contact, struct, friction is not None, scene, adhesion is not None)
    watched = Watched(progress, struct, scene)
    status, message = watched.call(
        library.contact_normal_solve, ctypes.byref(scene.struct), ctypes.byref(struct), ctypes.byref(outputs.fields),
        ctypes.byref(outputs.report), keep=(scene, outputs), report=outputs.report,
    )
    return Result(check(status, message), message, outputs, outputs.report, scene, units)


class AccurateResult(Result):
    """The result of `solve_to_accuracy`, on its last grid.

    Attributes
    ----------
    reached : float or None
        Estimated relative error of the force (of the approach, if the force is prescribed); None: not known.
    seconds : float
        Wall-clock time of the solves on all grids together.
    """

    reached: float | None
    seconds: float

    def _take(self, accuracy: Any, middle: tuple[float, float]) -> None:
        """Sets the grid to the last one of the search, with the middle of its rectangle, and sets `reached` and `seconds`."""
        self.dx, self.dy, self.seconds, self._centre = accuracy.dx, accuracy.dy, accuracy.seconds, middle
        self._scene = self._scene.on_grid(self.pressure.shape, self.dx, self.dy)
        self.reached = accuracy.reached if accuracy.reached >= 0 else None

    def __repr__(self) -> str:
        reached = "not known" if self.reached is None else f"{self.reached:.1e}"
        return f"{super().__repr__()[:-1]}; reached {reached}>"


def solve_to_accuracy(
    h: npt.ArrayLike | Callable[[Any, Any], Any],
    dx: float,
    dy: float,
    *,
    target: float = 1e-3,
    max_pressure_target: float = 0.0,
    contact_area_target: float = 0.0,
    targets: Mapping[str, float] | None = None,
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
    progress: Callable[[Progress], Any] | bool | None = None,
    **given: Unpack[AccuracyOptions],
) -> AccurateResult:
    """Solves on finer and finer grids until the estimated relative error of the force is at most `target`.

    If the force is prescribed, `target` is for the error of the approach instead. `to_accuracy` is a short name for this function.

    Parameters
    ----------
    h : array_like, (my, mx), or callable
        Undeformed distance on the first grid, from which finer grids are interpolated by cubics. A callable h(x, y) gets the coordinates of the element centres
        as arrays of the shapes (1, mx) and (my, 1), and returns the undeformed distance.
    dx, dy : float
        Element sizes of the first grid.
    target : float
        Relative error of the force (of the approach, if the force is prescribed).
    max_pressure_target, contact_area_target : float
        Wanted relative errors of the largest pressure and of the corrected contact area; 0: none.
    targets : mapping, optional
        Wanted relative errors of further quantities by name, as {"max_von_mises": 1e-2}; see `contact_normal.quantities` for the names. With such targets up to
        two grids coarser than the first one are solved before it.
    max_seconds, max_bytes : number
        Limits of the costs; 0: no limit.
    max_elements : int
        Limit of the elements of a grid; 0: 4096 x 4096.
    shape : (my, mx), optional
        Elements of the first grid, needed if `h` is a callable.
    corner : (x, y), optional
        Corner of the rectangle, for a callable `h`; by default the rectangle is centred on (0, 0).
    approach, force, mean_pressure, shear_modulus, poisson_ratio, young_modulus, e_star, units, progress, **given
        As for `solve`.
    layer, pressure_limit, period, patches, coating, friction, adhesion, visco
        As for `solve`. Arrays have the shape of the first grid; on other grids each element gets a mean of their values. `adhesion` needs a "range", and
        `visco` is a step from rest.

    Returns
    -------
    AccurateResult
        The result on the last grid. Its `status` is `OK` if the estimated errors meet the targets; otherwise `message` has the best accuracy.

    Raises
    ------
    ContactNormalError
        If the library refuses the scene, the target or an option.

    Examples
    --------
    >>> import contact_normal
    >>> result = contact_normal.solve_to_accuracy(lambda x, y: 0.002 * (x**2 + y**2), 0.5, 0.5, shape=(32, 32), target=1e-3,
    ...                                           force=1000.0, shear_modulus=82000.0, poisson_ratio=0.28)
    >>> result.status, result.reached <= 1e-3
    (0, True)
    """
    effects = {"layer": layer, "pressure_limit": pressure_limit, "period": period, "patches": patches, "coating": coating, "friction": friction,
               "adhesion": adhesion, "visco": visco}
    struct, units = options(given), checked(units)
    scene, surface, middle = on_any_grid(
        h, dx, dy, shape, corner, effects, approach=approach, force=force, mean_pressure=mean_pressure, shear_modulus=shear_modulus,
        poisson_ratio=poisson_ratio, young_modulus=young_modulus, e_star=e_star,
    )
    watched = Watched(progress, struct, None, asks=surface is not None)
    accuracy, handle = limits(max_seconds, max_bytes, max_elements, surface), Handle()
    accuracy.target = relative("target", target)
    accuracy.max_pressure_target = relative("max_pressure_target", max_pressure_target)
    accuracy.contact_area_target = relative("contact_area_target", contact_area_target)
    set_targets(accuracy, targets)
    scene.bodies.know_all(targets or ())
    ledger = Outputs((0, 0))

    def find(address: Any) -> int:
        return int(library.contact_normal_solve_to_accuracy(
            ctypes.byref(scene.struct), ctypes.byref(struct), ctypes.byref(accuracy), address, ctypes.byref(ledger.report)
        ))

    try:
        status, message = watched.call(partial(handle.set_up, find), keep=(surface, scene), report=ledger.report)
        if surface:
            surface.finish()
        check(status, message)
        outputs = Outputs((accuracy.my, accuracy.mx), has_friction=friction is not None, scene=scene, has_adhesion=adhesion is not None)
        outputs.rows = ledger.rows
        if handle:
            check(*called(library.contact_normal_solver_fields, ctypes.byref(outputs.fields), handle=handle))
    finally:
        handle.close()
    result = AccurateResult(status, message, outputs, ledger.report, scene, units)
    result._take(accuracy, middle)
    return result


to_accuracy = solve_to_accuracy
