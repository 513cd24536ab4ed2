"""Datasets of xarray, and NetCDF files. Both packages are imported only here: `pip install 'contact-normal[tables]'`."""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from typing import Any

from ._library import VERSION


def xarray(in_files: bool = True) -> Any:
    """The module xarray. `in_files`: netCDF4 must be there too, by which xarray writes files."""
    try:
        if in_files:
            importlib.import_module("netCDF4")
        return importlib.import_module("xarray")
    except ImportError as error:
        needed = "xarray and netCDF4" if in_files else "xarray"
        raise ImportError(f"{error}; this needs {needed}: pip install 'contact-normal[tables]'") from error


def write(path: str | os.PathLike[str], dataset: Any) -> None:
    """Writes NetCDF, whole or not at all."""
    xarray()
    # Links stay. Devices and pipes are refused: os.replace would replace them.
    target = Path(path).resolve()
    if target.exists() and not target.is_file():
        raise FileExistsError(f"{target} is no file")
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{target}: there is no folder {target.parent}")
    unfinished = target.with_name(target.name + ".unfinished")
    coding = {name: {"zlib": True, "complevel": 4} for name in dataset.data_vars if dataset[name].ndim}
    dataset.assign_attrs(made_by=f"contact-normal {VERSION}").to_netcdf(unfinished, engine="netcdf4", encoding=coding)
    os.replace(unfinished, target)


def read(path: str | os.PathLike[str]) -> Any:
    """The dataset of a file, in memory."""
    with xarray().open_dataset(path, engine="netcdf4") as dataset:
        return dataset.load()
