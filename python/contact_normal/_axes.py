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
# The colour of the border of a contact area and of marked places. It is readable on light and on dark pages.
EDGE = "crimson"
# Grids whose sides differ by more than this factor are not drawn to scale.
_SLENDER = 4.0


def new_axes(size: tuple[float, float]) -> Axes:
    """Makes a figure with a size in inches, and returns its axes."""
    axes: Axes = matplotlib().subplots(figsize=size, layout="constrained")[1]
    return axes


def matplotlib() -> Any:
    """Imports and returns matplotlib.pyplot."""
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("plots need matplotlib: pip install 'contact-normal[plot]'") from error
    return pyplot


def edges(centres: Doubles, d: float) -> Doubles:
    """The m + 1 edges of m elements of size d in a row, from their centres."""
    return np.append(centres - 0.5 * d, centres[-1:] + 0.5 * d)


def exterior(axes: Axes) -> tuple[float, float, float]:
    """The colour of the exterior area. It lies between the colours of the background and of the text; on dark pages nearer to the text, so that it differs
    from the colour of small pressures."""
    from matplotlib import colors

    back, front = (np.array(colors.to_rgb(colour)) for colour in (axes.get_facecolor(), axes.xaxis.label.get_color()))
    part = 0.06 if back.mean() > 0.5 else 0.4
    r, g, b = (1.0 - part) * back + part * front
    return r, g, b


def name_axes(axes: Axes, units: Units) -> None:
    """Labels the axes x and y of a view from above. Both have one scale, unless the grid is too slender."""
    width, height = (abs(high - low) for low, high in (axes.get_xlim(), axes.get_ylim()))
    is_slender = not 1.0 / _SLENDER <= width / height <= _SLENDER
    axes.set(xlabel=label("x", "length", units), ylabel=label("y", "length", units), aspect="auto" if is_slender else "equal")


def nearest(place: float, centres: Any, d: float, name: str) -> int:
    """The index of the element that contains the coordinate `place`, which has the `name` in messages."""
    k = np.floor((number(name, place) - centres[0]) / d + 0.5)
    if not 0 <= k < len(centres):
        raise ValueError(f"{name} is {place}; it must lie within the grid, from {centres[0] - 0.5 * d} to {centres[-1] + 0.5 * d}")
    return int(k)


def middle(centres: Any) -> float:
    """The coordinate of the middle of a row of elements."""
    return float(0.5 * (centres[0] + centres[-1]))


def line_of(x: float | None, y: float | None, grid: Any) -> tuple[str, str, float, Any]:
    """The line of elements that a section shows: the row at `y` or the column at `x`, by default the row in the middle of the grid.

    Returns the name of the coordinate along the line and of the one across it, the value of the latter, and the index of the line in fields (..., my, mx).
    """
    if x is not None and y is not None:
        raise TypeError("give either x or y: the plane of the section")
    if x is None:
        where = middle(grid.y) if y is None else y
        return "x", "y", where, (..., nearest(where, grid.y, grid.dy, "y"), slice(None))
    return "y", "x", x, (..., slice(None), nearest(x, grid.x, grid.dx, "x"))


def borders(inside: Any, centres: Any, d: float) -> Doubles:
    """The coordinates at which a line of elements enters or leaves the contact area."""
    padded = np.pad(np.asarray(inside, dtype=bool), 1)
    places: Doubles = edges(centres, d)[padded[1:] != padded[:-1]]
    return places
