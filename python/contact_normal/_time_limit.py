"""A limit of time that several solves of one call share, and whether one of them was ended."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._arguments import number
from ._constants import CANCELLED, OK

if TYPE_CHECKING:
    from ._result import Result

# Seconds that are left where none are: 0 would be no limit.
_LEAST = 1e-9


class TimeLimit:
    """That of the option `max_seconds`, if it is given, from now on."""

    def __init__(self, given: Mapping[str, Any]) -> None:
        self._began, self._seconds = time.monotonic(), number("max_seconds", given.get("max_seconds", 0.0))

    @property
    def left(self) -> dict[str, float]:
        """The option for the next solve."""
        return {"max_seconds": max(self._seconds - (time.monotonic() - self._began), _LEAST)} if self._seconds > 0.0 else {}

    def ended(self, result: Result) -> bool:
        """Whether a solve was cancelled, or stopped early since no time is left: no other one may follow it."""
        is_over = self._seconds > 0.0 and time.monotonic() - self._began >= self._seconds
        return result.status == CANCELLED or (result.status != OK and is_over)
