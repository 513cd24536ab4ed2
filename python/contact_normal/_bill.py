"""Which effects a scene calls for, and what they cost."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from ._arguments import flag, relative
from ._calls import called
from ._given import SceneArguments, scene_and_options
from ._library import check, initialised, library
from ._numbered import name_of, names_of
from ._quantities import LACKS, QUANTITY_NAMES, estimated, numbers
from ._structs import EffectsRow

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

OMISSIONS = {number: name for number, name in names_of("OMIT_").items() if number}
VERDICTS = ("not decided", "negligible", "needed")


def omissions(bits: int) -> tuple[str, ...]:
    """The names of the effects that were left out: bit k - 1 of `bits`, the report's `neglected`, stands for the effect with the number k."""
    return tuple(name for number, name in OMISSIONS.items() if bits >> (number - 1) & 1)


class BillRow(NamedTuple):
    """How much one quantity changes if one effect, or a pair of effects, is left out of a scene, and what this saves.

    Attributes
    ----------
    omitted : tuple of str
        The effects that are left out: "coating", "period", "patches", "layer", "pressure_limit", "friction", "coupling" (like bodies in the place of unlike
        ones), "spin", "friction_compliance", "coating_as_layer" (a thin layer in the place of the coating), "adhesion", "friction_law", "friction_layer",
        "visco". Two names: both effects are left out together.
    quantity : str
        The name of the quantity: "force", ...; see `contact_normal.quantities`.
    verdict : str
        "negligible", "needed" or "not decided", relative to the target.
    value, change, error : float
        The value with all effects, its change without the effect, and the estimated error of this change (negative: not known). nan: there is no such number.
    seconds, seconds_without : float
        Predicted seconds of a solve on the scene's grid with one thread, with and without the effect.
    bytes, bytes_without : float
        Predicted memory of a solve, with and without the effect.
    lack : str
        The reason for which a number of this row is not known; "": all are known.
    """

    omitted: tuple[str, ...]
    quantity: str
    verdict: str
    value: float
    change: float
    error: float
    seconds: float
    seconds_without: float
    bytes: float
    bytes_without: float
    lack: str

    @classmethod
    def of(cls, row: EffectsRow) -> BillRow:
        """Makes a row from a struct of the library."""
        omitted = tuple(name_of(OMISSIONS, number) for number in (row.omitted, row.also_omitted) if number)
        return cls(
            omitted, name_of(QUANTITY_NAMES, row.quantity), name_of(VERDICTS, row.verdict), row.value, row.change, row.change_error, row.seconds,
            row.seconds_without, row.bytes, row.bytes_without, name_of(LACKS, row.lack),
        )

    @property
    def relative(self) -> float:
        """The change relative to the value."""
        return self.change / abs(self.value) if self.value else float("nan")


class Bill(list[BillRow]):
    """The rows of `what_matters`: one row for each quantity without each effect, then one for each quantity without each pair of effects.

    Attributes
    ----------
    target : float
        The relative accuracy for which the verdicts hold.
    estimated : str
        What the quantity "force" is: "force", or "approach" if the force is prescribed.
    message : str
        The reason for which some rows have no values, if `max_seconds` or `max_cycles` ended the call; otherwise "".
    """

    target: float
    estimated: str = "force"
    message: str = ""

    def _with(self, verdict: str) -> list[str]:
        singles = list(dict.fromkeys(row.omitted[0] for row in self if len(row.omitted) == 1))
        of = {name: {row.verdict for row in self if row.omitted == (name,)} for name in singles}
        if verdict == "needed":
            return [name for name in singles if "needed" in of[name]]
        return [name for name in singles if of[name] == {verdict}]

    @property
    def needed(self) -> list[str]:
        """The effects without which a quantity changes by more than the target."""
        return self._with("needed")

    @property
    def negligible(self) -> list[str]:
        """The effects without which no quantity changes by more than the target, one effect at a time."""
        return self._with("negligible")

    def __str__(self) -> str:
        if not self:
            return "the scene names no effect: there is nothing to leave out"
        # The column is as wide as the longest name.
        names = [" + ".join(row.omitted) for row in self]
        width = max(34, *(len(name) + 2 for name in names))
        lines = [f"{'without':{width}}{'quantity':18}{'change':>10}{'+-':>10}{'seconds':>11}{'saved':>11}  verdict at {self.target:g}"]
        for name, row in zip(names, self):
            value = abs(row.value)
            error = f"{row.error / value:10.2g}" if row.error >= 0 and value else f" {row.lack:>9}"
            saved = row.seconds - row.seconds_without
            lines.append(
                f"{name:{width}}{row.quantity:18}{row.relative:10.2g}{error}{row.seconds:11.2g}{saved:11.2g}  {row.verdict}"
            )
        if self.estimated != "force" and any(row.quantity == "force" for row in self):
            lines.append(f"force is that of the {self.estimated}: the force is prescribed")
        if self.message:
            lines.append(self.message)
        return "\n".join(lines)

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws for each effect the largest relative change without it, and the seconds that are saved; `axes` as for `Result.plot`."""
        from ._plot_accuracy import plot_bill

        return plot_bill(self, axes)


def what_matters(
    h: npt.ArrayLike,
    dx: float,
    dy: float,
    *,
    target: float = 1e-2,
    quantities: Sequence[str] = ("force", "max_pressure", "contact_area"),
    pairs: bool = True,
    **given: Unpack[SceneArguments],
) -> Bill:
    """Finds which effects a scene needs: how much each quantity changes without an effect, and how much time leaving out the effect saves.

    The scene is solved with and without its effects on small grids. This takes at most 5 % of the predicted seconds of the scene, or 100 ms if that is more, or
    `max_seconds` if it is given.

    Parameters
    ----------
    h, dx, dy, **given
        As for `solve`, with effects and options, but without influence coefficients of the caller.
    target : float
        Wanted relative accuracy: smaller changes are negligible.
    quantities : sequence of str
        The names of the quantities; see `contact_normal.quantities`.
    pairs : bool
        Whether effects are also left out in pairs. The change without a pair is not the sum of the changes without each effect.

    Returns
    -------
    Bill
        A list of `BillRow`, which prints as a table. Its `needed` and `negligible` are the names of these effects.

    Raises
    ------
    ContactNormalError
        If the library refuses the scene or an option.

    Examples
    --------
    A layer whose compliance is negligible beside that of the contact:

    >>> import numpy as np, contact_normal
    >>> x = (np.arange(64) - 31.5) * 0.1
    >>> h = (x[None, :] ** 2 + x[:, None] ** 2) / 100.0
    >>> bill = contact_normal.what_matters(h, 0.1, 0.1, approach=0.05, e_star=1e5, layer=1e-10)
    >>> bill.negligible, bill.needed
    (['layer'], [])
    """
    scene, struct = scene_and_options(h, dx, dy, given)
    wanted, found = numbers("quantities", quantities), ctypes.c_int32(0)
    scene.bodies.know_all(quantities)
    goal, both = relative("target", target), int(flag("pairs", pairs))

    def ask(room: int, rows: object) -> str:
        status, message = called(
            library.contact_normal_effects_bill, ctypes.byref(scene.struct), ctypes.byref(struct), goal, both, len(wanted), wanted, room,
            rows, ctypes.byref(found), keep=(scene,), options=struct,
        )
        check(status, message)
        return message

    ask(0, None)
    room = found.value
    rows = (EffectsRow * max(1, room))(initialised("effects_row"))
    message = ask(room, rows)
    bill = Bill(BillRow.of(row) for row in rows[: found.value])
    bill.target, bill.message, bill.estimated = goal, message, estimated(scene)
    return bill
