"""Stresses below the surface."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import doubles, integer, options, pointer
from ._library import check, initialised, library

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._arguments import Doubles
    from ._scene import Scene

COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


class SubsurfaceStress:
    """Stresses below the centres of the elements, positive in tension.

    Attributes
    ----------
    depths : ndarray, (n,)
        The depths, into the body.
    xx, yy, zz, xy, xz, yz : ndarray, (n, my, mx)
        The components.
    von_mises, maximum_shear : ndarray, (n, my, mx)
        The von Mises stress, and the largest shear stress.
    principal : ndarray, (3, n, my, mx) or None
        The principal stresses, the largest first; None unless asked for.
    directions : ndarray, (3, n, my, mx, 3) or None
        The unit vectors of their directions; None unless asked for.
    largest_von_mises, largest_shear : dict
        The largest value of all depths and its place: "value", "x", "y", "z", "ix", "iy", "depth". x and y are counted from the middle
        of the grid.
    dx, dy : float
        Element sizes.
    """

    def __init__(self, depths: Doubles, stress: Doubles, scene: Scene) -> None:
        self.depths = depths
        self.xx, self.yy, self.zz, self.xy, self.xz, self.yz = stress
        self.von_mises: Doubles = np.zeros(stress.shape[1:])
        self.maximum_shear: Doubles = np.zeros(stress.shape[1:])
        self.principal: Doubles | None = None
        self.directions: Doubles | None = None
        self.largest_von_mises: dict[str, float] = {}
        self.largest_shear: dict[str, float] = {}
        self.dx: float = scene.struct.dx
        self.dy: float = scene.struct.dy

    def plot_section(self, x: float | None = None, y: float | None = None, of: str = "von_mises", axes: Axes | None = None) -> Axes:
        """Draws a stress in a plane across the body, with a cross at the largest.

        Parameters
        ----------
        x, y : float, optional
            The plane, from the middle of the grid: exactly one of them. Neither: y = 0.
        of : str
            "von_mises", "maximum_shear", or a component: "zz".
        axes : matplotlib.axes.Axes, optional
            Where to draw; by default the axes of a new figure.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, to add to or to save.
        """
        from ._plot import plot_section

        return plot_section(self, x, y, of, axes)

    def plot_depth(self, x: float = 0.0, y: float = 0.0, axes: Axes | None = None) -> Axes:
        """Draws stresses over the depth, below one element.

        Parameters
        ----------
        x, y : float
            The place, from the middle of the grid.
        axes : matplotlib.axes.Axes, optional
            Where to draw; by default the axes of a new figure.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, to add to or to save.
        """
        from ._plot import plot_depth

        return plot_depth(self, x, y, axes)


def subsurface(
    scene: Scene,
    pressure: Doubles,
    depths: npt.ArrayLike,
    traction: tuple[npt.ArrayLike, npt.ArrayLike] | None,
    body: int,
    principal: bool,
    threads: int,
) -> SubsurfaceStress:
    """See `Result.subsurface`."""
    levels = doubles("depths", np.atleast_1d(depths), dimensions="n")
    shape = (levels.size, *scene.shape)
    outputs = initialised("stress_outputs")
    stress = np.zeros((6, *shape))
    found = SubsurfaceStress(levels, stress, scene)
    for c in range(6):
        outputs.stress[c] = pointer(stress[c])
    outputs.von_mises, outputs.maximum_shear = pointer(found.von_mises), pointer(found.maximum_shear)
    if principal:
        found.principal, found.directions = np.zeros((3, *shape)), np.zeros((3, *shape, 3))
        for k in range(3):
            outputs.principal[k], outputs.directions[k] = pointer(found.principal[k]), pointer(found.directions[k])
    largest = [initialised("stress_maximum") for _ in range(2)]
    outputs.largest_von_mises, outputs.largest_shear = map(ctypes.pointer, largest)
    tractions = [None, None] if traction is None else [doubles(f"traction[{k}]", traction[k], scene.shape) for k in range(2)]
    given = [None if array is None else pointer(array) for array in (pressure, *tractions)]
    struct = options({"threads": threads})
    status = library.contact_normal_subsurface_stress(
        ctypes.byref(scene.struct), integer("body", body), *given, pointer(levels), levels.size, ctypes.byref(struct),
        ctypes.byref(outputs),
    )
    check(status)
    for at, name in zip(largest, ("largest_von_mises", "largest_shear")):
        values: dict[str, Any] = {key: getattr(at, key) for key in ("value", "x", "y", "z", "ix", "iy", "depth")}
        setattr(found, name, values)
    return found
