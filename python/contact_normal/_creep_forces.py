"""Tables of creep forces, and the interpolation between their entries."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _netcdf as netcdf
from ._arguments import both, flag, real
from ._creep_force_plane import AXES

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ._arguments import Doubles

VALUES = ("force_x", "force_y", "moment", "error", "residual", "products", "status")


class CreepForceTable:
    """A table of tangential forces and spin moments by creepages and spin, with an estimated error of each entry.

    Attributes
    ----------
    axis_ratio, poisson_ratio, phi, eta, xi : ndarray
        The values along the axes. For a surface axis_ratio and poisson_ratio have one value without a meaning.
    force_x, force_y, moment : ndarray, (axis_ratio, poisson_ratio, phi, eta, xi)
        Forces and moment. For ellipses they are relative to mu N and to mu N c; for a surface they are in the caller's units.
    error : ndarray, of that shape
        Estimated error of the forces relative to mu N, and of the moment relative to mu N times the radius of the contact area.
    residual, products : ndarray, of that shape
        The residual of the tractions of each entry, and the number of products that it took. A product is that of the tangential problem, of two components.
    status : ndarray of int, of that shape
        0 (OK), or another status of `friction_batch`. Entries with a status < 0 are NaN.
    of_surface : bool
        Whether the table is that of a surface, and not of ellipses.
    elements : int
        Elements along each side of the grid; 0 for a surface.
    """

    def __init__(self, axes: Mapping[str, Doubles], values: Mapping[str, Any], elements: int, tolerance: float, of_surface: bool,
                 mirrored: bool, plan_key: str) -> None:
        self.axis_ratio, self.poisson_ratio, self.phi, self.eta, self.xi = (np.asarray(axes[name], dtype=float) for name in AXES)
        self.force_x, self.force_y, self.moment, self.error, self.residual, self.products, self.status = (values[name] for name in VALUES)
        self.elements, self.tolerance, self.of_surface = elements, tolerance, of_surface
        self._mirrored, self._key = mirrored, plan_key

    def __repr__(self) -> str:
        shape = " x ".join(str(m) for m in self.error.shape)
        return f"<CreepForceTable: {shape} entries, largest error {np.nanmax(self.error):.2g}>"

    def to_xarray(self) -> Any:
        """Returns the table as an `xarray.Dataset` with the names of the attributes."""
        dataset = netcdf.xarray(in_files=False).Dataset(
            {name: (AXES, getattr(self, name)) for name in VALUES}, {name: getattr(self, name) for name in AXES},
            {"elements": self.elements, "tolerance": self.tolerance, "of_surface": int(self.of_surface),
             "mirrored": int(self._mirrored), "plan": self._key})
        if not self.of_surface:
            dataset.attrs["units"] = ("c = sqrt(a b); xi, eta: G c^2/(mu N) times the creepages; phi: G c^3/(mu N) times the spin; "
                                      "force: over mu N; moment: over mu N c")
        return dataset

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the table as NetCDF, whole or not at all. Needs xarray and netCDF4."""
        netcdf.write(path, self.to_xarray())

    @staticmethod
    def read(path: str | os.PathLike[str]) -> CreepForceTable:
        """Reads a table that `write` or `creep_force_table` has written."""
        dataset = netcdf.read(path)
        if not set(VALUES) <= set(dataset.data_vars):
            raise ValueError(f"{path} is no table of creep forces")
        told = dataset.attrs
        return CreepForceTable({name: dataset[name].values for name in AXES}, {name: dataset[name].values for name in VALUES},
                               int(told["elements"]), float(told["tolerance"]), bool(told["of_surface"]), bool(told["mirrored"]),
                               str(told["plan"]))

    def forces(self, xi: npt.ArrayLike, eta: npt.ArrayLike, phi: npt.ArrayLike, *, axis_ratio: npt.ArrayLike = 1.0,
               poisson_ratio: npt.ArrayLike | None = None, hold: bool = False) -> tuple[Doubles, Doubles, Doubles, Doubles]:
        """Interpolates forces, moment and error between the entries: linearly along each axis, along axis_ratio in its logarithm.

        Symmetries extend the table to other signs. If xi, eta and phi change their signs, so do forces and moment. For ellipses, if eta and phi alone change
        their signs, so do force_y and moment. So (-xi, eta, phi) has (-force_x, force_y, moment).

        Parameters
        ----------
        xi, eta, phi : array_like
            Creepages and spin in the units of the table. Arrays are broadcast.
        axis_ratio, poisson_ratio : array_like
            For ellipses only. The Poisson ratio may be left out if the table has only one.
        hold : bool
            True: arguments beyond the end of an axis are replaced by that end, and the results are NaN where an argument is NaN. False: both raise an error.

        Returns
        -------
        force_x, force_y, moment, error : ndarray

        Raises
        ------
        ValueError
            If a value is outside the table, without `hold`.
        """
        if poisson_ratio is None:
            if len(self.poisson_ratio) > 1:
                raise TypeError("poisson_ratio is needed: this table has several")
            poisson_ratio = self.poisson_ratio[0]
        if self.of_surface:
            axis_ratio, poisson_ratio = self.axis_ratio[0], self.poisson_ratio[0]
        keys = (real(name, value) for name, value in zip(AXES, (axis_ratio, poisson_ratio, phi, eta, xi)))
        given, hold = np.broadcast_arrays(*keys), flag("hold", hold)
        ratio, nu, spin, lateral, longitudinal = (np.array(value) for value in given)
        sign, mirror = np.ones(spin.shape), np.ones(spin.shape)
        if not self.of_surface:
            # `sign` changes all signs so that xi >= 0. `mirror` then changes those of eta and phi so that phi >= 0.
            sign = np.where(longitudinal < 0, -1.0, 1.0)
            mirror = np.where(sign * spin < 0, -1.0, 1.0)
            across = sign * mirror * lateral
            is_other = self._beyond("eta", -across) < self._beyond("eta", across)
            mirror = np.where(self._is_straight(spin) & is_other, -mirror, mirror)
        elif self._mirrored:
            sign = np.where(spin < 0, -1.0, 1.0)
            here, there = (self._beyond("xi", s * longitudinal) + self._beyond("eta", s * lateral) for s in (sign, -sign))
            sign = np.where(self._is_straight(spin) & (there < here), -sign, sign)
        places = ratio, nu, sign * mirror * spin, sign * mirror * lateral, sign * longitudinal
        corners = [self._between(name, place, hold) for name, place in zip(AXES, places)]
        unknown = np.isnan(places).any(axis=0)
        force_x, force_y, moment, error = (np.where(unknown, np.nan, _interpolated(getattr(self, name), corners))
                                           for name in ("force_x", "force_y", "moment", "error"))
        return sign * force_x, sign * mirror * force_y, sign * mirror * moment, error

    def plot(self, of: str = "force_x", *, eta: float = 0.0, axis_ratio: float = 1.0, poisson_ratio: float | None = None,
             axes: Axes | None = None) -> Axes:
        """Draws creep curves: a force or the moment over the longitudinal creepage, one curve for each spin, with the estimated errors as bands.

        Parameters
        ----------
        of : str
            "force_x", "force_y" or "moment".
        eta, axis_ratio, poisson_ratio : float
            As for `forces`.
        axes
            As for `Result.plot`, which returns the axes likewise.
        """
        from ._plot_lines import plot_creep_forces

        return plot_creep_forces(self, of, eta, axis_ratio, poisson_ratio, axes)

    def _is_straight(self, spin: Doubles) -> npt.NDArray[np.bool_]:
        """Where the table is read at spin 0. There the spin does not determine the signs, and those are chosen for which the table has entries."""
        return np.asarray(np.clip(np.abs(spin), self.phi[0], self.phi[-1]) == 0.0)

    def _beyond(self, name: str, places: Doubles) -> Doubles:
        """How far values are beyond the ends of an axis; 0 inside."""
        axis = getattr(self, name)
        return np.asarray(np.maximum(np.maximum(axis[0] - places, places - axis[-1]), 0.0))

    def _between(self, name: str, values: Doubles, hold: bool) -> tuple[npt.NDArray[np.int64], Doubles]:
        """For each value the index of the entry of an axis before it, and the part of the way, 0 to 1, from this entry to the next one."""
        axis = getattr(self, name)
        if len(axis) == 1 and not hold and not np.allclose(values, axis[0], rtol=1e-12, atol=0.0):
            raise ValueError(f"{name} has values outside the table, which has {axis[0]} only")
        if len(axis) == 1:
            return np.zeros(values.shape, dtype=np.int64), np.zeros(values.shape)
        if not hold and not bool(((values >= axis[0]) & (values <= axis[-1])).all()):
            raise ValueError(f"{name} has values outside the table, which goes from {axis[0]} to {axis[-1]}; hold=True takes the values at its end")
        held = np.clip(values, axis[0], axis[-1])
        if name == "axis_ratio":
            axis, held = np.log(axis), np.log(held)
        before = np.clip(np.searchsorted(axis, held, side="right") - 1, 0, len(axis) - 2)
        part: Doubles = (held - axis[before]) / (axis[before + 1] - axis[before])
        return before, part

    def wheel_rail(self, creepage: tuple[npt.ArrayLike, npt.ArrayLike], spin: npt.ArrayLike, *, semi_axes: tuple[float, float],
                   normal_force: float, coefficient: float, shear_modulus: float, poisson_ratio: float | None = None,
                   hold: bool = False) -> tuple[Doubles, Doubles, Doubles]:
        """Computes forces in x and y and the spin moment of an elliptic contact, in the caller's units.

        Parameters
        ----------
        creepage, spin
            The creepages in x and y, without a unit; the spin, one over a length.
        semi_axes : (float, float)
            The semi-axes in the direction of rolling and across it; positive where there is a load.
        normal_force, coefficient, shear_modulus, poisson_ratio
            Of the contact; both bodies have the same elastic constants. Without a load or without friction all forces are 0.
        hold
            As for `forces`.

        Returns
        -------
        force_x, force_y, moment : ndarray
        """
        if self.of_surface:
            raise TypeError("this is the table of a surface: use `forces`")
        a, b = (real(f"semi_axes[{k}]", one) for k, one in enumerate(both("semi_axes", semi_axes)))
        load, mu = real("normal_force", normal_force), real("coefficient", coefficient)
        for name, value in (("normal_force", load), ("coefficient", mu)):
            if np.any(value < 0.0):
                raise ValueError(f"{name} is {value}; it must not be negative")
        modulus = real("shear_modulus", shear_modulus)
        if np.any(modulus <= 0.0):
            raise ValueError(f"shear_modulus is {shear_modulus}; it must be positive")
        bound = np.asarray(mu * load)
        if np.any((bound > 0.0) & (_is_no_length(a) | _is_no_length(b))):
            raise ValueError(f"semi_axes is {semi_axes}; they must be positive and finite where there is a load")
        # Without a load the semi-axes have no effect: they are set to 1.
        a, b = (np.where(_is_no_length(one) | (bound == 0.0), 1.0, one) for one in (a, b))
        c = np.sqrt(a * b)
        if not bound.any():
            shape = np.broadcast_shapes(bound.shape, *(np.shape(one) for one in (*both("creepage", creepage), spin, a, b)))
            return np.zeros(shape), np.zeros(shape), np.zeros(shape)
        along, across = (real(f"creepage[{k}]", one) for k, one in enumerate(both("creepage", creepage)))
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            unit = modulus * c * c / np.where(bound > 0.0, bound, np.inf)
            empty = (bound == 0.0) | np.isinf(unit)
            # Without a load the forces are set to 0 below. Until then the first entry of the table takes the place of the arguments.
            axes = ((self.xi, along), (self.eta, across), (self.phi, c * real("spin", spin)))
            xi, eta, phi = (np.where(empty, axis[0], unit * value) for axis, value in axes)
            ratio = np.where(empty, self.axis_ratio[0], a / b)
        nu = None if poisson_ratio is None else np.where(empty, self.poisson_ratio[0], real("poisson_ratio", poisson_ratio))
        x, y, moment, _ = self.forces(xi, eta, phi, axis_ratio=ratio, poisson_ratio=nu, hold=hold)
        force_x, force_y, spin_moment = (np.where(empty, 0.0, bound * one) for one in (x, y, c * moment))
        return force_x, force_y, spin_moment


def _is_no_length(values: Doubles) -> npt.NDArray[np.bool_]:
    """Whether a semi-axis is infinite or not positive. NaN passes: its forces are NaN."""
    return np.asarray((values <= 0.0) | np.isinf(values))


def _interpolated(values: Doubles, corners: Sequence[tuple[Any, Any]]) -> Doubles:
    """Interpolates linearly: sums the values at the corners of each cell times their weights."""
    total: Doubles = np.zeros(corners[0][0].shape)
    for corner in np.ndindex(*(2,) * len(corners)):
        weight, index = np.ones(total.shape), []
        for (before, part), size, after in zip(corners, values.shape, corner):
            weight = weight * (part if after else 1.0 - part)
            index.append(np.minimum(before + after, size - 1))
        # An entry that is NaN has no effect where its weight is 0.
        total += np.where(weight > 0, weight * values[tuple(index)], 0.0)
    return total
