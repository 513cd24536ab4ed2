"""Calls with callbacks on daemon threads, at the end of the process.

The interpreter ends a daemon as soon as it asks for the interpreter, with an exception that passes all frames. In a callback these are frames
of the library, which does not let it pass: the process would abort. So at the end such calls are cancelled and waited for.
"""

from __future__ import annotations

import atexit
import threading
import time
from contextlib import AbstractContextManager, nullcontext

from ._library import library
from ._structs import LogCallback

# Seconds that the end of the process waits at most: most cycles and set-ups take less. A callback after that aborts.
_LAST_CYCLE = 10.0

# Whether a callable ever got messages of the library.
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
    """Marks a call of the library on this thread, if its callbacks have to be waited for."""
    return _Call() if has_callbacks and threading.current_thread().daemon else _NOTHING


def is_to_end() -> bool:
    """Whether this thread is a daemon of a process that ends."""
    return _ending.is_set() and threading.current_thread().daemon


def forget() -> None:
    """In a forked process, which has none of these threads."""
    _calls.clear()


def end() -> None:
    """Cancels the calls with callbacks at the next of these, and waits for them. A daemon that begins another one ends, as the interpreter would end it."""
    _ending.set()
    if has_logged.is_set():
        # Calls without callbacks go on, and nobody hears their messages. One message may be on its way.
        library.contact_normal_set_log(LogCallback(), 1, None)
        time.sleep(0.05)
    last = time.monotonic() + _LAST_CYCLE
    while _calls and time.monotonic() < last:
        time.sleep(0.01)


atexit.register(end)
