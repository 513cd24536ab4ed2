"""The arrays and structs that a solve writes."""

from __future__ import annotations

from ctypes import Array, c_double, c_int32
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import doubles, integers, pointer
from ._constants import ACTIVE_SET_FIXED, INITIAL_GUESS_GIVEN, INITIAL_GUESS_NONE
from ._library import initialised
from ._structs import LedgerRow

if TYPE_CHECKING:
    import numpy.typing as npt

    from ._arguments import Doubles
    from ._scene import Scene

# The number of ledger rows that a solve can write. It has one row per grid, each with half the elements of the next in a direction, and mx and my have 32 bits.
LEDGER_ROOM = 32
_ROWS = LedgerRow * LEDGER_ROOM


class Outputs:
    """The arrays that the solve of one problem writes, and the structs that point to them. `pressure` and `contact` are the initial guess.

    `of_effects` has the arrays of effects by name, only for the effects of the scene: to clear and write those of friction takes some 0.25 ms of a solve of
    10 ms on 256 x 256 elements.
    """

    def __init__(
        self, shape: tuple[int, int], pressure: Any = None, contact: Any = None, options: Any = None, has_friction: bool = False,
        scene: Scene | None = None, has_adhesion: bool = False,
    ) -> None:
        self._shape = shape
        self.doubles: list[Doubles] = [np.zeros(shape) for _ in range(3)]
        self.contact = np.zeros(shape, dtype=np.int32)
        self.fields, self.report = initialised("fields"), initialised("report")
        self.fields.pressure, self.fields.deformed_distance, self.fields.displacement = map(pointer, self.doubles)
        self.fields.contact = pointer(self.contact, c_int32)
        self.of_effects: dict[str, npt.NDArray[Any]] = {}
        if has_friction:
            self.of_effects.update(traction=np.zeros((2, *shape)), slip=np.zeros((2, *shape)), stick_slip=np.zeros(shape, dtype=np.int32))
        if scene is not None and scene.has_particles:
            self.of_effects.update(friction_coefficient=np.zeros(shape), yield_limit=np.zeros(shape))
        if has_adhesion:
            self.of_effects.update(contact_pressure=np.zeros(shape), attraction=np.zeros(shape))
        self.lend(self.fields)
        self.rows = _ROWS(initialised("ledger_row"))
        self.report.ledger, self.report.ledger_capacity = self.rows, LEDGER_ROOM
        if pressure is not None or contact is not None:
            self._start(pressure, contact, options, scene)

    def _start(self, pressure: Any, contact: Any, options: Any, scene: Scene | None) -> None:
        """Copies the initial guess into the arrays: pressures, the contact area, or both; or the contact area that is prescribed."""
        if contact is not None:
            self.contact[:] = integers("contact", contact, self._shape)
        if pressure is not None:
            self.doubles[0][:] = doubles("pressure", pressure, self._shape)
            if contact is None:
                self.contact[:] = self.doubles[0] > 0
        elif options.active_set == ACTIVE_SET_FIXED:
            return
        elif scene is not None:
            self.doubles[0][:] = scene.pressures_of(self.contact)
        if options.initial_guess == INITIAL_GUESS_NONE:
            options.initial_guess = INITIAL_GUESS_GIVEN

    def lend(self, struct: Any) -> None:
        """Sets the members of a struct that have the names of the arrays of effects to the addresses of these arrays."""
        for name, array in self.of_effects.items():
            if isinstance(getattr(struct, name), Array):
                getattr(struct, name)[:] = [pointer(part) for part in array]
            else:
                setattr(struct, name, pointer(array, c_int32 if array.dtype == np.int32 else c_double))
