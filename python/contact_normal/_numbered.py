"""Names of what the library counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence


def name_of(names: Sequence[str] | Mapping[int, str], number: int) -> str:
    """The name of a number; "number 9" where a library that is newer than this package has one more."""
    try:
        return names[number] if number >= 0 else f"number {number}"
    except LookupError:
        return f"number {number}"
