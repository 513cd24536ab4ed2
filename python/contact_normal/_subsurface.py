"""Computes stresses below the surface, by the pressures of a result or by given pressures and tractions."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import both, doubles, flag, integer, options, pointer, real, shaped
from ._callbacks import Watched
from ._calls import called
from ._library import check, initialised, library
from ._parts import parts
from ._scene import Scene
from ._stress import COMPONENTS, TENSOR, SubsurfaceStress
from ._units import checked

if TYPE_CHECKING:
    import numpy.typing as npt

    from ._arguments import Doubles


def subsurface(
    scene: Scene,
    pressure: Doubles | None,
    depths: npt.ArrayLike,
    traction: Any,
    body: int,
    components: Iterable[str] | None,
    principal: bool,
    threads: int,
) -> SubsurfaceStress:
    """See `Solved.subsurface`."""
    scene.needs_half_space()
    scene.bodies.needs_poisson("a stress")
    levels = shaped("depths", np.atleast_1d(real("depths", depths)), dimensions="n").copy()
    wanted = _wanted(components)
    found = SubsurfaceStress(levels, scene, wanted, flag("principal", principal))
    outputs = initialised("stress_outputs")
    for c, name in enumerate(TENSOR):
        if name in wanted:
            outputs.stress[c] = pointer(getattr(found, name))
    for name in ("von_mises", "maximum_shear"):
        if name in wanted:
            setattr(outputs, name, pointer(getattr(found, name)))
    if found.principal is not None and found.directions is not None:
        for k in range(3):
            outputs.principal[k], outputs.directions[k] = pointer(found.principal[k]), pointer(found.directions[k])
    largest = {name: initialised("stress_maximum") for name in ("von_mises", "maximum_shear")}
    for name, member in (("von_mises", "largest_von_mises"), ("maximum_shear", "largest_shear")):
        if name in wanted:
            setattr(outputs, member, ctypes.pointer(largest[name]))
    given = _loads(pressure, traction, scene.shape)
    found._loaded = None if pressure is None else np.asarray(pressure) != 0.0
    struct = options({"threads": threads})
    watched = Watched(None, struct, None)
    status, message = watched.call(
        library.contact_normal_subsurface_stress, ctypes.byref(scene.without_load.struct), integer("body", body), *given, pointer(levels),
        levels.size, ctypes.byref(struct), ctypes.byref(outputs), keep=(scene, given, levels, found, largest),
    )
    check(status, message)
    for name, member in (("von_mises", "largest_von_mises"), ("maximum_shear", "largest_shear")):
        if name in wanted and levels.size:
            values: dict[str, Any] = {key: getattr(largest[name], key) for key in ("value", "x", "y", "z", "ix", "iy", "depth")}
            setattr(found, member, values)
    return found


def at_points(
    scene: Scene, pressure: Doubles | None, points: npt.ArrayLike, traction: Any, body: int, threads: int, middle: tuple[float, float]
) -> Doubles:
    """See `Solved.stress_at_points`."""
    scene.needs_half_space()
    scene.bodies.needs_poisson("a stress")
    places = doubles("points", points, dimensions="(n, 3)")
    if places.shape[1] != 3:
        raise ValueError(f"points has shape {places.shape}; it must be (n, 3)")
    # The library takes coordinates relative to the middle of the grid.
    moved = places - np.array([*middle, 0.0])
    given, struct = _loads(pressure, traction, scene.shape), options({"threads": threads})
    stress = np.zeros((len(moved), 6))
    for part in parts(len(moved), 100):
        check(*called(
            library.contact_normal_stress_at_points, ctypes.byref(scene.without_load.struct), integer("body", body), *given, pointer(moved[part]),
            len(moved[part]), ctypes.byref(struct), pointer(stress[part]), keep=(scene, given, moved, stress),
        ))
    return stress


def subsurface_stress(
    pressure: npt.ArrayLike | None,
    dx: float,
    dy: float,
    depths: npt.ArrayLike,
    *,
    poisson_ratio: Any,
    traction: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    body: int = 1,
    period: str | None = None,
    patches: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    components: Iterable[str] | None = None,
    principal: bool = False,
    threads: int = 1,
    units: tuple[str, str] | None = None,
) -> SubsurfaceStress:
    """Computes the stresses below the surface of one body by given pressures and tractions, which are constant on each element.

    Parameters
    ----------
    pressure : array_like, (my, mx), or None
        Pressures; None: tractions only.
    dx, dy : float
        Element sizes.
    depths, traction, body, components, principal, threads
        As for `Result.subsurface`.
    poisson_ratio : float or pair of floats
        The Poisson ratio of both bodies, or of each.
    period, patches, units
        As for `solve`.

    Returns
    -------
    SubsurfaceStress

    Examples
    --------
    Deep below a square of uniform pressure the stress is nearly that of a point force F, szz = -3 F/(2 pi z^2):

    >>> import numpy as np, contact_normal
    >>> stress = contact_normal.subsurface_stress(np.ones((9, 9)), 0.1, 0.1, [20.0], poisson_ratio=0.3, components=["zz"])
    >>> float(round(stress.zz[0, 4, 4] * 2 * np.pi * 20.0**2 / (3 * 0.81), 2))
    -1.0
    """
    units = checked(units)
    scene, pressures = _loaded(pressure, traction, dx, dy, poisson_ratio, period, patches)
    found = subsurface(scene, pressures, depths, traction, body, components, principal, threads)
    found.units = units
    return found


def stress_at_points(
    pressure: npt.ArrayLike | None,
    dx: float,
    dy: float,
    points: npt.ArrayLike,
    *,
    poisson_ratio: Any,
    traction: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    body: int = 1,
    patches: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    threads: int = 1,
) -> Doubles:
    """Computes the stresses at single points of one body by given pressures and tractions, which are constant on each element.

    Parameters
    ----------
    pressure, dx, dy, poisson_ratio, traction, body, patches, threads
        As for `subsurface_stress`.
    points : array_like, (n, 3)
        The coordinates x and y relative to the middle of the grid, and the depth. At depth 0 no point may be on the edge of an element.

    Returns
    -------
    ndarray, (n, 6)
        xx, yy, zz, xy, xz, yz of each point, positive in tension.

    Examples
    --------
    >>> import numpy as np, contact_normal
    >>> stress = contact_normal.stress_at_points(np.ones((3, 3)), 0.1, 0.1, [(0.0, 0.0, 0.0)], poisson_ratio=0.3)
    >>> float(round(stress[0, 2], 12))
    -1.0
    """
    scene, pressures = _loaded(pressure, traction, dx, dy, poisson_ratio, None, patches)
    return at_points(scene, pressures, points, traction, body, threads, (0.0, 0.0))


def _loaded(pressure: Any, traction: Any, dx: Any, dy: Any, poisson_ratio: Any, period: Any, patches: Any) -> tuple[Scene, Doubles | None]:
    """A scene for the stresses by given pressures and tractions, and the pressures. The shear modulus is set to 1, because stresses do not depend on it."""
    pressures = None if pressure is None else doubles("pressure", pressure)
    if pressures is None and traction is None:
        raise TypeError("give pressure, or traction, or both")
    shape = pressures.shape if pressures is not None else doubles("traction[0]", both("traction", traction)[0]).shape
    return Scene(np.zeros(shape), dx, dy, None, 0.0, 1.0, poisson_ratio, {"period": period, "patches": patches}), pressures


def _loads(pressure: Any, traction: Any, shape: tuple[int, int]) -> list[Any]:
    """Pointers to the pressures and to the tractions in x and y; None where one is not given."""
    given = both("traction", traction) if traction is not None else (None, None)
    tractions = [None if one is None else doubles(f"traction[{k}]", one, shape) for k, one in enumerate(given)]
    return [None if array is None else pointer(array) for array in (pressure, *tractions)]


def _wanted(components: Iterable[str] | None) -> tuple[str, ...]:
    wanted = COMPONENTS if components is None else (components,) if isinstance(components, str) else tuple(components)
    for name in wanted:
        if name not in COMPONENTS:
            raise ValueError(f"components has {name!r}; there are: {', '.join(COMPONENTS)}")
    return wanted
