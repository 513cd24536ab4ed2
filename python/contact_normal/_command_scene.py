"""Options of the command line that several commands have: the surface, the bodies and the load."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._heights import read_heights

if TYPE_CHECKING:
    from ._arguments import Doubles

ELASTIC = ("young_modulus", "shear_modulus", "poisson_ratio", "e_star")
LOADS = ("force", "approach", "mean_pressure")


class Surface(NamedTuple):
    """The undeformed distance of a file, and its grid."""

    h: Doubles
    dx: float
    dy: float
    units: tuple[str, str] | None


def add_scene(command: argparse.ArgumentParser) -> None:
    """The options of a surface, bodies and a load."""
    surface = command.add_argument_group("surface")
    surface.add_argument("file", help="heights: .npy, .npz, text, .nc; .x3p, .sur and more by SurfaceTopography")
    surface.add_argument("--gap", action="store_true",
                         help="the file holds the undeformed distance h; without this: heights z of body 1 towards a plane, h = max z - z")
    surface.add_argument("--variable", metavar="NAME", help="which array of an .npz or .nc file")
    surface.add_argument("--dx", type=float, help="element size along a row; by default what the file says")
    surface.add_argument("--dy", type=float, help="element size across rows; by default what the file says, else dx")
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
    """The options of effects."""
    effects = command.add_argument_group("effects")
    effects.add_argument("--period", choices=("x", "y", "xy"), help="the grid is one period of a scene that repeats itself")
    effects.add_argument("--pressure-limit", type=float, metavar="P", help="no pressure is larger: hardness")
    effects.add_argument("--layer", type=float, metavar="C", help="compliance of a thin layer, a length per pressure")
    for body in (1, 2):
        effects.add_argument(f"--coating-{body}", type=float, nargs=3, metavar=("T", "G", "NU"),
                             help=f"a layer bonded to body {body}: thickness, shear modulus, Poisson ratio")


def effects_of(given: argparse.Namespace) -> dict[str, Any]:
    """Effects as the functions of the package take them."""
    coating = tuple(tuple(layer) if layer else None for layer in (given.coating_1, given.coating_2))
    return {"period": given.period, "pressure_limit": given.pressure_limit, "layer": given.layer, "coating": coating if any(coating) else None}


def surface_of(given: argparse.Namespace) -> Surface:
    """The undeformed distance that the options name."""
    found = read_heights(given.file, given.variable)
    values = np.where(found.values == given.hole, np.nan, found.values)
    hole = np.isnan(values)
    if hole.all():
        raise ValueError(f"{given.file} has no element with a surface")
    h = values if given.gap else np.max(values[~hole]) - values
    dx = given.dx if given.dx is not None else found.dx
    if dx is None:
        raise ValueError(f"{given.file} does not say its element size; give it by --dx")
    dy = given.dy if given.dy is not None else found.dy if found.dy is not None and given.dx is None else dx
    if found.unit and given.units is None:
        print(f"lengths in {found.unit}, as {given.file} says: moduli and load must be in units that go with it", file=sys.stderr)
    return Surface(np.where(hole, np.inf, h), dx, dy, tuple(given.units) if given.units else None)


def scene_arguments(given: argparse.Namespace) -> dict[str, Any]:
    """Bodies, load and options as the functions of the package take them."""
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
