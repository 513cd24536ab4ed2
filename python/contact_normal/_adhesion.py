"""The effect of adhesion as the struct of the C ABI."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ._arguments import constant, doubles, flag, number, pointer
from ._library import initialised

_KNOWN = ("law", "work", "range", "smear", "start", "stiffness", "stability", "shear_strength")


def adhesion(value: Any, shape: tuple[int, int]) -> tuple[Any, Any]:
    """A `contact_normal_adhesion` from the mapping of a caller, and the array of works of adhesion to which it points, if there is one."""
    if not isinstance(value, Mapping):
        raise TypeError(f"adhesion is {value!r}; it must be a mapping of {', '.join(_KNOWN)}")
    unknown = [str(name) for name in value if name not in _KNOWN]
    if unknown:
        raise ValueError(f"adhesion has {', '.join(sorted(unknown))}; it may have {', '.join(_KNOWN)}")
    given = {name: one for name, one in value.items() if one is not None}
    if "work" not in given:
        raise ValueError("adhesion has no work: give the work of adhesion, one or (my, mx)")
    effect, works = initialised("adhesion"), None
    if np.ndim(given["work"]) == 0:
        effect.work_of_adhesion = number("adhesion['work']", given["work"])
    else:
        works = doubles("adhesion['work']", given["work"], shape)
        effect.works_of_adhesion = pointer(works)
    for name in ("range", "smear", "shear_strength"):
        if name in given:
            setattr(effect, name, number(f"adhesion['{name}']", given[name]))
    for name in ("law", "start"):
        if name in given:
            setattr(effect, name, constant(f"adhesion['{name}']", name, given[name]))
    for name in ("stiffness", "stability"):
        setattr(effect, name, flag(f"adhesion['{name}']", given.get(name, False)))
    return effect, works
