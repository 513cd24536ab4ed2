"""Finds the pull-off force of a scene with adhesion."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ._arguments import Both, SolveOptions, options
from ._callbacks import Progress, Watched
from ._library import check, library
from ._outputs import Outputs
from ._result import Result
from ._scene import Scene
from ._units import checked

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack


def pull_off(
    h: npt.ArrayLike,
    dx: float,
    dy: float,
    *,
    adhesion: Mapping[str, Any],
    approach: float | None = None,
    force: float | None = None,
    mean_pressure: float | None = None,
    shear_modulus: Both | None = None,
    poisson_ratio: Both | None = None,
    young_modulus: Both | None = None,
    e_star: float | None = None,
    influence: Any = None,
    layer: npt.ArrayLike | None = None,
    period: str | None = None,
    patches: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    coating: Any = None,
    units: tuple[str, str] | None = None,
    progress: Callable[[Progress], Any] | bool | None = None,
    **given: Unpack[SolveOptions],
) -> Result:
    """Finds the state at pull-off: that of the least normal force, which is negative. With a stronger pull the bodies part.

    Parameters
    ----------
    h, dx, dy, adhesion, shear_modulus, poisson_ratio, young_modulus, e_star, influence, layer, period, patches, coating, units, progress, **given
        As for `solve`.
    approach, force, mean_pressure : float, optional
        The load at which the search begins; by default a force of 0.

    Returns
    -------
    Result
        `result.force` is the pull-off force, negative.

    Examples
    --------
    >>> import numpy as np, contact_normal
    >>> x = (np.arange(64) - 31.5) * 6 / 64
    >>> h = (x[None, :] ** 2 + x[:, None] ** 2) / 2
    >>> found = contact_normal.pull_off(h, 6 / 64, 6 / 64, e_star=0.75, adhesion={"work": 1 / np.pi, "range": 0.5648})
    >>> round(found.force, 2)
    -1.66
    """
    effects = {"influence": influence, "layer": layer, "period": period, "patches": patches, "coating": coating, "adhesion": adhesion}
    force = 0.0 if force is None and approach is None and mean_pressure is None else force
    struct, units = options(given), checked(units)
    scene = Scene(h, dx, dy, approach, force, shear_modulus, poisson_ratio, effects, mean_pressure=mean_pressure,
                  young_modulus=young_modulus, e_star=e_star)
    outputs = Outputs(scene.shape, has_adhesion=True)
    watched = Watched(progress, struct, scene)
    status, message = watched.call(
        library.contact_normal_pull_off, ctypes.byref(scene.struct), ctypes.byref(struct), ctypes.byref(outputs.fields),
        ctypes.byref(outputs.report), keep=(scene, outputs), report=outputs.report,
    )
    return Result(check(status, message), message, outputs, outputs.report, scene, units)
