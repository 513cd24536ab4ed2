"""The effect of viscoelastic bodies as the struct of the C ABI."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ._arguments import both, constant, doubles, flag, number, pointer
from ._library import initialised

_KNOWN = ("modulus", "time", "time_step", "form", "continues")
_PAIR = "a pair: those of body 1 and of body 2, None where a body is elastic"


def visco(value: Any) -> tuple[Any, Any]:
    """A `contact_normal_visco` from the mapping of a caller, and the arrays to which it points."""
    if not isinstance(value, Mapping):
        raise TypeError(f"visco is {value!r}; it must be a mapping of {', '.join(_KNOWN)}")
    unknown = [str(name) for name in value if name not in _KNOWN]
    if unknown:
        raise ValueError(f"visco has {', '.join(sorted(unknown))}; it may have {', '.join(_KNOWN)}")
    given = {name: one for name, one in value.items() if one is not None}
    effect = initialised("visco")
    kept: list[Any] = []
    moduli, times = (both(f"visco['{name}']", given.get(name, (None, None)), _PAIR) for name in ("modulus", "time"))
    for body, (modulus, time) in enumerate(zip(moduli, times)):
        if (modulus is None) != (time is None):
            raise ValueError(f"visco['modulus'] and visco['time'] of body {body + 1} must both be given, or neither")
        if modulus is None:
            continue
        count = (np.size(modulus),)
        arrays = [doubles(f"visco['{name}'][{body}]", np.atleast_1d(one), count, "(branches)") for name, one in (("modulus", modulus), ("time", time))]
        effect.branches[body] = count[0]
        effect.modulus[body], effect.time[body] = (pointer(array) for array in arrays)
        kept += arrays
    effect.time_step = number("visco['time_step']", given.get("time_step", 0.0))
    if "form" in given:
        form = given["form"]
        effect.form = constant("visco['form']", "form", form)
    effect.continues = flag("visco['continues']", given.get("continues", False))
    return effect, kept
