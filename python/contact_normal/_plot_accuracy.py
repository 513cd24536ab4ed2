"""Pictures of the costs of accuracy and of effects, by matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._axes import SIZE, new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._bill import Bill
    from ._prices import Prices
    from ._quantities import Quantities

_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
# The axis of changes begins at this part of the target, if there are smaller changes.
_LEAST = 1e-4
# If the axis of time covers more decades than this, only powers of ten have labels.
_DECADES = 2.0


def _error_axes(axes: Axes) -> None:
    from matplotlib.ticker import FixedLocator, LogFormatterSciNotation, NullFormatter

    axes.set(xscale="log", yscale="log", xlabel="time [s]", ylabel="relative error")
    first, last = axes.get_xlim()
    if last < 10.0**_DECADES * first:
        # Between a few powers of ten there is room for labels at some multiples, but not at all nine.
        between = (1.0, 2.0, 5.0) if last > 10.0 * first else (1.0, 2.0, 3.0, 5.0, 7.0)
        powers = 10.0 ** np.arange(np.floor(np.log10(first)), np.ceil(np.log10(last)))
        axes.xaxis.set_major_locator(FixedLocator(np.outer(powers, between).ravel().tolist()))
        axes.xaxis.set_major_formatter(LogFormatterSciNotation(minor_thresholds=(np.inf, np.inf)))
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(True, which="major", color="0.5", alpha=0.2, linewidth=0.8)
    axes.spines[["top", "right"]].set_visible(False)


def plot_quantities(rows: Quantities, axes: Axes | None) -> Axes:
    """See `Quantities.plot`."""
    axes = axes or new_axes(SIZE)
    for k, name in enumerate(dict.fromkeys(row.name for row in rows)):
        known = [row for row in rows if row.name == name and row.error > 0 and row.value]
        called = _called(rows, name)
        if not known:
            axes.plot([], [], " ", label=f"{called}:\n{rows.last(name).lack or 'no error'}")
            continue
        seconds, errors = [row.seconds for row in known], [row.error / abs(row.value) for row in known]
        axes.plot(seconds, errors, "o-", color=_COLOURS[k % len(_COLOURS)], label=called, markersize=5)
    _write_elements(axes, [(row.seconds, row.shape) for row in rows])
    _error_axes(axes)
    _write_legend(axes)
    return axes


def _called(rows: Bill | Prices | Quantities, quantity: str) -> str:
    """The name of a quantity in words."""
    return rows.estimated if quantity == "force" else quantity.replace("_", " ")


def _write_legend(axes: Axes) -> None:
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def plot_ledger(ledger: Sequence[dict[str, float]], estimated: str, axes: Axes | None) -> Axes:
    """See `Ledger.plot`."""
    axes = axes or new_axes(SIZE)
    quantities = (
        ("pressures (rms)", "error_pressure", None),
        (estimated, "error_force", estimated),
        ("max pressure", "error_max_pressure", "max_pressure"),
        ("contact area", "error_corrected_area", "corrected_area"),
    )
    for (name, error, of), colour in zip(quantities, _COLOURS):
        sizes = [1.0 if of is None else abs(row[of]) for row in ledger]
        points = [(row["seconds"], row[error] / size) for row, size in zip(ledger, sizes) if row[error] > 0 and size > 0]
        if points:
            axes.plot(*zip(*points), "o-", color=colour, label=name, markersize=5)
    _write_elements(axes, [(row["seconds"], (int(row["my"]), int(row["mx"]))) for row in ledger if row["seconds"] > 0])
    _error_axes(axes)
    axes.set_ylabel("estimated relative error")
    _write_legend(axes)
    return axes


def _write_elements(axes: Axes, grids: list[tuple[float, tuple[int, int]]]) -> None:
    """Writes the numbers of elements of each grid along the upper border, from the right to the left. Labels that would overlap the last one are left out."""
    if not grids:
        return
    places = sorted(dict((shape, (seconds, shape)) for seconds, shape in grids).values(), reverse=True)
    apart = max(1.2, (places[0][0] / places[-1][0]) ** 0.08)
    last = float("inf")
    for seconds, (my, mx) in places:
        if seconds * apart > last:
            continue
        last = seconds
        axes.axvline(seconds, color="0.5", alpha=0.2, linewidth=0.8, zorder=0)
        axes.annotate(
            f"{mx} × {my}", (seconds, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 4), textcoords="offset points", fontsize=8,
            ha="center", rotation=30,
        )


def plot_prices(prices: Prices, axes: Axes | None, measured: Any) -> Axes:
    """See `Prices.plot`."""
    had = [price for price in prices if not price.obstacle and price.seconds > 0]
    if not had and not measured:
        raise ValueError(f"no accuracy of the list can be had: {', '.join(dict.fromkeys(price.obstacle for price in prices))}")
    axes = axes or new_axes(SIZE)
    axes.plot([price.seconds for price in had], [price.error for price in had], "-", color=_COLOURS[0], label="predicted")
    axes.plot([price.seconds for price in had], [price.error for price in had], "o", mfc="none", mec=_COLOURS[0], label="grids of the list")
    if measured:
        seconds, errors = zip(*measured)
        axes.plot(seconds, errors, "s", color=_COLOURS[1], label="measured")
    _write_elements(axes, [(price.seconds, price.shape) for price in had])
    _error_axes(axes)
    axes.set_ylabel(f"relative error of the {_called(prices, prices.quantity)}")
    axes.legend(frameon=False, fontsize=9)
    return axes


def plot_bill(bill: Bill, axes: Axes | None) -> Axes:
    """See `Bill.plot`."""
    singles = list(dict.fromkeys(row.omitted for row in bill if len(row.omitted) == 1))
    axes = axes or new_axes((SIZE[0], 1.4 + 0.62 * max(1, len(singles))))
    quantities = list(dict.fromkeys(row.quantity for row in bill))
    height, named = 0.8 / max(1, len(quantities)), set()
    for q, quantity in enumerate(quantities):
        for k, omitted in enumerate(singles):
            row = next(row for row in bill if row.omitted == omitted and row.quantity == quantity)
            if row.change != row.change or not row.value:
                continue
            place, size = k + (q - 0.5 * (len(quantities) - 1)) * height, max(abs(row.relative), 1e-12)
            error = row.error / abs(row.value) if row.error >= 0 else 0.0
            axes.barh(place, size, height * 0.9, color=_COLOURS[q % len(_COLOURS)], label=None if quantity in named else _called(bill, quantity),
                      xerr=[[min(error, 0.99 * size)], [error]], error_kw={"elinewidth": 1, "ecolor": "0.5"})
            named.add(quantity)
    axes.axvline(bill.target, color="0.5", linestyle="--", linewidth=1)
    axes.annotate("target", (bill.target, 0.0), xycoords=("data", "axes fraction"), xytext=(3, 3), textcoords="offset points", fontsize=8)
    # Changes far below the target need not be distinguished.
    axes.set(xscale="log", xlim=(max(axes.get_xlim()[0], _LEAST * bill.target), None), xlabel="relative change without the effect", yticks=range(len(singles)))
    axes.set_yticklabels([_bill_label(bill, omitted) for omitted in singles])
    axes.invert_yaxis()
    axes.grid(True, axis="x", color="0.5", alpha=0.2, linewidth=0.8)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    if named:
        axes.legend(frameon=False, fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return axes


def _bill_label(bill: Bill, omitted: tuple[str, ...]) -> str:
    row = next(row for row in bill if row.omitted == omitted)
    saved = 100.0 * (1.0 - row.seconds_without / row.seconds) if row.seconds else 0.0
    saves = f"saves {saved:.0f} % of the time" if saved >= 1.0 else "saves no time"
    return f"{omitted[0].replace('_', ' ')}\n{saves}"
