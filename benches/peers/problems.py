"""The problems of the comparison, and a check of pressures that is independent of all solvers.

e = h + A p - approach, p >= 0, e >= 0, p e = 0; A holds Love's exact coefficients of a uniformly loaded rectangle on the
half-space, applied here by scipy's FFT. Arrays are (my, mx): x fastest.
"""

import os

import numpy as np
import scipy.fft

ROUGH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data", "rough", "self_affine.txt")

# Steel on steel: 1/E* = 2 (1 - nu)/(2 G).
SHEAR_MODULUS, POISSON_RATIO = 82000.0, 0.28
STEEL = SHEAR_MODULUS / (1 - POISSON_RATIO)


class Problem:
    """A normal problem: the undeformed distance, the element sizes, E* and the prescribed force."""

    def __init__(self, h, dx, dy, modulus, force):
        self.h, self.dx, self.dy, self.modulus, self.force = h, dx, dy, modulus, force
        self._spectrum = None

    @property
    def square(self):
        """Whether grid and elements are square."""
        return self.h.shape[0] == self.h.shape[1] and self.dx == self.dy

    @property
    def sides(self):
        """Lengths of the grid in y and x."""
        return self.h.shape[0] * self.dy, self.h.shape[1] * self.dx

    @property
    def mean_pressure(self):
        """The force over the area of the grid."""
        return self.force / (self.sides[0] * self.sides[1])

    def displacement(self, p):
        """Computes u = A p."""
        my, mx = p.shape
        if self._spectrum is None:
            c = love(my, mx, self.dy, self.dx) / self.modulus
            k = np.zeros((2 * my, 2 * mx))
            k[:my, :mx] = c
            k[my + 1 :, :mx] = c[:0:-1]
            k[:, mx + 1 :] = k[:, mx - 1 : 0 : -1]
            self._spectrum = scipy.fft.rfft2(k, workers=2).real.copy()
        transformed = scipy.fft.rfft2(p, s=(2 * my, 2 * mx), workers=2) * self._spectrum
        return scipy.fft.irfft2(transformed, s=(2 * my, 2 * mx), workers=2)[:my, :mx]

    def error(self, p):
        """The error of pressures: the largest of four numbers.

        These are the largest |e| in contact and the largest penetration outside, both over max |u|; the relative error of the force; and the most
        negative pressure over the largest one.
        """
        p = np.asarray(p, dtype=float).reshape(self.h.shape)
        u = self.displacement(p)
        contact = p > 0
        if not contact.any() or not np.isfinite(p).all():
            return np.inf
        e = self.h + u
        e -= e[contact].mean()  # the approach that fits p best
        outside = max(0.0, -e[~contact].min()) if not contact.all() else 0.0
        negative = max(0.0, -p.min()) / p.max()
        force = abs(p.sum() * self.dx * self.dy / self.force - 1)
        return float(max(np.abs(e[contact]).max() / np.abs(u).max(), outside / np.abs(u).max(), force, negative))


def love(my, mx, dy, dx):
    """The displacements, times E*, at the offsets 0..my-1 by 0..mx-1 from an element with a unit pressure."""

    def corner(y, x):
        return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))

    g = corner(((np.arange(my + 1) - 0.5) * dy)[:, None], ((np.arange(mx + 1) - 0.5) * dx)[None, :])
    return (g[1:, 1:] - g[:-1, 1:] - g[1:, :-1] + g[:-1, :-1]) / np.pi


def centres(m, length):
    """The centres of m elements in a row of this length around 0."""
    return ((np.arange(m) + 0.5) / m - 0.5) * length


def ellipse(m):
    """The test problem of the paper, with the force that its approach leads to."""
    x, y = centres(m, 20.0)[None, :], centres(m, 12.0)[:, None]
    return Problem(0.0016681 * x**2 + 0.0030671 * y**2, 20.0 / m, 12.0 / m, STEEL, 82000.0)


def sphere(m):
    """A ball with R = 200 mm on 16 x 16 mm, pressed to a contact radius of 5 mm."""
    x = centres(m, 16.0)
    h = (x[None, :] ** 2 + x[:, None] ** 2) / 400.0
    return Problem(h, 16.0 / m, 16.0 / m, STEEL, 4 * STEEL * 5.0**3 / (3 * 200.0))


def rough(m):
    """The surface of data/rough, under a force that gives about 10 % contact."""
    spectrum = np.zeros((m, m), dtype=complex)
    ky, kx, re, im = np.loadtxt(ROUGH, unpack=True)
    ky, kx = ky.astype(int), kx.astype(int)
    np.add.at(spectrum, (ky % m, kx % m), re + 1j * im)
    np.add.at(spectrum, (-ky % m, -kx % m), re - 1j * im)
    z = np.fft.ifft2(spectrum).real * m * m
    return Problem(z.max() - z, 1.0 / m, 1.0 / m, 1.0, 0.007)


PROBLEMS = {"sphere": sphere, "rough": rough, "ellipse": ellipse}
