"""The coordinates of elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ._arguments import Doubles


def centres(m: int, d: float, middle: float = 0.0) -> Doubles:
    """The coordinates of the centres of m elements of size d in a row, whose middle is at `middle`."""
    return np.asarray((np.arange(m) + 0.5 - 0.5 * m) * d + middle, dtype=np.float64)
