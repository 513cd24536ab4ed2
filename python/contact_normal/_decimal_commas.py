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
