"""Reads rows of numbers from texts."""

from __future__ import annotations

import os
import re
import warnings
from typing import Any

import numpy as np

from .._decimal_commas import cut_decimals, has_decimal_commas
from .._texts import text_of

# The names of the separators of numbers, for messages.
_BETWEEN = {None: "spaces", ",": "commas", ";": "semicolons", "\t": "tabs"}


def of_text(path: str | os.PathLike[str], end: str, above: int = 0) -> Any:
    """Reads the numbers of a text as an array of lines and columns.

    Numbers are separated by semicolons, if the first line has any; then commas are decimal points. Otherwise commas separate the numbers of .csv files, and
    blanks or tabs those of others. Cells may be quoted where commas or semicolons separate them. Cells without a number are NaN, as are empty cells between
    tabs. The first `above` lines are not read.
    """
    lines = [line.split("#")[0] for line in text_of(path).splitlines()[above:]]
    tabs, lines = _between_tabs(lines), [line for line in lines if line.strip()]
    if not lines:
        raise ValueError(f"{path} has no numbers")
    delimiter = ";" if ";" in lines[0] else "," if end == ".csv" and "," in lines[0] else "\t" if tabs else None
    cells = tabs if tabs and delimiter == "\t" else lines
    if delimiter == ";":
        cells = [line.replace(",", ".") for line in cells]
    if delimiter and any(delimiter in quoted for line in cells for quoted in _QUOTED.findall(line)):
        raise ValueError(f"{path} has {_BETWEEN[delimiter]} within quoted cells: decimal commas need semicolons between the numbers")
    if delimiter and delimiter != "\t":
        cells = _filled([line.replace('"', "") for line in cells], delimiter)
    try:
        values = np.loadtxt([_FORTRAN.sub("e", line) for line in cells], delimiter=delimiter, ndmin=2)
    except ValueError as error:
        are_decimal = has_decimal_commas(lines) or delimiter == "," and cut_decimals(cells)
        commas = "decimal commas need semicolons between the numbers; " if are_decimal else ""
        raise ValueError(f"{path}: {error}, lines with # and empty ones not counted; it must hold numbers alone, a row of the grid a line, separated by "
                         f"{_BETWEEN[delimiter]}; {commas}put # before other lines, and nan where nothing was measured") from error
    if delimiter == "," and (reason := cut_decimals(cells)):
        raise ValueError(f"{path} has {reason}")
    if delimiter == "\t" and (empty := np.flatnonzero(np.isnan(values).all(axis=0))).size:
        warnings.warn(f"column {empty[0]}, counted from 0, has no number: a column of holes", stacklevel=3)
    return values


def refuse_skipped_rows(path: str | os.PathLike[str]) -> None:
    """Refuses a map with a word in a row of numbers. SurfaceTopography would take such a row for a line of the header, and leave it out."""
    rows = [line.split() for line in text_of(path).splitlines()]
    counts = [sum(map(_is_number, row)) for row in rows]
    full = [k for k, (row, count) in enumerate(zip(rows, counts)) if row and count == len(row)]
    if not full:
        return
    width = max(len(rows[k]) for k in full)
    if width < _LEAST_WIDTH:
        return
    for k, (row, count) in enumerate(zip(rows, counts)):
        if not row or row[0].startswith("#") and row[0] != "#N/A":
            continue
        is_among = full[0] < k < full[-1]
        is_row = len(row) == width and (is_among or len(set(row)) == 1)
        has_holes_alone = all(_is_number(cell) or _HOLE.fullmatch(cell) for cell in row)
        if count < len(row) and (2 * count >= width or is_row) and (is_among or has_holes_alone):
            word = next(cell for cell in row if not _is_number(cell))
            raise ValueError(f"{path}: line {k + 1} has {word!r} among its numbers; write nan where nothing was measured, and comments on lines of their own")


# Maps with fewer columns are not checked by `refuse_skipped_rows`, because their rows look like lines of a header.
_LEAST_WIDTH = 4

# Words that stand for holes, and damaged numbers. Above and below the numbers, lines with other words are those of a header.
_HOLE = re.compile(r"[-+]?[\d.].*|[-*?_]+|#?n/?[av]|#\w.*|[-+]?nan\(.*\)|none|null|no|data|nodata|missing|void|invalid", re.IGNORECASE)


def _is_number(cell: str) -> bool:
    """Whether SurfaceTopography reads a cell as a number or as a hole."""
    try:
        float(cell)
    except ValueError:
        return cell.lower() in ("bad", "infinite")
    return True


# A cell in quotation marks.
_QUOTED = re.compile(r'"[^"]*"')

# The exponent letter D of Fortran within a number.
_FORTRAN = re.compile(r"(?<=[\d.])[dD](?=[-+\d])")


def has_empty_cells(path: str | os.PathLike[str]) -> bool:
    """Whether single tabs separate the cells of all lines of a file, and some cells are empty."""
    return _between_tabs([line.split("#")[0] for line in text_of(path).splitlines()]) is not None


def _between_tabs(lines: list[str]) -> list[str] | None:
    """The lines of a text with nan in the empty cells between tabs; None without empty cells, or if single tabs do not separate all numbers."""
    lines = [line.replace('"', "").strip(" \r") for line in lines]
    most = max((line.count("\t") for line in lines), default=0)
    # A line without a number is a row of holes if it has as many cells as the others.
    lines = [line for line in lines if line.strip() or line and line.count("\t") >= max(1, most - 1)]
    if not any(re.search(r"^\t|\t[^\S\t]*\t|\t$", line) for line in lines):
        return None
    rows = _without_end([[cell.strip() for cell in line.split("\t")] for line in lines])
    if all(len(row) > 1 and not row[0] for row in rows) and all(cell for row in rows for cell in row[1:]):
        rows = [row[1:] for row in rows]
    if any(" " in cell for row in rows for cell in row):
        return None
    if any(len(row) != len(rows[0]) for row in rows):
        if len({sum(map(bool, row)) for row in rows}) == 1:
            warnings.warn("some numbers are parted by several tabs, and lines differ in their cells: tabs in a row are one; write nan for holes", stacklevel=4)
        return None
    # If every second cell of all lines is empty, two tabs stand for one between all numbers.
    if not all(any(cell for row in rows for cell in row[first::2]) for first in (0, 1)) or all(cell for row in rows for cell in row):
        return None
    return ["\t".join(cell or "nan" for cell in row) for row in rows]


def _without_end(rows: list[list[str]]) -> list[list[str]]:
    """The rows without the empty last cell that a tab at the end of all lines, or of the lines that are longer by one, makes."""
    shortest = min(len(row) for row in rows)
    if all(len(row) == shortest and not row[-1] for row in rows):
        return [row[:-1] for row in rows]
    return [row[:-1] if len(row) == shortest + 1 and not row[-1] else row for row in rows]


def _filled(lines: list[str], delimiter: str) -> list[str]:
    """The lines with nan in their empty cells. A delimiter at the end of every line does not make a cell."""
    lines = [line.strip() for line in lines]
    if all(line.endswith(delimiter) for line in lines):
        lines = [line[:-1] for line in lines]
    empty = re.compile(rf"(?:^|(?<={delimiter}))\s*(?={delimiter}|$)")
    return [empty.sub("nan", line) for line in lines]
