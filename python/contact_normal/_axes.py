"""Axes of matplotlib, which is imported only by the modules that draw: `pip install contact-normal[plot]`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import number
from ._units import Units, label

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._arguments import Doubles

SIZE = (6.8, 4.4)  # inches, as in contact_normal.mplstyle
# The border of a contact area, and places that are marked: readable on light and on dark pages.
EDGE = "crimson"
# Grids whose sides differ by more than this factor are not drawn to scale.
_SLENDER = 4.0


def new_axes(size: tuple[float, float]) -> Axes:
    """The axes of a new figure of that size in inches."""
    axes: Axes = matplotlib().subplots(figsize=size, layout="constrained")[1]
    return axes


def matplotlib() -> Any:
    """matplotlib's pyplot."""
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("plots need matplotlib: pip install 'contact-normal[plot]'") from error
    return pyplot


def edges(centres: Doubles, d: float) -> Doubles:
    """The edges of elements, from their centres."""
    return np.append(centres - 0.5 * d, centres[-1:] + 0.5 * d)


def exterior(axes: Axes) -> tuple[float, float, float]:
    """The colour of the exterior area, between those of the background and of the text: on dark pages far enough from that of small pressures."""
    from matplotlib import colors

    back, front = (np.array(colors.to_rgb(colour)) for colour in (axes.get_facecolor(), axes.xaxis.label.get_color()))
    part = 0.06 if back.mean() > 0.5 else 0.4
    r, g, b = (1.0 - part) * back + part * front
    return r, g, b


def name_axes(axes: Axes, units: Units) -> None:
    """Names the axes x and y of a view from above. They are to scale, unless the grid is too slender."""
    width, height = (abs(high - low) for low, high in (axes.get_xlim(), axes.get_ylim()))
    is_slender = not 1.0 / _SLENDER <= width / height <= _SLENDER
    axes.set(xlabel=label("x", "length", units), ylabel=label("y", "length", units), aspect="auto" if is_slender else "equal")


def nearest(place: float, centres: Any, d: float, name: str) -> int:
    """The element at a place."""
    k = np.floor((number(name, place) - centres[0]) / d + 0.5)
    if not 0 <= k < len(centres):
        raise ValueError(f"{name} is {place}; it must lie within the grid, from {centres[0] - 0.5 * d} to {centres[-1] + 0.5 * d}")
    return int(k)


def middle(centres: Any) -> float:
    """The middle of a row of elements."""
    return float(0.5 * (centres[0] + centres[-1]))


def line_of(x: float | None, y: float | None, grid: Any) -> tuple[str, str, float, Any]:
    """The row or column of elements at `y` or at `x`, by default the row in the middle: the coordinate along it and the one across, the
    place of the line, and the index of it in fields (..., my, mx)."""
    if x is not None and y is not None:
        raise TypeError("give either x or y: the plane of the section")
    if x is None:
        where = middle(grid.y) if y is None else y
        return "x", "y", where, (..., nearest(where, grid.y, grid.dy, "y"), slice(None))
    return "y", "x", x, (..., slice(None), nearest(x, grid.x, grid.dx, "x"))


def borders(inside: Any, centres: Any, d: float) -> Doubles:
    """Where a line of elements enters or leaves the contact area."""
    padded = np.pad(np.asarray(inside, dtype=bool), 1)
    places: Doubles = edges(centres, d)[padded[1:] != padded[:-1]]
    return places
