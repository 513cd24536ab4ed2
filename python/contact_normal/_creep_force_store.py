"""The finished planes of a table, in a folder beside it. Each plane is written whole or not at all."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ._creep_force_plane import AXES, Plan


def key(plan: Plan) -> str:
    """A hash of the axes, elements, tolerance and surface of a plan, by which the files of equal plans are recognised."""
    axes = {name: getattr(plan, name) for name in (*AXES, "elements", "tolerance")}
    digest = hashlib.sha256(json.dumps(axes, sort_keys=True).encode())
    for grid in () if plan.surface is None else (plan.surface["fine"], plan.surface["coarse"]):
        for name in ("pressure", "dx", "dy", "shear_modulus", "poisson_ratio"):
            digest.update(np.ascontiguousarray(grid[name], dtype=float).tobytes())
        for name, value in sorted(grid["friction"].items()):
            digest.update(name.encode())
            digest.update(value.encode() if isinstance(value, str) else np.ascontiguousarray(value, dtype=float).tobytes())
    return digest.hexdigest()


class Journal:
    """The finished planes of a table, in the folder `<path>.parts`.

    Parameters
    ----------
    path : path
        The path of the table.
    plan : Plan
        The plan of the table. A folder of another plan is refused.
    """

    def __init__(self, path: str | os.PathLike[str], plan: Plan) -> None:
        self._path, self._key = Path(path), key(plan)
        self._folder = self._path.with_name(self._path.name + ".parts")
        self._folder.mkdir(parents=True, exist_ok=True)
        told = self._folder / "plan"
        if not told.exists():
            _replace(told, self._key.encode())
        elif told.read_text() != self._key:
            raise ValueError(f"{self._folder} has the parts of another table; choose another path, or remove the folder")

    def _file(self, index: int) -> Path:
        return self._folder / f"{index:06d}.npz"

    def leave(self) -> None:
        """Removes the folder if it has no plane. It is called if the library refuses the table."""
        if not any(self._folder.glob("[0-9]*.npz")):
            shutil.rmtree(self._folder, ignore_errors=True)

    def done(self) -> dict[int, dict[str, Any]]:
        """The finished planes by their index."""
        found = {}
        for file in sorted(self._folder.glob("[0-9]*.npz")):
            with np.load(file) as arrays:
                found[int(file.stem)] = dict(arrays)
        return found

    def write(self, index: int, arrays: Mapping[str, Any]) -> None:
        """Writes a finished plane into the folder."""
        file = self._file(index)
        unfinished = file.with_suffix(".unfinished")
        with open(unfinished, "wb") as out:
            np.savez(out, **arrays)
            out.flush()
            os.fsync(out.fileno())
        os.replace(unfinished, file)

    def finish(self) -> None:
        """Removes the folder. It is called after the whole table is written."""
        shutil.rmtree(self._folder)


def _replace(file: Path, content: bytes) -> None:
    unfinished = file.with_suffix(".unfinished")
    unfinished.write_bytes(content)
    os.replace(unfinished, file)
