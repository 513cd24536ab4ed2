"""Ends calls with callbacks on daemon threads before the interpreter ends.

When the interpreter ends, it unwinds each daemon thread that asks for it by an exception through all frames. In a callback some of these frames belong to the
library, through which no exception may pass: the process would abort. Therefore such calls are cancelled at the end of the process, which waits for them.
"""

from __future__ import annotations

import atexit
import threading
import time
from contextlib import AbstractContextManager, nullcontext

from ._library import library
from ._structs import LogCallback

# The longest time, in seconds, for which the end of the process waits. Most cycles and set-ups take less. A callback after this time aborts the process.
_LAST_CYCLE = 10.0

# Whether a callable has ever received messages of the library.
has_logged = threading.Event()
_calls: set[object] = set()
_ending = threading.Event()
_NOTHING = nullcontext()


class _Call:
    """A context that registers a call of the library for which the end of the process waits. At the end no call may begin."""

    def __enter__(self) -> None:
        _calls.add(self)
        if _ending.is_set():
            _calls.discard(self)
            raise SystemExit

    def __exit__(self, *_: object) -> None:
        _calls.discard(self)


def within(has_callbacks: bool) -> AbstractContextManager[None]:
    """A context for a call of the library on this thread. It registers the call if it has callbacks and the thread is a daemon."""
    return _Call() if has_callbacks and threading.current_thread().daemon else _NOTHING


def is_to_end() -> bool:
    """Whether this thread is a daemon and the process is ending."""
    return _ending.is_set() and threading.current_thread().daemon


def forget() -> None:
    """In a forked process, which has none of the other threads: forgets their calls."""
    _calls.clear()


def end() -> None:
    """At the end of the process: cancels registered calls at their next callback, and waits for them. A daemon thread that begins another call ends."""
    _ending.set()
    if has_logged.is_set():
        # Calls without other callbacks go on without log messages. The pause lets a message that is being delivered arrive.
        library.contact_normal_set_log(LogCallback(), 1, None)
        time.sleep(0.05)
    last = time.monotonic() + _LAST_CYCLE
    while _calls and time.monotonic() < last:
        time.sleep(0.01)


atexit.register(end)
