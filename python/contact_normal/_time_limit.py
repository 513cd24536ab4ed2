"""A limit of time that several calls of the library share, and whether one of them was ended."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._arguments import number
from ._constants import CANCELLED, ITERATION_LIMIT, OK

if TYPE_CHECKING:
    from ._result import Result

# Seconds that are left where none are: 0 would be no limit.
_LEAST = 1e-9


class Clock:
    """A limit of so many seconds from now on; 0: none."""

    def __init__(self, seconds: float) -> None:
        self._began, self._seconds = time.monotonic(), seconds

    def _rest(self) -> float:
        return self._seconds - (time.monotonic() - self._began)

    @property
    def left(self) -> float:
        """The limit of the next call; what is no limit stays, for the library to judge."""
        return max(self._rest(), _LEAST) if self._seconds > 0.0 else self._seconds

    @property
    def is_over(self) -> bool:
        """Whether no time is left."""
        return self._seconds > 0.0 and self._rest() <= 0.0


class TimeLimit:
    """That of the option `max_seconds`, if it is given, from now on. A callable `progress` that cancels a solve ends the others, too."""

    def __init__(self, given: Mapping[str, Any]) -> None:
        self._clock = Clock(number("max_seconds", given.get("max_seconds", 0.0)))
        self._progress: Any = given.get("progress")
        self._is_cancelled = False

    @property
    def left(self) -> dict[str, Any]:
        """The options for the next solve."""
        told = {"progress": self._tell} if callable(self._progress) else {}
        return {**told, "max_seconds": left} if (left := self._clock.left) else told

    def is_over(self) -> bool:
        """Whether no time is left."""
        return self._clock.is_over

    def _tell(self, progress: Any) -> bool:
        # The status of the solve may tell of something else.
        if is_cancelled := bool(self._progress(progress)):
            self._is_cancelled = True
        return is_cancelled

    def ended(self, result: Result) -> bool:
        """Whether a solve was cancelled, or stopped early since no time is left: no other one may follow it. The status tells that it was cancelled."""
        if self._is_cancelled and result.status == OK:
            _stop(result, CANCELLED, "the progress callback cancelled")
        return self._is_cancelled or result.status == CANCELLED or (result.status != OK and self._clock.is_over)

    def leaves_none(self, result: Result, why: str) -> bool:
        """Whether no time is left for a solve after this one; its status and message then tell so, and what is missing."""
        if self._clock.is_over:
            _stop(result, ITERATION_LIMIT, f"max_seconds was reached {why}")
            return True
        return False


def _stop(result: Result, status: int, why: str) -> None:
    """Says of a result that what was asked for ended at it."""
    if result.status == OK:
        result.status = status
    result.message = "\n".join(text for text in (why, result.message) if text)
