"""Reads heights from files: those of numpy, texts, NetCDF by xarray, and files of instruments by SurfaceTopography."""

from __future__ import annotations

import errno
import os
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from .._texts import is_text
from .._units import same_length
from ._given import SIZES, steps_of, with_header, with_unit
from ._headers import header_of, refuse_esri_grid
from ._heights import Heights, heights
from ._instruments import NO_SIZE, TEXTS, chosen, of_instrument, size_of
from ._lists import of_list, of_text_list
from ._not_a_map import doubt
from ._not_a_map import why as why_no_map
from ._texts import has_empty_cells, of_text


def from_xarray(array: Any, **given: Any) -> Heights:
    """Makes `Heights` from an `xarray.DataArray` with two dimensions, in any order, that have coordinates.

    The dimension of x is the one whose name begins with "x"; otherwise it is the second one, or with axes="xy" the first one. The unit of length is that of the
    attribute "units", if x, y and the heights have it; different units are refused. If dx, size, span, or x and y are given, the coordinates are not read. In
    files of SurfaceTopography the attribute "unit" is the unit of length, and "periodic" of a coordinate says that the surface is periodic in its direction.
    """
    if hasattr(array, "data_vars") or not hasattr(array, "dims"):
        choose = f": choose one of {', '.join(map(str, array.data_vars))}" if hasattr(array, "data_vars") else ""
        raise TypeError(f"array is a {type(array).__name__}; it must be a DataArray{choose}")
    if len(array.dims) != 2:
        kept = [name for name in array.dims if array.sizes[name] > 1]
        if len(kept) != 2:
            raise ValueError(f"the array has the dimensions {tuple(array.dims)}; heights have two: choose one map by isel")
        array = array.squeeze([name for name in array.dims if name not in kept], drop=True)
    y, x = array.dims
    first, last = (str(name).lower().startswith("x") for name in (y, x))
    axes, given = given.get("axes"), {name: one for name, one in given.items() if name != "axes"}
    if axes not in (None, "yx", "xy"):
        raise ValueError(f'axes is {axes!r}; it must be "yx" or "xy"')
    if axes and first != last and (axes == "xy") != first:
        raise ValueError(f"axes is {axes!r}, but the array has the dimensions {tuple(array.dims)}: leave axes out")
    if first and not last or axes == "xy":
        x, y = y, x
    ordered = array.transpose(y, x)
    of_axes = [array[name].attrs if name in array.coords else {} for name in (x, y)]
    if period := "".join(axis for axis, one in zip("xy", of_axes) if one.get("periodic")):
        given = {"period": period, **given}
    if SIZES & set(given):
        return heights(ordered.values, **with_unit(_unit(array.attrs), given))
    for name in (x, y):
        if name not in array.coords:
            raise ValueError(f"the dimension {name} has no coordinates: give dx and dy")
    said = [_unit(one) for one in (array.attrs, *of_axes)]
    for name, unit in ((x, said[1]), (y, said[2])):
        if said[0] and unit and not same_length(str(said[0]), str(unit)):
            raise ValueError(f"the heights are in {said[0]}, and {name} in {unit}: convert one of them")
    if said[1] and said[2] and not same_length(str(said[1]), str(said[2])):
        raise ValueError(f"{x} is in {said[1]}, and {y} in {said[2]}: convert one of them")
    if any(said) and not all(said):
        names = ", ".join(f"{name} in {unit}" if unit else f"{name} in no unit" for name, unit in zip(("heights", x, y), said))
        warnings.warn(f"the file has {names}: all of them are taken to be in one unit", stacklevel=2)
    unit = said[0] if all(said) else None
    return heights(ordered.values, x=ordered[x].values, y=ordered[y].values, **with_unit(unit, given))


def _unit(attributes: Any) -> Any:
    """The unit among the attributes of an array: "units" by the conventions of NetCDF, or "unit" by SurfaceTopography."""
    return attributes.get("units") or attributes.get("unit")


def from_topography(topography: Any, **given: Any) -> Heights:
    """Makes `Heights` from a uniform topography of the package SurfaceTopography.

    The first index of its arrays is x. With axes="yx" the first index, and the first of its lengths, are taken for y.
    """
    if not hasattr(topography, "heights"):
        raise TypeError(f"topography is a {type(topography).__name__}; it must be a topography of SurfaceTopography")
    if getattr(topography, "dim", 2) != 2 or not getattr(topography, "is_uniform", True):
        raise ValueError("the topography is a line scan or not uniform; it must be a map")
    unit = getattr(topography, "unit", None)
    said: dict[str, Any] = {"axes": "xy"}
    if topography.is_periodic:
        said["period"] = "xy"
    if not SIZES & set(given):
        if (sizes := size_of(topography)) is None:
            raise TypeError(f"the topography {NO_SIZE}")
        said["size"] = sizes[::-1] if given.get("axes") == "yx" else sizes
    return heights(topography.heights(), **{**said, **with_unit(unit, given)})


