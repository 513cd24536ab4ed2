"""Converts the elastic constants and the load that a caller gives to those of the C ABI."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ._arguments import number, pair, real
from ._constants import PRESCRIBED_APPROACH, PRESCRIBED_FORCE


class Bodies(NamedTuple):
    """The elastic constants of both bodies, as the C ABI takes them.

    Attributes
    ----------
    shear_modulus, poisson_ratio : array of two doubles
        The constants of each body.
    poisson_is_known : bool
        Whether the caller gave Poisson ratios. Friction, coatings and stresses need them; pressures depend on E* only.
    """

    shear_modulus: Any
    poisson_ratio: Any
    poisson_is_known: bool = True

    @property
    def e_star(self) -> float:
        """E* of both bodies: 1/E* is the sum of (1 - nu)/(2 G) = (1 - nu^2)/E over the bodies; inf if both are rigid."""
        compliance = sum((1.0 - nu) / (2.0 * shear) for shear, nu in zip(self.shear_modulus, self.poisson_ratio) if shear != 0.0)
        return 1.0 / compliance if compliance > 0.0 else float("inf")

    def needs_poisson(self, what: str) -> None:
        """Raises an error if the caller gave E* without Poisson ratios, on which `what` depends."""
        if not self.poisson_is_known:
            raise TypeError(f"poisson_ratio is needed with e_star: {what} depends on it")

    def know_all(self, quantities: Iterable[str]) -> None:
        """Raises an error if one of the quantities is a stress, and the caller gave E* without Poisson ratios."""
        for name in quantities:
            if name in _STRESSES:
                self.needs_poisson(name)


# Quantities that depend on the Poisson ratio.
_STRESSES = {"max_von_mises", "von_mises_depth", "max_shear"}


def bodies(shear_modulus: Any, poisson_ratio: Any, young_modulus: Any, e_star: Any) -> Bodies:
    """The elastic constants of both bodies, from exactly one of shear modulus, Young's modulus and E*."""
    moduli = {"shear_modulus": shear_modulus, "young_modulus": young_modulus, "e_star": e_star}
    named = [name for name, value in moduli.items() if value is not None]
    if len(named) != 1:
        raise TypeError(f"give one of shear_modulus, young_modulus and e_star, {'and only one' if named else 'the elastic constants of the bodies'}")
    if e_star is None and poisson_ratio is None:
        raise TypeError(f"give poisson_ratio beside {named[0]}")
    nu = pair("poisson_ratio", 0.0 if poisson_ratio is None else poisson_ratio)
    if shear_modulus is not None:
        return Bodies(pair("shear_modulus", shear_modulus), nu)
    if young_modulus is not None:
        young = pair("young_modulus", young_modulus)
        _refuse_unless_positive("young_modulus", young)
        # nu = -1 is refused by the library.
        return Bodies(pair("shear_modulus", tuple(0.5 * e / (1.0 + n) if n != -1.0 else e for e, n in zip(young, nu))), nu)
    star = number("e_star", e_star)
    _refuse_unless_positive("e_star", [star])
    # Each body gets half of the compliance 1/E*: (1 - nu)/(2 G) = 1/(2 E*), so G = E* (1 - nu). The library refuses nu = 1.
    return Bodies(pair("shear_modulus", tuple(star * (1.0 - n) if n != 1.0 else star for n in nu)), nu, poisson_ratio is not None)


def _refuse_unless_positive(name: str, values: Any) -> None:
    for value in values:
        if not value > 0.0:
            raise ValueError(f"{name} is {value}; it must be positive")


def load(approach: Any, force: Any, mean_pressure: Any = None, area: float = 0.0) -> tuple[int, float]:
    """Which load is prescribed, as PRESCRIBED_APPROACH or PRESCRIBED_FORCE, and its value. A mean pressure is converted to a force on the area of the grid."""
    if (approach is not None) + (force is not None) + (mean_pressure is not None) != 1:
        raise TypeError(f"give either approach or force{', or mean_pressure' if area else ''}, and only one of them")
    if approach is not None:
        return PRESCRIBED_APPROACH, number("approach", approach)
    if force is not None:
        return PRESCRIBED_FORCE, number("force", force)
    return PRESCRIBED_FORCE, number("mean_pressure", mean_pressure) * area


def loads_of_each(count: int, approach: Any, force: Any, mean_pressure: Any) -> list[dict[str, Any]]:
    """The load arguments of each problem of a batch. Each load is given as one value for all problems, or as one for each."""

    def of_each(name: str, values: Any) -> list[Any]:
        if values is None:
            return [None] * count
        array = real(name, values)
        if array.shape not in ((), (count,)):
            raise ValueError(f"{name} has shape {array.shape}; it must be one value, or {count}: one for each problem")
        return [float(value) for value in np.broadcast_to(array, (count,))]

    names = ("approach", "force", "mean_pressure")
    columns = (of_each(name, values) for name, values in zip(names, (approach, force, mean_pressure)))
    return [dict(zip(names, loads)) for loads in zip(*columns)]
