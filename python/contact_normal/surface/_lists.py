"""Makes heights from a list of points, and from what the lines above the list say of its columns."""

from __future__ import annotations

import os
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ._columns import Columns, columns_of
from ._given import SIZES, steps_of, with_unit
from ._headers import count_above, head_of
from ._heights import Heights, heights
from ._lattice import MOST_COLUMNS, Lattice, lattice_of, may_be_list
from ._not_a_map import why
from ._texts import of_text


def of_list(path: str | os.PathLike[str], values: Any, given: dict[str, Any]) -> Heights | None:
    """The heights of a list of points of a grid; None if the numbers are no such list."""
    if sizes := sorted(SIZES & set(given)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if why(values, steps_of(values.shape, given)) and lattice_of(values) is not None:
                raise ValueError(f"{path} has x, y and z of {len(values)} points of a grid, which say the size of an element: "
                                 f"leave out {' and '.join(sizes)}")
        return None
    if not may_be_list(values.shape):
        return None
    said = Columns() if Path(path).suffix.lower() in (".npy", ".npz") else columns_of(path, values.shape[1])
    lattice, is_y_first = lattice_of(values[:, said.order]) if said.order else None, False
    if lattice is None:
        lattice, is_y_first = lattice_of(values), said.is_y_first
    if lattice is None:
        return None
    if given.get("axes", "yx") != "yx":
        raise ValueError(f"{path} has x, y and z of points, and no indices: leave out axes; where the first column is y, "
                         "exchange the columns, or name them in a header, # y x z")
    if said.doubt and not given.get("units"):
        warnings.warn(f"{path}: the unit in the line '{said.doubt}' is not read: x, y and z are taken to be in one unit; "
                      "a line # x [mm] y [mm] z [mm] names it", stacklevel=4)
    if is_y_first:
        lattice = Lattice(np.ascontiguousarray(lattice.z.T), lattice.y, lattice.x)
    return heights(lattice.z, x=lattice.x, y=lattice.y, **with_unit(said.unit, given))


def of_text_list(path: str | os.PathLike[str], given: dict[str, Any]) -> Heights | None:
    """The heights of a text that SurfaceTopography would read as a map, if the text is a list of points of a grid; otherwise None.

    Lines above the points need no #.
    """
    head = head_of(path)
    above = count_above(head)
    first = next((line for each in head.splitlines()[above:] if (line := each.split("#")[0].strip())), "")
    # A first line of many numbers shows a map. It is left to SurfaceTopography, before the whole file is read here.
    if len(re.findall(r"[^\s;]+", first)) > MOST_COLUMNS:
        return None
    with warnings.catch_warnings():
        # `has_empty_cells` has issued the warnings of this file before.
        warnings.simplefilter("ignore")
        try:
            values = of_text(path, ".txt", above)
        except ValueError:
            return None
    return of_list(path, values, given)
