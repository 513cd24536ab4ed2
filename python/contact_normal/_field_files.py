"""Writes the fields of a result, or a picture, into a file in the format that its ending names."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._axes import matplotlib
from ._netcdf import xarray

if TYPE_CHECKING:
    from ._result import Result

PICTURES = (".png", ".svg", ".pdf")
FIELDS = (".nc", ".npz", ".vtk", ".vtu")
_NAMES = ("pressure", "deformed_distance", "displacement", "contact")


def write_fields(path: str | Path, result: Result) -> None:
    """Writes the fields of a result as NetCDF (.nc), as an archive of numpy (.npz), or for ParaView (.vtk, .vtu).

    Raises
    ------
    ValueError
        If the ending is none of these.
    ImportError
        If the format needs a package that is not installed; the message names it.
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


def refuse_unless_writable(path: str | Path, surface: str | Path | None = None) -> None:
    """Raises an error if an output file cannot be written. It is called before a long solve.

    Parameters
    ----------
    path : str or path
        The output file.
    surface : str or path, optional
        The file of the surface, which the output must not overwrite.

    Raises
    ------
    OSError
        If the folder of the output does not exist or is not writable.
    ImportError
        If the format of the output needs a package that is not installed; the message names it.
    ValueError
        If the output is the file of the surface.
    """
    path = Path(path)
    if surface is not None and path.exists() and Path(surface).exists() and path.samefile(surface):
        raise ValueError(f"{path} is the file of the surface, which would be lost: name another output")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path}: there is no folder {path.parent}")
    if path.is_dir():
        raise IsADirectoryError(f"{path} is a folder; it must be a file")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise PermissionError(f"{path} may not be written")
    if path.suffix == ".nc":
        xarray()
    elif path.suffix in (".vtk", ".vtu"):
        _meshio(path)
    elif path.suffix in PICTURES:
        matplotlib()


def _meshio(path: Path) -> Any:
    try:
        return importlib.import_module("meshio")
    except ImportError as error:
        raise ImportError(f"{path}: {path.suffix} is written by meshio, which is not installed: pip install 'contact-normal[vtk]'") from error


def _write_mesh(path: Path, result: Result) -> None:
    """Writes one quadrilateral for each element, with its values."""
    meshio = _meshio(path)
    my, mx = result.pressure.shape
    x, y = (np.append(centres - 0.5 * d, centres[-1] + 0.5 * d) for centres, d in ((result.x, result.dx), (result.y, result.dy)))
    corners = np.stack([np.tile(x, my + 1), np.repeat(y, mx + 1), np.zeros((my + 1) * (mx + 1))], axis=1)
    first = (np.arange(my)[:, None] * (mx + 1) + np.arange(mx)[None, :]).ravel()
    quadrilaterals = np.stack([first, first + 1, first + mx + 2, first + mx + 1], axis=1)
    fields = {name: [np.ascontiguousarray(getattr(result, name), dtype=float).ravel()] for name in _NAMES}
    meshio.Mesh(corners, [("quad", quadrilaterals)], cell_data=fields).write(path)


def save(path: str | Path, plot: Callable[[], Any]) -> None:
    """Saves the picture that `plot()` draws, in the style of this package."""
    from ._style import matplotlib_style

    with matplotlib_style():
        plot().figure.savefig(path)
