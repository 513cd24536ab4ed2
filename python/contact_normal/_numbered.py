"""Names of numbered constants of the library."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from . import _constants


def names_of(prefix: str) -> dict[int, str]:
    """The names in lower case of the constants with a prefix, by number."""
    return {value: name[len(prefix):].lower() for name, value in vars(_constants).items() if name.startswith(prefix)}


def name_of(names: Sequence[str] | Mapping[int, str], number: int) -> str:
    """The name of a number, or "number 9" if a newer library has a number without a name here."""
    try:
        return names[number] if number >= 0 else f"number {number}"
    except LookupError:
        return f"number {number}"
