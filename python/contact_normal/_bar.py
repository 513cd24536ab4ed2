"""The bar that `progress=True` draws."""

from __future__ import annotations

import importlib
import sys
import time
from typing import Any, TextIO


class Bar:
    """A bar that fills: with tqdm if that is installed, else on stderr by itself."""

    WIDTH = 30

    def __init__(self, file: TextIO | None = None) -> None:
        self._file, self._began = file or sys.stderr, time.monotonic()
        try:
            self._tqdm: Any = importlib.import_module("tqdm").tqdm(
                total=100, file=self._file, bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}"
            )
        except ImportError:
            self._tqdm = None

    def draw(self, part: float, text: str) -> None:
        """Draws how much is done, 0 to 1, and what is said of it."""
        if self._tqdm is not None:
            self._tqdm.n = round(100 * part)
            self._tqdm.set_postfix_str(text)
            return
        filled = round(self.WIDTH * part)
        seconds = time.monotonic() - self._began
        self._file.write(f"\r[{'#' * filled}{'.' * (self.WIDTH - filled)}] {seconds:.1f} s, {text}   ")
        self._file.flush()

    def close(self) -> None:
        """Leaves the bar as it is and goes to the next line."""
        if self._tqdm is not None:
            self._tqdm.close()
        else:
            self._file.write("\n")
