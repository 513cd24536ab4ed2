"""Solves symmetric systems with five diagonals, in a time proportional to their size."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .._arguments import Doubles


def solve(diagonal: Doubles, first: Doubles, second: Doubles, right: Doubles) -> Doubles:
    """Solves M x = right for a positive definite matrix M with the main `diagonal`, and the diagonals `first` and `second` above and below it.

    M is factorised as L D L' (Golub and Van Loan, section 4.3), where L has ones on its diagonal and two diagonals below. The loops use lists, because numbers
    of Python are faster in a loop than those of numpy.
    """
    n = len(diagonal)
    m0, m1, m2 = diagonal.tolist(), [*first.tolist(), 0.0], [*second.tolist(), 0.0, 0.0]
    d, l1, l2, x = [0.0] * n, [0.0] * n, [0.0] * n, right.tolist()
    for k in range(n):
        d[k] = m0[k]
        if k > 0:
            d[k] -= l1[k - 1] ** 2 * d[k - 1]
            m1[k] -= l2[k - 1] * d[k - 1] * l1[k - 1]
            x[k] -= l1[k - 1] * x[k - 1]
        if k > 1:
            d[k] -= l2[k - 2] ** 2 * d[k - 2]
            x[k] -= l2[k - 2] * x[k - 2]
        l1[k], l2[k] = m1[k] / d[k], m2[k] / d[k]
    x = [value / of for value, of in zip(x, d)]
    for k in range(n - 2, -1, -1):
        x[k] -= l1[k] * x[k + 1]
        if k < n - 2:
            x[k] -= l2[k] * x[k + 2]
    return np.array(x)
