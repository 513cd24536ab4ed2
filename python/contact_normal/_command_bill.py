"""`contact-normal bill`: which effects a scene calls for, and what they cost."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ._bill import what_matters
from ._command_scene import USAGE, add_effects, add_scene, effects_of, gap_of, scene_arguments
from ._field_files import PICTURES, refuse_unless_writable, save
from ._quantities import QUANTITIES


def add(commands: Any) -> None:
    """Adds the command and its options."""
    command = commands.add_parser("bill", usage=USAGE, help="which effects the scene calls for, and what they cost",
                                  description="Says how much each quantity changes without an effect, and what leaving it out saves.")
    add_scene(command)
    add_effects(command)
    command.add_argument("--target", type=float, default=1e-2, help="relative accuracy that is asked for; default 1e-2")
    command.add_argument("--quantities", nargs="+", choices=tuple(QUANTITIES), default=["force", "max_pressure", "contact_area"], metavar="NAME",
                         help=f"default force max_pressure contact_area; others: {', '.join(list(QUANTITIES)[3:])}")
    command.add_argument("--pairs", action=argparse.BooleanOptionalAction, default=True, help="leave out pairs, too; default yes")
    command.add_argument("--plot", nargs="?", const="", metavar="FILE",
                         help=f"a picture as {', '.join(PICTURES)}; by default the name of the surface with .bill.png")
    command.set_defaults(run=run)


def run(given: argparse.Namespace) -> int:
    """Prints the rows and the verdicts."""
    plot = str(Path(given.file).with_suffix(".bill.png")) if given.plot == "" else given.plot
    if plot and Path(plot).suffix not in PICTURES:
        raise ValueError(f"{plot} must end in one of {', '.join(PICTURES)}")
    if plot:
        refuse_unless_writable(plot, given.file)
    surface = gap_of(given)
    bill = what_matters(surface.h, surface.dx, surface.dy, target=given.target, quantities=given.quantities, pairs=given.pairs,
                        **effects_of(given, surface.period), **scene_arguments(given))
    print(bill)
    if not bill:
        return 0
    print(f"needed: {', '.join(bill.needed) or 'none'}; negligible: {', '.join(bill.negligible) or 'none'}")
    if plot:
        save(plot, bill.plot)
    return 0
