"""Heights from files: numpy's own and text; instruments' by SurfaceTopography; NetCDF by xarray."""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from typing import Any

import numpy as np

from ._heights import Heights, heights


def from_xarray(array: Any, **given: Any) -> Heights:
    """Heights of an `xarray.DataArray` with two dimensions that have coordinates, in any order.

    The dimension of x is the one whose name begins with "x", or else the second one. Units of lengths are those of the attribute "units", if x, y and
    the heights agree on them.
    """
    if len(array.dims) != 2:
        raise ValueError(f"the array has the dimensions {tuple(array.dims)}; heights have two")
    y, x = array.dims
    if str(y).lower().startswith("x") and not str(x).lower().startswith("x"):
        x, y = y, x
    ordered = array.transpose(y, x)
    for name in (x, y):
        if name not in array.coords:
            raise ValueError(f"the dimension {name} has no coordinates: give dx and dy to heights(array.values, ...)")
    said = {one.attrs.get("units") for one in (array, array[x], array[y])}
    if len(said) == 1 and None not in said and "units" not in given:
        given["units"] = (str(said.pop()), "N")
    return heights(ordered.values, x=ordered[x].values, y=ordered[y].values, **given)


def from_topography(topography: Any, **given: Any) -> Heights:
    """Heights of a uniform topography of the package SurfaceTopography, whose arrays have x as the first index."""
    if getattr(topography, "dim", 2) != 2 or not getattr(topography, "is_uniform", True):
        raise ValueError("the topography is a line scan or not uniform; it must be a map")
    unit = getattr(topography, "unit", None)
    said: dict[str, Any] = {"size": tuple(float(length) for length in topography.physical_sizes), "axes": "xy"}
    if topography.is_periodic:
        said["period"] = "xy"
    if unit:
        said["units"] = (str(unit), "N")
    return heights(topography.heights(), **{**said, **given})


def read(path: str | os.PathLike[str], variable: str | None = None, **given: Any) -> Heights:
    """Reads heights from a file.

    Parameters
    ----------
    path : str or path
        `.npy`; `.npz`; `.txt`, `.dat` and `.csv` as columns of numbers; `.nc` as NetCDF, by the package xarray; all others, as `.x3p`, `.sur`, `.opd` and
        `.gwy`, by the package SurfaceTopography. Heights and coordinates must be in one unit of length.
    variable : str, optional
        Which array of a file that has several.
    **given
        What the file does not tell, or tells wrong: see `heights`.

    Raises
    ------
    ImportError
        If the package is missing; the message names it and how to install it.
    """
    end = Path(path).suffix.lower()
    if end == ".npy":
        return heights(np.load(path), **given)
    if end == ".npz":
        with np.load(path) as file:
            return heights(file[_chosen(variable, list(file), path)], **given)
    if end in (".txt", ".dat", ".csv"):
        return heights(np.loadtxt(path, delimiter="," if end == ".csv" else None, ndmin=2), **given)
    if end == ".nc":
        from .._netcdf import read as netcdf

        dataset = netcdf(path)
        return from_xarray(dataset[_chosen(variable, list(dataset.data_vars), path)], **given)
    try:
        read_topography = importlib.import_module("SurfaceTopography").read_topography
    except ImportError as error:
        raise ImportError(f"{error}; files {end or 'without an end'} need SurfaceTopography: pip install 'contact-normal[surface]'") from error
    return from_topography(read_topography(os.fspath(path)), **given)


def _chosen(name: str | None, names: list[Any], path: str | os.PathLike[str]) -> Any:
    if name is None and len(names) == 1:
        return names[0]
    if name not in names:
        raise ValueError(f"{path} has {', '.join(map(str, names))}; give variable, one of them")
    return name