def read(path: str | os.PathLike[str], variable: str | None = None, **given: Any) -> Heights:
    """Reads heights from a file.

    Parameters
    ----------
    path : str or path
        The file. Heights and coordinates must be in one unit of length. The format is that of the ending:

        - `.npy`, `.npz`: arrays of numpy.
        - `.txt`, `.dat`, `.csv`: numbers, each line a row of the grid. A header as Gwyddion writes it says the size of the field and the unit.
        - The same, and `.xyz`, `.asc`, `.tsv`: x, y and z of the places of a grid, one point per line, in any order. A line `# x [mm] y [mm] z [mm]` names the
          columns.
        - `.nc`: NetCDF, by the package xarray.
        - All others, as `.x3p`, `.sur`, `.opd`, `.gwy` and `.mat`: by the package SurfaceTopography. The first index of a matrix of `.mat` is that of y.
    variable : str, optional
        The name of the array, if the file has several.
    **given
        Arguments of `heights` that are missing in the file, or wrong there. `units` must name the unit of length of the file.

    Raises
    ------
    ImportError
        If the package is missing; the message names it and how to install it.
    """
    end = Path(path).suffix.lower()
    if Path(path).is_dir():
        raise IsADirectoryError(f"{path} is a folder; it must be a file")
    if end in (".npy", ".npz"):
        values = _of_numpy(path, variable)
        # Arrays with other dtypes or dimensions go to `heights`, which has the error messages for them.
        is_plain = values.ndim == 2 and values.dtype.kind in "iuf"
        return _of_numbers(path, values, given) if is_plain else heights(values, **given)
    if end in (".asc", ".txt", ".dat") and Path(path).exists():
        refuse_esri_grid(path)
    # Some instruments write binary files with the endings of texts, so the contents decide.
    of_numbers = end in (".txt", ".dat", ".csv") and is_text(path)
    of_others = end in TEXTS and Path(path).exists() and is_text(path)
    # SurfaceTopography would shift the columns after an empty cell.
    if of_numbers or of_others and has_empty_cells(path):
        _refuse_variable(path, variable)
        told = header_of(path, bool(SIZES & set(given)))
        if given.get("axes") == "xy" and told.get("size"):
            # The width in the header is that along a line of the file, which is y here.
            told = {**told, "size": told["size"][::-1]}
        made = _of_numbers(path, of_text(path, end), with_header(told, given))
        _warn_of_size(path, told, made)
        return made
    if end == ".nc":
        return _of_netcdf(path, variable, given)
    if of_others and (found := of_text_list(path, given)) is not None:
        _refuse_variable(path, variable)
        return found
    topography = of_instrument(path, end, variable, bool(SIZES & set(given)))
    if end == ".mat":
        given = {"axes": "yx", **given}
    if end in TEXTS and getattr(topography, "dim", 2) == 2:
        # Arrays of SurfaceTopography have x as the first index, so the transposed array has the lines of the file.
        values = np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan)
        steps = steps_of(values.T.shape, given)
        if reason := why_no_map(values.T, steps) or why_no_map(values, steps[::-1]):
            raise ValueError(f"{path} {reason}")
        if reason := doubt(values.T):
            warnings.warn(f"{path} {reason}", stacklevel=2)
        # The caller's `axes` describe the lines of the file, which are transposed here.
        if "axes" in given:
            given = {**given, "axes": {"yx": "xy", "xy": "yx"}.get(given["axes"], given["axes"])}
    return from_topography(topography, **given)


def _of_netcdf(path: str | os.PathLike[str], variable: str | None, given: dict[str, Any]) -> Heights:
    """Reads heights from a NetCDF file."""
    from .._netcdf import read as netcdf

    dataset = netcdf(path)
    # Only variables with two dimensions can be heights. Others describe, for example, a map projection.
    maps = [name for name, array in dataset.data_vars.items() if array.ndim == 2 or sum(size > 1 for size in array.shape) == 2]
    # The variable "mask" of a file of SurfaceTopography marks the holes of the heights. The heights are NaN there anyway.
    maps = [name for name in maps if not (name == "mask" and "maskandscale" in dataset[name].attrs)]
    names = maps if maps and variable is None else list(dataset.data_vars)
    return from_xarray(dataset[chosen(variable, names, path)], **given)


def _warn_of_size(path: str | os.PathLike[str], told: dict[str, Any], made: Heights) -> None:
    """Warns if the size of the heights differs from that of the header by more than one element in n and one per cent."""
    if not told.get("size"):
        return
    for name, n, d, length in zip("xy", made.z.shape[::-1], (made.dx, made.dy), told["size"]):
        if abs(n * d - length) > (0.01 + 1.0 / n) * length:
            warnings.warn(f"{path} says that the field is {length:.6g} {told['unit']} long in {name}, and {n * d:.6g} is given: lengths are in {told['unit']}, as the heights",
                          stacklevel=3)
            return


def _of_numbers(path: str | os.PathLike[str], values: Any, given: dict[str, Any]) -> Heights:
    """The heights of an array of numbers, which may be a map or a list of points. Numbers that are neither are refused."""
    if (found := of_list(path, values, given)) is not None:
        return found
    if reason := why_no_map(values, steps_of(values.shape, given)):
        raise ValueError(f"{path} {reason}")
    if reason := doubt(values):
        warnings.warn(f"{path} {reason}", stacklevel=3)
    return heights(values, **given)


def _refuse_variable(path: str | os.PathLike[str], variable: str | None) -> None:
    """Raises an error if the caller names an array, although the file has only one."""
    if variable is not None:
        raise ValueError(f"{path} holds one array; give variable for files of several")


def _of_numpy(path: str | os.PathLike[str], variable: str | None) -> Any:
    """Reads an array from a file of numpy."""
    try:
        with open(path, "rb") as file:
            found = np.load(file)
            is_archive = not isinstance(found, np.ndarray)
            if is_archive:
                found = found[chosen(variable, list(found), path)]
            _refuse_variable(path, None if is_archive else variable)
        if not isinstance(found, np.ndarray):
            raise ValueError("it holds bytes")
        return found
    except Exception as error:  # A damaged file raises errors of zlib, zipfile, tokenize and other modules.
        is_of_system = isinstance(error, OSError) and error.errno not in (None, errno.EINVAL)
        if is_of_system or isinstance(error, MemoryError) or "give variable" in str(error):
            raise
        raise ValueError(f"{path} is no file of numbers that numpy.save or numpy.savez wrote, or it is damaged") from error
