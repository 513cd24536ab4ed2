"""The `repr` of objects that hold arrays: it has the shapes and ranges of the arrays in the place of their numbers."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np


class Short:
    """A base class of dataclasses. The `repr` has the shapes and ranges of arrays, and leaves out private members and those that are None."""

    def __repr__(self) -> str:
        members: Any = self
        return told(self, [field.name for field in dataclasses.fields(members) if not field.name.startswith("_")])


def told(holder: Any, names: Any) -> str:
    """The `repr` of an object with the members `names`."""
    values = {name: getattr(holder, name) for name in names}
    return f"{type(holder).__name__}({', '.join(f'{name}={short(value)}' for name, value in values.items() if value is not None)})"


def short(value: Any) -> str:
    """The `repr` of a value. For an array it is the shape and the range of the finite numbers."""
    if not isinstance(value, np.ndarray):
        return repr(value)
    shape = " x ".join(map(str, value.shape))
    if value.dtype == bool:
        return f"<{shape}: {int(value.sum())} True>"
    known = value[np.isfinite(value)]
    if not known.size:
        return f"<{shape}: no finite number>"
    left_out = f", {value.size - known.size} not finite" if known.size < value.size else ""
    return f"<{shape}: from {known.min():.6g} to {known.max():.6g}{left_out}>"
