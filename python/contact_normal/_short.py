"""The `repr` of objects that hold arrays: with shapes and ranges in place of the numbers."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np


class Short:
    """A dataclass whose `repr` has the shapes and ranges of its arrays, without members that are None."""

    def __repr__(self) -> str:
        members: Any = self
        return told(self, [field.name for field in dataclasses.fields(members) if not field.name.startswith("_")])


def told(holder: Any, names: Any) -> str:
    """`repr` of an object with these members."""
    values = {name: getattr(holder, name) for name in names}
    return f"{type(holder).__name__}({', '.join(f'{name}={short(value)}' for name, value in values.items() if value is not None)})"


def short(value: Any) -> str:
    """`repr` of a value; of an array its shape and the range of its finite numbers."""
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
