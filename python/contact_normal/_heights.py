"""Reads a grid of heights, or of undeformed distances, from a file."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ._arguments import Doubles


class Heights(NamedTuple):
    """What a file holds: one number for each element, NaN where there is no surface, and what it says of the grid."""

    values: Doubles
    dx: float | None = None
    dy: float | None = None
    unit: str | None = None


def read_heights(path: str | Path, variable: str | None = None) -> Heights:
    """Reads .npy, .npz, text, NetCDF, and by SurfaceTopography the files of instruments (.x3p, .sur, .opd, ...).

    Parameters
    ----------
    path : path
        The file; its ending says the format.
    variable : str, optional
        Which array of an .npz or NetCDF file; needed where it has more than one of two dimensions.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it holds no grid of numbers.
    ImportError
        If its format needs a package that is not installed; the text names it.
    """
    path = Path(path)
    readers: dict[str, Callable[[Path, str | None], Heights]] = {
        ".npy": _npy, ".npz": _npz, ".nc": _netcdf, **dict.fromkeys((".txt", ".dat", ".csv", ".asc"), _text),
    }
    path.stat()
    found = readers.get(path.suffix.lower(), _instrument)(path, variable)
    values = _plain(found.values)
    if values.ndim != 2 or not values.size:
        raise ValueError(f"{path} holds an array of shape {values.shape}; it must be (my, mx)")
    return found._replace(values=values)


def _plain(values: Any) -> Doubles:
    """Doubles, NaN where they are masked."""
    plain: Doubles = np.ma.asarray(values, dtype=float).filled(np.nan)
    return plain


def _npy(path: Path, variable: str | None) -> Heights:
    return Heights(np.load(path, allow_pickle=False))


def _npz(path: Path, variable: str | None) -> Heights:
    with np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    chosen = _chosen(path, arrays, variable)
    dx, dy = (float(arrays[name]) if name in arrays and arrays[name].ndim == 0 else None for name in ("dx", "dy"))
    return Heights(arrays[chosen], dx, dy)


def _text(path: Path, variable: str | None) -> Heights:
    """Rows of numbers with blanks, tabs, commas or semicolons between them; lines that begin with # are left out."""
    with open(path, encoding="utf-8") as file:
        lines = [re.sub(r"[,;]", " ", line) for line in file]
    return Heights(np.loadtxt(lines, ndmin=2))


def _netcdf(path: Path, variable: str | None) -> Heights:
    from ._netcdf import read

    dataset = read(path)
    chosen = dataset[_chosen(path, dataset.data_vars, variable)]
    dx, dy = (_spacing(path, chosen, chosen.dims[axis]) for axis in (1, 0))
    return Heights(chosen.values, dx, dy, chosen.attrs.get("units"))


def _spacing(path: Path, array: Any, dimension: str) -> float | None:
    """The distance of neighbours along a dimension, None where the file does not have it."""
    if dimension not in array.coords or array.sizes[dimension] < 2:
        return None
    places = array.coords[dimension].values.astype(float)
    mean = float(places[-1] - places[0]) / (len(places) - 1)
    # Coordinates in single precision are good to 1e-7 of the largest, which is within the thousandth for 10^4 elements.
    if not np.allclose(np.diff(places), mean, rtol=1e-3, atol=0.0):
        raise ValueError(f"{path}: {dimension} is not evenly spaced; the library needs a grid of equal elements")
    return abs(mean)


def _instrument(path: Path, variable: str | None) -> Heights:
    try:
        topography = importlib.import_module("SurfaceTopography")
    except ImportError as error:
        raise ImportError(f"{path}: files {path.suffix or 'without an ending'} are read by SurfaceTopography, which is not installed: "
                          "pip install 'contact-normal[surface]'") from error
    try:
        found = topography.read_topography(str(path))
        # Its arrays have x first.
        values = _plain(found.heights()).T
    except Exception as error:
        raise ValueError(f"{path}: SurfaceTopography does not read it: {error}") from error
    dx, dy = found.pixel_size
    return Heights(values, float(dx), float(dy), found.unit)


def _chosen(path: Path, arrays: Mapping[Any, Any], variable: str | None) -> str:
    """The variable that is asked for, or the only one of two dimensions."""
    grids = [str(name) for name in arrays if arrays[name].ndim == 2]
    if variable is None and len(grids) == 1:
        return grids[0]
    if variable not in grids:
        raise ValueError(f"{path} has the grids {', '.join(grids) or '(none)'}; name one of them by --variable")
    return variable
