"""Prepares calls that solve a scene on several grids: a surface with values on any grid, limits, and targets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ._arguments import both, integer, number, relative, two
from ._callbacks import Surface
from ._library import initialised
from ._quantities import QUANTITIES
from ._scene import Scene


def on_any_grid(
    h: Any, dx: Any, dy: Any, shape: Any, corner: Any, effects: Mapping[str, Any], **loaded: Any
) -> tuple[Scene, Surface | None, tuple[float, float]]:
    """The scene on the first grid, the surface callback if `h` is a callable, else None, and the coordinates of the middle of the rectangle."""
    if not callable(h):
        for name, value in (("shape", shape), ("corner", corner)):
            if value is not None:
                raise TypeError(f"{name} is for a surface that is a callable")
        return Scene(h, dx, dy, effects=effects, **loaded), None, (0.0, 0.0)
    if shape is None:
        raise TypeError("shape (my, mx) of the first grid is needed where h is a callable")
    my, mx = (integer("shape", m) for m in both("shape", shape))
    half = 0.5 * mx * number("dx", dx), 0.5 * my * number("dy", dy)
    x, y = (-half[0], -half[1]) if corner is None else two("corner", corner)
    # The library does not read the distances of the scene if there is a surface callback: they are zeros.
    scene = Scene(np.zeros((max(my, 0), max(mx, 0))), dx, dy, effects=effects, **loaded)
    # Invalid counts of elements are left to the library, which has a message for them.
    scene.struct.my, scene.struct.mx = my, mx
    return scene, Surface(h, (x, y)), (0.0, 0.0) if corner is None else (x + half[0], y + half[1])


def limits(max_seconds: Any, max_bytes: Any, max_elements: Any, surface: Surface | None) -> Any:
    """A `contact_normal_accuracy` with the given limits and surface callback."""
    accuracy = initialised("accuracy")
    accuracy.max_seconds = number("max_seconds", max_seconds)
    for name, value in (("max_bytes", max_bytes), ("max_elements", max_elements)):
        # A float such as 2e9 is allowed if it is a whole number.
        setattr(accuracy, name, integer(name, int(value) if isinstance(value, float) and value.is_integer() else value, 64))
    if surface:
        accuracy.surface = surface.callback
    return accuracy


def set_targets(accuracy: Any, targets: Mapping[str, float] | None) -> None:
    """Sets the wanted relative errors of the named quantities in a `contact_normal_accuracy`."""
    if targets is not None and not isinstance(targets, Mapping):
        raise TypeError(f"targets is {targets!r}; it must be a mapping, as {{'force': 0.01}}")
    for name, target in (targets or {}).items():
        member = "target" if name == "force" else f"{name}_target"
        if name not in QUANTITIES:
            raise ValueError(f"targets has {name!r}; it may have {', '.join(QUANTITIES)}")
        setattr(accuracy, member, relative(f"targets[{name!r}]", target))
