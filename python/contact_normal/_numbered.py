"""Converts numbers of the library, as those of quantities, to the names of their constants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from . import _constants


def names_of(prefix: str) -> dict[int, str]:
    """For each number the name, in lower case and without the prefix, of the constant that has this prefix and this value."""
    return {value: name[len(prefix):].lower() for name, value in vars(_constants).items() if name.startswith(prefix)}


def name_of(names: Sequence[str] | Mapping[int, str], number: int) -> str:
    """The name of a number. If a newer library returns a number that has no name in this package, the text is "number 9"."""
    try:
        return names[number] if number >= 0 else f"number {number}"
    except LookupError:
        return f"number {number}"
