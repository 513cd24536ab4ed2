"""Commas in text files of numbers: whether they are decimal points or separate columns."""

from __future__ import annotations

import re


def has_decimal_commas(lines: list[str]) -> bool:
    """Whether commas are decimal points: no line has a point, and of those with commas each has at least two words, none with several commas."""
    words = [re.findall(r"(?<!\S)[-+.,\d]\S*", line.replace(";", " ")) for line in lines if "," in line]
    return bool(words) and not any("." in line for line in lines) and all(len(one) > 1 and max(map(_commas, one)) == 1 for one in words)


def _commas(word: str) -> int:
    """The number of commas of a word; 2 if one is not between digits, because it then separates columns."""
    return word.count(",") if re.fullmatch(r"[-+]?\d*(,\d+)?([eEdD][-+]?\d+)?", word) else 2


# Among so many numbers whose digits alternate chance is no reason: of columns of one kind each has both of them.
_MANY = 8


def cut_decimals(lines: list[str]) -> str | None:
    """Why the commas of these lines are decimal points, though they seem to part columns; None if they are not."""
    if any(re.search(r"(^|,)\s*0\d+\s*(,|$)", line) for line in lines):
        return "numbers that begin with zeros between its commas: decimal commas need semicolons between the numbers"
    if any("." in line for line in lines) or not (_are_halves(lines) or _are_pairs(lines)):
        return None
    return ("digits behind decimal commas, it seems: decimal commas need semicolons between the numbers. If these are "
            "integers, write one of them with a point, as 12.0")


def _are_halves(lines: list[str]) -> bool:
    """Whether every second cell has equally many digits and no sign, and many of the others, in at least half of their
    columns, have a sign or other lengths. A column alone, as of a dead detector, has a reason of its own."""
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
    """Whether commas with blanks behind them part all numbers, each of which has a comma within."""
    cells = [cell for line in lines for cell in re.split(r",\s+", line.strip(" ,"))]
    numbers = [cell for cell in cells if re.search(r"\d", cell)]
    are_parted = any(re.search(r",\s", line.strip()) for line in lines)
    return are_parted and all(re.fullmatch(r"\s*[-+]?\d*,\d+\s*", cell) for cell in numbers)
