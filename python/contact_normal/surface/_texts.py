"""Heights as text: rows of numbers."""

from __future__ import annotations

import os
import re
from typing import Any

import numpy as np

from .._decimal_commas import has_decimal_commas
from .._texts import text_of
from ._not_a_map import has_cut_decimals

# What parts the numbers of a line, in words.
_BETWEEN = {None: "spaces", ",": "commas", ";": "semicolons", "\t": "tabs"}


def of_text(path: str | os.PathLike[str], end: str) -> Any:
    """Columns of numbers: those of a line are separated by spaces, in .csv by commas, or by semicolons where there are any: commas are
    then decimal points. Cells of such files may be quoted, and those without a number are NaN, as are empty cells between tabs."""
    lines = [line.split("#")[0] for line in text_of(path).splitlines()]
    lines = [line for line in lines if line.strip()]
    if not lines:
        raise ValueError(f"{path} has no numbers")
    delimiter = ";" if ";" in lines[0] else "," if end == ".csv" and "," in lines[0] else "\t" if _has_empty_cells(lines) else None
    cells = lines
    if delimiter == ";":
        cells = [line.replace(",", ".") for line in cells]
    if delimiter and any(delimiter in quoted for line in cells for quoted in _QUOTED.findall(line)):
        raise ValueError(f"{path} has {_BETWEEN[delimiter]} within quoted cells: decimal commas need semicolons between the numbers")
    if delimiter:
        cells = _filled([line.replace('"', "") for line in cells], delimiter)
    try:
        values = np.loadtxt([_FORTRAN.sub("e", line) for line in cells], delimiter=delimiter, ndmin=2)
    except ValueError as error:
        commas = "decimal commas need semicolons between the numbers; " if has_decimal_commas(lines) else ""
        raise ValueError(f"{path}: {error}, lines with # and empty ones not counted; it must hold numbers alone, a row of the grid a line, separated by "
                         f"{_BETWEEN[delimiter]}; {commas}put # before other lines, and nan where nothing was measured") from error
    if delimiter == "," and has_cut_decimals(cells):
        raise ValueError(f"{path} has numbers that begin with zeros between its commas: decimal commas need semicolons between the numbers")
    return values


# Cells between quotes.
_QUOTED = re.compile(r'"[^"]*"')

# Exponents of Fortran.
_FORTRAN = re.compile(r"(?<=[\d.])[dD](?=[-+\d])")


def _has_empty_cells(lines: list[str]) -> bool:
    """Whether single tabs part the numbers of all lines, and some cells are empty."""
    if not any("\t\t" in line or "\t" in (line[0], line.rstrip(" \r")[-1]) for line in lines):
        return False
    rows = [[cell.strip() for cell in line.split("\t")] for line in lines]
    if any(len(row) != len(rows[0]) or " " in cell for row in rows for cell in row):
        return False
    # Two tabs between all numbers, and one at the end of all lines, stand for nothing.
    if not any(cell for row in rows for cell in row[1::2]):
        return False
    last = None if any(row[-1] for row in rows) else -1
    return any(not cell for row in rows for cell in row[:last])


def _filled(lines: list[str], delimiter: str) -> list[str]:
    """Lines whose empty cells are NaN. A delimiter at the end of every line stands for nothing."""
    blank = r"[^\S\t]" if delimiter == "\t" else r"\s"
    lines = [re.sub(rf"^{blank}+|{blank}+$", "", line) for line in lines]
    if all(line.endswith(delimiter) for line in lines):
        lines = [line[:-1] for line in lines]
    empty = re.compile(rf"(?:^|(?<={delimiter})){blank}*(?={delimiter}|$)")
    return [empty.sub("nan", line) for line in lines]
