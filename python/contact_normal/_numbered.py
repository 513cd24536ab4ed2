"""Names of what the library counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from . import _constants


def names_of(prefix: str) -> dict[int, str]:
    """The names of the constants with a prefix, in lower case, by number."""
    return {value: name[len(prefix):].lower() for name, value in vars(_constants).items() if name.startswith(prefix)}


def name_of(names: Sequence[str] | Mapping[int, str], number: int) -> str:
    """The name of a number; "number 9" where a library that is newer than this package has one more."""
    try:
        return names[number] if number >= 0 else f"number {number}"
    except LookupError:
        return f"number {number}"
