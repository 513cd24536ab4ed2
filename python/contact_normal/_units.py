"""Names of the units of lengths and forces, and the units of pressures, areas and moments that follow from them."""

from __future__ import annotations

import re
from typing import Any, Optional

from ._arguments import both

# The name of the unit of lengths and that of forces.
Units = Optional[tuple[str, str]]

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# The unit of each kind of quantity as powers (of the unit of lengths, of the unit of forces).
_POWERS = {"length": (1, 0), "force": (0, 1), "pressure": (-2, 1), "area": (2, 0), "moment": (1, 1)}
_PRESSURES = {("m", "N"): "Pa", ("mm", "N"): "MPa", ("um", "N"): "TPa", ("m", "kN"): "kPa", ("mm", "kN"): "GPa",
              ("um", "mN"): "GPa", ("um", "uN"): "MPa", ("nm", "nN"): "GPa"}
# Units of length in metres.
_METRES = {"pm": 1e-12, "Å": 1e-10, "nm": 1e-9, "um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0}
_LENGTHS = {"nm", "um", "mm", "cm", "m"}
_NEWTONS = {"nN": 1e-9, "uN": 1e-6, "mN": 1e-3, "N": 1.0, "kN": 1e3, "MN": 1e6}
_FORCES = set(_NEWTONS)


def checked(units: Any) -> Units:
    """`units` as two names, or None. Pairs in which the name of a length and of a force seem to be exchanged are refused."""
    if units is None:
        return None
    length, force = both("units", units, 'a pair as ("mm", "N")')
    for name in (length, force):
        if not isinstance(name, str) or not name:
            raise TypeError(f'units are {units!r}; they must be a pair as ("mm", "N")')
    if _latin(length) in _FORCES or _latin(force) in _LENGTHS:
        raise ValueError(f'units are {units!r}; the first is that of lengths, the second that of forces, as ("mm", "N")')
    return length, force


def same_length(one: str, other: str) -> bool:
    """Whether two names mean the same unit of length. A name may be a symbol, or a word as in the conventions of NetCDF."""
    return _symbol(one) == _symbol(other)


def in_metres(name: str) -> float | None:
    """How many metres the unit of length `name` is; None if it is unknown."""
    return _METRES.get(_symbol(name))


def in_pascal(units: Units) -> float | None:
    """How many pascal the unit of pressures is; None if the units are not named or unknown."""
    if units is None:
        return None
    length, force = in_metres(units[0]), _NEWTONS.get(_latin(units[1]))
    return force / length**2 if length and force else None


class WithUnits:
    """A base class of objects with an attribute `units`."""

    _units: Units = None

    @property
    def units(self) -> Units:
        """Names of the units of lengths and forces, as ("mm", "N"), for pictures and files; None: unknown."""
        return self._units

    @units.setter
    def units(self, units: Any) -> None:
        self._units = checked(units)


def _symbol(name: str) -> str:
    """The symbol of a unit of length, from a symbol or a word: British or American, singular or plural."""
    word = re.fullmatch(r"(nano|micro|milli|centi|)met(?:er|re)s?|(micron)s?", name.strip().lower())
    return {"nano": "nm", "micro": "um", "milli": "mm", "centi": "cm", "": "m", None: "um"}[word[1]] if word else _latin(name.strip())


def _latin(name: str) -> str:
    """The name of a unit with u in the place of the two characters for micro, and with one of the two characters for angstrom."""
    return name.replace("\u00b5", "u").replace("\u03bc", "u").replace("\u212b", "\u00c5")


def unit(kind: str, units: Units) -> str:
    """The name of the unit of a kind of quantity: a "length", "force", "pressure", "area" or "moment"; "" without `units`."""
    if units is None:
        return ""
    if kind == "pressure" and (known := _PRESSURES.get((_latin(units[0]), _latin(units[1])))):
        return known
    length, force = _POWERS[kind]
    return " ".join(name + (str(power) if power != 1 else "") for name, power in ((units[1], force), (units[0], length)) if power)


def with_unit(value: str, kind: str, units: Units) -> str:
    """A text with a value and the unit of its kind."""
    return f"{value} {unit(kind, units)}" if units else value


def label(name: str, kind: str, units: Units) -> str:
    """The label of an axis: a name and its unit in brackets, with raised exponents."""
    return f"{name} [{_raised(unit(kind, units))}]" if units else name


def _raised(text: str) -> str:
    return re.sub("(?<=[a-z])-?[0-9]", lambda power: power[0].translate(_RAISED), text)


def title(value: str, kind: str, units: Units) -> str:
    """A text with a value and its unit for the title of a picture, with raised exponents."""
    return f"{value} {_raised(unit(kind, units))}" if units else value
