"""Reads files of instruments by the package SurfaceTopography, and chooses among several arrays of a file."""

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

# Texts that SurfaceTopography reads as maps, whatever they contain. Files of other names may be binary.
TEXTS = ".asc", ".xyz", ".tsv"

# The message on files and topographies without sizes. The command line recognises it by its words "size of an element".
NO_SIZE = "does not say the size of an element: give size, the lengths of the field, or dx and dy"


def size_of(topography: Any) -> tuple[float, ...] | None:
    """The lengths of the field of a topography; None if the topography does not have them."""
    try:
        sizes = tuple(float(length) for length in topography.physical_sizes)
    except TypeError:  # `physical_sizes` is None, or was computed from None.
        return None
    return sizes if all(0.0 < length < float("inf") for length in sizes) else None


def of_instrument(path: str | os.PathLike[str], end: str, variable: str | None, is_sized: bool) -> Any:
    """Reads the topography of an instrument's file. `is_sized`: the caller gives the size, so that the file need not have it."""
    try:
        open_topography = importlib.import_module("SurfaceTopography").open_topography
    except ImportError as error:
        raise ImportError(f"{error}; files {end or 'without an end'} need SurfaceTopography: pip install 'contact-normal[surface]'") from error
    is_marked = end in TEXTS and Path(path).is_file() and starts_with_mark(path)
    with _tried(lambda: open_topography(io.StringIO(text_of(path), newline=None) if is_marked else os.fspath(path)), path) as reader:
        if reader.format() == "asc":
            refuse_skipped_rows(path)
        which = _channel(reader, variable, end, path)
        try:
            found = reader.topography(channel_index=which)
            if is_sized or getattr(found, "dim", 2) != 2 or size_of(found) is not None:
                return found
        except Exception as error:  # SurfaceTopography raises errors of its own for each format.
            if "physical_sizes" not in str(error):
                return _tried(lambda: reader.topography(channel_index=which), path)
            if not is_sized:
                raise TypeError(f"{path} {NO_SIZE}") from error
        else:
            raise TypeError(f"{path} {NO_SIZE}")
        # SurfaceTopography requires sizes. The caller's size replaces these later.
        return _tried(lambda: reader.topography(channel_index=which, physical_sizes=(1.0, 1.0)), path)


def _tried(call: Callable[[], Any], path: str | os.PathLike[str]) -> Any:
    """Makes a call of SurfaceTopography, and returns its result. An error with a message of many lines becomes a ValueError of one line."""
    try:
        return call()
    except OSError:
        raise
    except Exception as error:
        first = next(iter(str(error).splitlines()), "")
        raise ValueError(f"{path} is no file of heights that SurfaceTopography reads: {type(error).__name__}, {first}") from error


def _channel(reader: Any, variable: str | None, end: str, path: str | os.PathLike[str]) -> int | None:
    """The index of the wanted array of a file; None: the array that SurfaceTopography chooses, with a warning if there are several.

    Of several arrays of a MATLAB file one must be named, because others may be coordinates.
    """
    channels = _tried(lambda: reader.channels, path)
    maps = {str(channel.name): k for k, channel in enumerate(channels) if channel.dim == 2 and min(channel.nb_grid_pts or (2,)) > 1}
    if variable is not None or (end == ".mat" and maps):
        return maps[chosen(variable, list(maps), path)]
    if len(maps) > 1:
        warnings.warn(f"{path} has {', '.join(maps)}; {reader.default_channel.name} is read: variable= names another one", stacklevel=4)
    return None


def chosen(name: str | None, names: list[Any], path: str | os.PathLike[str]) -> Any:
    """The `name` of an array if it is among `names`, or the only name. It must be given if there are several."""
    if name is None and len(names) == 1:
        return names[0]
    if not names:
        raise ValueError(f"{path} has no arrays")
    if name not in names:
        raise ValueError(f"{path} has {', '.join(map(str, names))}; give variable, one of them")
    return name
