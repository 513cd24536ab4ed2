"""Decides whether commas in text files of numbers are decimal points or separate columns."""

from __future__ import annotations

import re


def has_decimal_commas(lines: list[str]) -> bool:
    """Whether the commas of these lines are decimal points.

    They are if no line has a point, and each line with commas has at least two words, none of them with several commas.
    """
    words = [re.findall(r"(?<!\S)[-+.,\d]\S*", line.replace(";", " ")) for line in lines if "," in line]
    return bool(words) and not any("." in line for line in lines) and all(len(one) > 1 and max(map(_commas, one)) == 1 for one in words)


def _commas(word: str) -> int:
    """The number of commas in a word that is a number with at most one decimal comma; otherwise 2, because a comma then separates columns."""
    return word.count(",") if re.fullmatch(r"[-+]?\d*(,\d+)?([eEdD][-+]?\d+)?", word) else 2


# If every second cell has the same number of digits and no sign, but this many of the other cells do not, the second cells are decimals: with columns of one
# kind such cells would stand in all columns.
_MANY = 8


def cut_decimals(lines: list[str]) -> str | None:
    """The reason why the commas of these lines are decimal points, although they seem to separate columns; None if they do separate columns."""
    if any(re.search(r"(^|,)\s*0\d+\s*(,|$)", line) for line in lines):
        return "numbers that begin with zeros between its commas: decimal commas need semicolons between the numbers"
    if any("." in line for line in lines) or not (_are_halves(lines) or _are_pairs(lines)):
        return None
    return ("digits behind decimal commas, it seems: decimal commas need semicolons between the numbers. If these are "
            "integers, write one of them with a point, as 12.0")


def _are_halves(lines: list[str]) -> bool:
    """Whether every second cell seems to be the decimals of the cell before it.

    All of these cells have the same number of digits and no sign. Many of the other cells, in at least half of their columns, have a sign or another number of
    digits. One such column among many is not enough: it may come from a dead detector.
    """
    most = max((line.count(",") for line in lines), default=0)
    rows = [[cell.strip() for cell in line.split(",")] for line in lines if line.count(",") == most]
    first, second = ([cell for row in rows for cell in row[k::2]] for k in (0, 1))
    are_digits = all(re.fullmatch(r"\d+", cell) for cell in second)
    if most % 2 == 0 or not are_digits or not all(re.fullmatch(r"[-+]?\d+", cell) for cell in first):
        return False
    lengths = {len(cell) for cell in second}
    others = [k for row in rows for k in range(0, most, 2) if not row[k].isdigit() or len(row[k]) not in lengths]
    return len(lengths) == 1 and len(others) >= _MANY and 4 * len(set(others)) > most


def _are_pairs(lines: list[str]) -> bool:
    """Whether commas followed by blanks separate all numbers, and each number has another comma inside."""
    cells = [cell for line in lines for cell in re.split(r",\s+", line.strip(" ,"))]
    numbers = [cell for cell in cells if re.search(r"\d", cell)]
    are_parted = any(re.search(r",\s", line.strip()) for line in lines)
    return are_parted and all(re.fullmatch(r"\s*[-+]?\d*,\d+\s*", cell) for cell in numbers)
