"""Options that several commands share: the surface, the bodies and the load."""

from __future__ import annotations

import argparse
import dataclasses
import sys
from pathlib import Path
from typing import Any

import numpy as np

from .surface import Gap, Heights, faults, gap, level, read

ELASTIC = ("young_modulus", "shear_modulus", "poisson_ratio", "e_star")
# The usage that is printed with an error message. It is short, because a list of all options would hide the message.
USAGE = "%(prog)s FILE [options]; %(prog)s --help lists them"
LOADS = ("force", "approach", "mean_pressure")


def add_scene(command: argparse.ArgumentParser) -> None:
    """Adds the options of a surface, bodies and a load."""
    surface = command.add_argument_group("surface")
    surface.add_argument("file", help="heights: .npy, .npz, text, .nc; .x3p, .sur and more by SurfaceTopography")
    surface.add_argument("--gap", action="store_true",
                         help="the file holds the undeformed distance h; without this: heights z of body 1 towards a plane, h = max z - z")
    surface.add_argument("--level", choices=("mean", "plane", "quadric"), help="removes a tilt or a form, fitted by least squares")
    surface.add_argument("--faults", action="store_true", help="finds fill values and spikes, prints them, and makes them holes")
    surface.add_argument("--variable", metavar="NAME", help="which array of an .npz, .nc, .mat or instrument's file")
    surface.add_argument("--dx", type=float, help="element size along a row; by default what the file says")
    surface.add_argument("--dy", type=float, help="element size across rows; by default what the file says, else dx")
    surface.add_argument("--axes", choices=("yx", "xy"), help="what the indices of the array are: yx: [iy, ix]; xy: [ix, iy]; by default what the file says, else yx")
    surface.add_argument("--top-first", action="store_true", help="the first row is that of the largest y, as in an image")
    surface.add_argument("--hole", type=float, metavar="VALUE", help="elements with this value have no surface, as those with NaN")
    surface.add_argument("--units", nargs=2, metavar=("LENGTH", "FORCE"), help="names for output, as: --units m N; they change no number")
    bodies = command.add_argument_group("bodies: one modulus; one value, or one for each body")
    bodies.add_argument("--young-modulus", type=float, nargs="+", metavar="E")
    bodies.add_argument("--shear-modulus", type=float, nargs="+", metavar="G")
    bodies.add_argument("--poisson-ratio", type=float, nargs="+", metavar="NU")
    bodies.add_argument("--e-star", type=float, metavar="E*", help="1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2")
    load = command.add_argument_group("load: one of these").add_mutually_exclusive_group(required=True)
    for name, text in zip(LOADS, ("normal force", "approach of the bodies", "force over the area of the grid")):
        load.add_argument("--" + name.replace("_", "-"), type=float, help=text)
    command.add_argument("--tolerance", type=float, help="of the residual; default 1e-6")
    command.add_argument("--threads", type=int, default=0, help="default 0: all cores")


def add_effects(command: argparse.ArgumentParser) -> None:
    """Adds the options of effects."""
    effects = command.add_argument_group("effects")
    effects.add_argument("--period", choices=("x", "y", "xy", "none"),
                         help="the grid is one period of a scene that repeats itself; by default what the file says, else none")
    effects.add_argument("--pressure-limit", type=float, metavar="P", help="no pressure is larger: hardness")
    effects.add_argument("--layer", type=float, metavar="C", help="compliance of a thin layer, a length per pressure")
    for body in (1, 2):
        effects.add_argument(f"--coating-{body}", type=float, nargs=3, metavar=("T", "G", "NU"),
                             help=f"a layer bonded to body {body}: thickness, shear modulus, Poisson ratio")


def effects_of(given: argparse.Namespace, period: str | None) -> dict[str, Any]:
    """The effects of the options, as arguments of `solve`. `period` is that of the gap."""
    coating = tuple(tuple(layer) if layer else None for layer in (given.coating_1, given.coating_2))
    return {"period": period, "pressure_limit": given.pressure_limit, "layer": given.layer, "coating": coating if any(coating) else None}


