"""Splits the keyword arguments of `solve` into a scene and options."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._arguments import Both, SolveOptions, options
from ._scene import Scene
from ._units import checked

if TYPE_CHECKING:
    import numpy.typing as npt

EFFECTS = ("influence", "layer", "pressure_limit", "period", "patches", "row_tables", "coating", "friction", "adhesion", "visco")
_LOADS = ("approach", "force", "mean_pressure", "shear_modulus", "poisson_ratio", "young_modulus", "e_star")


class SceneArguments(SolveOptions, total=False):
    """The arguments of `solve` after h, dx and dy; its docstring describes them."""

    approach: float | None
    force: float | None
    mean_pressure: float | None
    shear_modulus: Both | None
    poisson_ratio: Both | None
    young_modulus: Both | None
    e_star: float | None
    layer: npt.ArrayLike | None
    pressure_limit: npt.ArrayLike | None
    period: str | None
    patches: tuple[npt.ArrayLike, npt.ArrayLike] | None
    coating: Any
    friction: Mapping[str, Any] | None
    adhesion: Mapping[str, Any] | None
    visco: Mapping[str, Any] | None
    units: tuple[str, str] | None


def effects_in(given: dict[str, Any]) -> dict[str, Any]:
    """Removes the arguments of effects from `given`, and returns them."""
    return {name: given.pop(name) for name in EFFECTS if name in given}


def scene_and_options(h: Any, dx: Any, dy: Any, given: Mapping[str, Any]) -> tuple[Scene, Any]:
    """The scene and the `contact_normal_options` of the arguments of `solve`."""
    rest = dict(given)
    checked(rest.pop("units", None))
    effects = effects_in(rest)
    loads = {name: rest.pop(name, None) for name in _LOADS}
    # The options are checked before the scene, so that a misspelt load is refused as an unknown option, not as a missing load.
    struct = options(rest)
    return Scene(h, dx, dy, effects=effects, **loads), struct
