"""Reads the lines above the numbers of a text, as Gwyddion writes them: the size of the field and the unit of the heights."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

from .._texts import decoded
from .._units import in_metres

# A header is looked for in this number of bytes at the beginning of a file.
_WITHIN = 4096

_LENGTH = re.compile(r"^#\s*(Width|Height)\s*:[ \t]*([-+.,\deE]+)(?![-+.,\d])[ \t]*(\S*)[ \t]*$", re.MULTILINE)
_UNIT = re.compile(r"^#\s*Value units?\s*:[ \t]*(\S*)[ \t]*$", re.MULTILINE)


def head_of(path: str | os.PathLike[str]) -> str:
    """The first `_WITHIN` bytes of a file as text."""
    with Path(path).open("rb") as file:
        return decoded(file.read(_WITHIN), cut=True).replace("\r", "")


# A cell with a number or a hole (nan, inf). The number may have a decimal comma, or the exponent letter D of Fortran.
_NUMBER = re.compile(r'"?[-+]?(?:[.,]?\d[\d.,]*(?:[eEdD][-+]?\d+)?|nan|inf(?:inity)?)"?', re.IGNORECASE)


def count_above(head: str) -> int:
    """The number of lines above the first line that consists of three numbers or more; 0 if there is no such line."""
    for k, line in enumerate(head.splitlines()):
        cells = [cell for cell in re.split(r"[\s;]+", line) if cell]
        if len(cells) >= 3 and all(_NUMBER.fullmatch(cell) for cell in cells):
            return k
    return 0


def refuse_esri_grid(path: str | os.PathLike[str]) -> None:
    """Refuses an ESRI grid of a geographic information system. Its header, with the element size and the number for "not measured", is not read."""
    if re.match(r"\s*ncols\s+\d", head_of(path), re.IGNORECASE):
        raise ValueError(f"{path} is an ESRI grid: read its numbers by numpy.loadtxt(path, skiprows=n), n being the lines of its header, 5 or 6 with NODATA_value. "
                         "Give them to surface.heights with its cellsize as dx and dy, its NODATA_value as fill, and top_first=True")


def header_of(path: str | os.PathLike[str], is_given: bool = False) -> dict[str, Any]:
    """Reads a header such as `# Width: 10.00 um`, `# Height: 5.00 um`, `# Value units: m`.

    Returns the "size" of the field, converted to the unit of the heights, and the "unit" of the heights; an empty dict if there is no such header. A size that
    is no positive length is refused; if the caller gives sizes (`is_given`), "size" is None instead.
    """
    text = head_of(path)
    lengths, value = {name: (number, unit) for name, number, unit in _LENGTH.findall(text)}, _UNIT.search(text)
    if len(lengths) < 2 or value is None:
        return {}
    unit = in_metres(value[1])
    if unit is None:
        raise ValueError(f"{path} says that its values are in {value[1] or 'no unit'}: they are no heights")
    sizes = []
    for name in ("Width", "Height"):
        number, of_length = lengths[name]
        length = in_metres(of_length)
        try:
            size = float(number.replace(",", ".")) * (length or 0.0) / unit
        except ValueError:
            size = 0.0
        if not 0.0 < size < float("inf"):
            if is_given:
                return {"size": None, "unit": value[1]}
            why = "; it must be a positive number without signs between thousands"
            if length is None:
                why = f", which {'is' if of_length else 'has'} no unit of length"
            raise ValueError(f"{path} says {name}: {f'{number} {of_length}'.rstrip()}{why}; or give size=(...)")
        sizes.append(size)
    return {"size": tuple(sizes), "unit": value[1]}
