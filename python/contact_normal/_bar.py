"""Progress bars for `progress=True`. The bar of a finished call ends at 100 %."""

from __future__ import annotations

import importlib
import math
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from ._callbacks import Progress


def has_terminal() -> bool:
    """Whether stderr is a terminal. Windowed programs and services have no stderr."""
    try:
        return sys.stderr is not None and sys.stderr.isatty()
    except Exception:  # A host program may have replaced stderr by a stream that is closed, with errors of its own.
        return False


class Bar:
    """A progress bar on stderr or in `file`, drawn by tqdm if that is installed."""

    WIDTH = 30

    def __init__(self, file: TextIO | None = None) -> None:
        # In windowed programs and services sys.stderr is None, and nothing is drawn.
        self._file, self._began = file or sys.stderr, time.monotonic()
        self._tqdm: Any = None
        try:
            tqdm = importlib.import_module("tqdm").tqdm
        except ImportError:
            return
        self._written(partial(self._begin, tqdm))

    def _begin(self, tqdm: Any) -> None:
        # The constructor of tqdm already writes, and so may fail.
        self._tqdm = tqdm(total=100, file=self._file, bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}")

    def draw(self, part: float, text: str) -> None:
        """Draws the bar with the finished `part`, 0 to 1, and a text beside it."""
        if self._tqdm is not None:
            self._tqdm.n = round(100 * part)
            self._written(partial(self._tqdm.set_postfix_str, text))
            return
        filled = round(self.WIDTH * part)
        seconds = time.monotonic() - self._began
        self._written(partial(print, f"\r[{'#' * filled}{'.' * (self.WIDTH - filled)}] {seconds:.1f} s, {text}   ", end="", file=self._file, flush=True))

    def close(self) -> None:
        """Leaves the bar as it is and goes to the next line."""
        self._written(self._tqdm.close if self._tqdm is not None else partial(print, file=self._file))

    def _written(self, write: Callable[[], Any]) -> None:
        """Calls `write`. If it fails, as on a closed pipe, a full disk or the stream of a host program that has ended, nothing more is drawn, and the solve
        continues."""
        if self._file is not None:
            try:
                write()
            except Exception:  # Streams of host programs raise errors of their own.
                self._file = None


class SolveBar:
    """A bar for one solve: the finished part is log(residual)/log(tolerance). It is drawn at most ten times a second, and never goes back.

    Parameters
    ----------
    elements : int or None
        Elements of the finest grid; cycles on coarser grids do not advance the bar. None: not known; each finer grid then gets half of the remaining bar.
    tolerance : float
        Tolerance of the residual.
    entries : int
        Number of tangential problems, or 0. If there are some, the bar shows the part of them that is finished.
    """

    def __init__(self, elements: int | None, tolerance: float, entries: int = 0) -> None:
        self._bar = Bar()
        self._elements, self._tolerance, self._entries = elements, tolerance, entries
        self._part, self._due, self._text = 0.0, 0.0, ""
        self._finest, self._begin = 0, 0.0

    def tell(self, told: Progress) -> None:
        """Draws the progress that the callback of a solve gets."""
        self._part = max(self._part, self._part_of(told))
        self._text = f"{told.mx} x {told.my}, cycle {told.cycles}, residual {told.residual:.1e}"
        if time.monotonic() >= self._due:
            self._due = time.monotonic() + 0.1
            self._bar.draw(self._part, self._text)

    def _part_of(self, told: Progress) -> float:
        if self._entries:
            # The cycles of the normal problem come first. Only they change the pressures, so that their update is not 0.
            return min(1.0, told.cycles / self._entries) if told.update == 0.0 else 0.0
        share = 1.0
        if self._elements is None:
            if told.mx * told.my > self._finest:
                self._finest, self._begin = told.mx * told.my, 0.5 * (1.0 + self._begin) if self._finest else 0.0
            share = 0.5 * (1.0 - self._begin)
        elif told.mx * told.my != self._elements:
            return 0.0
        if not (0 < told.residual < 1 and 0 < self._tolerance < 1):
            return self._begin
        return self._begin + share * min(1.0, math.log(told.residual) / math.log(self._tolerance))

    def close(self, is_done: bool) -> None:
        """Draws the bar a last time, full if the call is done, and goes to the next line."""
        self._bar.draw(1.0 if is_done else self._part, self._text)
        self._bar.close()
