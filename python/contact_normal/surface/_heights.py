"""The class `Heights`: heights of a surface on a grid, in the layout of the library's arrays."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from .._arguments import flag, number, real, refuse_x_first, two, without_mask
from .._grid import centres
from .._short import Short
from .._units import Units, checked

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from .._arguments import Doubles

# Coordinates are evenly spaced if their spacings differ by at most this part. Files write coordinates with at least five digits.
_EQUAL = 1e-3

# Slopes outside of these limits show that heights and sizes are in different units. The median slope of a surface is below _STEEP, that of normally
# distributed slopes with an rms of 1. At least one slope of ten is above _LEVEL: smaller slopes arise from heights in m with sizes in um. The test needs
# _STEPS slopes.
_STEEP, _STEPS, _LEVEL = 0.67, 64, 2e-7

# The number of elements of a block. Temporary arrays for a block have some megabytes.
_BLOCK = 1 << 18


def blocks(shape: tuple[int, ...]) -> Iterator[slice]:
    """Yields slices of rows that divide an array into blocks, so that temporary arrays for large maps stay small."""
    rows = max(1, _BLOCK // max(shape[1], 1))
    for first in range(0, shape[0], rows):
        yield slice(first, min(first + rows, shape[0]))


@dataclass(frozen=True, eq=False, repr=False)
class Heights(Short):
    """Heights of a surface on a grid of elements, positive out of the material.

    The properties x and y are the coordinates of the centres of columns and rows, relative to the middle of the grid.

    Attributes
    ----------
    z : ndarray, (my, mx)
        Heights, lengths; x runs along a row. NaN: not measured.
    dx, dy : float
        Element sizes.
    period : {"x", "y", "xy"} or None
        Directions in which the grid is one period of the surface.
    units : (str, str) or None
        Names of the units of lengths and forces.
    """

    z: Doubles
    dx: float
    dy: float
    period: str | None = None
    units: Units = None

    _INSTEAD: ClassVar[str] = "make a gap of them by surface.gap(...), and call its solve(...)"

    @property
    def x(self) -> Doubles:
        """Coordinates of the centres of the columns, relative to the middle of the grid, (mx,)."""
        return centres(self.z.shape[1], self.dx)

    @property
    def y(self) -> Doubles:
        """Coordinates of the centres of the rows, relative to the middle of the grid, (my,)."""
        return centres(self.z.shape[0], self.dy)

    @property
    def holes(self) -> npt.NDArray[np.bool_]:
        """The elements that were not measured."""
        return np.isnan(self.z)

    @property
    def area(self) -> float:
        """Area of the grid: the number of elements times the area of one."""
        return float(self.z.size * self.dx * self.dy)

    def force(self, mean_pressure: float) -> float:
        """The force that has this mean pressure over the area of the whole grid, holes included."""
        return number("mean_pressure", mean_pressure) * self.area

    def without(self, where: npt.ArrayLike) -> Heights:
        """The heights with holes where the mask `where`, an array of booleans, is True."""
        mask = np.asarray(where)
        if mask.dtype != bool or mask.shape != self.z.shape:
            raise ValueError(f"where has shape {mask.shape} and dtype {mask.dtype}; it must be a mask of booleans, {self.z.shape}")
        return dataclasses.replace(self, z=np.where(mask, np.nan, self.z))

    def turned_over(self, about: str = "y") -> Heights:
        """The surface of a body that is turned over about an axis along x or y, so that it can lie on another body.

        Turned about y, the columns are in reverse order; turned about x, the rows. The heights keep their sign.
        """
        if about not in ("x", "y"):
            raise ValueError(f'about is {about!r}; it must be "x" or "y"')
        return dataclasses.replace(self, z=np.ascontiguousarray(self.z[:, ::-1] if about == "y" else self.z[::-1]))

    def plot(self, axes: Axes | None = None, marked: npt.ArrayLike | None = None) -> Axes:
        """Draws the heights; holes are white, and elements of the mask `marked` are red."""
        from .._plot_surfaces import plot_heights

        return plot_heights(self, axes, marked)


def refuse_others(**given: Any) -> None:
    """Raises an error for arguments that are not Heights, as arrays, which have no element sizes."""
    for name, one in given.items():
        if not isinstance(one, Heights):
            raise TypeError(f"{name} is a {type(one).__name__}; it must be Heights: surface.heights(values, dx, dy)")


def _spacing(name: str, places: Any, count: int) -> tuple[float, bool]:
    """The spacing of `count` evenly spaced coordinates, and whether they decrease."""
    values = real(name, places)
    if count < 2:
        raise ValueError(f"{name} has one place, which tells no spacing: give dx and dy in the place of x and y")
    if values.shape != (count,):
        raise ValueError(f"{name} has shape {values.shape}; it must be ({count},): the centre of each element")
    steps = np.diff(values)
    d = float(steps.mean())
    if not np.abs(steps - d).max() <= _EQUAL * abs(d):
        raise ValueError(f"{name} is not evenly spaced: from {np.abs(steps).min():.6g} to {np.abs(steps).max():.6g}")
    return abs(d), d < 0.0


def _plain(values: Any) -> Doubles:
    """`values` as a two-dimensional array of doubles, with NaN where elements were not measured."""
    z = real("values", without_mask("values", values))
    if z.ndim != 2 or not z.size:
        raise ValueError(f"values has shape {z.shape}; heights have two indices{'' if z.size else ', and one element at least'}")
    return np.asarray(np.where(np.isfinite(z), z, np.nan))


def _element_sizes(
    shape: tuple[int, ...], dx: Any, dy: Any, size: Any, span: Any, x: Any, y: Any
) -> tuple[tuple[float, float], tuple[bool, bool]]:
    """The sizes (dx, dy) of an element, from the one way in which they are given, and whether the coordinates x and y decrease."""
    my, mx = shape
    ways = (dx is not None or dy is not None, size is not None, span is not None, x is not None or y is not None)
    if sum(ways) != 1:
        raise TypeError("give the size of an element in one way: dx and dy, or size, or span, or x and y")
    falls = False, False
    if ways[0]:
        if dx is None or dy is None:
            raise TypeError(f"give {'dx' if dx is None else 'dy'}, too: elements have a size in x and one in y")
        sizes = number("dx", dx), number("dy", dy)
    elif ways[1]:
        lx, ly = two("size", size)
        sizes = lx / mx, ly / my
    elif ways[2]:
        if min(mx, my) < 2:
            raise ValueError(f"span needs at least 2 samples in each direction; there are {mx} and {my}")
        lx, ly = two("span", span)
        sizes = lx / (mx - 1), ly / (my - 1)
    else:
        (one, x_falls), (other, y_falls) = _spacing("x", x, mx), _spacing("y", y, my)
        sizes, falls = (one, other), (x_falls, y_falls)
    if not all(d > 0.0 and np.isfinite(d) for d in sizes):
        raise ValueError(f"element sizes are {sizes[0]} and {sizes[1]}; they must be positive and finite")
    return sizes, falls


def heights(
    values: npt.ArrayLike,
    dx: float | None = None,
    dy: float | None = None,
    *,
    size: tuple[float, float] | None = None,
    span: tuple[float, float] | None = None,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    axes: str = "yx",
    top_first: bool = False,
    fill: float | None = None,
    period: str | None = None,
    units: tuple[str, str] | None = None,
) -> Heights:
    """Makes `Heights` from an array and the size of an element. The array is transposed and reversed so that x grows along a row, and y from row to row.

    Parameters
    ----------
    values : array_like
        Heights. Elements that are NaN, infinite or masked were not measured.
    dx, dy : float
        Element sizes. Instead of them one of `size`, `span`, or `x` and `y`:
    size : (float, float)
        Lengths of the measured field in x and in y: those of mx and of my elements.
    span : (float, float)
        Lengths from the first to the last sample: those of mx - 1 and of my - 1 elements.
    x, y : array_like, (mx,) and (my,)
        Coordinates of the samples. If they decrease, the array is reversed.
    axes : {"yx", "xy"}
        The meaning of the indices of `values`: "yx": values[iy, ix]; "xy": values[ix, iy].
    top_first : bool
        Whether the first row has the largest y, as in an image. Decreasing coordinates y have the same meaning. Increasing ones contradict it, and are
        refused, also in files.
    fill : float, optional
        A fill value, which means "not measured", in the unit of the array. `faults` finds unknown fill values. There is a warning if no element has the value.
    period : {"x", "y", "xy"}, optional
        Directions in which the surface is periodic.
    units : (str, str), optional
        Names of the units of lengths and forces, as ("mm", "N").

    Returns
    -------
    Heights
    """
    if axes == "yx":
        refuse_x_first("values", values)
    z = _plain(values)
    if axes not in ("yx", "xy"):
        raise ValueError(f'axes is {axes!r}; it must be "yx" or "xy"')
    if period not in (None, "x", "y", "xy"):
        raise ValueError(f'period is {period!r}; it must be "x", "y" or "xy"')
    z = z.T if axes == "xy" else z
    (one, other), (x_falls, y_falls) = _element_sizes(z.shape, dx, dy, size, span, x, y)
    if flag("top_first", top_first) and y is not None and not y_falls:
        raise ValueError("y rises: its first row has the smallest y; leave out top_first")
    z = z[:: -1 if top_first or y_falls else 1, :: -1 if x_falls else 1]
    if fill is not None:
        # The fill value is rounded to the precision of the array: in single precision -9999.9 is another number. If no element has this value, it is rounded to
        # single precision, because the reader of a file may have converted such numbers to doubles.
        dtype = getattr(values, "dtype", np.dtype(float))
        as_held = number("fill", fill)
        if dtype.kind == "f":
            as_held = float(dtype.type(as_held))
        filled = z == as_held
        if not filled.any():
            # The largest number of single precision is written as 3.4028235e38. As a double this text is larger, and may overflow when it is rounded.
            with np.errstate(over="ignore"):
                single = float(np.float32(as_held))
            filled = z == single if np.isfinite(single) else filled
        # NaN and infinite values are holes anyway.
        if np.isfinite(as_held) and not filled.any():
            warnings.warn(f"no element has the value {fill!r} that stands for 'not measured': the heights are from {np.nanmin(z):g} to {np.nanmax(z):g}"
                          if np.isfinite(z).any() else f"no element has the value {fill!r}: none was measured", stacklevel=2)
        z = np.where(filled, np.nan, z)
    _warn_of_slopes(z, one, other)
    return Heights(np.ascontiguousarray(z), one, other, period, checked(units))


def _warn_of_slopes(z: Doubles, dx: float, dy: float) -> None:
    """Warns of slopes that no surface has, because heights and element sizes are then probably in different units.

    The test uses quantiles of the slopes, so that fill values and spikes have no effect.
    """
    for name, axis, d in (("x", 1, dx), ("y", 0, dy)):
        steps = np.abs(np.diff(z[:: max(1, len(z) // 64)] if axis == 1 else z[:, :: max(1, z.shape[1] // 64)], axis=axis))
        steps = steps[np.isfinite(steps)]
        if steps.size < _STEPS:
            continue
        half, most = np.quantile(steps, [0.5, 0.9]) / d
        if half > _STEEP or 0.0 < most < _LEVEL:
            told = f"half of the slopes in {name} are steeper than {half:.2g}" if half > _STEEP else f"nine of ten slopes in {name} are below {most:.2g}"
            warnings.warn(f"{told}: heights and sizes of elements must be in one unit, as nm and nm, not um and mm", stacklevel=3)
            return
