"""Python callables as the callbacks of the C ABI. An exception in one cancels the call and is raised after it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ._bar import Bar
from ._constants import LOG_INFO
from ._library import check, library
from ._structs import LogCallback, ProgressCallback, SurfaceCallback


class Progress(NamedTuple):
    """What the progress callback is told after each cycle.

    Attributes
    ----------
    mx, my : int
        Elements of the grid that the cycle was on.
    cycles : int
        Cycles on that grid so far.
    active_set_changes : int
        Elements that entered or left the contact area in the last cycle.
    seconds, work_units : float
        Since the solve began; a work unit is a product with the matrix of the finest grid.
    update : float
        rms over the contact area of the last change of the pressures.
    residual : float
        Relative residual over the contact area, as far as it is known.
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
    """The progress callback of one call: a callable, True for a bar, or nothing."""

    def __init__(self, progress: Callable[[Progress], Any] | bool | None, options: Any, elements: int | None) -> None:
        self._error: BaseException | None = None
        self._bar = Bar() if progress is True else None
        self._told = _residual_drawn(self._bar, elements, options.tolerance) if self._bar else progress
        if self._told:
            self._callback = ProgressCallback(self._call)
            options.progress = self._callback

    def _call(self, told: Any, _user: Any) -> int:
        try:
            assert callable(self._told)
            return 1 if self._told(Progress(*(getattr(told.contents, name) for name in Progress._fields))) else 0
        except BaseException as error:  # it must not cross the C frames
            self._error = error
            return 1

    def finish(self) -> None:
        """Closes the bar; raises what the callable raised."""
        if self._bar:
            self._bar.close()
        if self._error is not None:
            raise self._error


def _residual_drawn(bar: Bar, elements: int | None, tolerance: float) -> Callable[[Progress], None]:
    """A callback that draws how far the residual has come on its way to the tolerance, ten times a second at most.

    Cycles on coarser grids than the finest, which has so many elements (None: not known beforehand), do not fill the bar. NORM starts its
    inner solve anew when the contact area changes: its residual, and so its bar, goes back then.
    """
    part, due = 0.0, 0.0

    def draw(told: Progress) -> None:
        nonlocal part, due
        if told.seconds < due:
            return
        due = told.seconds + 0.1
        if 0 < told.residual < 1 and elements in (None, told.mx * told.my) and 0 < tolerance < 1:
            part = min(1.0, math.log(told.residual) / math.log(tolerance))
        bar.draw(part, f"{told.mx} x {told.my}, cycle {told.cycles}, residual {told.residual:.1e}")

    return draw


class Surface:
    """A callable h(x, y) of the coordinates of element centres as the surface callback."""

    def __init__(self, surface: Callable[[Any, Any], Any], corner: tuple[float, float]) -> None:
        self._surface, self._corner = surface, corner
        self._error: BaseException | None = None
        self.callback = SurfaceCallback(self._call)

    def _call(self, mx: int, my: int, dx: float, dy: float, h: Any, _user: Any) -> int:
        try:
            x = self._corner[0] + (np.arange(mx) + 0.5) * dx
            y = self._corner[1] + (np.arange(my) + 0.5) * dy
            np.ctypeslib.as_array(h, (my, mx))[:] = self._surface(x[None, :], y[:, None])
            return 0
        except BaseException as error:  # it must not cross the C frames
            self._error = error
            return 1

    def finish(self) -> None:
        """Raises what the callable raised."""
        if self._error is not None:
            raise self._error


def set_log(callback: Callable[[int, str], Any] | None, level: int = LOG_INFO) -> None:
    """Sends the library's log messages to a callable, for the whole process.

    Parameters
    ----------
    callback : callable or None
        Called as `callback(level, message)`; None: no messages, as at the start.
    level : int
        `LOG_WARNING`: what the caller should look at; `LOG_INFO`: what the library decided, too.

    Examples
    --------
    >>> set_log(lambda level, message: print(message))
    >>> set_log(None)
    """
    global _log_callback  # the library keeps the pointer: the object must live

    def call(at: int, message: bytes, _user: Any) -> None:
        assert callback is not None
        callback(at, message.decode())

    new = LogCallback(call) if callback else LogCallback()
    check(library.contact_normal_set_log(new, level, None))
    _log_callback = new


_log_callback: Any = None
