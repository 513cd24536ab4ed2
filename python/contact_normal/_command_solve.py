"""`contact-normal solve`: one scene on the grid of a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ._bar import has_terminal
from ._command_scene import USAGE, add_effects, add_scene, effects_of, gap_of, scene_arguments
from ._constants import OK
from ._field_files import FIELDS, PICTURES, refuse_unless_writable, save, write_fields
from ._library import library
from ._result import Result
from ._solve import solve
from ._units import with_unit


def add(commands: Any) -> None:
    """Adds the command and its options."""
    command = commands.add_parser("solve", usage=USAGE, help="pressures and contact area of a surface",
                                  description="Finds the pressures and the contact area of a surface that is pressed onto a plane.")
    add_scene(command)
    add_effects(command)
    out = command.add_argument_group("output")
    out.add_argument("-o", "--output", action="append", default=[], metavar="FILE", help=f"fields as {', '.join(FIELDS)}; may be repeated")
    out.add_argument("--plot", nargs="?", const="", metavar="FILE",
                     help=f"a picture as {', '.join(PICTURES)}; by default the name of the surface with .contact.png")
    out.add_argument("--progress", action=argparse.BooleanOptionalAction, default=None, help="a bar on stderr; by default on a terminal")
    command.set_defaults(run=run)


def run(given: argparse.Namespace) -> int:
    """Solves the scene, prints the results and writes the files. Returns 1 if the solve stopped early, else 0."""
    plot = str(Path(given.file).with_suffix(".contact.png")) if given.plot == "" else given.plot
    for name, endings in (*((output, FIELDS) for output in given.output), *([(plot, PICTURES)] if plot else [])):
        if Path(name).suffix not in endings:
            raise ValueError(f"{name} must end in one of {', '.join(endings)}")
        refuse_unless_writable(name, given.file)
    surface = gap_of(given)
    progress = has_terminal() if given.progress is None else given.progress
    result = solve(surface.h, surface.dx, surface.dy, units=surface.units, progress=progress,
                   **effects_of(given, surface.period), **scene_arguments(given))
    print("\n".join(f"{name:24}{text}" for name, text in [*told(result), *_hints(given, surface.period, result)]))
    for name in given.output:
        write_fields(name, result)
    if plot:
        save(plot, result.plot)
    return 0 if result.status == OK else 1


def told(result: Result) -> list[tuple[str, str]]:
    """The lines that are printed, as pairs of a name and a text."""
    (my, mx), units, report = result.pressure.shape, result.units, result.report
    share = 100.0 * report["contact_count"] / (my * mx)

    def value(name: str, kind: str) -> str:
        return with_unit(f"{getattr(result, name):.6g}", kind, units)

    lines = [
        ("status", library.contact_normal_status_text(result.status).decode()),
        ("elements", f"{mx} x {my}"),
        ("force", value("force", "force")),
        ("approach", value("approach", "length")),
        ("largest pressure", value("max_pressure", "pressure")),
        ("contact area", f"{value('contact_area', 'area')} ({share:.3g} % of the grid)"),
        ("residual", f"{report['residual']:.1e}"),
    ]
    lines.insert(-1, ("mean gap", value("mean_gap", "length")))
    estimated, kind = ("approach", "length") if result.ledger.estimated == "approach" else ("force", "force")
    for name, key, of in ((estimated, "error_force", kind), ("pressure", "error_max_pressure", "pressure"),
                          ("area", "error_contact_area", "area")):
        error = with_unit(f"{report[key]:.1e}", of, units) + " (an estimate)" if report[key] >= 0.0 else "not known"
        lines.append((f"error of the {name}", error))
    lines += [("warning", name) for name in result.warnings]
    return [*lines, *[("message", text) for text in result.message.splitlines()]]


def _hints(given: argparse.Namespace, period: str | None, result: Result) -> list[tuple[str, str]]:
    """Hints at options that may help if one element carries most of the force, or if the contact reaches the border of the grid."""
    if given.gap:
        return []
    few = {"ONE_ELEMENT", "SPIKE"} & set(result.warnings)
    return [("hint", text) for text, helps in (
        ("--faults finds spikes and fill values, and makes them holes", few and not given.faults),
        ("--level plane removes a tilt", (few or "BORDER" in result.warnings) and not given.level),
        ("--period xy for a piece of a larger surface", "BORDER" in result.warnings and not period),
    ) if helps]
