"""One plane of a table of creep forces: all creepages (eta, xi) for one ellipse, or surface, and one spin. Worker processes call `plane`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import distances, number, real, shaped
from ._constants import OK
from ._friction_batch import FrictionBatch, friction_batch
from ._solve import solve

if TYPE_CHECKING:
    from ._arguments import Doubles

AXES = ("axis_ratio", "poisson_ratio", "phi", "eta", "xi")
_MOTION = "STEADY_ROLLING"
# The pressure of an element of an ellipse is the mean of Hertz's pressures at this number of points along each of its sides.
_PLACES = 4
# The entries that the argument `surface` must have in addition to a load, and those that it may have.
_NEEDED = ("h", "dx", "dy", "shear_modulus", "poisson_ratio", "coefficient")
_MAY = ("rolling_direction", "spin_centre", "spin_offset")
_KNOWN = (*_NEEDED, *_MAY, "force", "approach")


@dataclass(frozen=True)
class Plan:
    """The axes and settings of a table. Every process or machine that computes a part of the table gets the same plan.

    `surface` is None for a table of ellipses, otherwise the result of `prepared`.
    """

    axis_ratio: tuple[float, ...]
    poisson_ratio: tuple[float, ...]
    phi: tuple[float, ...]
    eta: tuple[float, ...]
    xi: tuple[float, ...]
    elements: int
    tolerance: float
    surface: dict[str, dict[str, Any]] | None = field(default=None, compare=False)

    @property
    def shape(self) -> tuple[int, int, int, int, int]:
        """The numbers of entries along axis_ratio, poisson_ratio, phi, eta and xi."""
        ratio, nu, phi, eta, xi = (len(getattr(self, name)) for name in AXES)
        return ratio, nu, phi, eta, xi

    @property
    def planes(self) -> int:
        """The number of planes: one for each axis ratio, Poisson ratio and spin."""
        return len(self.axis_ratio) * len(self.poisson_ratio) * len(self.phi)

    @property
    def coarse_elements(self) -> int:
        """Elements along each side of the coarse grid, which serves to estimate errors."""
        return (self.elements + 1) // 2


def ellipse(elements: int, axis_ratio: float) -> tuple[Doubles, float, float]:
    """Hertz's pressures on an ellipse with sqrt(a b) = 1 and a force of 1, as means over elements, and the element sizes dx and dy."""
    a, b = np.sqrt(axis_ratio), 1.0 / np.sqrt(axis_ratio)
    places = (np.arange(elements * _PLACES) + 0.5) * 2.0 / (elements * _PLACES) - 1.0
    fine = np.sqrt(np.maximum(0.0, 1.0 - places[None, :] ** 2 - places[:, None] ** 2))
    pressure: Doubles = fine.reshape(elements, _PLACES, elements, _PLACES).mean(axis=(1, 3))
    dx, dy = 2.0 * a / elements, 2.0 * b / elements
    return pressure / (pressure.sum() * dx * dy), dx, dy


def _halves(h: Doubles) -> tuple[int, int]:
    """The factors by which elements grow in y and in x: 2, or 1 in a direction with one element."""
    by_y, by_x = (2 if m > 1 else 1 for m in h.shape)
    return by_y, by_x


