"""`contact-normal creep-table`: a table of creep forces in steady rolling."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from ._bar import has_terminal
from ._constants import OK
from ._creep_force_plane import AXES
from ._creep_force_table import creep_force_table
from ._field_files import refuse_unless_writable
from ._library import ContactNormalError

_DEFAULTS = {"xi": "0:1:5", "eta": "0", "phi": "0", "axis_ratio": "1", "poisson_ratio": "0.28"}
_MEANINGS = {
    "xi": "G c^2/(mu N) times the longitudinal creepage, c = sqrt(a b)", "eta": "likewise of the lateral creepage",
    "phi": "G c^3/(mu N) times the spin", "axis_ratio": "a/b, a along the direction of rolling", "poisson_ratio": "of both bodies",
}


def add(commands: Any) -> None:
    """Adds the command and its options."""
    command = commands.add_parser("creep-table", help="a table of creep forces of Hertz ellipses",
                                  description="Computes creep forces in steady rolling; axes are lists as 0,0.5,1 or ranges as 0:1:5.")
    command.add_argument("file", nargs="?", help="a NetCDF file; what was begun goes on where it ended; by default the table is printed")
    for name, default in _DEFAULTS.items():
        command.add_argument("--" + name.replace("_", "-"), default=default, metavar="AXIS", help=f"{_MEANINGS[name]}; default {default}")
    command.add_argument("--elements", type=int, default=35, help="along each side of the rectangle around an ellipse; default 35")
    command.add_argument("--tolerance", type=float, default=1e-4, help="of the residual of each entry; default 1e-4")
    command.add_argument("--workers", type=int, default=1, help="processes; 0: one for each core")
    command.add_argument("--progress", action=argparse.BooleanOptionalAction, default=None, help="a bar on stderr; by default on a terminal")
    command.set_defaults(run=run)


def axis(name: str, text: str) -> list[float]:
    """The values of an axis: a list as 0,0.5,1, or a range as first:last:count."""
    try:
        if ":" in text:
            first, last, count = text.split(":")
            return [float(value) for value in np.linspace(float(first), float(last), int(count))]
        return [float(value) for value in text.split(",")]
    except ValueError:
        raise ValueError(f"--{name.replace('_', '-')} is {text}; it must be numbers as 0,0.5,1 or first:last:count as 0:1:5") from None


def run(given: argparse.Namespace) -> int:
    """Computes the table, and prints or writes it. Returns 1 if an entry stopped early, else 0."""
    axes: dict[str, Any] = {name: axis(name, getattr(given, name)) for name in _DEFAULTS}
    if given.workers < 0:
        raise ValueError(f"--workers is {given.workers}; it must be 0, for one process a core, or more")
    if given.file is not None:
        if Path(given.file).suffix != ".nc":
            raise ValueError(f"{given.file} must end in .nc")
        refuse_unless_writable(given.file)
    progress = has_terminal() if given.progress is None else given.progress
    table = creep_force_table(given.file, **axes, elements=given.elements, tolerance=given.tolerance, workers=given.workers,
                              progress=progress)
    if given.file is None:
        names = (*reversed(AXES), "force_x", "force_y", "moment", "error")
        print(" ".join(f"{name:>13}" for name in names))
        for place in np.ndindex(table.error.shape):
            values = [getattr(table, name)[k] for name, k in zip(AXES, place)][::-1]
            values += [getattr(table, name)[place] for name in names[len(AXES):]]
            print(" ".join(f"{value:13.6g}" for value in values))
    elif np.isfinite(table.error).any():
        print(f"{given.file}: {' x '.join(map(str, table.error.shape))} entries, largest estimated error {np.nanmax(table.error):.2g}")
    if (refused := int((table.status < 0).sum())) > 0:
        raise ContactNormalError(int(table.status.min()), f"{refused} of {table.status.size} entries were refused")
    return 0 if (table.status == OK).all() else 1
