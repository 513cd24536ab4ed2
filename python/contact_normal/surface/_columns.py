"""Lines above lists of points: what they say of the columns, as `# x [mm] y [mm] z [mm]` or `# y x height`."""

from __future__ import annotations

import os
import re
from typing import NamedTuple

from .._units import in_metres, same_length
from ._headers import count_above, head_of

# Names of columns, and what they are. The first index of an array is that of y.
_KINDS = {"x": "x", "column": "x", "col": "x", "ix": "x", "y": "y", "row": "y", "iy": "y"}
_NAMES = "|".join((*_KINDS, "z", "heights?", "h", "h\u00f6he", "depth", "topography"))

# Units of length: symbols, but for that of metres, and words.
_SYMBOLS = "(?-i:pm|nm|[u\u00b5\u03bc]m|mm|cm|\u00c5|\u212b)"
_WORDS = "(?:nano|micro|milli|centi)?met(?:er|re)s?|microns?"

# x [mm], x (mm), x {mm}, x <mm>, x/mm, x in mm, x, mm or x_mm; and any other word.
_LABEL = (rf"(?<![^\W_])(?P<name>{_NAMES})(?:[ _-]?(?:axis|position|pos|coordinate))?(?![^\W_])"
          r"(?:\s*[\[({<]\s*(?P<within>[^\])}>\s]+)\s*[\])}>]|\s*/\s*(?P<per>[^\W\d_]+)"
          rf"|(?:\s+in\s+|\s*,\s*|[\s_]+)(?P<bare>(?:{_SYMBOLS}|(?-i:m)|{_WORDS})(?![^\W_])))?")
_WORD = re.compile(rf"{_LABEL}|[^\s,;|\[\](){{}}<>]+(?:\s*[\[({{<][^\])}}>]*[\])}}>])?", re.IGNORECASE)

# A unit that stands for itself. Beside a number it is that of a length, before / that of another quantity or a folder;
# words as Meter in Meter Ltd. are names.
_NO_VALUE = r"(?!\s*[\])}>]?\s*[:=]?\s*[-+.]?\d)"
_UNIT = re.compile(rf"(?<![^\W_])(?<!\d\s)(?!(?-i:[A-Z]\w+ [A-Z]))(?:{_SYMBOLS}|{_WORDS})(?![^\W_]|/){_NO_VALUE}"
                   rf"|\[[^\[\]]*(?<![^\W_])(?:{_SYMBOLS}|(?-i:m)|{_WORDS})\s*\]{_NO_VALUE}|units?\s*[:=]\s*m\b", re.IGNORECASE)

# A value behind a name, as in Step x [mm]: 1. Such a line is of no column.
_VALUE = re.compile(r"[:=]\s*[-+.]?\d")

# What marks a line that has no numbers.
_MARK = re.compile(r"^\s*[#%;/!*]*")

# So much of a line is quoted.
_QUOTED = 60


class Columns(NamedTuple):
    """What is said of the columns of a list: their unit; where x, y and z stand, if each column has a name, and else
    whether y stands before x; and the line that names a unit and is not understood."""

    unit: str | None = None
    order: tuple[int, int, int] | None = None
    is_y_first: bool = False
    doubt: str | None = None


class _Label(NamedTuple):
    """A word of a line: "x", "y", "z", or "" for another one, and its unit."""

    kind: str
    unit: str


def columns_of(path: str | os.PathLike[str], count: int) -> Columns:
    """What the lines above a list of so many columns say of them. Units that differ are refused."""
    head = head_of(path)
    above = count_above(head)
    told = [line for k, line in enumerate(head.splitlines()) if line.startswith("#") or k < above]
    lines = [_MARK.sub("", line).replace('"', " ").strip() for line in told]
    words = [_words_of(line) for line in lines]
    # A line for each column.
    named = [[one for one in each if one.kind and one.unit] for each in words]
    alone = [each[0] for line, each in zip(lines, named) if len(each) == 1 and not _VALUE.search(line)]
    for each in (*words, alone):
        units = dict[str, str]()
        for one in each:
            if one.kind and one.unit:
                # Of several columns of heights the first one counts.
                units.setdefault(one.kind, one.unit)
        if len(units) == 3:
            if not all(same_length(units["x"], other) for other in units.values()):
                all_units = ", ".join(f"{name} in {unit}" for name, unit in units.items())
                raise ValueError(f"{path} has {all_units}: convert them to one unit")
            kinds, unit = list(units), units["x"] if in_metres(units["x"]) else None
            return Columns(unit, _order_of(each, count), kinds.index("y") < kinds.index("x"))
    doubt = next((whole for whole, line in zip(told, lines) if _UNIT.search(line)), None)
    order = next((found for each in words if (found := _order_of(each, count))), None)
    # A line of x, y and z alone says their order among more columns, too.
    three = next((found for each in words if (found := _order_of(each, 3))), None)
    is_y_first = order is None and three is not None and three[1] < three[0]
    return Columns(None, order, is_y_first, doubt and (doubt if len(doubt) <= _QUOTED else doubt[:_QUOTED] + "..."))


def _words_of(line: str) -> list[_Label]:
    """The words of a line. Names of columns are followed by their units."""
    found = []
    for word in _WORD.finditer(line):
        name = word["name"]
        unit = word["within"] or word["per"] or word["bare"] or ""
        found.append(_Label(_KINDS.get(name.lower(), "z") if name else "", unit))
    return found


def _order_of(words: list[_Label], count: int) -> tuple[int, int, int] | None:
    """The columns of x, y and z, where a line has a word for each column and names each of these once."""
    kinds = [one.kind for one in words]
    if len(kinds) != count or any(kinds.count(kind) != 1 for kind in "xyz"):
        return None
    return kinds.index("x"), kinds.index("y"), kinds.index("z")
