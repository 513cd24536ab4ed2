"""Calls of the library that a signal can end: a worker thread makes the call, while the calling thread waits and runs the callbacks.

Python runs the handlers of signals, and so raises KeyboardInterrupt, on its main thread, and only between two instructions of Python. During a call of the
library a handler would wait until the call returns, and an exception within a callback of ctypes would be lost. So the main thread calls through a worker.
Other threads get no signals, and call the library themselves.
"""

from __future__ import annotations

import atexit
import math
import os
import sys
import threading
import time
from collections.abc import Callable
from contextlib import nullcontext
from ctypes import c_int32, pointer
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from . import _daemons
from ._library import last_error

if TYPE_CHECKING:
    from ._handle import Handle

T = TypeVar("T")

# Seconds for which the main thread waits for a call that it has given up. Most calls end with their next cycle, within this time.
_PATIENCE = 0.1
# The longest time between two checks for signals, in seconds.
_LISTEN = 0.05
# The main thread makes a solve itself if its elements times its `max_cycles` are at most this number. The slowest such solves, which do not converge, take
# 0.15 s on a busy machine. A worker with its callbacks costs some 50 us a solve, and a usual solve of this size takes 200 us.
_SHORT = 1_050_000


class Call(Generic[T]):
    """One call of the library by a worker.

    Attributes
    ----------
    given_up : bool
        Whether no thread waits for the result any more. The next callback, or `stop`, then ends the call.
    stop : c_int32
        The number to which `options.stop` points: 1 once the call is given up.
    """

    def __init__(self, work: Callable[[], T]) -> None:
        self.given_up, self.stop = False, c_int32(0)
        self._work: Callable[[], T] | None = work
        self._found: list[T] = []
        self._error: BaseException | None = None
        self._question: Callable[[], Any] | None = None
        self._answer: Any = None
        self._raised: Exception | None = None
        self._is_over = self._is_orphan = False
        self._news, self._answered, self._ended = (threading.Lock() for _ in range(3))
        for lock in (self._news, self._answered, self._ended):
            lock.acquire()
        # A worker acquires this lock when it begins the call. A thread that gives the call up before that acquires the lock, so that no worker begins it.
        self._begun = threading.Lock()

    def make(self) -> None:
        """On the worker: calls the library."""
        if not self._begun.acquire(blocking=False):
            return
        try:
            assert self._work is not None
            self._found.append(self._work())
        except BaseException as error:  # it is raised where the result is waited for
            self._error = error
        # The work may hold a solver that was closed meanwhile. Forgetting the work here frees this solver.
        self._work = None

    def end(self) -> None:
        """On the worker: tells the waiting thread that the call is over."""
        self._is_over = True
        _given_up.discard(self)
        self._ended.release()
        self._tell()

    def _tell(self) -> None:
        if self._news.locked():
            self._news.release()

    def ask(self, question: Callable[[], Any]) -> Any:
        """On the worker: lets the waiting thread compute `question()`, and returns the result or raises the exception."""
        self._question = question
        self._tell()
        self._answered.acquire()
        if self.given_up:
            raise RuntimeError("nobody waits for this call")
        answer, raised = self._answer, self._raised
        self._answer = self._raised = None
        if raised is not None:
            raise raised
        return answer

    def result(self, worker: _Worker) -> T:
        """On the waiting thread: gives the call to the worker, answers questions, and returns the result. Any exception gives the call up."""
        _waiting.add(self)
        try:
            worker.give(self)
            while True:
                # A signal that the system delivers to another thread does not wake this one.
                while not self._news.acquire(timeout=_LISTEN):
                    if self._is_orphan:
                        raise RuntimeError("a process that is forked within a callback must not return from it: its call goes on in the other process")
                question, self._question = self._question, None
                if question is None:
                    break
                try:
                    self._answer = question()
                except Exception as error:
                    self._raised = error
                self._answered.release()
        except BaseException:
            if not self._is_orphan:
                self._give_up()
            raise
        finally:
            _waiting.discard(self)
        raise_of(self)
        return self._found.pop()

    def orphan(self) -> None:
        """In a forked process, which does not have the worker: marks the call, so that the waiting thread raises instead of waiting."""
        self._is_orphan = True

    def _give_up(self) -> None:
        self.given_up, self.stop.value = True, 1
        if self._begun.acquire(blocking=False):
            self._is_over, self._work = True, None
            return
        _given_up.add(self)
        if self._answered.locked():
            self._answered.release()
        self.wait(_PATIENCE)

    def wait(self, seconds: float = math.inf) -> None:
        """Waits until the worker has finished the call, or at most `seconds`."""
        end = time.monotonic() + seconds
        while not self._is_over and time.monotonic() < end:
            self._ended.acquire(timeout=0.02)
        if self._is_over:
            _given_up.discard(self)


