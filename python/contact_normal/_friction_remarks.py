"""Remarks on numbers of friction that are probably in the wrong unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._constants import MOTION_SHIFT, PRESCRIBED_TANGENTIAL_FORCE

if TYPE_CHECKING:
    from ._arguments import Doubles

# A larger creepage is remarked on: most wheels have smaller ones.
_LARGE = 0.05
# A larger coefficient of friction is remarked on: surfaces have smaller ones.
_STICKY = 5.0
_IS_LENGTH = "the motion of friction is not given: it is a SHIFT, whose creepage is a length, and whose spin an angle"


@dataclass(frozen=True)
class Remarks:
    """Remarks for the caller on the friction of a scene.

    Attributes
    ----------
    effect : Friction
        The `contact_normal_friction` of the scene.
    has_motion : bool
        Whether the caller gave the motion.
    coefficient : float
        The largest coefficient of friction of an element.
    length : float
        Half of the longer side of the grid.
    """

    effect: Any
    has_motion: bool
    coefficient: float
    length: float

    def of_one(self) -> str:
        """Remarks on the creepages and the spin of the effect itself, one line each."""
        return self._lines([abs(one) for one in self.effect.creepage], abs(self.effect.spin))

    def of_entries(self, entries: Doubles) -> str:
        """Remarks on the entries of a table, one line each. The creepages and spins of the entries replace those of the effect."""
        if not len(entries):
            return self._lines([0.0, 0.0], 0.0)
        *given, spin = np.abs(np.where(np.isfinite(entries), entries, 0.0)).max(axis=0).tolist()
        are_forces = [one == PRESCRIBED_TANGENTIAL_FORCE for one in self.effect.prescribed]
        return self._lines([0.0 if is_force else one for one, is_force in zip(given, are_forces)], spin)

    def _lines(self, creepage: Sequence[float], spin: float) -> str:
        found, effect = [], self.effect
        if self.coefficient > _STICKY:
            found.append(f"a coefficient of {self.coefficient:g} is a ratio of forces: 30 % is 0.3")
        largest, by_spin = max(creepage), spin * self.length
        if effect.motion == MOTION_SHIFT:
            return "\n".join(found + ([_IS_LENGTH] if not self.has_motion and (largest > 0.0 or spin > 0.0) else []))
        # With a law of friction large creepages are usual.
        if largest > _LARGE and not effect.law:
            found.append(f"a creepage of {largest:g} is this part of the rolling speed: 0.1 % is 1e-3")
        if by_spin > _LARGE:
            found.append(f"a spin of {spin:g} makes a creepage of {by_spin:.2g} at the ends of the grid: it is in rad per length, "
                         "and 0.16 per m is 1.6e-4 per mm")
        return "\n".join(found)
