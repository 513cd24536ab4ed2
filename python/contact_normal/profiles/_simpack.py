"""Reads rails and wheels of SIMPACK: texts with a header of lines `name = value`, and points."""

from __future__ import annotations

import os
import re
import warnings

import numpy as np

from ._columns import NUMBER, columns_of, to_number

# The entries of the header that change the points, with their defaults. Bounds apply only if the lower one is less than the upper one.
_SAID = {
    "shift.y": 0.0, "shift.z": 0.0, "rotate": 0.0, "bound.y.min": 1.0, "bound.y.max": 0.0, "bound.z.min": 1.0, "bound.z.max": 0.0,
    "mirror.y": 0.0, "mirror.z": 0.0, "inversion": 0.0, "units.len.f": 1000.0, "units.ang.f": 1.0, "approx.smooth": 0.0, "point.dist.min": 0.0,
}
_KINDS = {0.0: "rail", 1.0: "wheel"}


def points_of(text: str, kind: str, path: str | os.PathLike[str]) -> tuple[np.ndarray, float]:
    """Reads the points, and applies the shift, rotation, bounds, mirrors and inversion of the header. Returns them, and the length of their unit in mm."""
    text = "\n".join(line.split("!")[0] for line in text.splitlines())
    found = re.search(r"point\.begin(.*?)point\.end", text, re.DOTALL | re.IGNORECASE)
    if not found:
        raise ValueError(f"{path} has no points between point.begin and point.end")
    points, _ = columns_of(found.group(1), (0, 1), path)
    said = _header(text[: found.start()], path)
    _check_kind(text, kind, path)
    y, z = points[:, 0] + said["shift.y"], points[:, 1] + said["shift.z"]
    angle = said["rotate"] / said["units.ang.f"]
    y, z = np.cos(angle) * y - np.sin(angle) * z, np.sin(angle) * y + np.cos(angle) * z
    inside = np.ones(len(y), dtype=bool)
    for values, axis in ((y, "y"), (z, "z")):
        low, high = said[f"bound.{axis}.min"], said[f"bound.{axis}.max"]
        if low < high:
            inside &= (values >= low) & (values <= high)
    if inside.sum() < 4:
        raise ValueError(f"{path} has {inside.sum()} points within its bounds, bound.y.min, ... of its header; at least 4 are needed")
    y, z = y[inside], z[inside]
    if said["mirror.y"]:
        y = -y
    if said["mirror.z"]:
        z = -z
    if said["inversion"]:
        y, z = y[::-1], z[::-1]
    return np.column_stack([y, z]), 1000.0 / said["units.len.f"]


def _header(text: str, path: str | os.PathLike[str]) -> dict[str, float]:
    """The values of the header's entries `_SAID`, whose names may be in upper or lower case. A value that is no number is refused, as it changes the points."""
    said = dict(_SAID)
    for name, value in re.findall(r"^\s*([\w.]+)\s*=\s*(.*?)\s*$", text, re.MULTILINE):
        key = name.lower()
        if key not in said:
            continue
        number = re.fullmatch(rf"(['\"]?)({NUMBER})\1\s*;?\s*(?:#.*|//.*)?", value)
        if not number:
            raise ValueError(f"{path} has {name} = {value} in its header; it must be a number: expressions and variables are not evaluated")
        said[key] = to_number(number[2])
    for name in ("units.len.f", "units.ang.f"):
        if not said[name] > 0.0:
            raise ValueError(f"{path} has {name} = {said[name]:g} in its header; it must be positive")
    for name in ("approx.smooth", "point.dist.min"):
        if said[name]:
            warnings.warn(f"{path} has {name} = {said[name]:g} in its header, which is not obeyed: smoothed(wave_length) and thinned(step) do the like",
                          stacklevel=5)
    return said


def _check_kind(text: str, kind: str, path: str | os.PathLike[str]) -> None:
    """Raises an error if the header says that a rail is read as a wheel, or a wheel as a rail."""
    header = re.search(r"header\.begin(.*?)header\.end", text, re.DOTALL | re.IGNORECASE)
    said = re.search(rf"^\s*type\s*=\s*({NUMBER})\s*$", header[1], re.MULTILINE | re.IGNORECASE) if header else None
    is_kind = _KINDS.get(to_number(said[1])) if said else None
    if is_kind and is_kind != kind:
        raise ValueError(f'{path} says type = {said[1]}, a {is_kind}: kind="{is_kind}"' if said else "")
