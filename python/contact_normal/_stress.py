"""The class `SubsurfaceStress`: stresses below the surface of a body."""

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
        Coordinates of the centres of the elements, relative to the middle of the grid.
    xx, yy, zz, xy, xz, yz : ndarray, (n, my, mx), or None
        The components of stress; None: not asked for.
    von_mises, maximum_shear : ndarray, (n, my, mx), or None
        The von Mises stress, and the largest shear stress at each point; None: not asked for.
    principal : ndarray, (3, n, my, mx) or None
        The principal stresses, the largest first; None unless asked for.
    directions : ndarray, (3, n, my, mx, 3) or None
        The unit vectors of their directions; None unless asked for.
    largest_von_mises, largest_shear : dict
        The largest value at all depths, and where it is: "value"; the coordinates "x" and "y", relative to the middle of the grid, and the depth "z"; the
        indices "ix", "iy" and "depth" of the element and the depth.
    dx, dy : float
        Element sizes.
    units : (str, str) or None
        Names of the units of lengths and forces, for pictures and files. The caller may set them.
    """

    def __init__(self, depths: Doubles, scene: Scene, components: Iterable[str], principal: bool) -> None:
        self.depths = depths
        # Which elements have a pressure, (my, mx); None: not known. Pictures show their border.
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
        """Changes the coordinates so that the middle of the grid is at `middle`, and sets the names of the units."""
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
        """Returns the requested stresses as an `xarray.Dataset` with coordinates, names and, if `units` are known, units. Needs xarray."""
        from ._datasets import of_stress

        return of_stress(self)

    def to_netcdf(self, path: str | os.PathLike[str]) -> None:
        """Writes the dataset of `to_xarray` as a NetCDF file, whole or not at all. Needs xarray and netCDF4."""
        from ._netcdf import write, xarray

        xarray()
        write(path, self.to_xarray())

    def plot_section(self, x: float | None = None, y: float | None = None, of: str = "von_mises", axes: Axes | None = None) -> Axes:
        """Draws a stress in a plane across the body, with a cross at its largest absolute value and triangles at the edge of the contact area.

        Parameters
        ----------
        x, y : float, optional
            The plane: x or y is constant there. By default it is the plane of the row in the middle of the grid.
        of : str
            The stress that is drawn: "von_mises", "maximum_shear", or a component as "zz".
        axes
            As for `Result.plot`, which returns the axes likewise.
        """
        from ._plot_stress import plot_stress_section

        return plot_stress_section(self, x, y, of, axes)

    def plot_depth(self, x: float | None = None, y: float | None = None, axes: Axes | None = None) -> Axes:
        """Draws stresses over the depth below the element at `x` and `y`, by default that in the middle of the grid. `axes` is as for `Result.plot`."""
        from ._plot_stress import plot_depth

        return plot_depth(self, x, y, axes)


def warn_of_depths(stress: SubsurfaceStress, deep: float) -> None:
    """Warns if the depths seem to be wrong.

    They are if all of them exceed `deep`, twice the width of the contact: its stresses are small there. They may also be if the largest von Mises stress is at
    the first or the last depth: beyond it the stress may be larger.
    """
    depths = stress.depths
    if depths.size and depths.min() > deep > 0.0:
        warnings.warn(f"depths are {depths.min():g} and more, and the contact is {0.5 * deep:.2g} wide: are depths in the unit of x and y?", stacklevel=3)
    elif depths.size > 2 and stress.von_mises is not None and np.max(stress.von_mises) > 0.0:
        z = stress.largest_von_mises["z"]
        if z == depths.max() or z == depths.min() > 0.0:
            warnings.warn(f"the largest von Mises stress is at an end of the depths, {z:g}: {'deeper' if z == depths.max() else 'higher'} it may be larger",
                          stacklevel=3)