class _Worker(threading.Thread):
    """A thread that makes one call after another, until it is given None."""

    def __init__(self) -> None:
        super().__init__(name="contact-normal", daemon=True)
        self._given, self._ready = threading.Lock(), threading.Lock()
        self._given.acquire()
        self._ready.acquire()
        self._call: Call[Any] | None = None
        self.start()
        self._ready.acquire()

    def give(self, call: Call[Any] | None) -> None:
        """Gives the worker its next call."""
        self._call = call
        self._given.release()

    def run(self) -> None:
        """Makes the calls."""
        # The worker adds itself to the idle ones. The thread that started the worker might be interrupted by a signal before it could do so.
        _idle.append(self)
        self._ready.release()
        while True:
            self._given.acquire()
            call, self._call = self._call, None
            if call is None:
                return
            _here.call = call
            call.make()
            _here.call = None
            _idle.append(self)
            call.end()
            del call


def _resting() -> _Worker | None:
    """Takes an idle worker; None if there is none."""
    try:
        return _idle.pop()
    except IndexError:
        return None


_idle: list[_Worker] = []
_waiting: set[Call[Any]] = set()
_given_up: set[Call[Any]] = set()
_here = threading.local()


def raise_of(owner: Any) -> None:
    """Raises the exception that a callback stored in `owner._error`, and removes it there: its traceback would keep the objects of the call alive."""
    error, owner._error = owner._error, None
    if error is not None:
        try:
            raise error
        finally:
            del error


def here() -> Call[Any] | None:
    """The call that this thread makes as a worker; None on other threads."""
    call: Call[Any] | None = getattr(_here, "call", None)
    return call


def asked(question: Callable[[], T]) -> T:
    """Computes `question()` on the thread that waits for this call."""
    call = here()
    return question() if call is None else call.ask(question)


def given_up() -> bool:
    """Whether the call that this thread makes is to end: no thread waits for it, or this is a daemon thread of a process that ends."""
    call = here()
    return _daemons.is_to_end() if call is None else call.given_up


def on_main_thread() -> bool:
    """Whether this is the thread that receives signals."""
    return threading.get_ident() == threading.main_thread().ident


def is_short(elements: int, cycles: int) -> bool:
    """Whether a solve of so many elements and at most so many cycles is so short that no signal has to end it."""
    return 0 <= cycles * elements <= _SHORT


def made(work: Callable[[], T], short: bool = False) -> T:
    """Returns `work()`, which calls the library. On the main thread a worker makes the call, so that a signal can end it, unless the call is short."""
    # No thread can begin or continue while the interpreter ends.
    if short or not on_main_thread() or sys.is_finalizing():
        return work()
    try:
        while (worker := _resting()) is None:
            _Worker()
    except RuntimeError:  # the system has no more threads
        return work()
    return Call(work).result(worker)


def called(
    function: Callable[..., int], *arguments: Any, handle: Handle | None = None, keep: Any = None, short: bool = False, report: Any = None,
    options: Any = None, asks: bool = False,
) -> tuple[int, str]:
    """Calls a function of the library, and returns its status and its message. The message is "" after OK, unless the call writes a `report` with warnings.

    The address of a `handle`, if there is one, is the first argument. The objects of `keep` live until the function returns. A call without callbacks passes
    its `options`, whose `stop` ends the call when it is given up. A call with callbacks sets `asks`.
    """
    if handle is not None:
        handle.wait()
    return made(partial(_told, function, arguments, handle, (keep, report, options), asks), short)


_NO_HANDLE = nullcontext(())


def _told(
    function: Callable[..., int], arguments: tuple[Any, ...], handle: Handle | None, kept: tuple[Any, Any, Any], asks: bool
) -> tuple[int, str]:
    _, report, options = kept
    if options is not None and (call := here()) is not None:
        options.stop = pointer(call.stop)
    # Without a worker, the end of the process must wait for a daemon thread with callbacks. A call by a worker has a thread that waits for it.
    with _daemons.within(asks and here() is None), _NO_HANDLE if handle is None else handle as first:
        status = int(function(*first, *arguments))
        # The library keeps one message for each thread, so this thread reads it. After OK the message may be that of an earlier call.
        has_message = status or report is not None and report.warnings
        return status, last_error() if has_message else ""


def _end_workers() -> None:
    """Before a fork: ends idle workers, because a process with threads must not be forked."""
    while (worker := _resting()) is not None:
        worker.give(None)
        worker.join()


def _forget_workers() -> None:
    """In a forked process: forgets the workers and their calls, which do not exist there."""
    _here.call = None
    _daemons.forget()
    for call in list(_given_up):
        call.end()
    for call in list(_waiting):
        call.orphan()


def _wait_for_given_up() -> None:
    """At the end of the process: waits for the calls that were given up, because a call of the library must not outlast the interpreter."""
    for call in list(_given_up):
        call.wait()


atexit.register(_wait_for_given_up)
if sys.platform != "win32":  # Windows has no fork.
    os.register_at_fork(before=_end_workers, after_in_child=_forget_workers)
