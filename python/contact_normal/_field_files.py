"""Writes a result into a file, whose ending says the format."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._result import Result

PICTURES = (".png", ".svg", ".pdf")
FIELDS = (".nc", ".npz", ".vtk", ".vtu")
_NAMES = ("pressure", "deformed_distance", "displacement", "contact")


def write_fields(path: str | Path, result: Result) -> None:
    """Writes the fields of a result as NetCDF (.nc), .npz, or for ParaView (.vtk, .vtu).

    Raises
    ------
    ValueError
        If the ending is none of these.
    ImportError
        If the format needs a package that is not installed; the text names it.
    """
    path = Path(path)
    if path.suffix == ".nc":
        result.to_netcdf(path)
    elif path.suffix == ".npz":
        arrays = {name: getattr(result, name) for name in _NAMES}
        np.savez_compressed(path, **arrays, x=result.x, y=result.y, dx=result.dx, dy=result.dy)
    elif path.suffix in (".vtk", ".vtu"):
        _write_mesh(path, result)
    else:
        raise ValueError(f"{path}: results are written as {', '.join(FIELDS)}, pictures as {', '.join(PICTURES)}")


def _write_mesh(path: Path, result: Result) -> None:
    """One quadrilateral for each element, with its numbers."""
    try:
        meshio = importlib.import_module("meshio")
    except ImportError as error:
        raise ImportError(f"{path}: {path.suffix} is written by meshio, which is not installed: pip install 'contact-normal[vtk]'") from error
    my, mx = result.pressure.shape
    x, y = (np.append(centres - 0.5 * d, centres[-1] + 0.5 * d) for centres, d in ((result.x, result.dx), (result.y, result.dy)))
    corners = np.stack([np.tile(x, my + 1), np.repeat(y, mx + 1), np.zeros((my + 1) * (mx + 1))], axis=1)
    first = (np.arange(my)[:, None] * (mx + 1) + np.arange(mx)[None, :]).ravel()
    quadrilaterals = np.stack([first, first + 1, first + mx + 2, first + mx + 1], axis=1)
    fields = {name: [np.ascontiguousarray(getattr(result, name), dtype=float).ravel()] for name in _NAMES}
    meshio.Mesh(corners, [("quad", quadrilaterals)], cell_data=fields).write(path)


def save(path: str | Path, plot: Callable[[], Any]) -> None:
    """Saves what `plot` draws, in the style of this package."""
    from ._style import matplotlib_style

    with matplotlib_style():
        plot().figure.savefig(path)
