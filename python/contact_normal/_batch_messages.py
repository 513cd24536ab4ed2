"""Splits the message of a batch into one message for each problem."""

from __future__ import annotations

import functools
import operator
import re
from collections.abc import Sequence
from typing import Any

from ._constants import OK
from ._library import library


class Warned:
    """Stands for the reports of a batch where one report is needed: its `warnings` are those of all reports together."""

    def __init__(self, reports: Any) -> None:
        self._reports = reports

    @property
    def warnings(self) -> int:
        return functools.reduce(operator.or_, (report.warnings for report in self._reports), 0)


def messages_of(statuses: Any, told: str, warnings: Sequence[int]) -> list[str]:
    """The message of each problem, from the message `told` of the whole call.

    If some problems are not OK, the message has a line "problem 3: ..." for each of these. If all are OK, it is the text of all warnings.
    """
    if all(status == OK for status in statuses):
        return [_part_of(told, functools.reduce(operator.or_, warnings, 0), one) for one in warnings]
    parts = re.split(r"^problem (\d+): ", told, flags=re.MULTILINE)
    lines = {int(number): text.rstrip("\n") for number, text in zip(parts[1::2], parts[2::2])}
    texts = (library.contact_normal_status_text(status).decode() for status in statuses)
    return ["" if status == OK else lines.get(i, text) for i, (status, text) in enumerate(zip(statuses, texts))]


def _part_of(told: str, all_of: int, warnings: int) -> str:
    """The text of the `warnings` of one problem, cut from the text of the warnings `all_of` a batch, which are separated by "; " in the order of their bits."""
    bits = [1 << k for k in range(all_of.bit_length()) if all_of >> k & 1]
    texts = told.split("; ", len(bits) - 1) if bits else []
    if len(texts) != len(bits):
        return told if warnings else ""
    return "; ".join(text for bit, text in zip(bits, texts) if warnings & bit)
