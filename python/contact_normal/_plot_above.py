"""Pictures of a result in a view from above: pressures, tractions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._axes import EDGE, edges, exterior, name_axes, new_axes
from ._units import label, title

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._result import Result
    from ._solved import Solved

STICK, SLIP = (0.78, 0.87, 0.96), (0.99, 0.85, 0.74)
# An outline of more segments than this is drawn as pixels in vector files, which would become too large.
_SEGMENTS = 4000
# If this percentile of the pressures is less than half of the largest pressure, the colours end at the percentile.
_USUAL = 99.5
# Negative pressures smaller than this part of the largest pressure are round-off and count as 0. The same holds for forces beside larger ones.
_ROUND_OFF = 1e-12


def plot_pressure(result: Result, axes: Axes | None) -> Axes:
    """See `Result.plot`."""
    axes = axes or new_axes((6.8, 5.1))
    my, mx = result.pressure.shape
    x_edges, y_edges = edges(result.x, result.dx), edges(result.y, result.dy)
    shown, colours = _coloured(result)
    extent = (x_edges[0], x_edges[-1], y_edges[0], y_edges[-1])
    image = axes.imshow(shown, origin="lower", extent=extent, interpolation="nearest", **colours)
    axes.set_facecolor(exterior(axes))
    _outline(axes, result.contact, x_edges, y_edges)
    is_cut = colours.get("vmax", np.inf) < result.pressure.max(initial=0.0)
    name = f"pressure, at most {result.pressure.max():.4g}" if is_cut else "pressure"
    axes.figure.colorbar(image, ax=axes, shrink=0.9, extend="max" if is_cut else "neither", label=label(name, "pressure", result.units))
    name_axes(axes, result.units)
    carried = float(np.abs(result.pressure).sum()) * result.dx * result.dy
    total = result.force if abs(result.force) > _ROUND_OFF * carried else 0.0
    force, approach = title(f"{total:.5g}", "force", result.units), title(f"{result.approach:.5g}", "length", result.units)
    axes.set_title(f"force {force}, approach {approach}, {mx} × {my} elements", fontsize=10)
    return axes


def _coloured(result: Result) -> tuple[Any, dict[str, Any]]:
    """The values that `plot_pressure` draws, and the arguments of imshow for their colours."""
    largest = float(np.abs(result.pressure).max(initial=0.0))
    if result.pressure.min(initial=0.0) >= -_ROUND_OFF * largest:
        colours = {"cmap": "viridis", "vmin": 0.0}
        usual = float(np.percentile(result.pressure[result.contact], _USUAL)) if result.contact.any() else 0.0
        # On rough surfaces a few pressures are much larger than the others, which would all be dark if the colours reached the largest one.
        return np.ma.masked_where(~result.contact, result.pressure), {**colours, "vmax": usual} if 0.0 < usual < 0.5 * largest else colours
    # With adhesion there is tension, also outside the contact area: red is pressure, blue is tension, white is 0.
    return result.pressure, {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest}


def plot_traction(result: Solved, axes: Axes | None) -> Axes:
    """See `Result.plot_traction`."""
    if not result.has_friction:
        raise ValueError("the result has no tractions: its scene names no friction")
    axes = axes or new_axes((6.8, 5.1))
    my, mx = result.stick_slip.shape
    x_edges, y_edges = edges(result.x, result.dx), edges(result.y, result.dy)
    shown = np.ones((my, mx, 3)) * exterior(axes)
    for side, colour in ((1, STICK), (2, SLIP)):
        shown[result.stick_slip == side] = colour
    extent = (x_edges[0], x_edges[-1], y_edges[0], y_edges[-1])
    axes.imshow(shown, origin="lower", extent=extent, interpolation="nearest")
    _arrows(result, axes)
    _outline(axes, result.stick_slip > 0, x_edges, y_edges)
    _outline(axes, result.stick_slip == 1, x_edges, y_edges)
    # A component of the force that is round-off beside the other one is shown as 0.
    size = float(np.hypot(*result.tangential_force))
    fx, fy = (part if abs(part) > _ROUND_OFF * size else 0.0 for part in result.tangential_force)
    name_axes(axes, result.units)
    force = title(f"({fx:.5g}, {fy:.5g})", "force", result.units)
    axes.set_title(f"tractions: force {force}; stick blue, slip orange", fontsize=10)
    return axes


def _arrows(result: Solved, axes: Axes) -> None:
    """Draws arrows of the tractions, about twenty across the contact area, and a key.

    The longest arrow is 1.3 times as long as the distance of the arrows. The key has 1, 2 or 5 times a power of ten.
    """
    rows, columns = np.nonzero(result.stick_slip > 0)
    across = max(np.ptp(rows), np.ptp(columns)) + 1 if rows.size else 1
    step = -(-int(across) // 20)
    chosen = np.zeros(result.stick_slip.shape, dtype=bool)
    chosen[step // 2 :: step, step // 2 :: step] = True
    iy, ix = np.nonzero(chosen & (result.stick_slip > 0))
    qx, qy = result.traction[:, iy, ix]
    largest = float(np.hypot(result.traction[0], result.traction[1]).max(initial=0.0)) or 1.0
    scale = largest / (1.3 * step * min(result.dx, result.dy))
    arrows = axes.quiver(result.x[ix], result.y[iy], qx, qy, angles="xy", scale_units="xy", scale=scale, pivot="mid", width=0.004)
    unit = 10.0 ** np.floor(np.log10(largest))
    # Just below a power of ten the logarithm may be rounded up to that of the power, so that no part fits: then the key has the power.
    shown = unit * max((part for part in (1.0, 2.0, 5.0) if part * unit <= largest), default=1.0)
    axes.quiverkey(arrows, 0.98, 0.04, shown, title(f"{shown:g}", "pressure", result.units), labelpos="W", coordinates="axes",
                   color=axes.xaxis.label.get_color())


def _outline(axes: Axes, contact: npt.NDArray[np.bool_], x_edges: Any, y_edges: Any) -> None:
    """Draws the border of the contact area along the edges of its elements. The line is thin where elements are small, so that it does not cover them."""
    from matplotlib.collections import LineCollection

    padded = np.pad(contact, 1)
    rows, columns = np.nonzero(padded[1:, 1:-1] != padded[:-1, 1:-1])
    flat = np.stack([x_edges[columns], y_edges[rows], x_edges[columns + 1], y_edges[rows]], axis=1)
    rows, columns = np.nonzero(padded[1:-1, 1:] != padded[1:-1, :-1])
    upright = np.stack([x_edges[columns], y_edges[rows], x_edges[columns], y_edges[rows + 1]], axis=1)
    segments = np.concatenate([flat, upright]).reshape(-1, 2, 2)
    box = axes.get_position()
    figure: Any = axes.figure
    width, height = figure.get_size_inches() * (box.width, box.height)
    points = 72.0 * min(width / contact.shape[1], height / contact.shape[0])
    lines = LineCollection(list(segments), colors=EDGE, linewidths=min(1.6, 0.25 * points), capstyle="projecting",
                           rasterized=len(segments) > _SEGMENTS)
    axes.add_collection(lines, autolim=False)
