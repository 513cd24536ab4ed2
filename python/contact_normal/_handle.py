"""The class `Handle`: the library's handle of a solver, which is freed once it is closed and no call uses it."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from ctypes import byref, c_void_p
from typing import TYPE_CHECKING, Any

from ._calls import here
from ._library import library

if TYPE_CHECKING:
    from ._calls import Call


class Handle:
    """The address of a solver of the library.

    A call uses the solver until the call returns, even if nobody waits for the call any more. If the handle is closed meanwhile, the solver is freed when the
    call returns. The solver of a handle without references is freed, too.
    """

    def __init__(self) -> None:
        self._address = c_void_p()
        # A lock that the same thread may acquire twice: while it holds the lock, Python may free an object that closes a solver.
        self._lock = threading.RLock()
        self._users = 0
        self._is_closed = False
        self._call: Call[Any] | None = None
        self._free: Callable[[], Any] | None = None

    def set_up(self, create: Callable[[Any], int]) -> int:
        """Calls `create`, which sets up a solver and writes its address where the argument points. Returns the status."""
        status = create(byref(self._address))
        if self._address:
            free = weakref.finalize(self, library.contact_normal_solver_free, self._address)
            # At the end of the process the system frees the memory of the solver anyway.
            free.atexit = False
            self._free = free
        return status

    def __bool__(self) -> bool:
        return bool(self._address)

    def __enter__(self) -> tuple[c_void_p]:
        """Begins a call of the library, and returns the address as a tuple: the first argument of the call."""
        with self._lock:
            if self._is_closed:
                raise ValueError("this solver is closed")
            self._users += 1
            self._call = here()
        return (self._address,)

    def __exit__(self, *_error: object) -> None:
        with self._lock:
            self._users -= 1
            self._free_if_unused()

    def wait(self) -> None:
        """Waits until a call that was given up has returned, because only one call at a time may use the solver."""
        call = self._call
        if call is not None and call.given_up:
            call.wait()

    def close(self) -> None:
        """Frees the solver: at once, or when the call that uses it returns."""
        with self._lock:
            self._is_closed = True
            self._free_if_unused()

    @property
    def _as_parameter_(self) -> c_void_p:
        # ctypes passes this attribute in the place of a handle.
        return self._address

    @property
    def is_closed(self) -> bool:
        """Whether `close` was called."""
        return self._is_closed

    def _free_if_unused(self) -> None:
        if self._is_closed and not self._users and self._free is not None:
            self._free()
