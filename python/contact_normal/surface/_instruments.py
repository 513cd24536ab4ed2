"""Files of instruments, by the package SurfaceTopography, and the choice among several arrays."""

from __future__ import annotations

import importlib
import io
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .._texts import starts_with_mark, text_of
from ._texts import refuse_skipped_rows

# Texts that SurfaceTopography reads as maps; others may be binary.
_TEXTS = ".asc", ".xyz", ".tsv"

# What is said of files and topographies without sizes; the command line looks for it.
NO_SIZE = "does not say the size of an element: give size, the lengths of the field, or dx and dy"


def size_of(topography: Any) -> tuple[float, ...] | None:
    """The lengths of the field of a topography; None if it does not say them."""
    try:
        sizes = tuple(float(length) for length in topography.physical_sizes)
    except TypeError:  # They are None, or products with None.
        return None
    return sizes if all(0.0 < length < float("inf") for length in sizes) else None


def of_instrument(path: str | os.PathLike[str], end: str, variable: str | None, is_sized: bool) -> Any:
    """The topography of an instrument's file; `is_sized`: the caller gives its size."""
    try:
        open_topography = importlib.import_module("SurfaceTopography").open_topography
    except ImportError as error:
        raise ImportError(f"{error}; files {end or 'without an end'} need SurfaceTopography: pip install 'contact-normal[surface]'") from error
    is_marked = end in _TEXTS and Path(path).is_file() and starts_with_mark(path)
    with _tried(lambda: open_topography(io.StringIO(text_of(path), newline=None) if is_marked else os.fspath(path)), path) as reader:
        if reader.format() == "asc":
            refuse_skipped_rows(path)
        which = _channel(reader, variable, end, path)
        try:
            found = reader.topography(channel_index=which)
            if is_sized or getattr(found, "dim", 2) != 2 or size_of(found) is not None:
                return found
        except Exception as error:  # of that package: it has its own for each format
            if "physical_sizes" not in str(error):
                return _tried(lambda: reader.topography(channel_index=which), path)
            if not is_sized:
                raise TypeError(f"{path} {NO_SIZE}") from error
        else:
            raise TypeError(f"{path} {NO_SIZE}")
        # What the caller gives takes the place of these sizes.
        return _tried(lambda: reader.topography(channel_index=which, physical_sizes=(1.0, 1.0)), path)


def _tried(call: Callable[[], Any], path: str | os.PathLike[str]) -> Any:
    """The result of a call of this package. Its errors, which have many lines, become one."""
    try:
        return call()
    except OSError:
        raise
    except Exception as error:
        first = next(iter(str(error).splitlines()), "")
        raise ValueError(f"{path} is no file of heights that SurfaceTopography reads: {type(error).__name__}, {first}") from error


def _channel(reader: Any, variable: str | None, end: str, path: str | os.PathLike[str]) -> int | None:
    """The index of the wanted array; None: the reader's own choice. Arrays of MATLAB may be coordinates, so that one of several must be named."""
    channels = _tried(lambda: reader.channels, path)
    maps = {str(channel.name): k for k, channel in enumerate(channels) if channel.dim == 2 and min(channel.nb_grid_pts or (2,)) > 1}
    if variable is not None or (end == ".mat" and maps):
        return maps[chosen(variable, list(maps), path)]
    if len(maps) > 1:
        warnings.warn(f"{path} has {', '.join(maps)}; {reader.default_channel.name} is read: variable= names another one", stacklevel=4)
    return None


def chosen(name: str | None, names: list[Any], path: str | os.PathLike[str]) -> Any:
    """The name of an array, which must be given if there are several."""
    if name is None and len(names) == 1:
        return names[0]
    if not names:
        raise ValueError(f"{path} has no arrays")
    if name not in names:
        raise ValueError(f"{path} has {', '.join(map(str, names))}; give variable, one of them")
    return name
