"""Reads the text of files that instruments and spreadsheets write, in whatever encoding."""

from __future__ import annotations

import codecs
import os
from pathlib import Path

# Byte order marks at the beginning of a file, and the encodings that they indicate.
_MARKS = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
# A file is taken for a text if it has no byte 0 among this number of its first bytes.
_LOOKED_AT = 4096


def text_of(path: str | os.PathLike[str]) -> str:
    """The text of a file, in the encoding of its byte order mark, else in UTF-8 if that is valid, else in Latin-1. Typographic minus signs become hyphens."""
    return decoded(Path(path).read_bytes())


def starts_with_mark(path: str | os.PathLike[str]) -> bool:
    """Whether a file begins with the byte order mark of UTF-8 or UTF-16."""
    with open(path, "rb") as file:
        return file.read(3).startswith((codecs.BOM_UTF8, *_MARKS))


def decoded(data: bytes, cut: bool = False) -> str:
    """The text of the bytes of a file; see `text_of`. `cut`: the bytes are the beginning of a file and may end within a character."""
    named = [encoding for mark, encoding in _MARKS.items() if data.startswith(mark)]
    try:
        text = data.decode(named[0] if named else "utf-8-sig", errors="replace" if named else "strict")
    except UnicodeDecodeError as error:
        if cut and error.start > len(data) - 4:
            return decoded(data[: error.start])
        text = data.decode("latin-1").removeprefix("\xef\xbb\xbf")
    return text.replace("\u2212", "-")


def is_text(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a text, and not binary."""
    with open(path, "rb") as file:
        data = file.read(_LOOKED_AT)
    return b"\0" not in data or data.startswith(tuple(_MARKS))
