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
    """The names of what a report says was left out."""
    return tuple(name for number, name in OMISSIONS.items() if bits >> (number - 1) & 1)


class BillRow(NamedTuple):
    """What leaving out an effect, or two, does to a quantity, and what it saves.

    Attributes
    ----------
    omitted : tuple of str
        What is left out: "coating", "period", "patches", "layer", "pressure_limit", "friction", "coupling" (unlike bodies as if they were
        alike), "spin", "friction_compliance", "coating_as_layer" (a thin layer in the place of the coating), "adhesion", "friction_law",
        "friction_layer", "visco". Two names: both.
    quantity : str
        "force", ...
    verdict : str
        "negligible", "needed" or "not decided", by the target.
    value, change, error : float
        The value with all effects, what leaving out adds to it, and how far that may be off (negative: not known); nan: there is none.
    seconds, seconds_without : float
        Predicted for the scene's own grid with one thread, as it is and without.
    bytes, bytes_without : float
        The same of memory.
    lack : str
        Why a number is not known; "": nothing is missing.
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
        """The row of the library."""
        omitted = tuple(name_of(OMISSIONS, number) for number in (row.omitted, row.also_omitted) if number)
        return cls(
            omitted, name_of(QUANTITY_NAMES, row.quantity), name_of(VERDICTS, row.verdict), row.value, row.change, row.change_error, row.seconds,
            row.seconds_without, row.bytes, row.bytes_without, name_of(LACKS, row.lack),
        )

    @property
    def relative(self) -> float:
        """The change over the value."""
        return self.change / abs(self.value) if self.value else float("nan")


class Bill(list[BillRow]):
    """The rows of `what_matters`: for each effect, then for each pair, one for each quantity.

    Attributes
    ----------
    target : float
        The relative accuracy that the verdicts are for.
    estimated : str
        What the quantity "force" is: "force", or "approach" where the force is prescribed.
    message : str
        Why rows are not solved, where `max_seconds` or `max_cycles` ended the call; else "".
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
        """The effects without which no quantity changes by more than the target; one at a time."""
        return self._with("negligible")

    def __str__(self) -> str:
        if not self:
            return "the scene names no effect: there is nothing to leave out"
        # As wide as the longest names, and the columns of shorter bills stay.
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
        """Draws for each effect the largest relative change without it, beside the seconds that leaving it out saves; `axes` as for `Result.plot`."""
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
    """Says which effects a scene calls for: what each quantity changes by without an effect, and what leaving it out saves.

    The scene is solved on small grids, for at most 5 % of its own predicted seconds or 100 ms, or `max_seconds`.

    Parameters
    ----------
    h, dx, dy, **given
        As for `solve`, with its effects and options; without own coefficients.
    target : float
        Relative accuracy that is asked for: smaller changes are negligible.
    quantities : sequence of str
        See `contact_normal.quantities`.
    pairs : bool
        Whether pairs of effects are left out, too: leaving out two is not the sum.

    Returns
    -------
    Bill
        A list of `BillRow`, which prints as a table, and has `needed` and `negligible`.

    Raises
    ------
    ContactNormalError
        If the library refuses the scene or an option.

    Examples
    --------
    A layer that is a thousand times stiffer than the contact:

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
