"""Solves the tangential problem for given pressures."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import Both, SolveOptions, doubles, options, pointer
from ._callbacks import Progress, Watched
from ._library import check, initialised, library
from ._outputs import Outputs
from ._result import TangentialResult
from ._scene import Scene
from ._units import checked

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack

    from ._arguments import Doubles
    from ._handle import Handle


def with_pressures(
    h: Any, pressure: Any, dx: Any, dy: Any, loads: Mapping[str, Any], **given: Any
) -> tuple[Scene, Doubles | None]:
    """The scene and the pressures of a tangential problem. If pressures are given, the surface and the load are not used; otherwise the pressures are None."""
    if (given["shear_modulus"] is None) == (given["young_modulus"] is None):
        raise TypeError("give either shear_modulus or young_modulus, the elastic constants of the bodies, and only one of them")
    if pressure is None:
        if h is None:
            raise TypeError("give either h or pressure")
        return Scene(h, dx, dy, **loads, **given), None
    pressures = doubles("pressure", pressure)
    if all(load is None for load in loads.values()):
        loads = {"approach": 0.0, "force": None}
    scene = Scene(np.zeros(pressures.shape) if h is None else h, dx, dy, **loads, **given)
    return scene, doubles("pressure", pressures, scene.shape)


def solve_tangential(
    pressure: npt.ArrayLike,
    dx: float,
    dy: float,
    *,
    friction: Mapping[str, Any],
    shear_modulus: Both | None = None,
    poisson_ratio: Both | None = None,
    young_modulus: Both | None = None,
    influence: Any = None,
    layer: npt.ArrayLike | None = None,
    period: str | None = None,
    coating: Any = None,
    units: tuple[str, str] | None = None,
    progress: Callable[[Progress], Any] | bool | None = None,
    **given: Unpack[SolveOptions],
) -> TangentialResult:
    """Solves the tangential problem for given pressures: finds the tractions, the slips, and the stick and slip areas.

    The pressures stay as they are given. For bodies with different elastic constants, where tractions change the pressures, this is the tangential half of one
    iteration between the normal and the tangential problem. `friction_batch` solves many motions or forces for the same pressures.

    Parameters
    ----------
    pressure : array_like, (my, mx)
        Given pressures; those that are not positive count as no contact.
    dx, dy : float
        Element sizes.
    friction : mapping
        As for `solve`.
    shear_modulus, poisson_ratio, young_modulus, influence, layer, coating, units, progress, **given
        As for `solve`. With `influence` the entry "influence" of `friction` is needed, too.
    period
        Refused, as in `solve` with friction.

    Returns
    -------
    TangentialResult

    Raises
    ------
    ContactNormalError
        If the library refuses the scene or an option.

    Examples
    --------
    Half of the largest possible force mu N, for a uniform pressure:

    >>> import numpy as np, contact_normal
    >>> pressure = np.pad(np.full((8, 8), 100.0), 2)
    >>> found = contact_normal.solve_tangential(pressure, 0.1, 0.1, friction={"coefficient": 0.3, "force": (9.6, 0.0)},
    ...                                         shear_modulus=82000.0, poisson_ratio=0.28)
    >>> round(found.tangential_force[0], 4), bool((found.stick_slip == 1).any() and (found.stick_slip == 2).any())
    (9.6, True)
    """
    effects, struct = {"influence": influence, "layer": layer, "period": period, "coating": coating, "friction": friction}, options(given)
    units = checked(units)
    scene, pressures = with_pressures(None, pressure, dx, dy, {}, shear_modulus=shear_modulus, poisson_ratio=poisson_ratio,
                                      young_modulus=young_modulus, effects=effects)
    assert pressures is not None
    return of_pressures(scene, pressures, struct, progress, units, None)


def of_pressures(
    scene: Scene, pressures: Doubles, struct: Any, progress: Callable[[Progress], Any] | bool | None, units: tuple[str, str] | None,
    handle: Handle | None,
) -> TangentialResult:
    """Solves the tangential problem of a scene for given pressures, with the handle of a solver or without."""
    outputs, results = Outputs(scene.shape, has_friction=True, scene=scene), initialised("friction_results")
    outputs.doubles[0][:] = np.where(pressures > 0.0, pressures, 0.0)
    outputs.contact[:] = outputs.doubles[0] > 0.0
    outputs.lend(results)
    watched = Watched(progress, struct, scene)
    no_handle = [] if handle else [None]
    status, message = watched.call(
        library.contact_normal_solve_tangential, *no_handle, ctypes.byref(scene.struct), pointer(pressures), ctypes.byref(struct), 1, None,
        ctypes.byref(results), ctypes.byref(outputs.report), handle=handle, keep=(scene, pressures, outputs), report=outputs.report,
    )
    return TangentialResult(check(status, message), message, outputs, outputs.report, scene, units)
