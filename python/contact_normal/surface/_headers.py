"""Lines above the numbers of a text: the size of the field and the unit of the heights, as in files of Gwyddion, and the units of columns x y z."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

from .._texts import decoded
from .._units import in_metres, same_length

# A header is within this number of bytes.
_WITHIN = 4096

_LENGTH = re.compile(r"^#\s*(Width|Height)\s*:\s*([-+.,\deE]+)\s*(\S+)\s*$", re.MULTILINE)
_UNIT = re.compile(r"^#\s*Value units?\s*:[ \t]*(\S*)[ \t]*$", re.MULTILINE)


# x [mm], x (mm) or x/mm.
_COLUMN = re.compile(r"(?<![^\W_])([xyz])\s*(?:\[\s*([^\]\s]+)\s*\]|\(\s*([^)\s]+)\s*\)|/\s*([^\W\d_]+))", re.IGNORECASE)


def _head(path: str | os.PathLike[str]) -> str:
    """The beginning of a text."""
    with Path(path).open("rb") as file:
        return decoded(file.read(_WITHIN), cut=True).replace("\r", "")


def columns_of(path: str | os.PathLike[str]) -> tuple[str | None, bool]:
    """The unit in a line as `# x [mm] y [mm] z [mm]` or `# x y z` above a list of points, or None, and whether y stands before x. Different units are
    refused."""
    for line in (line for line in _head(path).split("\n") if line.startswith("#")):
        names = re.split(r"[\s,;]+", line[1:].strip().lower())
        if sorted(names) == ["x", "y", "z"]:
            return None, names.index("y") < names.index("x")
        found = {name.lower(): "".join(units) for name, *units in _COLUMN.findall(line)}
        if len(found) < 3:
            continue
        if not all(same_length(found["x"], other) for other in found.values()):
            raise ValueError(f"{path} has {', '.join(f'{name} in {unit}' for name, unit in found.items())}: convert them to one unit")
        order = list(found)
        return found["x"] if in_metres(found["x"]) else None, order.index("y") < order.index("x")
    return None, False


def refuse_esri_grid(path: str | os.PathLike[str]) -> None:
    """Refuses a grid of a geographic information system, whose header has the size of an element and the fill value."""
    if re.match(r"\s*ncols\s+\d", _head(path), re.IGNORECASE):
        raise ValueError(f"{path} is an ESRI grid: read its numbers by numpy.loadtxt(path, skiprows=n), n being the lines of its header, 5 or 6 with NODATA_value. "
                         "Give them to surface.heights with its cellsize as dx and dy, its NODATA_value as fill, and top_first=True")


def header_of(path: str | os.PathLike[str], is_given: bool = False) -> dict[str, Any]:
    """`size` and `unit` of a text with the header lines `# Width: 10.00 um`, `# Height: 5.00 um` and `# Value units: m`; the size is in the unit of the
    heights. Empty without such a header. An invalid size is refused, or, if the caller gives sizes, it is None."""
    text = _head(path)
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
            why = ", which is no unit of length" if length is None else "; it must be a positive number without signs between thousands"
            raise ValueError(f"{path} says {name}: {number} {of_length}{why}; or give size=(...)")
        sizes.append(size)
    return {"size": tuple(sizes), "unit": value[1]}
