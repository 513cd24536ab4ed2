"""A scene and its effects as the structs of the C ABI."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from ctypes import c_int32
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import doubles, integer, integers, pair, pointer
from ._constants import MOTION_SHIFT, PRESCRIBED_APPROACH, PRESCRIBED_FORCE, PRESCRIBED_TANGENTIAL_FORCE, value_of
from ._library import initialised

if TYPE_CHECKING:
    from ._arguments import Doubles


class Scene:
    """A `contact_normal_scene` with the arrays and effects that it points to, which live as long as it does.

    Parameters
    ----------
    h : array_like
        Undeformed distance (my, mx).
    dx, dy : float
        Element sizes.
    approach, force : float or None
        Exactly one of them is prescribed.
    shear_modulus, poisson_ratio : float or pair of floats
        Of both bodies, or of each.
    effects : mapping
        Effects by name, None: not simulated; see `solve`.
    """

    def __init__(self, h: Any, dx: float, dy: float, approach: float | None, force: float | None, shear_modulus: Any,
                 poisson_ratio: Any, effects: Mapping[str, Any]) -> None:
        self.h = doubles("h", h)
        self.struct = initialised("scene")
        self._kept: list[Any] = []
        self.struct.my, self.struct.mx = (integer(name, m) for name, m in zip(("my", "mx"), self.h.shape))
        self.struct.dx, self.struct.dy = dx, dy
        self.struct.undeformed_distance = pointer(self.h)
        self.struct.shear_modulus = pair("shear_modulus", shear_modulus)
        self.struct.poisson_ratio = pair("poisson_ratio", poisson_ratio)
        self.struct.load, amount = load(approach, force)
        setattr(self.struct, "approach" if force is None else "force", amount)
        for name, value in effects.items():
            if name == "coating" and value is not None:
                self._coat(value)
            elif value is not None:
                self._name(name, value)

    @property
    def shape(self) -> tuple[int, int]:
        """(my, mx)."""
        my, mx = self.h.shape
        return my, mx

    def _coat(self, value: Any) -> None:
        """Names the coatings of both bodies, None: none."""
        if len(value) != 2:
            raise ValueError(f"coating has {len(value)} parts; it must be a pair: that of body 1 and of body 2, None where there is none")
        for body, coating in enumerate(value):
            if coating is not None:
                effect = coating_of(coating, f"coating[{body}]")
                self.struct.coating[body] = ctypes.pointer(effect)
                self._kept.append(effect)

    def _name(self, name: str, value: Any) -> None:
        """Names the effect `name` in the scene."""
        if name == "friction":
            effect, arrays = _friction(value, self.shape)
        elif name in ("layer", "pressure_limit"):
            effect, arrays = _per_element(name, value, self.shape)
        else:
            effect, arrays = {"influence": influence, "period": _period, "row_tables": _row_tables}.get(
                name, lambda patches: _patches(patches, self.shape)
            )(value)
        setattr(self.struct, name, ctypes.pointer(effect))
        self._kept += [effect, arrays]


def coating_of(value: Any, name: str = "coating") -> Any:
    """A `contact_normal_coating` of `(thickness, shear_modulus, poisson_ratio)`."""
    if len(value) != 3:
        raise ValueError(f"{name} has {len(value)} parts; it must be (thickness, shear_modulus, poisson_ratio)")
    coating = initialised("coating")
    coating.thickness, coating.shear_modulus, coating.poisson_ratio = value
    return coating


def load(approach: float | None, force: float | None) -> tuple[int, float]:
    """Which load is prescribed, and its amount."""
    if approach is not None and force is None:
        return PRESCRIBED_APPROACH, approach
    if force is not None and approach is None:
        return PRESCRIBED_FORCE, force
    raise TypeError("give either approach or force")


def _scaled(values: Any) -> tuple[Any, float]:
    """Coefficients and their scale, of `coefficients` or `(coefficients, scale)`."""
    if isinstance(values, tuple):
        coefficients, scale = values
        return coefficients, float(scale)
    return values, 1.0


def influence(value: Any) -> tuple[Any, Doubles]:
    """A `contact_normal_influence` and the table that it points to."""
    table, scale = _scaled(value)
    table = doubles("influence", table, dimensions="(2 cy, 2 cx)")
    if table.shape[0] % 2 or table.shape[1] % 2:
        raise ValueError(f"influence has shape {table.shape}; it must be (2 cy, 2 cx)")
    effect = initialised("influence")
    effect.cy, effect.cx, effect.scale = table.shape[0] // 2, table.shape[1] // 2, scale
    effect.coefficients = pointer(table)
    return effect, table


def _per_element(name: str, value: Any, shape: tuple[int, int]) -> tuple[Any, Any]:
    """An effect of one number, or of one per element."""
    number, array = {"layer": ("compliance", "compliances"), "pressure_limit": ("limit", "limits")}[name]
    effect = initialised(name)
    if np.ndim(value) == 0:
        setattr(effect, number, value)
        return effect, None
    values = doubles(name, value, shape)
    setattr(effect, array, pointer(values))
    return effect, values


def _period(value: Any) -> tuple[Any, None]:
    if value not in ("x", "y", "xy"):
        raise ValueError(f"period is {value!r}; it must be 'x', 'y' or 'xy'")
    effect = initialised("period")
    effect.x, effect.y = "x" in value, "y" in value
    return effect, None


def _patches(value: Any, shape: tuple[int, int]) -> tuple[Any, Any]:
    if len(value) != 2:
        raise ValueError(f"patches has {len(value)} parts; it must be a pair: the patch of each element and the factors")
    patch, factors = integers("patches[0]", value[0], shape), doubles("patches[1]", value[1], dimensions="(count, count)")
    if factors.shape[0] != factors.shape[1]:
        raise ValueError(f"patches[1], the factors, has shape {factors.shape}; it must be square")
    effect = initialised("patches")
    effect.count, effect.patch, effect.factors = len(factors), pointer(patch, c_int32), pointer(factors)
    return effect, (patch, factors)


_FRICTION_NUMBERS = ("spin", "rolling_distance", "rolling_direction", "spin_offset")
_FRICTION_PAIRS = ("previous_traction", "rigid_slip")


_FRICTION = ("coefficient", "motion", "creepage", "force", "continues", "sensitivities", "spin_centre", "influence", "influence_cross",
             *_FRICTION_NUMBERS, *_FRICTION_PAIRS)


def _friction(value: Any, shape: tuple[int, int]) -> tuple[Any, Any]:
    unknown = sorted(set(value).difference(_FRICTION))
    if unknown:
        raise ValueError(f"friction has {', '.join(unknown)}; it may have {', '.join(_FRICTION)}")
    effect, kept = initialised("friction"), []
    coefficient = value.get("coefficient", 0.0)
    if isinstance(coefficient, float) or np.ndim(coefficient) == 0:
        effect.coefficient = coefficient
    else:
        kept.append(doubles("friction['coefficient']", coefficient, shape))
        effect.coefficients = pointer(kept[-1])
    motion = value.get("motion", MOTION_SHIFT)
    effect.motion = value_of("motion", motion) if isinstance(motion, str) else motion
    effect.continues = bool(value.get("continues", False))
    effect.sensitivities = bool(value.get("sensitivities", False))
    effect.creepage = pair("friction['creepage']", value.get("creepage", 0.0))
    effect.spin_centre = pair("friction['spin_centre']", value.get("spin_centre", 0.0))
    forces = value.get("force", (None, None))
    if not isinstance(forces, (tuple, list)) and np.ndim(forces) == 0 or len(forces) != 2:
        raise ValueError(f"friction['force'] is {forces!r}; it must be a pair, None where the creepage is given")
    for k, force in enumerate(forces):
        if force is not None:
            effect.prescribed[k], effect.force[k] = PRESCRIBED_TANGENTIAL_FORCE, force
    for name in _FRICTION_NUMBERS:
        if name in value:
            setattr(effect, name, value[name])
    for name in _FRICTION_PAIRS:
        for k, field in enumerate(value.get(name) if value.get(name) is not None else ()):
            kept.append(doubles(f"friction['{name}'][{k}]", field, shape))
            getattr(effect, name)[k] = pointer(kept[-1])
    if value.get("influence") is not None:
        kept = [*_tangential_influence(effect, value["influence"]), *kept]
        for k, table in enumerate(value["influence_cross"] if value.get("influence_cross") is not None else ()):
            kept.append(doubles(f"friction['influence_cross'][{k}]", table, kept[0].shape))
            cross = _table(kept[-1], effect.influence[0].contents.scale)
            effect.influence_cross[k] = ctypes.pointer(cross)
            kept.append(cross)
    elif value.get("influence_cross") is not None:
        raise ValueError("friction['influence_cross'] is given without friction['influence']")
    return effect, kept


def _tangential_influence(effect: Any, tables: Any) -> list[Any]:
    if len(tables) not in (3, 4):
        raise ValueError(f"friction['influence'] has {len(tables)} entries; it must be (xx, yy, xy) or (xx, yy, xy, scale)")
    kept = [doubles(f"friction['influence'][{k}]", table, dimensions="(2 cy, 2 cx)") for k, table in enumerate(tables[:3])]
    shape = kept[0].shape
    if any(table.shape != shape for table in kept) or shape[0] % 2 or shape[1] % 2:
        raise ValueError(f"friction['influence'] has shapes {[table.shape for table in kept]}; all must be (2 cy, 2 cx)")
    named = [_table(table, tables[3] if len(tables) == 4 else 1.0) for table in kept]
    for k, table in enumerate(named):
        effect.influence[k] = ctypes.pointer(table)
    return [*kept, *named]


def _table(coefficients: Doubles, scale: float) -> Any:
    effect = initialised("influence")
    effect.cy, effect.cx = coefficients.shape[0] // 2, coefficients.shape[1] // 2
    effect.coefficients, effect.scale = pointer(coefficients), scale
    return effect


def _row_tables(value: Any) -> tuple[Any, Doubles]:
    tables, scale = _scaled(value)
    tables = doubles("row_tables", tables, dimensions="(my, my, 2 cx)")
    if tables.shape[0] != tables.shape[1] or tables.shape[2] % 2:
        raise ValueError(f"row_tables has shape {tables.shape}; it must be (my, my, 2 cx)")
    effect = initialised("row_tables")
    effect.rows, effect.cx, effect.coefficients = tables.shape[0], tables.shape[2] // 2, pointer(tables)
    effect.scale = scale
    return effect, tables