def _period_of(found: Gap | Heights, given: argparse.Namespace) -> str | None:
    """The period that the options give, else that of the file, with a note on stderr."""
    if given.period is not None:
        return None if given.period == "none" else str(given.period)
    if found.period:
        print(f"the surface repeats itself in {found.period}, as {given.file} says: --period none takes it as a piece alone", file=sys.stderr)
    return found.period


def gap_of(given: argparse.Namespace) -> Gap:
    """Reads the file of the options, prepares its heights as the options say, and returns the gap."""
    if given.gap and Gap.is_in(given.file):
        for name in ("dx", "dy", "axes", "top_first", "variable", "hole", "faults", "level"):
            if getattr(given, name) not in (None, False):
                raise ValueError(f"{given.file} is a gap with the sizes of its elements, as Gap.write makes it: --{name.replace('_', '-')} does not go with it")
        found = Gap.read(given.file)
        return dataclasses.replace(found, units=tuple(given.units) if given.units else None, period=_period_of(found, given))
    if not given.gap and Path(given.file).is_file() and Gap.is_in(given.file):
        raise ValueError(f"{given.file} holds a gap, and not heights: add --gap")
    heights = _heights_of(given)
    period = _period_of(heights, given)
    # `level` refuses a periodic surface. The measured field is therefore levelled without its period, which is set afterwards.
    heights = dataclasses.replace(heights, period=None)
    if given.faults:
        found_faults = faults(heights)
        print(found_faults, file=sys.stderr)
        heights = found_faults.removed
    if given.level:
        heights = level(heights, given.level)
    heights = dataclasses.replace(heights, period=period)
    if heights.holes.all():
        raise ValueError(f"{given.file} has no element with a surface")
    if given.gap:
        return Gap(np.where(heights.holes, np.inf, heights.z), heights.dx, heights.dy, period=period, units=heights.units)
    return gap(heights)


def _heights_of(given: argparse.Namespace) -> Heights:
    """The heights of the file. Options replace what the file says of sizes, units and order of the elements."""
    said: dict[str, Any] = {}
    if given.hole is not None:
        said["fill"] = given.hole
    if given.dy is not None and given.dx is None:
        raise ValueError("--dy goes with --dx: both are the sizes of an element")
    if given.dx is not None:
        said.update(dx=given.dx, dy=given.dx if given.dy is None else given.dy)
    if given.units:
        said["units"] = tuple(given.units)
    if given.axes:
        said["axes"] = given.axes
    if given.top_first:
        said["top_first"] = True
    try:
        heights = read(given.file, given.variable, **said)
    except TypeError as error:
        if given.dx is None and "size of an element" in str(error):
            raise TypeError(f"{given.file} does not say how large its elements are: give --dx, and --dy if it differs") from error
        raise
    except (OSError, ImportError, ValueError):
        raise
    except Exception as error:  # The readers of other packages raise errors of their own.
        raise ValueError(f"{given.file}: {error}") from error
    if heights.units and not given.units:
        print(f"lengths in {heights.units[0]}, as {given.file} says: moduli and load must be in units that go with it", file=sys.stderr)
    return heights


def scene_arguments(given: argparse.Namespace) -> dict[str, Any]:
    """The elastic constants, the load and the options of a solve, as arguments of `solve`."""
    found: dict[str, Any] = {name: getattr(given, name) for name in LOADS}
    for name in ELASTIC:
        value = getattr(given, name)
        if isinstance(value, list):
            if len(value) > 2:
                raise ValueError(f"--{name.replace('_', '-')} has {len(value)} values; it takes one, or one for each of the two bodies")
            value = value[0] if len(value) == 1 else tuple(value)
        found[name] = value
    if given.tolerance is not None:
        found["tolerance"] = given.tolerance
    return {**found, "threads": given.threads}
