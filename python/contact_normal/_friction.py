"""The effect of friction as the struct of the C ABI."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import both, constant, doubles, flag, number, pointer, two
from ._constants import MOTION_SHIFT, PRESCRIBED_TANGENTIAL_FORCE
from ._friction_remarks import Remarks
from ._library import initialised

if TYPE_CHECKING:
    from ._arguments import Doubles

_NUMBERS = ("spin", "rolling_distance", "rolling_direction", "spin_offset")
_PAIRS = ("creepage", "spin_centre")
_FLAGS = ("continues", "sensitivities")
_FIELDS = ("previous_traction", "rigid_slip", "initial_traction", "creepage_weight")
_PARTICLES = ("previous_coefficient", "previous_yield_limit")
_OF_LAW = ("kinetic", "speed", "time_step", "memory_distance", "memory_speed")
_PAIRS_OF_LAW = ("falling", "half_speed")
_OF_LAYER = ("yield_limit", "hardening")
_OF_SET_UP = {"influence", "influence_cross", "row_tables"}
_OF_A_STEP = {"rolling_direction", "rolling_distance"}
_KNOWN = ("coefficient", "motion", "force", "compliance", *_PAIRS, *_FLAGS, "influence", "influence_cross", "row_tables", *_NUMBERS, *_FIELDS, "law", "layer", "branch", *_PARTICLES)


def friction(value: Any, shape: tuple[int, int], length: float = 0.0) -> tuple[Any, list[Any], Remarks]:
    """A `contact_normal_friction` from the mapping of a caller, the arrays to which it points, and remarks for the caller.

    `length` is half of the longer side of the grid; it converts a spin to a creepage in the remarks.
    """
    if not isinstance(value, Mapping):
        raise TypeError(f"friction is {value!r}; it must be a mapping of {', '.join(_KNOWN)}")
    unknown = [str(name) for name in value if name not in _KNOWN]
    if unknown:
        raise ValueError(f"friction has {', '.join(sorted(unknown))}; it may have {', '.join(_KNOWN)}")
    given = {name: one for name, one in value.items() if one is not None}
    # Only the set-up of a Solver may have friction without a coefficient: its influence tables. A plastic layer also needs the coefficient, because it limits
    # tractions in addition to mu p.
    if "coefficient" not in given and not (_OF_SET_UP & set(given) and set(given) <= _OF_SET_UP | {"motion", "compliance", *_OF_A_STEP}):
        raise ValueError("friction has no coefficient; without friction leave it out, or give a coefficient of 0")
    effect = initialised("friction")
    kept = _one_or_each(effect, "coefficient", given.get("coefficient", 0.0), shape)
    largest = max((float(one.max()) for one in kept if one.size), default=effect.coefficient)
    kept += _one_or_each(effect, "compliance", given.get("compliance", 0.0), shape)
    motion = given.get("motion", MOTION_SHIFT)
    effect.motion = constant("friction['motion']", "motion", motion)
    for name in _FLAGS:
        setattr(effect, name, flag(f"friction['{name}']", given.get(name, False)))
    forces = both("friction['force']", given.get("force", (None, None)), "a pair, None where the creepage is given")
    if "creepage" in given:
        given["creepage"] = _without_unknown(both("friction['creepage']", given["creepage"], "two numbers"), forces)
    for name in _PAIRS:
        if name in given:
            getattr(effect, name)[:] = two(f"friction['{name}']", given[name])
    for name in _NUMBERS:
        if name in given:
            setattr(effect, name, number(f"friction['{name}']", given[name]))
    for k, force in enumerate(forces):
        if force is not None:
            if effect.creepage[k] != 0.0:
                raise ValueError(f"friction['creepage'][{k}] is {effect.creepage[k]} and friction['force'][{k}] is {force!r}; give one of them, None the other")
            effect.prescribed[k], effect.force[k] = PRESCRIBED_TANGENTIAL_FORCE, number(f"friction['force'][{k}]", force)
    for name in _FIELDS:
        for k, field in enumerate(both(f"friction['{name}']", given[name]) if name in given else ()):
            kept.append(doubles(f"friction['{name}'][{k}]", field, shape))
            getattr(effect, name)[k] = pointer(kept[-1])
    for name in _PARTICLES:
        if name in given:
            kept.append(doubles(f"friction['{name}']", given[name], shape))
            setattr(effect, name, pointer(kept[-1]))
    branch = given.get("branch", 0)
    effect.branch = constant("friction['branch']", "friction_branch", branch)
    _law(effect, given.get("law"))
    _layer(effect, given.get("layer"))
    kept += _influence(effect, given)
    kept += _row_tables(effect, given)
    return effect, kept, Remarks(effect, "motion" in given, largest, length)


def _without_unknown(creepage: tuple[Any, Any], forces: tuple[Any, Any]) -> tuple[Any, Any]:
    """The creepages with 0 in the place of None. None is refused in a direction whose force is not given."""
    for k, one in enumerate(creepage):
        if one is None and forces[k] is None:
            raise ValueError(f"friction['creepage'][{k}] and friction['force'][{k}] are None; give one of them")
    x, y = (0.0 if one is None else one for one in creepage)
    return x, y


def _one_or_each(effect: Any, name: str, value: Any, shape: tuple[int, int]) -> list[Any]:
    """Sets a member of the struct to one number, or the member whose name ends in s to an array with one number per element; returns the arrays."""
    if np.ndim(value) == 0:
        setattr(effect, name, number(f"friction['{name}']", value))
        return []
    values = doubles(f"friction['{name}']", value, shape)
    setattr(effect, f"{name}s", pointer(values))
    return [values]


def _known(what: str, value: Any, names: tuple[str, ...]) -> dict[str, Any]:
    """The entries of a mapping that are not None. Entries with other names than these are refused."""
    if not isinstance(value, Mapping):
        raise TypeError(f"{what} is {value!r}; it must be a mapping of {', '.join(names)}")
    unknown = [str(name) for name in value if name not in names]
    if unknown:
        raise ValueError(f"{what} has {', '.join(sorted(unknown))}; it may have {', '.join(names)}")
    return {name: one for name, one in value.items() if one is not None}


def _law(effect: Any, value: Any) -> None:
    """Sets the law by which the coefficient falls with the slip velocity."""
    if value is None:
        return
    given = _known("friction['law']", value, ("kind", *_OF_LAW, *_PAIRS_OF_LAW))
    if "kind" not in given:
        raise ValueError("friction['law'] has no kind; it must be 'LINEAR', 'RATIONAL' or 'EXPONENTIAL'")
    kind = given["kind"]
    effect.law = constant("friction['law']['kind']", "friction_law", kind)
    for name in _OF_LAW:
        if name in given:
            setattr(effect, name, number(f"friction['law']['{name}']", given[name]))
    for name in _PAIRS_OF_LAW:
        if name in given:
            one = given[name]
            getattr(effect, name)[:] = two(f"friction['law']['{name}']", (one, 0.0) if np.ndim(one) == 0 else one)


def _layer(effect: Any, value: Any) -> None:
    """Sets a plastic layer."""
    if value is None:
        return
    given = _known("friction['layer']", value, _OF_LAYER)
    for name in _OF_LAYER:
        if name in given:
            setattr(effect, name, number(f"friction['layer']['{name}']", given[name]))


def _influence(effect: Any, given: Mapping[str, Any]) -> list[Any]:
    """Sets the caller's tangential influence coefficients, and returns the objects that must live as long as the struct."""
    if "influence" not in given:
        if "influence_cross" in given:
            raise ValueError("friction['influence_cross'] is given without friction['influence']")
        return []
    tables = _three("influence", given["influence"])
    kept = [doubles(f"friction['influence'][{k}]", tables[k], dimensions="(2 cy, 2 cx)") for k in range(3)]
    shape = kept[0].shape
    if any(table.shape != shape for table in kept) or shape[0] % 2 or shape[1] % 2:
        raise ValueError(f"friction['influence'] has shapes {[table.shape for table in kept]}; all must be (2 cy, 2 cx)")
    scale = number("friction['influence'][3], the scale,", tables[3]) if len(tables) == 4 else 1.0
    for k, table in enumerate(both("friction['influence_cross']", given["influence_cross"]) if "influence_cross" in given else ()):
        kept.append(doubles(f"friction['influence_cross'][{k}]", table, shape))
    structs = [_table(coefficients, scale) for coefficients in kept]
    for k, struct in enumerate(structs[:3]):
        effect.influence[k] = ctypes.pointer(struct)
    for k, struct in enumerate(structs[3:]):
        effect.influence_cross[k] = ctypes.pointer(struct)
    return [*kept, *structs]


