"""Calls with callbacks on daemon threads, at the end of the process.

The interpreter ends a daemon thread that asks for the interpreter, with an exception through all frames. In a callback some frames belong to the library, which
does not let it pass, so that the process would abort. So at the end of the process these calls are cancelled and waited for.
"""

from __future__ import annotations

import atexit
import threading
import time
from contextlib import AbstractContextManager, nullcontext

from ._library import library
from ._structs import LogCallback

# The longest time in seconds that the end of the process waits: most cycles and set-ups take less. A later callback aborts.
_LAST_CYCLE = 10.0

# Whether a callable has ever received messages of the library.
has_logged = threading.Event()
_calls: set[object] = set()
_ending = threading.Event()
_NOTHING = nullcontext()


class _Call:
    """A call that has to be waited for."""

    def __enter__(self) -> None:
        _calls.add(self)
        if _ending.is_set():
            _calls.discard(self)
            raise SystemExit

    def __exit__(self, *_: object) -> None:
        _calls.discard(self)


def within(has_callbacks: bool) -> AbstractContextManager[None]:
    """Marks a call of the library on this thread, if its callbacks must be waited for."""
    return _Call() if has_callbacks and threading.current_thread().daemon else _NOTHING


def is_to_end() -> bool:
    """Whether this thread is a daemon of a process that ends."""
    return _ending.is_set() and threading.current_thread().daemon


def forget() -> None:
    """In a forked process, which has none of these threads: forgets the calls."""
    _calls.clear()


def end() -> None:
    """Cancels calls at their next callback, and waits for them. A daemon that begins another call ends, as the interpreter would end it."""
    _ending.set()
    if has_logged.is_set():
        # Calls without callbacks continue without messages. One message may be on its way.
        library.contact_normal_set_log(LogCallback(), 1, None)
        time.sleep(0.05)
    last = time.monotonic() + _LAST_CYCLE
    while _calls and time.monotonic() < last:
        time.sleep(0.01)


atexit.register(end)
