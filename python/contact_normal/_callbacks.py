"""Python callables as callbacks of the C ABI. They are called on the thread that asked for the solve.

An exception in a callable cancels the solve, and is raised when the library has returned. A KeyboardInterrupt outside of callables is raised at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arguments import distances, integer
from ._bar import SolveBar
from ._calls import asked, called, given_up, is_short, on_main_thread, raise_of
from ._constants import LOG_INFO, OK
from ._daemons import has_logged
from ._library import check, library
from ._structs import LogCallback, ProgressCallback, SurfaceCallback

if TYPE_CHECKING:
    from ._handle import Handle
    from ._scene import Scene


class Progress(NamedTuple):
    """The progress after a cycle.

    Attributes
    ----------
    mx, my : int
        Elements in x and y of the grid of the cycle.
    cycles : int
        Cycles on this grid so far.
    active_set_changes : int
        Elements that entered or left the contact area in the last cycle.
    seconds, work_units : float
        Time and work since the beginning of the solve. A work unit is one product A p on the finest grid.
    update : float
        The rms over the contact area of the last change of the pressures.
    residual : float
        Relative residual over the contact area, as far as known from the iteration.
    """

    mx: int
    my: int
    cycles: int
    active_set_changes: int
    seconds: float
    work_units: float
    update: float
    residual: float


class Watched:
    """Makes the call of a solve with a progress callback: a callable, a bar, or only a check whether the call was given up.

    Parameters
    ----------
    progress : callable, bool or None
        As for `solve`.
    options : Options
        The `contact_normal_options` of the call, which gets the callback.
    scene : Scene or None
        The scene; None: the grids that will be solved are not known beforehand.
    entries : int
        Number of tangential problems that the call also solves.
    asks : bool
        Whether the call has callbacks besides that of progress.
    """

    def __init__(
        self, progress: Callable[[Progress], Any] | bool | None, options: Any, scene: Scene | None, entries: int = 0, asks: bool = False
    ) -> None:
        if progress is not None and not isinstance(progress, bool) and not callable(progress):
            raise TypeError(f"progress is {progress!r}; it must be a callable, or True for a bar")
        self._error: BaseException | None = None
        self._bar = SolveBar(scene.h.size if scene else None, options.tolerance, entries) if progress is True else None
        self._told: Any = self._bar.tell if self._bar else progress
        self._asks = bool(self._told) or asks
        self._is_short = not self._told and not _log and scene is not None and self._ends_soon(scene, options, entries)
        if self._told or not self._is_short and on_main_thread():
            self._callback = ProgressCallback(self._call)
            options.progress = self._callback

    @staticmethod
    def _ends_soon(scene: Scene, options: Any, entries: int) -> bool:
        # The bound of `is_short` does not hold with adhesion, whose searches may take more than `max_cycles`.
        return not scene.struct.adhesion and is_short(scene.effort * (entries + 1), options.max_cycles)

    def _call(self, told: Any, _user: Any) -> int:
        try:
            if given_up():
                return 1
            if not self._told:
                return 0
            progress = Progress(*(getattr(told.contents, name) for name in Progress._fields))
            return 1 if asked(lambda: self._told(progress)) else 0
        except BaseException as error:  # No exception may pass through the frames of the library.
            self._error = error
            return 1

    def call(
        self, function: Callable[..., int], *arguments: Any, handle: Handle | None = None, keep: Any = None, report: Any = None
    ) -> tuple[int, str]:
        """Calls a function of the library, as `called`. Afterwards it closes the bar, and raises the exception of the callable, if there was one."""
        status = -1
        try:
            status, message = called(function, *arguments, handle=handle, keep=(self, keep), short=self._is_short, report=report, asks=self._asks)
        finally:
            if self._bar:
                self._bar.close(status == OK)
        raise_of(self)
        return status, message


class Surface:
    """The surface callback of the library from a callable h(x, y) of the coordinates of element centres."""

    def __init__(self, surface: Callable[[Any, Any], Any], corner: tuple[float, float]) -> None:
        self._surface, self._corner = surface, corner
        self._error: BaseException | None = None
        self.callback = SurfaceCallback(self._call)

    def _call(self, mx: int, my: int, dx: float, dy: float, h: Any, _user: Any) -> int:
        try:
            if given_up():
                return 1
            x = self._corner[0] + (np.arange(mx) + 0.5) * dx
            y = self._corner[1] + (np.arange(my) + 0.5) * dy
            values = distances("what h(x, y) returns", asked(lambda: self._surface(x[None, :], y[:, None])))
            try:
                np.ctypeslib.as_array(h, (my, mx))[:] = values
            except ValueError:
                raise ValueError(f"what h(x, y) returns has shape {values.shape}; it must be {(my, mx)}, or what numpy makes that of") from None
            return 0
        except BaseException as error:  # No exception may pass through the frames of the library.
            self._error = error
            return 1

    def finish(self) -> None:
        """Raises the exception of the callable, if there was one."""
        raise_of(self)


def set_log(callback: Callable[[int, str], Any] | None, level: int = LOG_INFO) -> None:
    """Sends the log messages of the library to a callable, for the whole process.

    Parameters
    ----------
    callback : callable or None
        Called as `callback(level, message)`. None (the state at the beginning): the library sends no messages.
    level : int
        `LOG_WARNING`: only messages that need attention; `LOG_INFO`: also the decisions of the library.

    Examples
    --------
    >>> set_log(lambda level, message: print(message))
    >>> set_log(None)
    """
    if callback is not None and not callable(callback):
        raise TypeError(f"callback is {callback!r}; it must be a callable, or None")
    check(library.contact_normal_set_log(LogCallback() if callback is None else _LOGGED, integer("level", level), None))
    _log[:] = [] if callback is None else [callback]
    if callback is not None:
        has_logged.set()


def _logged(level: int, message: bytes, _user: Any) -> None:
    # A copy, because another thread may replace the callable meanwhile.
    callbacks = list(_log)
    try:
        if callbacks and not given_up():
            asked(lambda: callbacks[0](level, message.decode()))
    except Exception:
        if not given_up():
            raise


# The callable that receives messages; empty if there is none.
_log: list[Callable[[int, str], Any]] = []
# The callback that the library calls. It may do so at any time, so the callback is never freed. `_KEPT` also holds those of this module before a reload.
_LOGGED = LogCallback(_logged)
_KEPT = [*globals().get("_KEPT", ()), _LOGGED]
