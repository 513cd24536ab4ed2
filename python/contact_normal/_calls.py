"""Calls of the library that a signal can end: another thread makes them, while the calling thread waits and runs their callbacks.

Python runs the handlers of signals, and so raises KeyboardInterrupt, on its main thread, and only between two of its own instructions. During a call of the
library they would wait until it returns, and an exception within a callback of ctypes would be lost. So the main thread calls through a worker. Other threads
get no signals, and call the library themselves.
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

# The time for which an abandoned call is waited for: most calls end with their next cycle, within this time.
_PATIENCE = 0.1
# The longest time between two checks for signals.
_LISTEN = 0.05
# The largest number of elements times cycles of a solve that the main thread makes itself: the slowest, which do not converge, take .15 s on a busy machine. A
# worker costs some 50 us a solve with its callbacks; a usual solve of this size takes 200.
_SHORT = 1_050_000


class Call(Generic[T]):
    """One call of the library by a worker.

    Attributes
    ----------
    given_up : bool
        Whether no thread waits for the result: callbacks or `stop` end the call.
    stop : c_int32
        1 once the call is given up, for `options.stop`.
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
        # A worker acquires it when it begins. A thread that gives the call up acquires it if no worker has begun, and then none will.
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
        # The work may hold a solver that was closed meanwhile: it is freed here.
        self._work = None

    def end(self) -> None:
        """On the worker: tells the waiting thread that the result exists."""
        self._is_over = True
        _given_up.discard(self)
        self._ended.release()
        self._tell()

    def _tell(self) -> None:
        if self._news.locked():
            self._news.release()

    def ask(self, question: Callable[[], Any]) -> Any:
        """On the worker: the result of `question()` on the waiting thread."""
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
        """On the waiting thread: answers questions until the worker has the result. Any exception gives the call up."""
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
        """In a forked process, whose worker does not exist: ends the call."""
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
        # The worker adds itself to the idle ones, because a signal may interrupt the thread that started it.
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
    """An idle worker."""
    try:
        return _idle.pop()
    except IndexError:
        return None


_idle: list[_Worker] = []
_waiting: set[Call[Any]] = set()
_given_up: set[Call[Any]] = set()
_here = threading.local()


def raise_of(owner: Any) -> None:
    """Raises the exception of a callback of the `owner`, and forgets it, because its traceback would keep the objects of the call."""
    error, owner._error = owner._error, None
    if error is not None:
        try:
            raise error
        finally:
            del error


def here() -> Call[Any] | None:
    """The call that this thread makes as a worker."""
    call: Call[Any] | None = getattr(_here, "call", None)
    return call


def asked(question: Callable[[], T]) -> T:
    """The result of `question()` on the thread that waits for this call."""
    call = here()
    return question() if call is None else call.ask(question)


def given_up() -> bool:
    """Whether no thread waits for the call that this thread makes."""
    call = here()
    return _daemons.is_to_end() if call is None else call.given_up


def on_main_thread() -> bool:
    """Whether this is the thread that receives signals."""
    return threading.get_ident() == threading.main_thread().ident


def is_short(elements: int, cycles: int) -> bool:
    """Whether a solve is so short that no signal has to end it."""
    return 0 <= cycles * elements <= _SHORT


def made(work: Callable[[], T], short: bool = False) -> T:
    """The result of `work()`, which calls the library. On the main thread a signal ends it, unless it is short."""
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
    """The status of a function of the library, and its message: "" after OK, unless the call writes a `report` with warnings.

    With a handle its address is the first argument. `keep` lives until the function returns. A call without callbacks names its `options`, whose `stop` ends it
    when it is given up; one with callbacks sets `asks`.
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
    # A thread that calls through a worker waits for its calls anyway.
    with _daemons.within(asks and here() is None), _NO_HANDLE if handle is None else handle as first:
        status = int(function(*first, *arguments))
        # The message belongs to the calling thread. After OK it may be that of an earlier call.
        has_message = status or report is not None and report.warnings
        return status, last_error() if has_message else ""


def _end_workers() -> None:
    """Before a fork: ends idle workers, because a process with threads must not be forked."""
    while (worker := _resting()) is not None:
        worker.give(None)
        worker.join()


def _forget_workers() -> None:
    """In a forked process: forgets the workers, which do not exist there; the forked thread makes no call there."""
    _here.call = None
    _daemons.forget()
    for call in list(_given_up):
        call.end()
    for call in list(_waiting):
        call.orphan()


def _wait_for_given_up() -> None:
    """At the end of the process: waits for calls of the library, which must not outlast the interpreter."""
    for call in list(_given_up):
        call.wait()


atexit.register(_wait_for_given_up)
if sys.platform != "win32":  # Windows has no fork.
    os.register_at_fork(before=_end_workers, after_in_child=_forget_workers)
