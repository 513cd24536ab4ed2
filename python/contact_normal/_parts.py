"""Divides a call for many problems into several calls, so that signals can be handled between them."""

from __future__ import annotations

import time
from collections.abc import Iterator

# The time that one part should take, in seconds.
_PART = 0.2


def parts(count: int, first: int) -> Iterator[slice]:
    """Yields slices that divide `count` problems into parts. The caller solves each part before it asks for the next one.

    The first part has `first` problems. The size of the next ones is chosen by the time that the one before took, so that each takes some tenths of a second.
    There is at least one part, which may be empty.
    """
    begin, size = 0, first
    while True:
        began = time.perf_counter()
        yield slice(begin, min(begin + size, count))
        begin += size
        if begin >= count:
            return
        seconds = time.perf_counter() - began
        size = max(first, min(4 * size, int(size * _PART / max(seconds, 1e-6))))
