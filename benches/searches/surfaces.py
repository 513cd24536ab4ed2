"""Surfaces by which searches for an accuracy are judged. No constant of the library was chosen by them. Sizes and positions are random numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import contact_normal
import numpy as np

Random = np.random.Generator


@dataclass
class Surface:
    """A surface over a rectangle around the origin: a function h of x and y, or its values on the first grid. The approach is for E* = 1."""

    h: Any
    approach: float
    size: tuple[float, float] = (1.0, 1.0)
    #: Elements (my, mx) of the first grid.
    shape: tuple[int, int] = (16, 16)
    #: The largest number of elements of a grid of a search.
    most: int = 2**16

    def distance(self, doublings: int) -> np.ndarray:
        """The undeformed distance on the grid whose elements are halved `doublings` times."""
        if not callable(self.h):
            return self.refined(doublings)
        my, mx = (m << doublings for m in self.shape)
        x = (np.arange(mx) + 0.5 - 0.5 * mx) * (self.size[0] / mx)
        y = (np.arange(my) + 0.5 - 0.5 * my) * (self.size[1] / my)
        return np.broadcast_to(self.h(x[None, :], y[:, None]), (my, mx)).astype(float)

    def refined(self, doublings: int) -> np.ndarray:
        """The array as the library refines it. It is taken from the last grid of a search for an error that no grid reaches."""
        if doublings == 0:
            return self.h
        found = contact_normal.solve_to_accuracy(
            self.h, **self.element(0), e_star=1.0, approach=self.approach, target=1e-9, tolerance=1e-2, max_elements=self.h.size * 4**doublings
        )
        fine = found.deformed_distance - found.displacement + found.approach
        assert fine.shape == tuple(m << doublings for m in self.h.shape), found.message
        return fine

    def element(self, doublings: int) -> dict[str, float]:
        """The element sizes of the grid whose elements are halved `doublings` times."""
        return {"dx": self.size[0] / (self.shape[1] << doublings), "dy": self.size[1] / (self.shape[0] << doublings)}


def _turned(random: Random, reach: float = 0.06) -> Callable[[Any, Any], tuple[Any, Any]]:
    """A function that converts coordinates to those about a random centre, rotated by a random angle."""
    angle, (x0, y0) = random.uniform(0, np.pi), random.uniform(-reach, reach, 2)
    c, s = np.cos(angle), np.sin(angle)
    return lambda x, y: (c * (x - x0) + s * (y - y0), c * (y - y0) - s * (x - x0))


def superellipsoid(random: Random) -> Surface:
    """A sum of powers of the coordinates along two rotated axes."""
    n, m, a, b = random.uniform(1.6, 6), random.uniform(1.6, 6), random.uniform(0.35, 0.5), random.uniform(0.2, 0.5)
    turned = _turned(random)

    def h(x: Any, y: Any) -> Any:
        u, v = turned(x, y)
        return abs(u / a) ** n + abs(v / b) ** m

    return Surface(h, random.uniform(0.3, 0.7))


def finite_roller(random: Random) -> Surface:
    """A roller along y with sharp, rounded or chamfered ends. The ratio of the sides of its elements is up to 1:4."""
    length, crown, kind = random.uniform(0.5, 0.8), random.uniform(0, 0.3), random.integers(3)
    y0, aspect = random.uniform(-0.06, 0.06), [1, 2, 4][random.integers(3)]

    def h(x: Any, y: Any) -> Any:
        out = np.maximum(abs(y - y0) - 0.5 * length, 0.0)
        end = [np.where(out > 0, np.inf, 0.0), 30 * out**2, 3 * out][kind]
        return 2 * x**2 + crown * (y - y0) ** 2 + end

    return Surface(h, random.uniform(0.05, 0.15), shape=(16, 16 * aspect) if random.integers(2) else (16 * aspect, 16), most=2**16 * aspect)


def balls(count: int) -> Callable[[Random], Surface]:
    """A surface of several balls with different radii and heights."""

    def surface(random: Random) -> Surface:
        places = [(random.uniform(0.12, 0.3) * np.cos(a), random.uniform(0.12, 0.3) * np.sin(a))
                  for a in random.uniform(0, 2 * np.pi) + 2 * np.pi * np.arange(count) / count]
        radii, heights = random.uniform(1, 4, count), random.uniform(0, 0.02, count)

        def h(x: Any, y: Any) -> Any:
            each = [r * ((x - u) ** 2 + (y - v) ** 2) + z for (u, v), r, z in zip(places, radii, heights, strict=True)]
            return np.minimum.reduce(np.broadcast_arrays(*each))

        return Surface(h, random.uniform(0.03, 0.06), most=2**18)

    return surface


def torus(random: Random) -> Surface:
    """A ring with a rounded section, off the centre."""
    r0, n, (x0, y0) = random.uniform(0.2, 0.3), random.uniform(1.8, 3), random.uniform(-0.06, 0.06, 2)
    depth = random.uniform(0.08, 0.16) ** n * 3
    return Surface(lambda x, y: 2 * abs(np.hypot(x - x0, y - y0) - r0) ** n, depth, most=2**18)


def annulus(random: Random) -> Surface:
    """A flat or domed punch with a hole."""
    outer, (x0, y0), dome = random.uniform(0.3, 0.42), random.uniform(-0.06, 0.06, 2), random.uniform(0, 0.3) * random.integers(2)
    inner = outer * random.uniform(0.3, 0.6)

    def h(x: Any, y: Any) -> Any:
        r = np.hypot(x - x0, y - y0)
        return np.where((r < outer) & (r > inner), dome * r**2, np.inf)

    return Surface(h, 0.1)


def step(random: Random) -> Surface:
    """A ball of which one side is lower by a step."""
    at, turned = random.uniform(-0.1, 0.1), _turned(random) if random.integers(2) else (lambda x, y: (x, y))
    deep, approach = random.uniform(0.1, 0.6), random.uniform(0.1, 0.25)

    def h(x: Any, y: Any) -> Any:
        u, v = turned(x, y)
        return u**2 + v**2 + np.where(u > at, deep * approach, 0.0)

    return Surface(h, approach)


def square_punch(random: Random) -> Surface:
    """A flat punch whose sides are not at the edges of elements."""
    (x0, y0), (a, b) = random.uniform(-0.06, 0.06, 2), random.uniform(0.2, 0.42, 2)
    return Surface(lambda x, y: np.where((abs(x - x0) < a) & (abs(y - y0) < b), 0.0, np.inf), 0.1)


def worn(random: Random) -> Surface:
    """A ball or an ellipsoid with a flattened summit, or with a groove."""
    turned, ratio, deep = _turned(random), random.uniform(1, 3), random.uniform(0.1, 0.6)
    approach, groove, width = random.uniform(0.08, 0.2), random.integers(2), random.uniform(0.04, 0.1)

    def h(x: Any, y: Any) -> Any:
        u, v = turned(x, y)
        ball = u**2 + ratio * v**2
        return ball + deep * approach * np.exp(-((u / width) ** 2)) if groove else np.maximum(ball - deep * 0.2 * approach, 0.0)

    return Surface(h, approach)


def rough(random: Random, m: int = 128, hurst: float = 0.8) -> np.ndarray:
    """Self-affine heights with an rms of 1, whose shortest wave is at least 6 elements long."""
    k = np.hypot(np.fft.fftfreq(m)[None, :], np.fft.fftfreq(m)[:, None]) * m
    shortest, rolled = m / random.uniform(6, 12), random.uniform(2, 5)
    with np.errstate(divide="ignore"):
        amplitude = np.where((k > 0) & (k <= shortest), np.maximum(k, rolled) ** -(1 + hurst), 0.0)
    z = np.fft.ifft2(np.fft.fft2(random.standard_normal((m, m))) * amplitude).real
    return z / z.std()


def measured(what: str) -> Callable[[Random], Surface]:
    """A map as an instrument measures it: with a tilt, and for "holes" with holes, for "spikes" with spikes of one element and a light load."""

    def surface(random: Random) -> Surface:
        m = 128
        z = 1e-3 * rough(random, m, random.uniform(0.5, 0.9))
        i = np.arange(m) / m - 0.5
        z = z + random.uniform(-2e-3, 2e-3) * i[None, :] + random.uniform(-2e-3, 2e-3) * i[:, None]
        if what == "spikes":
            z.flat[random.integers(m * m, size=5)] += random.uniform(2e-3, 6e-3, 5)
        h = z.max() - z
        deep = np.quantile(h, random.uniform(0.02, 0.05) if what == "spikes" else random.uniform(0.1, 0.3))
        if what == "holes":
            h.flat[random.integers(m * m, size=60)] = np.inf
            ix, iy = random.integers(m - 10, size=2)
            h[iy:iy + 8, ix:ix + 10] = np.inf
        return Surface(h, float(deep), shape=(m, m), most=2**18)

    return surface


def elements(random: Random) -> Surface:
    """An ellipsoid on elements with sides of 1:1 to 20:1. The ratio of its own sides is that of the elements, or up to twice as large or small."""
    aspect, stretch = random.uniform(1, 20), random.uniform(0.5, 2)
    (x0, y0), n = random.uniform(-0.06, 0.06, 2), random.uniform(2, 3)
    h = lambda x, y: 2 * abs(x - x0) ** n + 2 * abs((y - y0 * aspect) / aspect * stretch) ** n  # noqa: E731
    return Surface(h, random.uniform(0.1, 0.25), size=(1.0, aspect))


def cut(random: Random) -> Surface:
    """An ellipsoid whose contact is cut off by the border of the grid."""
    a, ratio, n = random.uniform(0, 2 * np.pi), random.uniform(1, 3), random.uniform(2, 4)
    x0, y0 = 0.4 * np.cos(a), 0.4 * np.sin(a)
    return Surface(lambda x, y: abs(x - x0) ** n + ratio * abs(y - y0) ** n, random.uniform(0.15, 0.3) ** n * 3)


KINDS: dict[str, Callable[[Random], Surface]] = {
    "superellipsoid": superellipsoid,
    "finite roller": finite_roller,
    "two balls": balls(2),
    "three balls": balls(3),
    "torus": torus,
    "annulus": annulus,
    "step": step,
    "square punch": square_punch,
    "worn": worn,
    "measured, tilt": measured("tilt"),
    "measured, holes": measured("holes"),
    "measured, spikes": measured("spikes"),
    "elements to 20:1": elements,
    "cut by the border": cut,
}
