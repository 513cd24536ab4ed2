"""Profiles from files: SIMPACK's .prr and .prw, MiniProf's .ban and .whl, plain columns.

Each reader was written from the public description of its format, and from the comments that such files carry.
"""

from __future__ import annotations

import codecs
import os
import re
from pathlib import Path

import numpy as np

from .._arguments import number
from .._decimal_commas import has_decimal_commas
from ._profile import Profile

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"
# Kinds by the ends of file names; .ban is Danish for a track.
_KINDS = {".prr": "rail", ".prw": "wheel", ".ban": "rail", ".whl": "wheel"}
_UPSIDE_DOWN = ".ban", ".whl"


def read(
    path: str | os.PathLike[str],
    kind: str | None = None,
    *,
    columns: tuple[int, int] = (0, 1),
    mirror: bool = False,
    upside_down: bool | None = None,
    scale: float = 1.0,
) -> Profile:
    """Reads a profile from a file.

    Parameters
    ----------
    path : str or path
        `.prr` and `.prw` are read as SIMPACK's rails and wheels; `.ban` and `.whl` as MiniProf's, which are columns of numbers below lines
        `NAME=value`; all other files as columns of numbers. Lines that do not begin with a number are skipped; others among the points must be points.
    kind : {"wheel", "rail"}, optional
        What it is; by default what the end of the file's name says.
    columns : (int, int)
        The columns of y and z.
    mirror : bool
        Whether y grows towards the middle of the track in the file.
    upside_down : bool, optional
        Whether z grows upwards in the file; by default of `.ban` and `.whl` only.
    scale : float
        Millimetres in the unit of the file. The header of `.prr` and `.prw` has its own unit, which is obeyed.

    Returns
    -------
    Profile
        In mm, in its own coordinates: `Track` and `Wheelset` put it in its place.

    Raises
    ------
    ValueError
        If the file has no profile, a column has no coordinates, or the profile is mirrored or upside down; the message names the argument to change.
    """
    end = Path(path).suffix.lower()
    kind = _KINDS.get(end) if kind is None else kind
    if kind is None:
        raise ValueError(f'{path}: kind is not known; give kind="wheel" or kind="rail"')
    text = _text(path)
    points, in_mm, hint = _simpack(text, path) if end in (".prr", ".prw") else _table(text, columns, path)
    y, z = points.T * (in_mm * number("scale", scale))
    if mirror:
        y = -y
    if (end in _UPSIDE_DOWN) if upside_down is None else upside_down:
        z = -z
    if y[0] > y[-1]:
        y, z = y[::-1], z[::-1]
    try:
        return Profile(np.ascontiguousarray(y), np.ascontiguousarray(z), kind, Path(path).name)
    except ValueError as error:
        raise ValueError(f"{error}{hint}") from None


def _text(path: str | os.PathLike[str]) -> str:
    """The text of a file, in the encoding that its first bytes name; else any byte is a character."""
    data = Path(path).read_bytes()
    marks = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
    named = [encoding for mark, encoding in marks.items() if data.startswith(mark)]
    return data.decode(named[0] if named else "latin-1", errors="replace")


def _words(line: str, commas: bool) -> list[str]:
    """The columns of a line, parted by blanks, semicolons and, where they are no decimal points, commas."""
    return (line.replace(",", ".") if commas else line.replace(",", " ")).replace(";", " ").split()


def _table(text: str, columns: tuple[int, int], path: str | os.PathLike[str]) -> tuple[np.ndarray, float, str]:
    """The points of a file of columns, mm, and a hint for a profile that is refused. A column without coordinates is refused as y: it might pass as one."""
    points, width = _columns(text, columns, path)
    y, first, name = points[:, 0], columns[0], Path(path).name
    others = f"; y and z are other columns: columns=({first + 1}, {first + 2})?" if width > first + 2 else ""
    if width > 2 and y[0] in (0.0, 1.0) and (np.diff(y) == 1.0).all():
        raise ValueError(f"column {first} of {name} only counts its lines ({y[0]:.0f} {y[1]:.0f} {y[2]:.0f} ...){others} "
                         "If it is y, make Profile(y, z, kind)")
    if (y == y[0]).all():
        raise ValueError(f"column {first} of {name} is {y[0]:g} in every line{others}")
    hint = f"; or give columns=(y, z): the file has {width}" if width > 2 and not name.lower().endswith(_UPSIDE_DOWN) else ""
    return points, 1.0, hint


def _columns(text: str, columns: tuple[int, int], path: str | os.PathLike[str]) -> tuple[np.ndarray, int]:
    """Two columns of the lines that begin with numbers, and how many columns all of them have."""
    lines = [line for line in text.splitlines() if re.match(r"\s*[-+]?[.,]?\d", line)]
    rows: list[list[float]] = []
    commas, width, other = has_decimal_commas(lines), 0, ""
    for line in lines:
        words = _words(line, commas)
        if len(words) <= max(columns) or not all(re.fullmatch(_NUMBER, words[column]) for column in (0, *columns)):
            # Titles, counts and dates stand before all points, or behind them.
            other = line.strip() if rows and not other else other
            continue
        if other:
            raise ValueError(f"{path} has a line {other[:60]!r} among its points that begins with a number and has none in the columns {columns}: "
                             "do columns run into each other? Mend it, or put # before it")
        rows.append([float(re.sub("[dD]", "e", words[column])) for column in columns])
        width = min(width or len(words), len(words))
    if len(rows) < 4:
        raise ValueError(f"{path} has {len(rows)} points in the columns {columns}; at least 4 are needed")
    return np.array(rows), width


def _simpack(text: str, path: str | os.PathLike[str]) -> tuple[np.ndarray, float, str]:
    """The points of a .prr or .prw file, moved, rotated, mirrored and reversed as its header says, the mm in its unit, and no hint."""
    text = "\n".join(line.split("!")[0] for line in text.splitlines())
    found = re.search(r"point\.begin(.*?)point\.end", text, re.DOTALL)
    if not found:
        raise ValueError(f"{path} has no points between point.begin and point.end")
    points, _ = _columns(found.group(1), (0, 1), path)
    said = dict(re.findall(rf"^\s*([\w.]+)\s*=\s*({_NUMBER})\s*$", text[: found.start()], re.MULTILINE))

    def value(name: str, default: float) -> float:
        return float(re.sub("[dD]", "e", said.get(name, str(default))))

    y, z = points[:, 0] + value("shift.y", 0.0), points[:, 1] + value("shift.z", 0.0)
    angle = value("rotate", 0.0) / value("units.ang.f", 1.0)
    y, z = np.cos(angle) * y - np.sin(angle) * z, np.sin(angle) * y + np.cos(angle) * z
    inside = np.ones(len(y), dtype=bool)
    # Bounds count where the lower one is below the upper one.
    for values, axis in ((y, "y"), (z, "z")):
        low, high = value(f"bound.{axis}.min", 1.0), value(f"bound.{axis}.max", 0.0)
        if low < high:
            inside &= (values >= low) & (values <= high)
    y, z = y[inside], z[inside]
    if value("mirror.y", 0.0):
        y = -y
    if value("mirror.z", 0.0):
        z = -z
    if value("inversion", 0.0):
        y, z = y[::-1], z[::-1]
    return np.column_stack([y, z]), 1000.0 / value("units.len.f", 1000.0), ""
