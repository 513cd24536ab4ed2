"""Pictures by matplotlib, which is imported only here: `pip install contact-normal[plot]`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._arguments import Doubles


class Solved(Protocol):
    """What is drawn of a `Result`."""

    pressure: Doubles
    dx: float
    dy: float

    @property
    def traction(self) -> Doubles: ...

    @property
    def stick_slip(self) -> npt.NDArray[np.int32]: ...

    @property
    def contact(self) -> npt.NDArray[np.bool_]: ...

    @property
    def report(self) -> dict[str, Any]: ...


class Below(Protocol):
    """What is drawn of a `SubsurfaceStress`."""

    depths: Doubles
    zz: Doubles
    dx: float
    dy: float


def _new_axes(size: tuple[float, float]) -> Axes:
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("plots need matplotlib: pip install contact-normal[plot]") from error
    axes: Axes = pyplot.subplots(figsize=size, layout="constrained")[1]
    return axes


def plot_pressure(result: Solved, axes: Axes | None) -> Axes:
    """See `Result.plot`."""
    axes = axes or _new_axes((8.0, 6.0))
    my, mx = result.pressure.shape
    x_edges, y_edges = ((np.arange(m + 1) - 0.5 * m) * d for m, d in ((mx, result.dx), (my, result.dy)))
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
    axes.figure.colorbar(image, ax=axes, shrink=0.9, label="pressure")
    axes.set(xlabel="x", ylabel="y", aspect="equal")
    axes.set_title(f"force {result.report['force']:.5g}, approach {result.report['approach']:.5g}, {mx} × {my} elements", fontsize=10)
    return axes


def plot_traction(result: Solved, axes: Axes | None) -> Axes:
    """See `Result.plot_traction`."""
    axes = axes or _new_axes((8.0, 6.0))
    my, mx = result.stick_slip.shape
    x_edges, y_edges = ((np.arange(m + 1) - 0.5 * m) * d for m, d in ((mx, result.dx), (my, result.dy)))
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
    x, y = x_edges[ix] + 0.5 * result.dx, y_edges[iy] + 0.5 * result.dy
    axes.quiver(x, y, result.traction[0, iy, ix], result.traction[1, iy, ix], angles="xy", pivot="mid", width=0.003)
    _outline(axes, result.stick_slip > 0, x_edges, y_edges)
    _outline(axes, result.stick_slip == 1, x_edges, y_edges)
    fx, fy = result.report["tangential_force"]
    axes.set(xlabel="x", ylabel="y", aspect="equal")
    axes.set_title(f"tractions: force ({fx:.4g}, {fy:.4g}); stick blue, slip orange", fontsize=10)
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


def _nearest(place: float, d: float, m: int, name: str) -> int:
    """The element at a place from the middle of the grid."""
    k = int(np.floor(place / d + 0.5 * m))
    if not 0 <= k < m:
        raise ValueError(f"{name} is {place}; it must lie within the grid, at most {0.5 * m * d} from its middle")
    return k


def plot_section(stress: Below, x: float | None, y: float | None, of: str, axes: Axes | None) -> Axes:
    """See `SubsurfaceStress.plot_section`."""
    if x is not None and y is not None:
        raise TypeError("give either x or y: the plane of the section")
    field = getattr(stress, of)
    my, mx = field.shape[1:]
    axes = axes or _new_axes((8.0, 4.5))
    if x is None:
        where, across, m, d, name = y or 0.0, "x", mx, stress.dx, "y"
        shown = field[:, _nearest(where, stress.dy, my, "y"), :]
    else:
        where, across, m, d, name = x, "y", my, stress.dy, "x"
        shown = field[:, :, _nearest(where, stress.dx, mx, "x")]
    order = np.argsort(stress.depths)
    places, depths = (np.arange(m) + 0.5 - 0.5 * m) * d, stress.depths[order]
    filled = axes.contourf(places, depths, shown[order], 24, cmap="magma")
    row, column = np.unravel_index(np.argmax(np.abs(shown[order])), shown.shape)
    for colour, width in (("black", 4), ("white", 2)):
        axes.plot(places[column], depths[row], "+", color=colour, markersize=10 + width, markeredgewidth=width)
    axes.figure.colorbar(filled, ax=axes, label={"von_mises": "von Mises"}.get(of, of.replace("_", " ")))
    axes.set(xlabel=across, ylabel="depth z", aspect="equal")
    axes.set_title(f"{name} = {where:.4g}: largest {shown[order][row, column]:.4g} at {across} = {places[column]:.4g}, z = {depths[row]:.4g}",
                   fontsize=10)
    axes.set_ylim(depths[-1], depths[0])
    return axes


def plot_depth(stress: Below, x: float, y: float, axes: Axes | None) -> Axes:
    """See `SubsurfaceStress.plot_depth`."""
    axes = axes or _new_axes((6.0, 4.5))
    my, mx = stress.zz.shape[1:]
    element = (slice(None), _nearest(y, stress.dy, my, "y"), _nearest(x, stress.dx, mx, "x"))
    order = np.argsort(stress.depths)
    for name, label in (("xx", "$\\sigma_{xx}$"), ("yy", "$\\sigma_{yy}$"), ("zz", "$\\sigma_{zz}$"), ("von_mises", "von Mises"),
                        ("maximum_shear", "largest shear")):
        axes.plot(getattr(stress, name)[element][order], stress.depths[order], label=label)
    axes.invert_yaxis()
    axes.axvline(0.0, color="0.8", zorder=0)
    axes.set(xlabel="stress", ylabel="depth z")
    axes.legend(fontsize="small")
    return axes
