"""A scene and its effects as the structs of the C ABI."""

from __future__ import annotations

import copy
import ctypes
from collections.abc import Mapping
from ctypes import c_int32
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ._adhesion import adhesion
from ._arguments import both, distances, doubles, integer, integers, number, pointer, shaped
from ._bodies import bodies, load
from ._constants import PRESCRIBED_APPROACH, PRESCRIBED_FORCE, UNSUPPORTED
from ._friction import friction
from ._library import ContactNormalError, initialised
from ._visco import visco

if TYPE_CHECKING:
    from ._arguments import Doubles, Integers
    from ._friction_remarks import Remarks


class Scene:
    """A `contact_normal_scene` with the arrays and effects to which the struct points. They live as long as this object.

    Parameters
    ----------
    h : array_like
        Undeformed distance (my, mx); masked: no surface.
    dx, dy : float
        Element sizes.
    approach, force, mean_pressure : float or None
        Exactly one of them is prescribed.
    shear_modulus, poisson_ratio, young_modulus, e_star
        The elastic constants; see `solve`.
    effects : mapping
        The effects by name as arguments of `solve`; None: the effect is not simulated.
    """

    def __init__(
        self, h: Any, dx: Any, dy: Any, approach: Any, force: Any, shear_modulus: Any, poisson_ratio: Any, effects: Mapping[str, Any],
        *, mean_pressure: Any = None, young_modulus: Any = None, e_star: Any = None,
    ) -> None:
        self.h = shaped("h", distances("h", h))
        self.struct = initialised("scene")
        self.bodies = bodies(shear_modulus, poisson_ratio, young_modulus, e_star)
        self.remarks: Remarks | None = None
        self._kept: list[Any] = []
        self._effects = effects = {**effects, **{name: owned(effects.get(name)) for name in _OF_STRESSES}}
        self._own = [name for name in ("influence", "row_tables") if effects.get(name) is not None]
        self._constants = {
            "shear_modulus": owned(shear_modulus), "poisson_ratio": owned(poisson_ratio), "young_modulus": owned(young_modulus), "e_star": owned(e_star),
        }
        self.struct.my, self.struct.mx = (integer(name, m) for name, m in zip(("my", "mx"), self.h.shape))
        self.struct.dx, self.struct.dy = number("dx", dx), number("dy", dy)
        self.struct.undeformed_distance = pointer(self.h)
        self.struct.shear_modulus, self.struct.poisson_ratio = self.bodies.shear_modulus, self.bodies.poisson_ratio
        self.struct.load, amount = load(approach, force, mean_pressure, self.h.size * self.struct.dx * self.struct.dy)
        setattr(self.struct, "approach" if self.struct.load == PRESCRIBED_APPROACH else "force", amount)
        for name, value in effects.items():
            if value is not None:
                if name in ("coating", "friction", "visco"):
                    self.bodies.needs_poisson(name)
                self._set_effect(name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        # A scene is pickled without its struct, which holds addresses: only the data that stresses below the surface need.
        return _without_load, (self.shape, self.struct.dx, self.struct.dy, self._constants, self._of_stresses, self._own)

    @property
    def _of_stresses(self) -> dict[str, Any]:
        """The arguments of those effects on which stresses below the surface depend."""
        return {name: self._effects.get(name) for name in _OF_STRESSES}

    @cached_property
    def without_load(self) -> Scene:
        """A scene with the data that stresses below the surface need. It has copies, which later changes by the caller do not affect."""
        return _without_load(self.shape, self.struct.dx, self.struct.dy, self._constants, self._of_stresses, self._own)

    def on_grid(self, shape: tuple[int, int], dx: float, dy: float) -> Scene:
        """A scene without a load on another grid, with the data that stresses below the surface need."""
        effects = self._of_stresses
        if effects["patches"] is not None:
            patch, factors = both("patches", effects["patches"])
            # Elements of another grid belong to the patch in which they begin.
            rows, columns = (np.arange(m) * n // m for m, n in zip(shape, self.shape))
            effects["patches"] = np.asarray(patch)[rows[:, None], columns], factors
        return _without_load(shape, dx, dy, self._constants, effects, self._own)

    def know_own(self, names: list[str]) -> None:
        """Records which influence coefficients the caller gave to the handle of a solver. Later scenes of the solver leave them out."""
        self._own = names

    def needs_half_space(self) -> None:
        """Raises an error if the caller gives influence coefficients: stresses below the surface are those of a half-space."""
        for name in self._own:
            raise ContactNormalError(UNSUPPORTED, f"{name} is given; subsurface stresses are those of a half-space")

    @property
    def remark(self) -> str:
        """Remarks for the caller on arguments of friction that may be in a wrong unit, one line each."""
        return self.remarks.of_one() if self.remarks else ""

    @property
    def has_particles(self) -> bool:
        """Whether the particles of the interface have a state, as with a law of friction or a plastic layer."""
        effect = self.struct.friction
        return bool(effect) and (effect.contents.law != 0 or effect.contents.yield_limit != 0.0)

    @property
    def period(self) -> str:
        """The directions in which the grid is one period of a periodic scene: "x", "y", "xy" or ""."""
        period = self._effects.get("period")
        return period if isinstance(period, str) else ""

    @property
    def has_half_space(self) -> bool:
        """Whether the bodies deform as half-spaces with their elastic constants: without influence coefficients of the caller and without coatings."""
        return not self._own and not any(self.struct.coating)

    @property
    def shape(self) -> tuple[int, int]:
        """(my, mx)."""
        my, mx = self.h.shape
        return my, mx

    @property
    def effort(self) -> int:
        """The cost of one product A p: the number of elements times the number of products by FFT that row tables or patches need."""
        factors = [effect.contents.rows if name == "row_tables" else effect.contents.count
                   for name in ("row_tables", "patches") if (effect := getattr(self.struct, name))]
        return int(self.h.size * max([1, *factors]))

    def pressures_of(self, contact: Integers) -> Doubles:
        """Uniform pressures in a guessed contact area, estimated from the load; 0 outside."""
        inside = contact != 0
        area = inside.sum() * self.struct.dx * self.struct.dy
        if not area:
            return np.zeros(self.shape)
        if self.struct.load == PRESCRIBED_FORCE:
            pressure = self.struct.force / area
        else:
            # The mean displacement of a circle of radius a by a uniform pressure p is 16/(3 pi) p a/E*. Here it is the mean of approach - h in the area.
            displacement = np.maximum(self.struct.approach - np.where(inside, self.h, np.inf), 0.0)[inside].mean()
            compliance = sum((1.0 - nu) / (2.0 * g) for g, nu in zip(self.struct.shear_modulus, self.struct.poisson_ratio))
            radius = np.sqrt(area / np.pi)
            pressure = displacement * 3.0 * np.pi / 16.0 / radius / compliance if compliance > 0.0 else 0.0
        return np.where(inside, pressure if np.isfinite(pressure) else 0.0, 0.0)

    def _set_effect(self, name: str, value: Any) -> None:
        """Sets the pointer of the struct to the effect `name`, and keeps the effect and its arrays alive."""
        if name == "coating":
            self._set_coatings(value)
            return
        arrays: Any
        if name == "friction":
            half = 0.5 * max(self.struct.mx * self.struct.dx, self.struct.my * self.struct.dy)
            effect, arrays, self.remarks = friction(value, self.shape, half)
        elif name == "adhesion":
            effect, arrays = adhesion(value, self.shape)
        elif name == "visco":
            effect, arrays = visco(value)
        elif name in ("layer", "pressure_limit"):
            effect, arrays = _per_element(name, value, self.shape)
        else:
            effect, arrays = {"influence": influence, "period": _period, "row_tables": _row_tables}.get(
                name, lambda patches: _patches(patches, self.shape)
            )(value)
        setattr(self.struct, name, ctypes.pointer(effect))
        self._kept += [effect, arrays]

    def _set_coatings(self, value: Any) -> None:
        """Sets the coating of each body; None: the body has none."""
        for body, coating in enumerate(both("coating", value, "a pair: that of body 1 and of body 2, each (thickness, shear_modulus, poisson_ratio) or None")):
            if coating is not None:
                effect = coating_of(coating, f"coating[{body}]")
                self.struct.coating[body] = ctypes.pointer(effect)
                self._kept.append(effect)


_OF_STRESSES = ("period", "patches", "coating")


def owned(value: Any) -> Any:
    """A copy of an argument, because callers may change their lists and arrays later. Strings of numpy become plain strings."""
    if isinstance(value, str):
        return str(value)
    if isinstance(value, np.ma.MaskedArray) or hasattr(value, "dims") and hasattr(value, "copy"):
        # The mask and the names of the dimensions are checked later.
        return value.copy()
    if isinstance(value, memoryview) or hasattr(value, "__array__"):
        return np.array(value)
    if type(value) in (list, tuple):
        return type(value)(owned(one) for one in value)
    return value if value is None or isinstance(value, (int, float)) else copy.deepcopy(value)


def _without_load(
    shape: tuple[int, int], dx: float, dy: float, constants: Mapping[str, Any], effects: Mapping[str, Any], own: list[str]
) -> Scene:
    """A scene with a flat surface and no load: its grid, bodies and effects only."""
    scene = Scene(np.zeros(shape), dx, dy, None, 0.0, effects=effects, **constants)
    scene.know_own(own)
    return scene


def coating_of(value: Any, name: str = "coating") -> Any:
    """A `contact_normal_coating` from `(thickness, shear_modulus, poisson_ratio)`."""
    if not isinstance(value, (tuple, list)) or len(value) != 3:
        count = f"has {len(value)} parts" if isinstance(value, (tuple, list)) else f"is {value!r}"
        raise ValueError(f"{name} {count}; it must be (thickness, shear_modulus, poisson_ratio)")
    coating = initialised("coating")
    for member, one in zip(("thickness", "shear_modulus", "poisson_ratio"), value):
        setattr(coating, member, number(f"{name}: {member}", one))
    return coating


def _scaled(values: Any) -> tuple[Any, float]:
    """Coefficients and their scale, from `coefficients` or `(coefficients, scale)`."""
    if isinstance(values, tuple):
        coefficients, scale = both("influence", values, "coefficients and their scale")
        return coefficients, number("the scale of the coefficients", scale)
    return values, 1.0


def influence(value: Any) -> tuple[Any, Doubles]:
    """A `contact_normal_influence`, and the table that it points to."""
    table, scale = _scaled(value)
    table = doubles("influence", table, dimensions="(2 cy, 2 cx)")
    if table.shape[0] % 2 or table.shape[1] % 2:
        raise ValueError(f"influence has shape {table.shape}; it must be (2 cy, 2 cx)")
    effect = initialised("influence")
    effect.cy, effect.cx, effect.scale = table.shape[0] // 2, table.shape[1] // 2, scale
    effect.coefficients = pointer(table)
    return effect, table


def _per_element(name: str, value: Any, shape: tuple[int, int]) -> tuple[Any, Any]:
    """The struct of `layer` or `pressure_limit`, whose value is one number or one per element, and the array to which it points."""
    one, array = {"layer": ("compliance", "compliances"), "pressure_limit": ("limit", "limits")}[name]
    effect = initialised(name)
    if np.ndim(value) == 0:
        setattr(effect, one, number(name, value))
        return effect, None
    values = doubles(name, value, shape)
    setattr(effect, array, pointer(values))
    return effect, values


def _period(value: Any) -> tuple[Any, None]:
    if not isinstance(value, str) or value not in ("x", "y", "xy"):
        raise ValueError(f"period is {value!r}; it must be 'x', 'y' or 'xy'")
    effect = initialised("period")
    effect.x, effect.y = "x" in value, "y" in value
    return effect, None


def _patches(value: Any, shape: tuple[int, int]) -> tuple[Any, Any]:
    of_element, of_patches = both("patches", value, "a pair: the patch of each element and the factors")
    patch, factors = integers("patches[0]", of_element, shape), doubles("patches[1]", of_patches, dimensions="(count, count)")
    if factors.shape[0] != factors.shape[1]:
        raise ValueError(f"patches[1], the factors, has shape {factors.shape}; it must be square")
    effect = initialised("patches")
    effect.count, effect.patch, effect.factors = len(factors), pointer(patch, c_int32), pointer(factors)
    return effect, (patch, factors)


def _row_tables(value: Any) -> tuple[Any, Doubles]:
    tables, scale = _scaled(value)
    tables = doubles("row_tables", tables, dimensions="(my, my, 2 cx)")
    if tables.shape[0] != tables.shape[1] or tables.shape[2] % 2:
        raise ValueError(f"row_tables has shape {tables.shape}; it must be (my, my, 2 cx)")
    effect = initialised("row_tables")
    effect.rows, effect.cx, effect.coefficients = tables.shape[0], tables.shape[2] // 2, pointer(tables)
    effect.scale = scale
    return effect, tables
