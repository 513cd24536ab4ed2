"""Reads and writes NetCDF files by xarray and netCDF4, which are imported only here: `pip install 'contact-normal[tables]'`."""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from typing import Any

from ._library import VERSION


def xarray(in_files: bool = True) -> Any:
    """Imports and returns xarray. With `in_files` it also requires netCDF4, by which xarray reads and writes files."""
    try:
        if in_files:
            importlib.import_module("netCDF4")
        return importlib.import_module("xarray")
    except ImportError as error:
        needed = "xarray and netCDF4" if in_files else "xarray"
        raise ImportError(f"{error}; this needs {needed}: pip install 'contact-normal[tables]'") from error


def write(path: str | os.PathLike[str], dataset: Any) -> None:
    """Writes a dataset as a NetCDF file, whole or not at all."""
    xarray()
    # A symbolic link is resolved, so that the link stays. Devices and pipes are refused, because os.replace would replace them by a file.
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
    """Reads the whole dataset of a file into memory."""
    with xarray().open_dataset(path, engine="netcdf4") as dataset:
        return dataset.load()
