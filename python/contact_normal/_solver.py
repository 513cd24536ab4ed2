"""A handle for many solves on one grid and one pair of bodies."""

from __future__ import annotations

import ctypes
import re
import weakref
from collections.abc import Callable, Mapping, Sequence
from ctypes import c_int32, c_void_p
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import Both, SolveOptions, doubles, integer, options
from ._callbacks import Progress, Watched
from ._constants import OK
from ._library import check, last_error, library
from ._result import Outputs, Result
from ._scene import Scene, influence as influence_of
from ._solve import run
from ._structs import Fields, Report
from ._structs import Scene as SceneStruct

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack


class Solver:
    """A handle for many solves on one grid and one pair of bodies, which sets up everything once.

    It is freed at the end of a `with`, by `close`, or when Python drops it. One thread at a time may use it.

    Parameters
    ----------
    my, mx : int
        Elements in y and x.
    dx, dy : float
        Element sizes.
    shear_modulus, poisson_ratio, influence, layer, period, patches, row_tables, coating, **given
        As for `solve`: for all later solves.

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
        shear_modulus: Both,
        poisson_ratio: Both,
        influence: Any = None,
        layer: npt.ArrayLike | None = None,
        period: str | None = None,
        patches: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
        row_tables: Any = None,
        coating: Any = None,
        **given: Unpack[SolveOptions],
    ) -> None:
        self._shape = integer("my", my), integer("mx", mx)
        self._size = dx, dy
        self._bodies = shear_modulus, poisson_ratio
        self._effects = {"layer": layer, "period": period, "patches": patches, "coating": coating}
        self._given = given
        # The set-up reads neither the undeformed distance nor the load, but checks them. Counts that are no counts are left to the
        # library, whose message says so.
        scene = Scene(np.zeros([max(m, 0) for m in self._shape]), dx, dy, None, 0.0, *self._bodies,
                      {"influence": influence, "row_tables": row_tables, **self._effects})
        struct, handle = options(given), c_void_p()
        check(library.contact_normal_solver_new(ctypes.byref(scene.struct), ctypes.byref(struct), ctypes.byref(handle)))
        self._address: int | None = handle.value
        self._free = weakref.finalize(self, library.contact_normal_solver_free, handle)

    @property
    def _handle(self) -> c_void_p:
        if self._address is None:
            raise ValueError("this solver is closed")
        return c_void_p(self._address)

    def _scene(self, h: Any, approach: float | None, force: float | None, pressure_limit: Any,
               friction: Any) -> Scene:
        effects = {"pressure_limit": pressure_limit, "friction": friction, **self._effects}
        return Scene(doubles("h", h, self._shape), *self._size, approach, force, *self._bodies, effects)

    def solve(
        self,
        h: npt.ArrayLike,
        *,
        approach: float | None = None,
        force: float | None = None,
        pressure_limit: npt.ArrayLike | None = None,
        friction: Mapping[str, Any] | None = None,
        pressure: npt.ArrayLike | None = None,
        contact: npt.ArrayLike | None = None,
        progress: Callable[[Progress], Any] | bool | None = None,
        **given: Unpack[SolveOptions],
    ) -> Result:
        """Solves for an undeformed distance and a load.

        Parameters
        ----------
        h : array_like, (my, mx)
            Undeformed distance.
        approach, force, pressure_limit, friction, pressure, contact, progress, **given
            As for the function `solve`; options add to those of the set-up. `initial_guess="PREVIOUS"` starts from the last result.

        Returns
        -------
        Result
        """
        handle = self._handle
        scene = self._scene(h, approach, force, pressure_limit, friction)
        struct = options({**self._given, **given})
        outputs = Outputs(scene.shape, pressure, contact, struct, friction is not None)
        watched = Watched(progress, struct, scene.h.size)

        def call(fields: Any, report: Any) -> int:
            status = library.contact_normal_solver_solve(
                handle, ctypes.byref(scene.struct), ctypes.byref(struct), fields, report
            )
            return int(status)

        return run(call, scene, outputs, watched)

    def solve_batch(
        self,
        h: Sequence[npt.ArrayLike] | npt.NDArray[Any],
        *,
        approach: npt.ArrayLike | None = None,
        force: npt.ArrayLike | None = None,
        pressure_limit: npt.ArrayLike | None = None,
        friction: Mapping[str, Any] | None = None,
        pressure: Sequence[npt.ArrayLike] | npt.NDArray[Any] | None = None,
        contact: Sequence[npt.ArrayLike] | npt.NDArray[Any] | None = None,
        **given: Unpack[SolveOptions],
    ) -> list[Result]:
        """Solves one problem for each undeformed distance, as many at a time as the solver was set up with `threads`.

        Parameters
        ----------
        h : sequence of array_like, (count, my, mx)
            Undeformed distances.
        approach, force : float or array_like, (count,)
            One of them: one value for all problems, or one for each.
        pressure_limit : float or array_like, (my, mx), optional
            For all problems.
        friction : mapping, optional
            For all problems, as for `solve`, but "continues" is refused: the order of the solves is not known.
        pressure, contact : sequence of array_like, (count, my, mx), optional
            Initial guesses.
        **given : SolveOptions
            As for `solve`; `initial_guess` may not be "PREVIOUS".

        Returns
        -------
        list of Result
            A problem that is refused does not keep the others from being solved: its `status` is negative, its `message` says why, its
            arrays mean nothing.

        Raises
        ------
        ContactNormalError
            If the call itself is refused.
        """
        handle, count, struct = self._handle, len(h), options({**self._given, **given})
        loads = [None if values is None else np.broadcast_to(np.asarray(values), (count,)) for values in (approach, force)]
        scenes, outputs = [], []
        for i in range(count):
            one_approach, one_force = (None if values is None else float(values[i]) for values in loads)
            scenes.append(self._scene(h[i], one_approach, one_force, pressure_limit, friction))
            guess, area = (None if values is None else values[i] for values in (pressure, contact))
            outputs.append(Outputs(self._shape, guess, area, struct, friction is not None))
        reports = (Report * count)(*(each.report for each in outputs))
        untouched = -(2**31)
        statuses = (c_int32 * count)(*[untouched] * count)
        status = library.contact_normal_solver_solve_batch(
            handle,
            count,
            (SceneStruct * count)(*(scene.struct for scene in scenes)),
            ctypes.byref(struct),
            (Fields * count)(*(each.fields for each in outputs)),
            reports,
            statuses,
        )
        if untouched in statuses:
            check(status)
        messages = _messages(statuses, last_error() if status else "")
        return [Result(statuses[i], messages[i], outputs[i], reports[i], scenes[i]) for i in range(count)]

    def set_influence(self, influence: Any) -> None:
        """Gives later solves other influence coefficients; only for a solver that was set up with some.

        Parameters
        ----------
        influence : array_like, (2 cy, 2 cx), or (array_like, scale)
            As for `solve`.
        """
        effect, _table = influence_of(influence)
        check(library.contact_normal_solver_set_influence(self._handle, ctypes.byref(effect)))

    def close(self) -> None:
        """Frees the handle; a second call does nothing."""
        self._address = None
        self._free()

    def __enter__(self) -> Solver:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


def _messages(statuses: Any, told: str) -> list[str]:
    """The message of each problem, of the lines "problem 3: ..." that the library has for those that are not OK."""
    parts = re.split(r"^problem (\d+): ", told, flags=re.MULTILINE)
    lines = {int(number): text.rstrip("\n") for number, text in zip(parts[1::2], parts[2::2])}
    texts = (library.contact_normal_status_text(status).decode() for status in statuses)
    return ["" if status == OK else lines.get(i, text) for i, (status, text) in enumerate(zip(statuses, texts))]
