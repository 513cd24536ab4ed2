"""Pictures of surfaces before a solve: heights, gaps, profiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._axes import edges, name_axes, new_axes
from ._units import label

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._gap import Gap
    from .profiles._profile import Profile
    from .surface._heights import Heights


def _map(on: Gap | Heights, shown: Any, name: str, axes: Axes | None, **colours: Any) -> Axes:
    """Draws values on the grid of `on` as a map, with a labelled colour bar."""
    axes = axes or new_axes((8.0, 6.0))
    x, y = edges(on.x, on.dx), edges(on.y, on.dy)
    extent = (x[0], x[-1], y[0], y[-1])
    image = axes.imshow(np.ma.masked_invalid(shown), origin="lower", extent=extent, interpolation="nearest", **colours)
    axes.figure.colorbar(image, ax=axes, shrink=0.9, label=label(name, "length", on.units))
    name_axes(axes, on.units)
    return axes


def plot_gap(gap: Gap, axes: Axes | None, largest: float | None) -> Axes:
    """See `Gap.plot`."""
    return _map(gap, gap.h, "undeformed distance h", axes, cmap="viridis_r", vmax=largest)


def plot_heights(heights: Heights, axes: Axes | None, marked: npt.ArrayLike | None) -> Axes:
    """See `Heights.plot`."""
    axes = _map(heights, heights.z, "height z", axes, cmap="cividis")
    if marked is not None:
        rows, columns = np.nonzero(np.asarray(marked))
        axes.plot(heights.x[columns], heights.y[rows], "s", color="crimson", markersize=3.0, linestyle="none")
    return axes


def plot_profile(profile: Profile, axes: Axes | None) -> Axes:
    """See `Profile.plot`."""
    axes = axes or new_axes((8.0, 4.0))
    axes.plot(profile.y, profile.z, linewidth=1.5, label=profile.name or profile.kind)
    axes.set(xlabel="y, to the field side [mm]", ylabel="z, downwards [mm]", aspect="equal")
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
    return axes
