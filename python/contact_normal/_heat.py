"""Flash temperature: the warming of the surfaces by friction."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arguments import doubles, integer, number, pointer
from ._calls import called
from ._library import check, initialised, library
from ._short import told

if TYPE_CHECKING:
    import numpy.typing as npt

    Both = float | Sequence[float]


class FlashTemperature(NamedTuple):
    """Steady flash temperatures of both surfaces, above the temperature far away.

    Attributes
    ----------
    rise : array, (2, my, mx)
        The temperature rise of the surface of body 1 and of body 2.
    share : float
        The part of the heat that goes into body 1, 0 to 1.
    largest : (float, float)
        The largest temperature rise of each body.
    at : ((float, float), (float, float))
        The coordinates (x, y) of the largest rise of each body, relative to the middle of the grid.
    """

    rise: npt.NDArray[np.float64]
    share: float
    largest: tuple[float, float]
    at: tuple[tuple[float, float], tuple[float, float]]

    def __repr__(self) -> str:
        return told(self, self._fields)


def _both(name: str, value: Any) -> Any:
    """A C array of two numbers, from one number for both bodies or one for each."""
    values = (value, value) if np.ndim(value) == 0 else tuple(value)
    if len(values) != 2:
        raise ValueError(f"{name} has {len(values)} values; it must be one number, or one of each body")
    return (ctypes.c_double * 2)(*[number(f"{name}[{b}]", each) for b, each in enumerate(values)])


def flash_temperature(
    heat_flux: npt.ArrayLike,
    dx: float,
    dy: float,
    *,
    conductivity: Both,
    diffusivity: Both,
    speed: Both = 0.0,
    share: float | None = None,
    threads: int = 1,
) -> FlashTemperature:
    """Computes the steady flash temperature by a heat flux through the contact of two bodies whose surfaces move in x.

    Parameters
    ----------
    heat_flux : array_like, (my, mx)
        Power per area: for friction the traction times the slip velocity. Negative values cool.
    dx, dy : float
        Element sizes.
    conductivity, diffusivity : float or pair
        The thermal conductivity lambda, a power per length and temperature, and the diffusivity kappa = lambda/(density times heat capacity), an area per time;
        for both bodies or for each.
    speed : float or pair
        The velocity in +x of each surface relative to the contact; 0: the surface does not move. For bodies that roll towards +x at V both are -V.
    share : float, optional
        The part of the heat that goes into body 1. By default it is chosen so that both bodies have the same largest temperature (Blok 1937); it is one half if
        the heat makes no body warmer.
    threads : int
        Number of threads; 0: all cores.

    Returns
    -------
    FlashTemperature

    Examples
    --------
    >>> import numpy as np, contact_normal
    >>> flux = np.zeros((16, 16)); flux[6:10, 6:10] = 1e6
    >>> contact_normal.flash_temperature(flux, 1e-4, 1e-4, conductivity=50.0, diffusivity=1.4e-5, speed=(1.0, 0.0)).share > 0.5
    True
    """
    shape = np.shape(heat_flux)
    if len(shape) != 2:
        raise ValueError(f"heat_flux has {len(shape)} dimensions; it must be (my, mx)")
    flux = doubles("heat_flux", heat_flux, shape)
    heat, flash = initialised("heat"), initialised("flash")
    (heat.my, heat.mx), heat.heat_flux = shape, pointer(flux)
    heat.dx, heat.dy = number("dx", dx), number("dy", dy)
    for name, value in (("conductivity", conductivity), ("diffusivity", diffusivity), ("speed", speed)):
        setattr(heat, name, _both(name, value))
    if share is not None:
        heat.share = number("share", share)
        if not heat.share >= 0.0:
            raise ValueError(f"share is {share}; a part must lie in [0, 1]")
    heat.threads = integer("threads", threads)
    rise = np.empty((2, *shape))
    check(*called(library.contact_normal_flash_temperature, ctypes.byref(heat), pointer(rise), ctypes.byref(flash), keep=(flux, rise)))
    places = ((flash.x[0], flash.y[0]), (flash.x[1], flash.y[1]))
    return FlashTemperature(rise, flash.share, (flash.largest[0], flash.largest[1]), places)
