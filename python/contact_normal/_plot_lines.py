"""Pictures with curves: sections, histograms of pressures, contact area over load, creep forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._axes import EDGE, SIZE, borders, line_of, new_axes
from ._units import label, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._creep_forces import CreepForceTable
    from ._friction_batch import FrictionBatch
    from ._result import Result
    from ._solved import Solved

# Pressures that differ by less than the relative amount _EQUAL, the default tolerance of a solve, count as equal. The range of a histogram of equal pressures
# is _SHOWN times their value.
_EQUAL, _SHOWN = 1e-6, 0.1


def plot_section(result: Result, x: float | None, y: float | None, axes: Axes | None) -> Axes:
    """See `Result.plot_section`."""
    along, across, where, line = line_of(x, y, result)
    places, d = getattr(result, along), getattr(result, "d" + along)
    axes = axes or new_axes(SIZE)
    axes.fill_between(places, result.pressure[line], alpha=0.2, linewidth=0.0)
    axes.plot(places, result.pressure[line])
    _mark_borders(axes, borders(result.contact[line], places, d))
    axes.set(xlabel=label(along, "length", result.units), ylabel=label("pressure", "pressure", result.units), xlim=(places[0], places[-1]))
    axes.set_ylim(bottom=min(0.0, float(result.pressure[line].min())))
    axes.set_title(f"{across} = {title(f'{where:.4g}', 'length', result.units)}; dotted: the contact's edge", fontsize=10)
    return axes


def _mark_borders(axes: Axes, places: Any) -> None:
    # A rough surface has many borders. They are drawn as thin lines, so that they do not cover the curve.
    for place in places:
        axes.axvline(place, color=EDGE, linestyle=":", linewidth=1.2 if len(places) <= 12 else 0.4, zorder=0)


def _least_range(values: Any, bins: Any) -> tuple[float, float] | None:
    """The range of a histogram whose values are all equal to the error of a solve: all of them are in the middle of one bin. None if the values differ."""
    middle = 0.5 * (values.min() + values.max()) if values.size else 0.0
    if not np.isfinite(middle) or middle == 0.0 or np.ptp(values) > _EQUAL * abs(middle):
        return None
    count = max(1, int(bins)) if isinstance(bins, (int, np.integer)) else 1
    width, below = _SHOWN * abs(middle) / count, count // 2 + 0.5
    return float(middle - below * width), float(middle + (count - below) * width)


def plot_histogram(result: Solved, bins: int, axes: Axes | None) -> Axes:
    """See `Result.plot_histogram`."""
    axes = axes or new_axes(SIZE)
    inside = result.pressure[result.contact]
    share = np.full(inside.shape, 100.0 / max(1, inside.size))
    axes.hist(inside, bins=bins, weights=share, range=_least_range(inside, bins))
    axes.set(xlabel=label("pressure", "pressure", result.units), ylabel="share of the contact area [%]")
    area = title(f"{result.contact_area:.4g}", "area", result.units)
    axes.set_title(f"contact area {area}, largest pressure {title(f'{result.max_pressure:.4g}', 'pressure', result.units)}", fontsize=10)
    return axes


def plot_creep_curve(batch: FrictionBatch, over: str | None, axes: Axes | None) -> Axes:
    """See `FrictionBatch.plot`."""
    if over not in (None, "x", "y"):
        raise ValueError(f'over is {over!r}; it must be "x" or "y"')
    if np.isnan(batch.force).all():
        raise ValueError("no entry is solved: there is nothing to draw")
    ranges = np.nanmax(batch.creepage, axis=0) - np.nanmin(batch.creepage, axis=0)
    k = int(ranges[1] > ranges[0]) if over is None else "xy".index(over)
    axes = axes or new_axes(SIZE)
    for side, name in enumerate("xy"):
        axes.plot(batch.creepage[:, k], batch.force[:, side], "o-", markersize=4, label=f"$F_{name}$")
    axes.axhline(0.0, color="0.5", linewidth=0.8, zorder=0)
    axes.set(xlabel=f"creepage in {'xy'[k]}", ylabel=label("tangential force on body 1", "force", batch.units))
    axes.legend()
    return axes


def plot_contact_area(results: Sequence[Solved], axes: Axes | None = None) -> Axes:
    """Draws the contact area of several results over their normal forces.

    Parameters
    ----------
    results : sequence of Result
        The results in any order; units are those of the first.
    axes : matplotlib.axes.Axes, optional
        The axes to draw on; by default those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, for additions or for saving.
    """
    if not isinstance(results, Sequence):
        raise TypeError(f"results is a {type(results).__name__}; it must be a sequence of results")
    if not results:
        raise ValueError("results is empty; it must have at least one result")
    axes, units = axes or new_axes(SIZE), results[0].units
    places = sorted((result.force, result.contact_area) for result in results)
    axes.plot(*zip(*places), "o-")
    axes.set(xlabel=label("normal force", "force", units), ylabel=label("contact area", "area", units))
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    return axes


def plot_creep_forces(table: CreepForceTable, of: str, eta: float, axis_ratio: float, poisson_ratio: float | None, axes: Axes | None) -> Axes:
    """See `CreepForceTable.plot`."""
    names = {"force_x": (0, "force $F_x$"), "force_y": (1, "force $F_y$"), "moment": (2, "moment $M_z$")}
    if of not in names:
        raise ValueError(f"of is {of!r}; it must be one of {', '.join(names)}")
    axes = axes or new_axes(SIZE)
    which, text = names[of]
    first, last = float(table.xi[0] if table.of_surface else -table.xi[-1]), float(table.xi[-1])
    xi = np.linspace(first, last, 201)
    for phi in table.phi:
        *forces, error = table.forces(xi, eta, phi, axis_ratio=axis_ratio, poisson_ratio=poisson_ratio)
        (line,) = axes.plot(xi, forces[which], label=f"$\\phi$ = {phi:g}")
        if not table.of_surface:  # errors are relative to mu N, as the forces are
            axes.fill_between(xi, forces[which] - error, forces[which] + error, color=line.get_color(), alpha=0.3, linewidth=0.0)
    per = "" if table.of_surface else " / ($\\mu N c$)" if of == "moment" else " / ($\\mu N$)"
    axes.set(xlabel="creepage $\\xi$" if table.of_surface else "creepage $G c^2 \\xi/(\\mu N)$", ylabel=text + per)
    axes.legend(title="spin" if table.of_surface else "spin $G c^3 \\phi/(\\mu N)$")
    return axes
