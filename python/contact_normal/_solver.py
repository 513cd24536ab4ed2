"""The class `Solver`: many solves on one grid with one pair of bodies."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Mapping, Sequence
from ctypes import c_int32
from functools import partial
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import Both, SolveOptions, distances, doubles, integer, options, pointer, shaped
from ._batch_messages import Warned, messages_of
from ._bodies import loads_of_each
from ._callbacks import Progress, Watched
from ._calls import called, is_short
from ._constants import OK
from ._handle import Handle
from ._library import ContactNormalError, check, library
from ._outputs import Outputs
from ._parts import parts
from ._friction import friction as friction_of
from ._friction_batch import FrictionBatch, table_of
from ._result import Result, TangentialResult
from ._scene import Scene, influence as influence_of, owned
from ._structs import Fields, Report
from ._structs import Scene as SceneStruct
from ._tangential import of_pressures
from ._time_limit import Clock
from ._units import checked

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack

    from ._arguments import Doubles

_Problem = tuple[Scene, Outputs]


class Solver:
    """Solves many problems on one grid with one pair of bodies. The influence coefficients and operators are set up once.

    A solver is freed at the end of a `with`, by `close`, or when it has no references. One thread at a time may use a solver.

    Parameters
    ----------
    my, mx : int
        Elements in y and x.
    dx, dy : float
        Element sizes.
    shear_modulus, poisson_ratio, young_modulus, e_star, influence, layer, period, patches, row_tables, coating, units, **given
        As for `solve`: for all later solves.
    friction : mapping, optional
        The entries "influence" and "influence_cross", or "row_tables": the tangential coefficients of all later solves, whose `friction` may leave them out.
    visco : mapping, optional
        The entries "modulus" and "time": the branches of the bodies in all later solves, whose `visco` may leave them out.

    Examples
    --------
    >>> import numpy as np, contact_normal
    >>> x = (np.arange(64) - 31.5) * 0.05
    >>> h = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 50.0)
    >>> with contact_normal.Solver(64, 64, 0.05, 0.05, shear_modulus=82000.0, poisson_ratio=0.28) as solver:
    ...     first = solver.solve(h, force=1000.0)
    ...     second = solver.solve(h, force=1010.0, initial_guess="PREVIOUS")
    >>> second.approach > first.approach
    True
    """

    def __init__(
        self,
        my: int,
        mx: int,
        dx: float,
        dy: float,
        *,
        shear_modulus: Both | None = None,
        poisson_ratio: Both | None = None,
        young_modulus: Both | None = None,
        e_star: float | None = None,
        influence: Any = None,
        layer: npt.ArrayLike | None = None,
        period: str | None = None,
        patches: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
        row_tables: Any = None,
        coating: Any = None,
        friction: Mapping[str, Any] | None = None,
        visco: Mapping[str, Any] | None = None,
        units: tuple[str, str] | None = None,
        **given: Unpack[SolveOptions],
    ) -> None:
        self._shape = integer("my", my), integer("mx", mx)
        self._size = dx, dy
        bodies = {"shear_modulus": shear_modulus, "poisson_ratio": poisson_ratio, "young_modulus": young_modulus, "e_star": e_star}
        self._bodies = {name: owned(value) for name, value in bodies.items()}
        self._units = checked(units)
        self._effects = {"layer": owned(layer), "period": period, "patches": owned(patches), "coating": owned(coating)}
        self._given = given
        self._visco = owned(visco)
        self._own = [name for name, table in (("influence", influence), ("row_tables", row_tables)) if table is not None]
        # The library checks the undeformed distance and the load of a set-up, but does not use them. Invalid counts of elements are left to the library, which
        # has a message for them.
        scene = Scene(np.zeros([max(m, 0) for m in self._shape]), dx, dy, None, 0.0, **self._bodies,
                      effects={"influence": influence, "row_tables": row_tables, "friction": friction, "visco": visco, **self._effects})
        scene.struct.my, scene.struct.mx = self._shape
        struct, self._handle = options(given), Handle()
        create = partial(library.contact_normal_solver_new, ctypes.byref(scene.struct), ctypes.byref(struct))
        check(*called(partial(self._handle.set_up, create), keep=scene, short=is_short(scene.effort, 1000)))

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise TypeError("a Solver can be neither pickled nor copied: it is a handle of this process; set up another one")

    def __repr__(self) -> str:
        my, mx = self._shape
        return f"<Solver: {mx} x {my} elements{', closed' if self._handle.is_closed else ''}>"

    def _scene(
        self, h: Any, loads: Mapping[str, Any], pressure_limit: Any, friction: Any, adhesion: Any = None, visco: Mapping[str, Any] | None = None
    ) -> Scene:
        if visco is not None and not isinstance(visco, Mapping):
            raise TypeError(f"visco is {visco!r}; it must be a mapping")
        step = self._visco if visco is None else {**(self._visco or {}), **visco}
        effects = {"pressure_limit": pressure_limit, "friction": friction, "adhesion": adhesion, "visco": step, **self._effects}
        dx, dy = self._size
        scene = Scene(shaped("h", distances("h", h), self._shape), dx, dy, **loads, **self._bodies, effects=effects)
        scene.know_own(self._own)
        return scene

    def solve(
        self,
        h: npt.ArrayLike,
        *,
        approach: float | None = None,
        force: float | None = None,
        mean_pressure: float | None = None,
        pressure_limit: npt.ArrayLike | None = None,
        friction: Mapping[str, Any] | None = None,
        adhesion: Mapping[str, Any] | None = None,
        visco: Mapping[str, Any] | None = None,
        pressure: npt.ArrayLike | None = None,
        contact: npt.ArrayLike | None = None,
        progress: Callable[[Progress], Any] | bool | None = None,
        **given: Unpack[SolveOptions],
    ) -> Result:
        """Solves the contact problem of an undeformed distance and a load.

        Parameters
        ----------
        h : array_like, (my, mx)
            Undeformed distance.
        approach, force, mean_pressure, pressure_limit, friction, adhesion, visco, pressure, contact, progress, **given
            As for the function `solve`. Options replace those of the same name that the set-up has. `initial_guess="PREVIOUS"` starts from the last result.

        Returns
        -------
        Result
        """
        struct = options({**self._given, **given})
        scene = self._scene(h, {"approach": approach, "force": force, "mean_pressure": mean_pressure}, pressure_limit, friction, adhesion,
                            visco)
        outputs = Outputs(scene.shape, pressure, contact, struct, friction is not None, scene, adhesion is not None)
        watched = Watched(progress, struct, scene)
        status, message = watched.call(
            library.contact_normal_solver_solve, ctypes.byref(scene.struct), ctypes.byref(struct), ctypes.byref(outputs.fields),
            ctypes.byref(outputs.report), handle=self._handle, keep=(scene, outputs), report=outputs.report,
        )
        return Result(check(status, message), message, outputs, outputs.report, scene, self._units)

    def solve_batch(
        self,
        h: Sequence[npt.ArrayLike] | npt.NDArray[Any],
        *,
        approach: npt.ArrayLike | None = None,
        force: npt.ArrayLike | None = None,
        mean_pressure: npt.ArrayLike | None = None,
        pressure_limit: npt.ArrayLike | None = None,
        friction: Mapping[str, Any] | None = None,
        adhesion: Mapping[str, Any] | None = None,
        pressure: Sequence[npt.ArrayLike] | npt.NDArray[Any] | None = None,
        contact: Sequence[npt.ArrayLike] | npt.NDArray[Any] | None = None,
        **given: Unpack[SolveOptions],
    ) -> list[Result]:
        """Solves one problem for each undeformed distance, as many at a time as the `threads` of the set-up.

        Parameters
        ----------
        h : sequence of array_like, (count, my, mx)
            Undeformed distances.
        approach, force, mean_pressure : float or array_like, (count,)
            One of them: one value for all problems, or one for each.
        pressure_limit : float or array_like, (my, mx), optional
            As for `solve`; the same for all problems.
        friction : mapping, optional
            As for `solve`; the same for all problems. "continues" is refused, because the order of the solves is not defined.
        adhesion : mapping, optional
            As for `solve`; the same for all problems.
        pressure, contact : sequence of array_like, (count, my, mx), optional
            Initial guess of each problem, as for `solve`.
        **given : SolveOptions
            As for `solve`; `initial_guess` may not be "PREVIOUS".

        Returns
        -------
        list of Result
            A refused problem does not affect the others: its `status` is negative, its `message` says why, and its arrays have no meaning.

        Raises
        ------
        ContactNormalError
            If the call itself is refused.
        """
        count, struct = len(h), options({**self._given, **given})
        for name, values in (("pressure", pressure), ("contact", contact)):
            if values is not None and len(values) != count:
                raise ValueError(f"{name} has {len(values)} parts; it must have {count}: one for each problem")
        problems = []
        for i, loads in enumerate(loads_of_each(count, approach, force, mean_pressure)):
            scene = self._scene(h[i], loads, pressure_limit, friction, adhesion)
            guess, area = (None if values is None else values[i] for values in (pressure, contact))
            problems.append((scene, Outputs(self._shape, guess, area, struct, friction is not None, scene, adhesion is not None)))
        threads = self._given.get("threads", 1) or os.cpu_count() or 1
        # `max_seconds` limits the whole call: each part of the batch gets the time that is left.
        clock, results = Clock(struct.max_seconds), []
        for part in parts(count, threads):
            struct.max_seconds = clock.left
            results += self._solved(problems[part], struct)
        return results

    def _solved(self, problems: list[_Problem], struct: Any) -> list[Result]:
        """Solves some problems of a batch in one call of the library."""
        count = len(problems)
        scenes = (SceneStruct * count)(*(scene.struct for scene, _ in problems))
        fields = (Fields * count)(*(outputs.fields for _, outputs in problems))
        reports = (Report * count)(*(outputs.report for _, outputs in problems))
        untouched = -(2**31)
        statuses = (c_int32 * count)(*[untouched] * count)
        status, message = called(
            library.contact_normal_solver_solve_batch, count, scenes, ctypes.byref(struct), fields, reports, statuses,
            handle=self._handle, keep=problems, options=struct, report=Warned(reports),
        )
        if untouched in statuses:
            check(status, message)
        messages = messages_of(statuses, message, [report.warnings for report in reports])
        return [Result(statuses[i], messages[i], problems[i][1], reports[i], problems[i][0], self._units) for i in range(count)]

    def solve_tangential(
        self,
        pressure: npt.ArrayLike,
        *,
        friction: Mapping[str, Any],
        progress: Callable[[Progress], Any] | bool | None = None,
        **given: Unpack[SolveOptions],
    ) -> TangentialResult:
        """Solves the tangential problem for given pressures, as the function `solve_tangential`, with the operators and the last tractions of this solver.

        Parameters
        ----------
        pressure : array_like, (my, mx)
            Given pressures; those that are not positive count as no contact.
        friction : mapping
            As for `solve`. With `"continues": True` the last tractions of this solver are the previous tractions of the step.
        progress, **given
            As for `solve`. With `initial_guess="PREVIOUS"` the iteration starts from the last tractions.

        Returns
        -------
        TangentialResult
        """
        pressures = shaped("pressure", doubles("pressure", pressure), self._shape)
        scene = self._scene(np.zeros(self._shape), {"approach": 0.0, "force": None}, None, friction)
        return of_pressures(scene, pressures, options({**self._given, **given}), progress, self._units, self._handle)

    def friction_batch(
        self,
        pressure: npt.ArrayLike,
        entries: npt.ArrayLike,
        *,
        friction: Mapping[str, Any],
        fields: bool = False,
        progress: Callable[[Progress], Any] | bool | None = None,
        **given: Unpack[SolveOptions],
    ) -> FrictionBatch:
        """Solves many tangential problems for given pressures, as the function `friction_batch`, with the operators of this solver.

        Parameters
        ----------
        pressure : array_like, (my, mx)
            Given pressures; those that are not positive count as no contact.
        entries : array_like, (n, 3)
            For each entry the prescribed values in x and in y, and the spin.
        friction, fields, progress, **given
            As for `friction_batch`.

        Returns
        -------
        FrictionBatch
        """
        pressures = shaped("pressure", doubles("pressure", pressure), self._shape)
        scene = self._scene(np.zeros(self._shape), {"approach": 0.0, "force": None}, None, friction)
        return table_of(scene, pressures, entries, options({**self._given, **given}), progress, fields, self._handle, self._units)

    def set_influence(self, influence: Any = None, friction: Mapping[str, Any] | None = None) -> None:
        """Replaces the caller's influence coefficients for later solves. The solver must have been set up with such coefficients.

        Parameters
        ----------
        influence : array_like, (2 cy, 2 cx), or (array_like, scale), optional
            As for `solve`.
        friction : mapping, optional
            The entries "influence" and "influence_cross", or "row_tables", as for `solve`.
        """
        effect, table = (None, None) if influence is None else influence_of(influence)
        tables, kept, _ = (None, None, "") if friction is None else friction_of(friction, self._shape)
        structs = [None if struct is None else ctypes.byref(struct) for struct in (effect, tables)]
        check(*called(library.contact_normal_solver_set_influence, *structs, handle=self._handle, keep=(table, kept)))

    def product(self, pressure: npt.ArrayLike) -> Doubles:
        """Computes the displacements u = A p of pressures of any sign. A contains the effects of the set-up that change it: layers, periods, patches, coatings.

        Parameters
        ----------
        pressure : array_like, (my, mx)
            Pressures.

        Returns
        -------
        ndarray, (my, mx)
            Displacements. The last result, from which a later solve may start, does not change.
        """
        given = doubles("pressure", pressure, self._shape)
        found = np.zeros(self._shape)
        check(*called(library.contact_normal_solver_product, pointer(given), pointer(found), handle=self._handle, keep=(given, found)))
        return found

    def stiffness(self) -> float:
        """Computes the stiffness dF/dapproach of the last result, a force per length.

        The contact area, the tractions, and the pressures at their limit are held constant.

        Raises
        ------
        ContactNormalError
            If there is no result, or full contact with two periods.
        """
        value, residual = ctypes.c_double(), ctypes.c_double()
        status, message = called(
            library.contact_normal_solver_stiffness, ctypes.byref(value), ctypes.byref(residual), handle=self._handle, keep=(value, residual)
        )
        if check(status, message) != OK:
            raise ContactNormalError(status, message)
        return value.value

    def close(self) -> None:
        """Frees the solver: at once, or when the call that uses it returns. Closing it again has no effect."""
        self._handle.close()

    def __enter__(self) -> Solver:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()
