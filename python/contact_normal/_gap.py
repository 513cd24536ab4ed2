"""The class `Gap`: the undeformed distance of two surfaces on a grid, and what a solve, a picture or a program in C or Fortran needs of it."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ._grid import centres
from ._short import Short
from ._units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._arguments import Doubles
    from ._result import Result

# The first line of each file that `Gap.write` writes.
_HEAD = "# Undeformed distance on a grid, made by contact-normal"


@dataclass(frozen=True, eq=False, repr=False)
class Gap(Short):
    """The undeformed distance of two surfaces on a grid of rectangular elements.

    The properties x and y are the coordinates of the centres of columns and rows.

    Attributes
    ----------
    h : ndarray, (my, mx)
        Undeformed distance of each element, a length; x runs along a row. +inf: no surface there.
    dx, dy : float
        Element sizes, lengths.
    middle : (float, float)
        The middle of the grid in the coordinates of the surfaces.
    period : {"x", "y", "xy"} or None
        Directions in which the grid is one period of a scene that repeats itself.
    units : (str, str) or None
        Names of the units of lengths and forces.
    """

    h: Doubles
    dx: float
    dy: float
    middle: tuple[float, float] = (0.0, 0.0)
    period: str | None = None
    units: Units = None

    _INSTEAD: ClassVar[str] = "call its solve(...), or pass its h, dx and dy"

    @property
    def x(self) -> Doubles:
        """Coordinates of the centres of the columns, (mx,)."""
        return centres(self.h.shape[1], self.dx, self.middle[0])

    @property
    def y(self) -> Doubles:
        """Coordinates of the centres of the rows, (my,)."""
        return centres(self.h.shape[0], self.dy, self.middle[1])

    @property
    def area(self) -> float:
        """Area of the grid: the number of elements times the area of one. A mean pressure is a force over this area."""
        return float(self.h.size * self.dx * self.dy)

    def solve(self, **scene: Any) -> Result:
        """Presses the two surfaces together: calls `contact_normal.solve` for this gap.

        The arguments are a load, elastic constants, effects and options. Coordinates in the result are those of the surfaces. Coordinates in arguments, as
        `spin_centre`, are relative to the middle of the grid.
        """
        from ._solve import solve

        result = solve(self.h, self.dx, self.dy, **{"period": self.period, "units": self.units, **scene})
        result._centre = self.middle
        return result

    def write(self, path: str | os.PathLike[str], comment: str = "") -> None:
        """Writes the gap as a text file, which the examples `gap.c` and `gap.f90` read.

        The file has two lines that begin with "#", then a line `mx my dx dy`, then one undeformed distance per line, x fastest; "inf": no surface there. The
        second line has the period, if there is one, and the comment. The middle and the units are not in the file.
        """
        if "\n" in comment or "\r" in comment:
            raise ValueError("comment has several lines; it must be one")
        my, mx = self.h.shape
        period = f"period {self.period or 'none'}: " if self.period or comment.startswith("period ") else ""
        lines = [_HEAD, f"# {period}{comment}", f"{mx} {my} {float(self.dx)!r} {float(self.dy)!r}", *(repr(float(value)) for value in self.h.flat)]
        Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")

    @staticmethod
    def is_in(path: str | os.PathLike[str]) -> bool:
        """Whether a file was written by `write`."""
        with open(path, "rb") as file:
            return file.readline().rstrip() == _HEAD.encode()

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Gap:
        """Reads the gap from a file that was written by `write`."""
        lines = Path(path).read_text(encoding="utf-8").rstrip("\n").split("\n")
        if len(lines) < 3 or lines[0] != _HEAD:
            raise ValueError(f"{path} does not begin with {_HEAD!r}: it is no file of a gap")
        try:
            first, second, third, fourth = lines[2].split()
            mx, my, dx, dy = int(first), int(second), float(third), float(fourth)
        except ValueError:
            raise ValueError(f"{path} has {lines[2]!r} in line 3; it must have mx my dx dy") from None
        if min(mx, my) < 1 or not (0.0 < dx < np.inf and 0.0 < dy < np.inf):
            raise ValueError(f"{path} has {lines[2]!r} in line 3; mx, my, dx and dy must be positive")
        try:
            h = np.array([float(line) for line in lines[3:]])
        except ValueError as error:
            raise ValueError(f"{path}: {error}; there must be one undeformed distance a line") from None
        if h.size != mx * my:
            raise ValueError(f"{path} has {h.size} distances; {mx} x {my} elements need {mx * my}")
        period = re.match("# period (xy|x|y): ", lines[1])
        return cls(h.reshape(my, mx), dx, dy, period=period[1] if period else None)

    def plot(self, axes: Axes | None = None, largest: float | None = None) -> Axes:
        """Draws the undeformed distance. If `largest` is given, the colours end at this distance. Elements without a surface are white."""
        from ._plot_surfaces import plot_gap

        return plot_gap(self, axes, largest)