def _three(name: str, tables: Any) -> Any:
    """Returns the tables (xx, yy, xy) or (xx, yy, xy, scale); refuses any other number of entries."""
    count = len(tables) if isinstance(tables, (tuple, list)) or np.ndim(tables) else 0
    if not count:
        raise TypeError(f"friction['{name}'] is {tables!r}; it must be (xx, yy, xy) or (xx, yy, xy, scale)")
    if count not in (3, 4):
        raise ValueError(f"friction['{name}'] has {count} entries; it must be (xx, yy, xy) or (xx, yy, xy, scale)")
    return tables


def _row_tables(effect: Any, given: Mapping[str, Any]) -> list[Any]:
    """Sets the caller's tangential coefficients for each loaded row, and returns the objects that must live as long as the struct."""
    tables = given.get("row_tables")
    if tables is None:
        return []
    _three("row_tables", tables)
    kept = [doubles(f"friction['row_tables'][{k}]", tables[k], dimensions="(my, my, 2 cx)") for k in range(3)]
    shape = kept[0].shape
    if any(table.shape != shape for table in kept) or shape[0] != shape[1] or shape[2] % 2:
        raise ValueError(f"friction['row_tables'] has shapes {[table.shape for table in kept]}; all must be (my, my, 2 cx)")
    structs = [initialised("row_tables") for _ in kept]
    for k, (struct, table) in enumerate(zip(structs, kept)):
        struct.rows, struct.cx, struct.coefficients = shape[0], shape[2] // 2, pointer(table)
        if len(tables) == 4:
            struct.scale = number("friction['row_tables'][3], the scale,", tables[3])
        effect.row_tables[k] = ctypes.pointer(struct)
    return [*kept, *structs]


def _table(coefficients: Doubles, scale: float) -> Any:
    """A `contact_normal_influence` that points to the coefficients."""
    effect = initialised("influence")
    effect.cy, effect.cx = coefficients.shape[0] // 2, coefficients.shape[1] // 2
    effect.coefficients, effect.scale = pointer(coefficients), scale
    return effect
