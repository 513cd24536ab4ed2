"""A time limit that several calls of the library share, and whether one of them was ended."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._arguments import number
from ._constants import CANCELLED, ITERATION_LIMIT, OK

if TYPE_CHECKING:
    from ._result import Result

# Seconds that are passed if none are left: 0 would be no limit.
_LEAST = 1e-9


class Clock:
    """A limit of `seconds` from now on; 0: none."""

    def __init__(self, seconds: float) -> None:
        self._began, self._seconds = time.monotonic(), seconds

    def _rest(self) -> float:
        return self._seconds - (time.monotonic() - self._began)

    @property
    def left(self) -> float:
        """The limit of the next call. Invalid limits are passed on, for the library to refuse."""
        return max(self._rest(), _LEAST) if self._seconds > 0.0 else self._seconds

    @property
    def is_over(self) -> bool:
        """Whether no time is left."""
        return self._seconds > 0.0 and self._rest() <= 0.0


class TimeLimit:
    """The limit of the option `max_seconds`, if it is given, from now on. A callable `progress` that cancels a solve also ends the others."""

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
        # The status of the solve may have another reason.
        if is_cancelled := bool(self._progress(progress)):
            self._is_cancelled = True
        return is_cancelled

    def ended(self, result: Result) -> bool:
        """Whether a solve was cancelled, or stopped early without time left, so that no other one may follow. A cancelled one gets the status CANCELLED."""
        if self._is_cancelled and result.status == OK:
            _stop(result, CANCELLED, "the progress callback cancelled")
        return self._is_cancelled or result.status == CANCELLED or (result.status != OK and self._clock.is_over)

    def leaves_none(self, result: Result, why: str) -> bool:
        """Whether no time is left after this solve; its status and message then say so, and what is missing."""
        if self._clock.is_over:
            _stop(result, ITERATION_LIMIT, f"max_seconds was reached {why}")
            return True
        return False


def _stop(result: Result, status: int, why: str) -> None:
    """Sets the status and the message of a result at which the call ended."""
    if result.status == OK:
        result.status = status
    result.message = "\n".join(text for text in (why, result.message) if text)
