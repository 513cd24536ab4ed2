"""A time limit that several calls of the library share."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._arguments import number
from ._constants import CANCELLED, ITERATION_LIMIT, OK

if TYPE_CHECKING:
    from ._result import Result

# The limit of a call, in seconds, if no time is left: 0 would mean that there is no limit.
_LEAST = 1e-9


class Clock:
    """A time limit of `seconds` from the construction of the object on; 0: there is none."""

    def __init__(self, seconds: float) -> None:
        self._began, self._seconds = time.monotonic(), seconds

    def _rest(self) -> float:
        return self._seconds - (time.monotonic() - self._began)

    @property
    def left(self) -> float:
        """The seconds that are left for the next call; 0: no limit. An invalid limit is returned as it is, and the library refuses it."""
        return max(self._rest(), _LEAST) if self._seconds > 0.0 else self._seconds

    @property
    def is_over(self) -> bool:
        """Whether no time is left."""
        return self._seconds > 0.0 and self._rest() <= 0.0


class TimeLimit:
    """The limit `max_seconds` of several solves together, from the construction of the object on. A `progress` that cancels one solve ends them all."""

    def __init__(self, given: Mapping[str, Any]) -> None:
        self._clock = Clock(number("max_seconds", given.get("max_seconds", 0.0)))
        self._progress: Any = given.get("progress")
        self._is_cancelled = False

    @property
    def left(self) -> dict[str, Any]:
        """The options that the next solve needs: `max_seconds` if there is a limit, and `progress` if it is a callable."""
        told = {"progress": self._tell} if callable(self._progress) else {}
        return {**told, "max_seconds": left} if (left := self._clock.left) else told

    def is_over(self) -> bool:
        """Whether no time is left."""
        return self._clock.is_over

    def _tell(self, progress: Any) -> bool:
        # The status of the solve is not enough: the solve may end for another reason before it is cancelled.
        if is_cancelled := bool(self._progress(progress)):
            self._is_cancelled = True
        return is_cancelled

    def ended(self, result: Result) -> bool:
        """Whether no other solve may follow this one: it was cancelled, or it stopped early and no time is left. The status of a cancelled one is CANCELLED."""
        if self._is_cancelled and result.status == OK:
            _stop(result, CANCELLED, "the progress callback cancelled")
        return self._is_cancelled or result.status == CANCELLED or (result.status != OK and self._clock.is_over)

    def leaves_none(self, result: Result, why: str) -> bool:
        """Whether no time is left after this solve. If so, the status of its result becomes ITERATION_LIMIT, and `why` is added to its message."""
        if self._clock.is_over:
            _stop(result, ITERATION_LIMIT, f"max_seconds was reached {why}")
            return True
        return False


def _stop(result: Result, status: int, why: str) -> None:
    """Sets the status of a result that was OK, and adds a reason to its message."""
    if result.status == OK:
        result.status = status
    result.message = "\n".join(text for text in (why, result.message) if text)
