"""`contact-normal prices`: predicts what accuracies of a scene cost."""

from __future__ import annotations

import argparse
from typing import Any

from ._command_scene import USAGE, add_effects, add_scene, effects_of, gap_of, scene_arguments
from ._prices import cost_of_accuracy
from ._quantities import QUANTITIES


def add(commands: Any) -> None:
    """Adds the command and its options."""
    command = commands.add_parser("prices", usage=USAGE, help="what accuracies cost: grid, seconds, bytes",
                                  description="Predicts which grid, time and memory relative errors of 1e-2, 1e-3, ... take.")
    add_scene(command)
    add_effects(command)
    command.add_argument("--targets", type=float, nargs="+", default=[1e-2, 1e-3, 1e-4], metavar="ERROR", help="default 1e-2 1e-3 1e-4")
    command.add_argument("--quantity", choices=tuple(QUANTITIES), default="force",
                         help="default force; with a prescribed force this is the approach")
    command.set_defaults(run=run)


def run(given: argparse.Namespace) -> int:
    """Prints one line for each target."""
    surface = gap_of(given)
    rows = cost_of_accuracy(surface.h, surface.dx, surface.dy, targets=given.targets, quantity=given.quantity,
                            **effects_of(given, surface.period), **scene_arguments(given))
    print(rows)
    return 0
