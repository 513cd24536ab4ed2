"""Python callables as the callbacks of the C ABI. An exception in one cancels the call and is raised after it."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Callable
from typing import Any, NamedTuple, TextIO

import numpy as np

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
        self._bar = Bar(elements, options.tolerance) if progress is True else None
        self._told = self._bar.draw if self._bar else progress
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


class Bar:
    """Draws how far the residual has come on its way to the tolerance: with tqdm if that is installed, else on stderr by itself.

    NORM starts its inner solve anew when the contact area changes: its residual, and so its bar, goes back then.

    Parameters
    ----------
    elements : int or None
        Elements of the finest grid: coarser ones do not fill the bar. None: that grid is not known beforehand.
    tolerance : float
        Where the bar is full.
    """

    WIDTH = 30

    def __init__(self, elements: int | None, tolerance: float, file: TextIO | None = None) -> None:
        self._elements, self._tolerance, self._file, self._part = elements, tolerance, file or sys.stderr, 0.0
        self._next = 0.0
        try:
            self._tqdm: Any = importlib.import_module("tqdm").tqdm(total=100, unit="%", file=self._file, bar_format="{l_bar}{bar}| {elapsed}{postfix}")
        except ImportError:
            self._tqdm = None

    def draw(self, told: Progress) -> None:
        """Draws the state after a cycle, ten times a second at most."""
        if told.seconds < self._next:
            return
        self._next = told.seconds + 0.1
        if 0 < told.residual < 1 and self._elements in (None, told.mx * told.my) and 0 < self._tolerance < 1:
            self._part = min(1.0, math.log(told.residual) / math.log(self._tolerance))
        text = f"{told.mx} x {told.my}, cycle {told.cycles}, residual {told.residual:.1e}"
        if self._tqdm is not None:
            self._tqdm.n = round(100 * self._part)
            self._tqdm.set_postfix_str(text)
        else:
            filled = round(self.WIDTH * self._part)
            self._file.write(f"\r[{'#' * filled}{'.' * (self.WIDTH - filled)}] {told.seconds:.1f} s, {text}   ")
            self._file.flush()

    def close(self) -> None:
        """Leaves the bar as it is and goes to the next line."""
        if self._tqdm is not None:
            self._tqdm.close()
        else:
            self._file.write("\n")


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
