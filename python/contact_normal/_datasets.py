"""Results as xarray datasets, with names and units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._library import VERSION
from ._netcdf import xarray
from ._result import Result
from ._units import Units, unit

if TYPE_CHECKING:
    from ._solved import Solved
    from ._stress import SubsurfaceStress

# For each field its description, and the kind of its unit ("": it has none).
_FIELDS = {
    "pressure": ("pressure", "pressure"),
    "deformed_distance": ("deformed distance", "length"),
    "displacement": ("normal displacement of both bodies", "length"),
    "contact": ("contact area", ""),
    "at_limit": ("elements at the pressure limit", ""),
}
_OF_FRICTION = {
    "traction": ("traction on body 1", "pressure"),
    "slip": ("slip of body 1 over body 2 in the step", "length"),
    "stick_slip": ("0 exterior, 1 stick, 2 slip, 3 plastic", ""),
}
# Fields that only some scenes have.
_OF_EFFECTS = {
    "contact_pressure": ("pressure in contact, beside the attraction", "pressure"),
    "attraction": ("attraction across the gap", "pressure"),
    "friction_coefficient": ("coefficient of friction that particles carry after the step", ""),
    "yield_limit": ("yield limit that particles carry after the step", "pressure"),
}
_STRESSES = {
    **{name: f"stress {name}" for name in ("xx", "yy", "zz", "xy", "xz", "yz")},
    "von_mises": "von Mises stress",
    "maximum_shear": "largest shear stress",
}


def _told(name: str, kind: str, units: Units) -> dict[str, str]:
    attributes = {"long_name": name}
    if kind and units:
        attributes["units"] = unit(kind, units)
    return attributes


def _coordinates(x: Any, y: Any, units: Units) -> dict[str, Any]:
    return {"x": ("x", x, _told("x of the centres of the elements", "length", units)),
            "y": ("y", y, _told("y of the centres of the elements", "length", units))}


def of_result(result: Solved) -> Any:
    """See `Result.to_xarray`."""
    units, coordinates = result.units, _coordinates(result.x, result.y, result.units)
    variables: dict[str, Any] = {}
    fields = {**_FIELDS, **(_OF_FRICTION if result.has_friction else {})}
    for name, (what, kind) in fields.items():
        values = getattr(result, name, None)
        if values is None:
            continue
        if values.dtype == bool:
            values = values.astype(np.int8)
        dimensions = ("component", "y", "x") if values.ndim == 3 else ("y", "x")
        variables[name] = (dimensions, values, _told(what, kind, units))
    for name, (what, kind) in _OF_EFFECTS.items():
        if name in result._of_effects:
            variables[name] = (("y", "x"), getattr(result, name), _told(what, kind, units))
    if result.has_friction:
        coordinates["component"] = ("component", ["x", "y"])
    attributes = {"status": result.status, "message": result.message, "dx": result.dx, "dy": result.dy, "made_by": f"contact-normal {VERSION}",
                  **{name: list(value) if isinstance(value, tuple) else value for name, value in result.report.items()}}
    if isinstance(result, Result) and result.ledger:
        for name in result.ledger[0]:
            variables[f"ledger_{name}"] = ("grid", np.array([row[name] for row in result.ledger]))
    return xarray(in_files=False).Dataset(variables, coordinates, attributes)


def of_stress(stress: SubsurfaceStress) -> Any:
    """See `SubsurfaceStress.to_xarray`."""
    units, dimensions = stress.units, ("depth", "y", "x")
    variables: dict[str, Any] = {name: (dimensions, getattr(stress, name), _told(what, "pressure", units))
                                 for name, what in _STRESSES.items() if getattr(stress, name) is not None}
    coordinates = {**_coordinates(stress.x, stress.y, units), "depth": ("depth", stress.depths, _told("depth into the body", "length", units))}
    if stress.principal is not None and stress.directions is not None:
        variables["principal"] = (("order", *dimensions), stress.principal, _told("principal stresses, the largest first", "pressure", units))
        variables["directions"] = (("order", *dimensions, "component"), stress.directions, _told("their directions", "", units))
        coordinates["component"] = ("component", ["x", "y", "z"])
    return xarray(in_files=False).Dataset(variables, coordinates, {"dx": stress.dx, "dy": stress.dy, "made_by": f"contact-normal {VERSION}"})