def halved(h: Doubles) -> Doubles:
    """The values of a field on elements twice as large in each direction that has several elements.

    The value of a large element is the mean of the finite values of its small elements, or inf if it has none.
    """
    by_y, by_x = _halves(h)
    padded = np.pad(h, [(0, m % by) for m, by in zip(h.shape, (by_y, by_x))], constant_values=np.inf)
    my, mx = padded.shape
    parts = padded.reshape(my // by_y, by_y, mx // by_x, by_x)
    finite = np.isfinite(parts)
    count = finite.sum(axis=(1, 3))
    sums = np.where(finite, parts, 0.0).sum(axis=(1, 3))
    coarse: Doubles = np.where(count > 0, sums / np.maximum(count, 1), np.inf)
    return coarse


def prepared(surface: Mapping[str, Any], tolerance: float) -> dict[str, dict[str, Any]]:
    """Solves the normal problem of a surface on its grid and on one of elements twice as large, once for all planes of a table.

    Returns the arguments of `friction_batch` on both grids, as "fine" and "coarse".
    """
    unknown, missing = sorted(set(surface) - set(_KNOWN)), [name for name in _NEEDED if name not in surface]
    if unknown or missing or ("force" in surface) == ("approach" in surface):
        raise ValueError(f"surface has {', '.join(surface)}; it must have {', '.join(_NEEDED)}, either force or approach, "
                         "and may have rolling_direction, spin_centre, spin_offset")
    h = shaped("surface['h']", distances("surface['h']", surface["h"]))
    (my, mx), (x, y) = h.shape, surface.get("spin_centre", (0.0, 0.0))
    dx, dy = (number(f"surface['{name}']", surface[name]) for name in ("dx", "dy"))
    mu = real("surface['coefficient']", surface["coefficient"])
    by_y, by_x = _halves(h)
    # `halved` pads an odd number of elements by one, which moves the middle of the grid.
    centre = x - 0.5 * (mx % by_x) * dx, y - 0.5 * (my % by_y) * dy
    fine = {**surface, "h": h, "coefficient": mu}
    coarse = {**fine, "h": halved(h), "dx": by_x * dx, "dy": by_y * dy, "spin_centre": centre,
              "coefficient": halved(mu) if mu.ndim else mu}
    if by_y > by_x:
        # By default the step of rolling is dx, which does not grow in a grid of one column.
        coarse["rolling_distance"] = by_y * dx
    return {"fine": _pressed(fine, tolerance), "coarse": _pressed(coarse, tolerance)}


def _pressed(surface: Mapping[str, Any], tolerance: float) -> dict[str, Any]:
    """Solves the normal problem of a surface on one grid, and returns the arguments of `friction_batch` with its pressures."""
    given = {name: surface[name] for name in ("dx", "dy", "shear_modulus", "poisson_ratio")}
    load = {name: surface[name] for name in ("force", "approach") if name in surface}
    result = solve(surface["h"], **given, **load, tolerance=min(tolerance, 1e-6))
    if result.status != OK:
        raise ValueError(f"the normal problem of the surface is not solved: {result.message}")
    friction = {name: surface[name] for name in ("coefficient", *_MAY, "rolling_distance") if name in surface}
    return {"h": None, "pressure": result.pressure, **given, "friction": {**friction, "motion": _MOTION}}


def _grids(plan: Plan, ratio: int, nu: int) -> list[dict[str, Any]]:
    """The arguments of `friction_batch` on the fine and on the coarse grid. `ratio` and `nu` are indices of the axis ratio and the Poisson ratio."""
    if plan.surface is not None:
        return [plan.surface["fine"], plan.surface["coarse"]]
    grids = []
    for elements in (plan.elements, plan.coarse_elements):
        pressure, dx, dy = ellipse(elements, plan.axis_ratio[ratio])
        grids.append({"h": None, "pressure": pressure, "dx": dx, "dy": dy, "shear_modulus": 1.0,
                      "poisson_ratio": plan.poisson_ratio[nu], "friction": {"coefficient": 1.0, "motion": _MOTION}})
    return grids


def _scales(grid: dict[str, Any]) -> tuple[float, float]:
    """The scales of errors: mu N, and the radius of a circle with the area of the contact."""
    area = grid["dx"] * grid["dy"]
    force = float((grid["friction"]["coefficient"] * np.maximum(grid["pressure"], 0.0)).sum() * area)
    return force, float(np.sqrt((grid["pressure"] > 0).sum() * area / np.pi))


def plane(plan: Plan, index: int) -> dict[str, Any]:
    """Solves plane `index` of a table on one thread. Returns arrays (eta, xi) by name:

    - "force_x", "force_y", "moment", "residual": the values on the fine grid.
    - "products": the products on both grids, those of the coarse grid weighted by the ratio of the numbers of elements.
    - "status": the status on the fine grid, or, if that is OK, on the coarse grid.
    - "difference": the estimated change of forces and moment from the fine grid to infinitely fine elements, for convergence of first order. It is the root of
      the sum of squares of the changes. Those of forces are relative to mu N, that of the moment to mu N times the radius of the contact area.
    """
    ratios, nus, phis, rows, columns = plan.shape
    ratio, nu, spin = np.unravel_index(index, (ratios, nus, phis))
    eta, xi = (np.asarray(axis) for axis in (plan.eta, plan.xi))
    entries = np.empty((rows, columns, 3))
    entries[..., 0], entries[..., 1], entries[..., 2] = xi[None, :], eta[:, None], plan.phi[spin]
    # The entries of every other row are reversed, so that neighbours in the list are neighbours in the plane: each solve starts from the one before.
    entries[1::2] = entries[1::2, ::-1]
    grids = _grids(plan, int(ratio), int(nu))
    fine, coarse = (_solved(grid, entries.reshape(-1, 3), plan.tolerance) for grid in grids)
    force, radius = _scales(grids[0])
    # The coarse grid of a grid of one element is the same grid. Then the change is 0, and the growth of the elements is set to 1.
    growth = max(grids[1][d] / grids[0][d] for d in ("dx", "dy")) - 1.0 or 1.0
    changes = np.column_stack([fine.force - coarse.force, (fine.moment - coarse.moment) / radius])
    # Without friction mu N and all changes are 0.
    changes /= force * growth if force > 0.0 else 1.0
    found = {"force_x": fine.force[:, 0], "force_y": fine.force[:, 1], "moment": fine.moment, "residual": fine.residual,
             "products": fine.products + coarse.products * (grids[1]["pressure"].size / grids[0]["pressure"].size),
             "status": np.where(fine.status != 0, fine.status, coarse.status), "difference": np.sqrt((changes**2).sum(axis=1))}
    arrays = {name: values.reshape(rows, columns) for name, values in found.items()}
    for values in arrays.values():
        values[1::2] = values[1::2, ::-1].copy()
    return arrays


def _solved(grid: dict[str, Any], entries: Doubles, tolerance: float) -> FrictionBatch:
    given = dict(grid)
    return friction_batch(given.pop("h"), given.pop("dx"), given.pop("dy"), entries, tolerance=tolerance, threads=1, **given)
