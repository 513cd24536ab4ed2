"""Reads profiles from files: .prr and .prw of SIMPACK, .ban and .whl of MiniProf, plain columns.

Each reader follows the public description of its format, and comments in such files.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np

from .._arguments import integer, number
from .._texts import text_of
from ._columns import columns_of
from ._profile import Profile
from ._simpack import points_of

# The kind of profile for each ending of file names. (Bane is Danish for a track.)
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
        The file. The format is that of its ending:

        - `.prr`, `.prw`: rails and wheels of SIMPACK.
        - `.ban`, `.whl`: rails and wheels of MiniProf, columns of numbers below lines `NAME=value`, of which `ColumnDef=` names the columns X and Y.
        - All others: columns of numbers. Lines that do not begin with a number are skipped. Among the points every line that begins with a number must be a
          point.
    kind : {"wheel", "rail"}, optional
        Whether the profile is that of a wheel or of a rail; by default the ending of the file name decides.
    columns : (int, int)
        The columns of y and z, counted from 0.
    mirror : bool
        Whether y grows towards the middle of the track in the file.
    upside_down : bool, optional
        Whether z grows upwards in the file; by default for `.ban` and `.whl` only.
    scale : float
        Millimetres per unit of the file. For `.prr` and `.prw` the unit of their header is used in addition.

    Returns
    -------
    Profile
        The profile in mm, in the coordinates of the file. `Track` and `Wheelset` put it in its place.

    Raises
    ------
    ValueError
        If the file has no profile, a column has no coordinates, or the profile is mirrored or upside down; the message names the argument to change.
    """
    end = Path(path).suffix.lower()
    kind = _KINDS.get(end) if kind is None else kind
    if kind is None:
        raise ValueError(f'{path}: kind is not known; give kind="wheel" or kind="rail"')
    if not 0.0 < number("scale", scale) < float("inf"):
        raise ValueError(f"scale is {scale}; it must be positive, the millimetres in the unit of the file")
    text, hint = text_of(path), ""
    if end in (".prr", ".prw"):
        points, in_mm = points_of(text, kind, path)
        scale = scale * in_mm
    else:
        chosen = _checked(columns)
        if end in _UPSIDE_DOWN and chosen == (0, 1):
            chosen = _defined(text, chosen)
        points, hint = _table(text, chosen, path)
    y, z = points.T * scale
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


def _checked(columns: Any) -> tuple[int, int]:
    """Checks the argument `columns` of `read`, and returns it as two integers."""
    if isinstance(columns, str) or np.ndim(columns) != 1 or len(columns) != 2:
        raise TypeError(f"columns is {columns!r}; it must be two numbers, those of y and z, counted from 0")
    first, second = (integer(f"columns[{k}]", column) for k, column in enumerate(columns))
    if first == second or min(first, second) < 0:
        raise ValueError(f"columns is {columns!r}; it must be two different numbers, those of y and z, counted from 0")
    return first, second


def _defined(text: str, else_: tuple[int, int]) -> tuple[int, int]:
    """The columns X and Y that the header of a MiniProf file names, `ColumnDef=X,Y,...`; otherwise `else_`."""
    said = re.search(r"^\s*ColumnDef\s*=\s*(.*?)\s*$", text, re.MULTILINE | re.IGNORECASE)
    names = [name.strip(' "*').upper() for name in said[1].split(",")] if said else []
    return (names.index("X"), names.index("Y")) if {"X", "Y"} <= set(names) else else_


def _table(text: str, columns: tuple[int, int], path: str | os.PathLike[str]) -> tuple[np.ndarray, str]:
    """Reads the points of a file of columns. Returns them, and a hint for the message if the profile is refused.

    A column of y that only counts its lines, or is constant, is refused, because the profile might pass the other checks.
    """
    points, width = columns_of(text, columns, path)
    y, first, name = points[:, 0], columns[0], Path(path).name
    others = f"; y and z are other columns: columns=({first + 1}, {first + 2})?" if width > first + 2 else ""
    if width > 2 and y[0] in (0.0, 1.0) and (np.diff(y) == 1.0).all():
        raise ValueError(f"column {first} of {name} only counts its lines ({y[0]:.0f} {y[1]:.0f} {y[2]:.0f} ...){others} "
                         "If it is y, make Profile(y, z, kind)")
    if (y == y[0]).all():
        raise ValueError(f"column {first} of {name} is {y[0]:g} in every line{others}")
    hint = f"; or give columns=(y, z): the file has {width}" if width > 2 and not name.lower().endswith(_UPSIDE_DOWN) else ""
    return points, hint
