"""Combines the arguments of a caller of `read` with what the file itself says of units and sizes."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._units import same_length

# The arguments of `heights` by which the size of an element is given.
SIZES = {"dx", "dy", "size", "span", "x", "y"}


def with_unit(unit: Any, given: dict[str, Any]) -> dict[str, Any]:
    """The arguments `given`, with the unit of length that the file says, if it says one. Another unit among the arguments is refused."""
    if not unit:
        return given
    units = given.get("units") or (str(unit), "N")
    if not same_length(str(unit), units[0]):
        raise ValueError(f"units are {units!r}, but lengths are in {unit} in the file: name that unit, or convert the heights")
    return {**given, "units": units}


def with_header(told: dict[str, Any], given: dict[str, Any]) -> dict[str, Any]:
    """The arguments `given`, with the unit of the header of a text, and with its size unless the caller gives sizes."""
    if not told:
        return given
    sizes = {} if SIZES & set(given) else {"size": told["size"]}
    return {**sizes, **with_unit(told["unit"], given)}


def steps_of(shape: tuple[int, int], given: dict[str, Any]) -> tuple[float | None, float | None]:
    """The distances between the columns and between the lines of a text, from the sizes that the caller gives. `shape` has the numbers of lines and columns.

    They are None if no sizes are given or these are no lengths; `heights` has the messages for that.
    """
    is_xy, (lines, columns) = given.get("axes") == "xy", shape
    counts = (lines, columns) if is_xy else (columns, lines)
    try:
        if "dx" in given:
            found = float(given["dx"]), float(given.get("dy", given["dx"]))
        else:
            name, fewer = ("size", 0) if "size" in given else ("span", 1)
            found = float(given[name][0]) / max(counts[0] - fewer, 1), float(given[name][1]) / max(counts[1] - fewer, 1)
    except (TypeError, ValueError, LookupError):
        return None, None
    if not all(0.0 < step < np.inf for step in found):
        return None, None
    return found[::-1] if is_xy else found
