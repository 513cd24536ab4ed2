"""A shift with friction from rest, and a check of tractions that is independent of all solvers.

    s = w + A q;  stick: s = 0, |q| <= g = mu p;  slip: |q| = g, s opposite to q;  elsewhere: q = 0

The rigid slip w is minus the shift. A holds the displacements of two equal half-spaces by a uniform traction on an element (Kalker 1990),

    Axx = ((1 - nu) a + b)/(pi G),  Ayy = (a + (1 - nu) b)/(pi G),  Axy = nu c/(pi G),
    a = [X asinh(Y/|X|)],  b = [Y asinh(X/|Y|)],  c = -[r]  ([ ]: differences of the four corners),

and is applied here by scipy's FFT. Arrays are (my, mx), tractions (2, my, mx). In a, asinh(Y/|X|) takes the place of ln(Y + r): the difference,
X ln |X|, does not depend on Y and cancels in the sum over the corners.
"""

import numpy as np
import scipy.fft


class Shift:
    """The tangential problem of two bodies with equal elastic constants and the E* of the normal problem.

    A tangential force along x is given, or a shift (a pair).
    """

    def __init__(self, normal, poisson_ratio, friction, force):
        self.normal, self.poisson_ratio, self.mu = normal, poisson_ratio, friction
        self.force, self.shift = force, None
        # E* = G/(1 - nu) for two bodies with equal constants.
        self.shear_modulus = normal.modulus * (1.0 - poisson_ratio)
        my, mx = normal.h.shape
        tables = coefficients(my, mx, normal.dy, normal.dx, poisson_ratio) / self.shear_modulus
        self._spectra = [scipy.fft.rfft2(circulant(table, odd)).real.copy() for table, odd in zip(tables, (False, False, True))]

    def displacement(self, q):
        """Computes u = A q, with both components."""
        my, mx = q.shape[1:]
        x, y = scipy.fft.rfft2(q, s=(2 * my, 2 * mx))
        xx, yy, xy = self._spectra
        return scipy.fft.irfft2(np.stack([xx * x + xy * y, xy * x + yy * y]), s=(2 * my, 2 * mx))[:, :my, :mx]

    def error(self, p, q, moved):
        """The error of tractions q: the largest of several numbers.

        These are the `residual` of the slip conditions; the largest |q| beyond the traction bound, or outside the contact, over the largest bound;
        and, where the force is given, its error over the sum of the bounds. Where the force is given, w is minus the shift that the solver reports
        (`moved`), or the w that fits the sticking elements best, whichever has the smaller residual.
        """
        g = self.mu * np.maximum(p, 0.0)
        contact, size = g > 0, np.hypot(*q)
        if not contact.any() or not np.isfinite(q).all():
            return np.inf
        infeasible = max(np.maximum(size - g, 0.0).max() / g.max(), size[~contact].max(initial=0.0) / g.max())
        q = q * np.minimum(1.0, np.divide(g, size, out=np.ones_like(g), where=size > 0))
        u = self.displacement(q)[:, contact]
        q, g = q[:, contact], g[contact]
        circle = np.hypot(*q) >= g * (1.0 - 1e-7)
        if self.shift is not None:
            return max(infeasible, residual(q, u, circle, -np.asarray(self.shift)))
        given = np.array([self.force, 0.0]) / (self.normal.dx * self.normal.dy)
        forces = np.abs(q.sum(axis=1) - given).max() / g.sum()
        shifts = [-np.asarray(moved)] if moved is not None else []
        if not circle.all():
            shifts.append(-u[:, ~circle].mean(axis=1))
        return max(infeasible, forces, min((residual(q, u, circle, w) for w in shifts), default=np.inf))


def residual(q, u, circle, w):
    """The rms over the contact area of the part of the slip s that violates the conditions of friction, over the larger one of the rms of w and u.

    Where an element sticks this is all of s. Where an element is on the bound (`circle`) it is s without its part opposite to q.
    """
    s = w[:, None] + u
    n = q / np.maximum(np.hypot(*q), np.finfo(float).tiny)
    opposite = np.minimum((s * n).sum(axis=0), 0.0)
    left = s - np.where(circle, opposite, 0.0) * n
    rms = lambda field: np.sqrt((field**2).sum(axis=0).mean())  # noqa: E731
    return float(rms(left) / max(np.hypot(*w), rms(u)))


def coefficients(my, mx, dy, dx, nu):
    """The coefficients Axx, Ayy and Axy, times G, at the offsets 0..my-1 by 0..mx-1."""
    y, x = (((np.arange(m + 1) - 0.5) * d) for m, d in ((my, dy), (mx, dx)))
    y, x = y[:, None], x[None, :]
    corners = lambda f: f[1:, 1:] - f[:-1, 1:] - f[1:, :-1] + f[:-1, :-1]  # noqa: E731
    a, b, c = (corners(f) for f in (x * np.arcsinh(y / np.abs(x)), y * np.arcsinh(x / np.abs(y)), -np.hypot(x, y)))
    return np.stack([(1.0 - nu) * a + b, a + (1.0 - nu) * b, nu * c]) / np.pi


def circulant(table, odd):
    """The table at all offsets of a period, from one that is even in both directions, or odd in both; 0 at the offset of half a period."""
    my, mx = table.shape
    sign = -1.0 if odd else 1.0
    if odd:
        table = table.copy()
        table[0, :] = table[:, 0] = 0.0
    all_offsets = np.zeros((2 * my, 2 * mx))
    all_offsets[:my, :mx] = table
    all_offsets[my + 1 :, :mx] = sign * table[:0:-1]
    all_offsets[:, mx + 1 :] = sign * all_offsets[:, mx - 1 : 0 : -1]
    return all_offsets
