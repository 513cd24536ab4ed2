"""Pictures by matplotlib, which is imported only here: `pip install contact-normal[plot]`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._units import Units, label, unit, with_unit

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._result import Result
    from ._solved import Solved
    from ._stress import SubsurfaceStress


def _new_axes(size: tuple[float, float]) -> Axes:
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("plots need matplotlib: pip install contact-normal[plot]") from error
    axes: Axes = pyplot.subplots(figsize=size, layout="constrained")[1]
    return axes


def _edges(centres: Any, d: float) -> Any:
    return np.append(centres - 0.5 * d, centres[-1:] + 0.5 * d)


def _name_axes(axes: Axes, units: Units) -> None:
    axes.set(xlabel=label("x", "length", units), ylabel=label("y", "length", units), aspect="equal")


def plot_pressure(result: Result, axes: Axes | None) -> Axes:
    """See `Result.plot`."""
    axes = axes or _new_axes((8.0, 6.0))
    my, mx = result.pressure.shape
    x_edges, y_edges = _edges(result.x, result.dx), _edges(result.y, result.dy)
    shown = np.ma.masked_where(~result.contact, result.pressure)
    image = axes.imshow(
        shown,
        origin="lower",
        extent=(x_edges[0], x_edges[-1], y_edges[0], y_edges[-1]),
        cmap="viridis",
        vmin=0.0,
        interpolation="nearest",
    )
    axes.set_facecolor("0.94")
    _outline(axes, result.contact, x_edges, y_edges)
    axes.figure.colorbar(image, ax=axes, shrink=0.9, label=label("pressure", "pressure", result.units))
    _name_axes(axes, result.units)
    force, approach = with_unit(f"{result.force:.5g}", "force", result.units), with_unit(f"{result.approach:.5g}", "length", result.units)
    axes.set_title(f"force {force}, approach {approach}, {mx} × {my} elements", fontsize=10)
    return axes


def plot_traction(result: Solved, axes: Axes | None) -> Axes:
    """See `Result.plot_traction`."""
    axes = axes or _new_axes((8.0, 6.0))
    my, mx = result.stick_slip.shape
    x_edges, y_edges = _edges(result.x, result.dx), _edges(result.y, result.dy)
    colours = {1: (0.78, 0.87, 0.96), 2: (0.99, 0.85, 0.74)}
    shown = np.ones((my, mx, 3)) * 0.94
    for side, colour in colours.items():
        shown[result.stick_slip == side] = colour
    extent = (x_edges[0], x_edges[-1], y_edges[0], y_edges[-1])
    axes.imshow(shown, origin="lower", extent=extent, interpolation="nearest")
    # Some 30 arrows across.
    step = max(1, max(mx, my) // 30)
    chosen = np.zeros((my, mx), dtype=bool)
    chosen[step // 2 :: step, step // 2 :: step] = True
    iy, ix = np.nonzero(chosen & (result.stick_slip > 0))
    axes.quiver(result.x[ix], result.y[iy], result.traction[0, iy, ix], result.traction[1, iy, ix], angles="xy", pivot="mid", width=0.003)
    _outline(axes, result.stick_slip > 0, x_edges, y_edges)
    _outline(axes, result.stick_slip == 1, x_edges, y_edges)
    fx, fy = result.tangential_force
    _name_axes(axes, result.units)
    force = with_unit(f"({fx:.4g}, {fy:.4g})", "force", result.units)
    axes.set_title(f"tractions: force {force}; stick blue, slip orange", fontsize=10)
    return axes


def _outline(axes: Axes, contact: npt.NDArray[np.bool_], x_edges: Any, y_edges: Any) -> None:
    """The border of the contact area along the edges of its elements."""
    padded = np.pad(contact, 1)
    rows, columns = np.nonzero(padded[1:, 1:-1] != padded[:-1, 1:-1])
    axes.hlines(y_edges[rows], x_edges[columns], x_edges[columns + 1], color="crimson", linewidth=1.6)
    rows, columns = np.nonzero(padded[1:-1, 1:] != padded[1:-1, :-1])
    axes.vlines(x_edges[columns], y_edges[rows], y_edges[rows + 1], color="crimson", linewidth=1.6)


def plot_ledger(ledger: Sequence[dict[str, float]], estimated: str, axes: Axes | None) -> Axes:
    """See `Ledger.plot`."""
    axes = axes or _new_axes((6.4, 4.2))
    for name, error, of in (
        ("pressures (rms)", "error_pressure", None),
        (estimated, "error_force", estimated),
        ("largest pressure", "error_max_pressure", "max_pressure"),
    ):
        scales = [1.0 if of is None else row[of] for row in ledger]
        points = [(row["seconds"], row[error] / scale) for row, scale in zip(ledger, scales) if row[error] > 0 and scale > 0]
        if points:
            axes.loglog(*zip(*points), "o-", label=name)
    shown = 0.0
    for row in ledger:
        if row["seconds"] < 1.15 * shown:  # its label would lie on the one before
            continue
        shown = row["seconds"]
        axes.axvline(row["seconds"], color="0.9", zorder=0)
        axes.annotate(
            f"{row['mx']:.0f} × {row['my']:.0f}",
            (row["seconds"], 0.99),
            xycoords=("data", "axes fraction"),
            rotation=90,
            va="top",
            ha="right",
            fontsize=7,
        )
    axes.set(xlabel="seconds", ylabel="estimated relative error", title="What accuracy costs: the ledger of one solve")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower left", fontsize="small")
    return axes


def _nearest(place: float, centres: Any, d: float, name: str) -> int:
    """The element at a place."""
    k = int(np.floor((place - centres[0]) / d + 0.5))
    if not 0 <= k < len(centres):
        raise ValueError(f"{name} is {place}; it must lie within the grid, from {centres[0] - 0.5 * d} to {centres[-1] + 0.5 * d}")
    return k


def _middle(centres: Any) -> float:
    return float(0.5 * (centres[0] + centres[-1]))


def _field(stress: SubsurfaceStress, name: str) -> Any:
    field = getattr(stress, name, None)
    if field is None or name not in ("xx", "yy", "zz", "xy", "xz", "yz", "von_mises", "maximum_shear"):
        raise ValueError(f"{name} is not there to be drawn: it was not asked for, or is no stress")
    return field


def plot_section(stress: SubsurfaceStress, x: float | None, y: float | None, of: str, axes: Axes | None) -> Axes:
    """See `SubsurfaceStress.plot_section`."""
    if x is not None and y is not None:
        raise TypeError("give either x or y: the plane of the section")
    field, units = _field(stress, of), stress.units
    axes = axes or _new_axes((8.0, 4.5))
    if x is None:
        where, across, places, name = _middle(stress.y) if y is None else y, "x", stress.x, "y"
        shown = field[:, _nearest(where, stress.y, stress.dy, "y"), :]
    else:
        where, across, places, name = x, "y", stress.y, "x"
        shown = field[:, :, _nearest(where, stress.x, stress.dx, "x")]
    order = np.argsort(stress.depths)
    depths = stress.depths[order]
    filled = axes.contourf(places, depths, shown[order], 24, cmap="magma")
    row, column = np.unravel_index(np.argmax(np.abs(shown[order])), shown.shape)
    for colour, width in (("black", 4), ("white", 2)):
        axes.plot(places[column], depths[row], "+", color=colour, markersize=10 + width, markeredgewidth=width)
    axes.figure.colorbar(filled, ax=axes, label=label({"von_mises": "von Mises"}.get(of, of.replace("_", " ")), "pressure", units))
    axes.set(xlabel=label(across, "length", units), ylabel=label("depth z", "length", units), aspect="equal")
    largest, length = with_unit(f"{shown[order][row, column]:.4g}", "pressure", units), f" {unit('length', units)}" if units else ""
    axes.set_title(f"{name} = {where:.4g}{length}: largest {largest} at {across} = {places[column]:.4g}{length}, z = {depths[row]:.4g}{length}",
                   fontsize=10)
    axes.set_ylim(depths[-1], depths[0])
    return axes


def plot_depth(stress: SubsurfaceStress, x: float | None, y: float | None, axes: Axes | None) -> Axes:
    """See `SubsurfaceStress.plot_depth`."""
    axes = axes or _new_axes((6.0, 4.5))
    x, y = _middle(stress.x) if x is None else x, _middle(stress.y) if y is None else y
    element = (slice(None), _nearest(y, stress.y, stress.dy, "y"), _nearest(x, stress.x, stress.dx, "x"))
    order = np.argsort(stress.depths)
    for name, text in (("xx", "$\\sigma_{xx}$"), ("yy", "$\\sigma_{yy}$"), ("zz", "$\\sigma_{zz}$"), ("von_mises", "von Mises"),
                       ("maximum_shear", "largest shear")):
        if getattr(stress, name) is not None:
            axes.plot(getattr(stress, name)[element][order], stress.depths[order], label=text)
    axes.invert_yaxis()
    axes.axvline(0.0, color="0.8", zorder=0)
    axes.set(xlabel=label("stress", "pressure", stress.units), ylabel=label("depth z", "length", stress.units))
    axes.legend(fontsize="small")
    return axes
