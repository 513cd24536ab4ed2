"""The message of each problem of a batch, from that of the whole call."""

from __future__ import annotations

import functools
import operator
import re
from collections.abc import Sequence
from typing import Any

from ._constants import OK
from ._library import library


class Warned:
    """The warnings of all reports of a batch together."""

    def __init__(self, reports: Any) -> None:
        self._reports = reports

    @property
    def warnings(self) -> int:
        return functools.reduce(operator.or_, (report.warnings for report in self._reports), 0)


def messages_of(statuses: Any, told: str, warnings: Sequence[int]) -> list[str]:
    """The message of each problem. Problems that are not OK have lines "problem 3: ..." in the text of the library. If all are OK, the text has warnings."""
    if all(status == OK for status in statuses):
        return [_part_of(told, functools.reduce(operator.or_, warnings, 0), one) for one in warnings]
    parts = re.split(r"^problem (\d+): ", told, flags=re.MULTILINE)
    lines = {int(number): text.rstrip("\n") for number, text in zip(parts[1::2], parts[2::2])}
    texts = (library.contact_normal_status_text(status).decode() for status in statuses)
    return ["" if status == OK else lines.get(i, text) for i, (status, text) in enumerate(zip(statuses, texts))]


def _part_of(told: str, all_of: int, warnings: int) -> str:
    """The text of some warnings, cut from the text of all of them, which has the order of their bits."""
    bits = [1 << k for k in range(all_of.bit_length()) if all_of >> k & 1]
    texts = told.split("; ", len(bits) - 1) if bits else []
    if len(texts) != len(bits):
        return told if warnings else ""
    return "; ".join(text for bit, text in zip(bits, texts) if warnings & bit)
