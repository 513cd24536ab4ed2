"""Reads columns of numbers from a text: finds the lines that are points of a profile."""

from __future__ import annotations

import os
import re

import numpy as np

from .._decimal_commas import cut_decimals, has_decimal_commas

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"

# The beginning of lines that may be points: a number, or a mark for a number that is too long for its field (*) or unknown (nan).
_BEGINS = re.compile(r"\s*(?:[-+]?[.,]?\d|\*|[-+]?(?:nan|inf)\b)", re.IGNORECASE)
# A letter shows that a line is a title, unless it belongs to a number (_NO_TITLE).
_LETTERS = re.compile(r"[^\W\d_]")
_NO_TITLE = re.compile(r"nan|inf|(?<=[\d.])[eEdD](?=[-+\d])", re.IGNORECASE)
# Quotation marks and brackets around numbers are replaced by blanks.
_BRACKETS = str.maketrans("\"()[]", "     ")
# At most this many lines of other numbers, as counts and dates, may stand before and behind the points.
_OTHERS = 2


def to_number(word: str) -> float:
    """The value of a word that matches `NUMBER`, which may have the exponent letter D of Fortran."""
    return float(re.sub("[dD]", "e", word))


def columns_of(text: str, columns: tuple[int, int], path: str | os.PathLike[str]) -> tuple[np.ndarray, int]:
    """Reads two columns of the lines that are points. Returns them, and the least number of columns in these lines.

    Titles, counts and dates may stand before and behind all points. A line of numbers that lacks one of the columns is refused if it stands among the points.
    More than `_OTHERS` such lines are refused anywhere, because they are probably points that cannot be read.
    """
    lines = [line for line in text.translate(_BRACKETS).splitlines() if _BEGINS.match(line)]
    rows: list[list[float]] = []
    commas, width, others, among = has_decimal_commas(lines), 0, list[str](), ""
    behind = ""
    # Lines whose commas may be decimal points although they also separate columns: a point has at least two numbers, each with a decimal comma.
    halves = [line for line in lines if line.count(",") > 2 and ";" not in line]
    # If other numbers have decimal points, these lines are counts and dates, as 0001.
    if not commas and not any("." in line for line in halves) and (reason := cut_decimals(halves)):
        raise ValueError(f"{path} has {reason}")
    for line in lines:
        words = _words(line, commas)
        if len(words) > max(columns) and all(re.fullmatch(NUMBER, words[column]) for column in (0, *columns)):
            among = among or behind
            rows.append([to_number(words[column]) for column in columns])
            width = min(width or len(words), len(words))
            continue
        if rows:
            behind = behind or line.strip()
        if not _LETTERS.search(_NO_TITLE.sub("", line)):
            others.append(line.strip())
    if among:
        raise ValueError(f"{path} has a line {among[:60]!r} among its points that has no numbers in the columns {columns}: do columns run into each other, or "
                         "was nothing measured there? Mend it, leave it out, or put # before it")
    if rows and len(others) > _OTHERS:
        raise ValueError(f"{path} has {len(others)} lines of numbers beside its {len(rows)} points, as {others[0][:60]!r}, that have no numbers in the columns "
                         f"{columns}: do columns run into each other? Mend them, leave them out, or put # before them")
    if len(rows) < 4:
        raise ValueError(f"{path} has {len(rows)} points in the columns {columns}; at least 4 are needed")
    return np.array(rows), width


def _words(line: str, commas: bool) -> list[str]:
    """The cells of a line. They are separated by blanks, by semicolons, and by commas, unless commas are decimal points."""
    return (line.replace(",", ".") if commas else line.replace(",", " ")).replace(";", " ").split()
