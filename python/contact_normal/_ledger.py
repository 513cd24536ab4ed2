"""The class `Ledger`: the results on each grid of a solve, and their costs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Ledger(list[dict[str, float]]):
    """The results on each grid and their costs: one dict per grid, coarsest first.

    The keys are the members of `contact_normal_ledger_row`: "mx", "my", "cycles", "seconds", "work_units", "residual", "approach", "force", "max_pressure",
    "contact_area", "error_force", ... Estimated errors are absolute; a negative one means that the error is not known. "error_force" is the error of the
    quantity that the attribute `estimated` names: "force", or "approach" if the force is prescribed.
    """

    def __init__(self, rows: Iterable[dict[str, float]] = (), estimated: str = "force") -> None:
        super().__init__(rows)
        self.estimated = estimated

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the estimated relative errors on each grid over the seconds after which the grid was solved. `axes` is as for `Result.plot`."""
        from ._plot_accuracy import plot_ledger

        return plot_ledger(self, self.estimated, axes)
