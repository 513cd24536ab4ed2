"""Reads the lines above a list of points that name its columns, as `# x [mm] y [mm] z [mm]` or `# y x height`."""

from __future__ import annotations

import os
import re
from typing import NamedTuple

from .._units import in_metres, same_length
from ._headers import count_above, head_of

# Names of columns, and the coordinate that each of them means. A row is an index of y, because the first index of an array is that of y.
_KINDS = {"x": "x", "column": "x", "col": "x", "ix": "x", "y": "y", "row": "y", "iy": "y"}
_NAMES = "|".join((*_KINDS, "z", "heights?", "h", "h\u00f6he", "depth", "topography"))

# Regular expressions for units of length: symbols except m, and words.
_SYMBOLS = "(?-i:pm|nm|[u\u00b5\u03bc]m|mm|cm|\u00c5|\u212b)"
_WORDS = "(?:nano|micro|milli|centi)?met(?:er|re)s?|microns?"

# The name of a column, with or without a unit: x [mm], x (mm), x {mm}, x <mm>, x/mm, x in mm, x, mm or x_mm. _WORD also matches any other word.
_LABEL = (rf"(?<![^\W_])(?P<name>{_NAMES})(?:[ _-]?(?:axis|position|pos|coordinate))?(?![^\W_])"
          r"(?:\s*[\[({<]\s*(?P<within>[^\])}>\s]+)\s*[\])}>]|\s*/\s*(?P<per>[^\W\d_]+)"
          rf"|(?:\s+in\s+|\s*,\s*|[\s_]+)(?P<bare>(?:{_SYMBOLS}|(?-i:m)|{_WORDS})(?![^\W_])))?")
_WORD = re.compile(rf"{_LABEL}|[^\s,;|\[\](){{}}<>]+(?:\s*[\[({{<][^\])}}>]*[\])}}>])?", re.IGNORECASE)

# A unit of length that stands alone and may be that of the columns. It is not if a number stands beside it (a length), or / behind it (another quantity, or a
# folder). Words such as Meter in Meter Ltd. are names.
_NO_VALUE = r"(?!\s*[\])}>]?\s*[:=]?\s*[-+.]?\d)"
_UNIT = re.compile(rf"(?<![^\W_])(?<!\d\s)(?!(?-i:[A-Z]\w+ [A-Z]))(?:{_SYMBOLS}|{_WORDS})(?![^\W_]|/){_NO_VALUE}"
                   rf"|\[[^\[\]]*(?<![^\W_])(?:{_SYMBOLS}|(?-i:m)|{_WORDS})\s*\]{_NO_VALUE}|units?\s*[:=]\s*m\b", re.IGNORECASE)

# A value behind a name, as in Step x [mm]: 1. Such a line does not describe a column.
_VALUE = re.compile(r"[:=]\s*[-+.]?\d")

# Characters that mark a line as a comment.
_MARK = re.compile(r"^\s*[#%;/!*]*")

# Messages quote this number of characters of a line.
_QUOTED = 60


class Columns(NamedTuple):
    """What the lines above a list say of its columns.

    Attributes
    ----------
    unit : str or None
        The unit of length of the columns.
    order : (int, int, int) or None
        The columns of x, y and z, if each column has a name.
    is_y_first : bool
        Whether y stands before x, where `order` is None.
    doubt : str or None
        A line that names a unit, but is not understood.
    """

    unit: str | None = None
    order: tuple[int, int, int] | None = None
    is_y_first: bool = False
    doubt: str | None = None


class _Label(NamedTuple):
    """A word of a line: the column that it names, "x", "y" or "z" ("": it is another word), and the unit behind it ("": none)."""

    kind: str
    unit: str


def columns_of(path: str | os.PathLike[str], count: int) -> Columns:
    """What the lines above a list of `count` columns say of the columns. Columns in different units are refused."""
    head = head_of(path)
    above = count_above(head)
    told = [line for k, line in enumerate(head.splitlines()) if line.startswith("#") or k < above]
    lines = [_MARK.sub("", line).replace('"', " ").strip() for line in told]
    words = [_words_of(line) for line in lines]
    # Lines that each name one column and its unit.
    named = [[one for one in each if one.kind and one.unit] for each in words]
    alone = [each[0] for line, each in zip(lines, named) if len(each) == 1 and not _VALUE.search(line)]
    for each in (*words, alone):
        units = dict[str, str]()
        for one in each:
            if one.kind and one.unit:
                # If several columns are heights, the first one is read.
                units.setdefault(one.kind, one.unit)
        if len(units) == 3:
            if not all(same_length(units["x"], other) for other in units.values()):
                all_units = ", ".join(f"{name} in {unit}" for name, unit in units.items())
                raise ValueError(f"{path} has {all_units}: convert them to one unit")
            kinds, unit = list(units), units["x"] if in_metres(units["x"]) else None
            return Columns(unit, _order_of(each, count), kinds.index("y") < kinds.index("x"))
    doubt = next((whole for whole, line in zip(told, lines) if _UNIT.search(line)), None)
    order = next((found for each in words if (found := _order_of(each, count))), None)
    # A line with only x, y and z tells their order, too, if the list has more columns.
    three = next((found for each in words if (found := _order_of(each, 3))), None)
    is_y_first = order is None and three is not None and three[1] < three[0]
    return Columns(None, order, is_y_first, doubt and (doubt if len(doubt) <= _QUOTED else doubt[:_QUOTED] + "..."))


def _words_of(line: str) -> list[_Label]:
    """The words of a line, those that name columns with the units behind them."""
    found = []
    for word in _WORD.finditer(line):
        name = word["name"]
        unit = word["within"] or word["per"] or word["bare"] or ""
        found.append(_Label(_KINDS.get(name.lower(), "z") if name else "", unit))
    return found


def _order_of(words: list[_Label], count: int) -> tuple[int, int, int] | None:
    """The columns of x, y and z, if a line has one word for each of `count` columns and names each coordinate once; otherwise None."""
    kinds = [one.kind for one in words]
    if len(kinds) != count or any(kinds.count(kind) != 1 for kind in "xyz"):
        return None
    return kinds.index("x"), kinds.index("y"), kinds.index("z")
