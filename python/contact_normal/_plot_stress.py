"""Pictures of stresses below the surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._axes import EDGE, SIZE, borders, line_of, middle, nearest, new_axes
from ._stress import COMPONENTS
from ._units import label, unit, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._stress import SubsurfaceStress

def plot_depth(stress: SubsurfaceStress, x: float | None, y: float | None, axes: Axes | None) -> Axes:
    """See `SubsurfaceStress.plot_depth`."""
    axes = axes or new_axes(SIZE)
    x, y = middle(stress.x) if x is None else x, middle(stress.y) if y is None else y
    element = (slice(None), nearest(y, stress.y, stress.dy, "y"), nearest(x, stress.x, stress.dx, "x"))
    order = np.argsort(stress.depths)
    for name, text in (("xx", "$\\sigma_{xx}$"), ("yy", "$\\sigma_{yy}$"), ("zz", "$\\sigma_{zz}$"), ("von_mises", "von Mises"),
                       ("maximum_shear", "largest shear")):
        if getattr(stress, name) is not None:
            axes.plot(getattr(stress, name)[element][order], stress.depths[order], label=text)
    axes.invert_yaxis()
    axes.axvline(0.0, color="0.5", alpha=0.4, linewidth=1.0, zorder=0)
    axes.set(xlabel=label("stress", "pressure", stress.units), ylabel=label("depth z", "length", stress.units))
    axes.legend(fontsize="small")
    return axes


def plot_stress_section(stress: SubsurfaceStress, x: float | None, y: float | None, of: str, axes: Axes | None) -> Axes:
    """See `SubsurfaceStress.plot_section`."""
    along, across, where, line = line_of(x, y, stress)
    if len(stress.depths) < 2 or len(getattr(stress, along)) < 2:
        raise ValueError(f"a section along {along} has {len(stress.depths)} depths of {len(getattr(stress, along))} elements; it must have two of each at least")
    field, units, places, d = _field(stress, of)[line], stress.units, getattr(stress, along), getattr(stress, "d" + along)
    # The height of the figure in inches: that of the section to scale, and 1.3 for the title and the labels.
    height = float(np.clip(5.2 * np.ptp(stress.depths) / (len(places) * d) + 1.3, 2.4, 6.0))
    axes = axes or new_axes((SIZE[0], height))
    order = np.argsort(stress.depths)
    depths, shown = stress.depths[order], field[order]
    filled: Any = axes.contourf(places, depths, shown, 24, cmap="magma")
    # Edges in the colour of the level avoid seams between levels in vector files. Before matplotlib 3.8 each level is a collection of its own.
    levels: Any = [filled] if hasattr(filled, "set_edgecolor") else filled.collections
    for level in levels:
        level.set_edgecolor("face")
    row, column = np.unravel_index(np.argmax(np.abs(shown)), shown.shape)
    for colour, width in (("black", 4), ("white", 2)):
        axes.plot(places[column], depths[row], "+", color=colour, markersize=10 + width, markeredgewidth=width)
    ends: Any = borders(stress._loaded[line], places, d) if stress._loaded is not None else []
    axes.plot(ends, np.full(len(ends), depths[0]), "v", color=EDGE, markersize=7 if len(ends) <= 12 else 2, clip_on=False, label="edge of the contact")
    axes.figure.colorbar(filled, ax=axes, label=label({"von_mises": "von Mises"}.get(of, of.replace("_", " ")), "pressure", units))
    axes.set(xlabel=label(along, "length", units), ylabel=label("depth z", "length", units), aspect="equal")
    largest, length = title(f"{shown[row, column]:.4g}", "pressure", units), f" {unit('length', units)}" if units else ""
    axes.set_title(f"{across} = {where:.4g}{length}: largest {largest} at {along} = {places[column]:.4g}{length}, z = {depths[row]:.4g}{length}",
                   fontsize=10)
    axes.set_ylim(depths[-1], depths[0])
    return axes


def _field(stress: SubsurfaceStress, name: str) -> Any:
    field = getattr(stress, name, None)
    if field is None or name not in COMPONENTS:
        raise ValueError(f"{name} is not there to be drawn: it was not asked for, or is no stress")
    return field
