"""Divides many pieces of work into parts, between which signals are handled."""

from __future__ import annotations

import time
from collections.abc import Iterator

# Seconds that one part takes.
_PART = 0.2


def parts(count: int, first: int) -> Iterator[slice]:
    """Divides `count` pieces of work into parts, between which signals are handled. Each part takes some tenths of a second, by the time of the one before.

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
