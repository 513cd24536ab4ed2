"""Stresses below the surface."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._grid import centres
from ._units import Units, WithUnits

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._arguments import Doubles
    from ._scene import Scene

TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")
COMPONENTS = (*TENSOR, "von_mises", "maximum_shear")


class SubsurfaceStress(WithUnits):
    """Stresses below the centres of the elements, positive in tension.

    Attributes
    ----------
    depths : ndarray, (n,)
        The depths, into the body.
    x, y : ndarray, (mx,) and (my,)
        Centres of the elements, from the middle of the grid.
    xx, yy, zz, xy, xz, yz : ndarray, (n, my, mx), or None
        The components; None: not asked for.
    von_mises, maximum_shear : ndarray, (n, my, mx), or None
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
    units : (str, str) or None
        Names of the units of lengths and forces, which pictures and files then have. May be set.
    """

    def __init__(self, depths: Doubles, scene: Scene, components: Iterable[str], principal: bool) -> None:
        self.depths = depths
        # The elements with a pressure, (my, mx).
        self._loaded: Any = None
        shape = (depths.size, *scene.shape)
        fields: list[Doubles | None] = [np.zeros(shape) if name in components else None for name in COMPONENTS]
        self.xx, self.yy, self.zz, self.xy, self.xz, self.yz, self.von_mises, self.maximum_shear = fields
        self.principal: Doubles | None = np.zeros((3, *shape)) if principal else None
        self.directions: Doubles | None = np.zeros((3, *shape, 3)) if principal else None
        self.largest_von_mises: dict[str, float] = {}
        self.largest_shear: dict[str, float] = {}
        self.dx: float = scene.struct.dx
        self.dy: float = scene.struct.dy
        my, mx = scene.shape
        self.x: Doubles = centres(mx, self.dx)
        self.y: Doubles = centres(my, self.dy)

    def _place(self, middle: tuple[float, float], units: Units) -> None:
        """Moves the middle of the grid there."""
        self.x, self.y, self._units = self.x + middle[0], self.y + middle[1], units
        for largest in (self.largest_von_mises, self.largest_shear):
            if largest:
                largest["x"] += middle[0]
                largest["y"] += middle[1]

    def __repr__(self) -> str:
        my, mx = len(self.y), len(self.x)
        told = [f"{name} {found['value']:.5g} at ({found['x']:.4g}, {found['y']:.4g}, {found['z']:.4g})"
                for name, found in (("von_mises", self.largest_von_mises), ("maximum_shear", self.largest_shear)) if found]
        return f"<SubsurfaceStress: {mx} x {my} elements, {len(self.depths)} depths; largest {', '.join(told) or 'values not asked for'}>"

    def to_xarray(self) -> Any:
        """The requested stresses as an `xarray.Dataset` with coordinates, names and, if `units` are known, units. Needs xarray."""
        from ._datasets import of_stress

        return of_stress(self)

    def to_netcdf(self, path: str | os.PathLike[str]) -> None:
        """Writes the dataset of `to_xarray` as a file, whole or not at all. Needs xarray and netCDF4."""
        from ._netcdf import write, xarray

        xarray()
        write(path, self.to_xarray())

    def plot_section(self, x: float | None = None, y: float | None = None, of: str = "von_mises", axes: Axes | None = None) -> Axes:
        """Draws a stress in a plane across the body, with a cross at the largest and triangles at the edge of the contact area.

        Parameters
        ----------
        x, y : float, optional
            The plane: one of them. Neither: the y of the middle of the grid.
        of : str
            "von_mises", "maximum_shear", or a component: "zz".
        axes
            As for `Result.plot`, which returns the axes likewise.
        """
        from ._plot_stress import plot_stress_section

        return plot_stress_section(self, x, y, of, axes)

    def plot_depth(self, x: float | None = None, y: float | None = None, axes: Axes | None = None) -> Axes:
        """Draws stresses over the depth, below the element at `x` and `y`, by default in the middle of the grid; `axes` as for `Result.plot`."""
        from ._plot_stress import plot_depth

        return plot_depth(self, x, y, axes)


def warn_of_depths(stress: SubsurfaceStress, deep: float) -> None:
    """Warns of depths that are all deeper than a contact of this width reaches, and of a largest stress at an end of them, beyond which it may be larger."""
    depths = stress.depths
    if depths.size and depths.min() > deep > 0.0:
        warnings.warn(f"depths are {depths.min():g} and more, and the contact is {0.5 * deep:.2g} wide: are depths in the unit of x and y?", stacklevel=3)
    elif depths.size > 2 and stress.von_mises is not None and np.max(stress.von_mises) > 0.0:
        z = stress.largest_von_mises["z"]
        if z == depths.max() or z == depths.min() > 0.0:
            warnings.warn(f"the largest von Mises stress is at an end of the depths, {z:g}: {'deeper' if z == depths.max() else 'higher'} it may be larger",
                          stacklevel=3)
