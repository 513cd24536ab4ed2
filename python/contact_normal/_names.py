"""The file names of the shared library on each platform, and the folders where it may be."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class Names(NamedTuple):
    """File names of the shared library on one platform."""

    built: str
    """The file that cargo builds, and that a wheel contains."""
    installed: str
    """The file that a linked program loads. Its name has the version of the ABI, where the platform has such names."""
    folders: tuple[str, ...]
    """The folders below an installation's prefix that may have the file."""


def names(platform: str) -> Names:
    """The names of the library on `platform`, a value of `sys.platform`."""
    if platform in ("win32", "cygwin"):
        # On Windows DLLs are in the folder of the programs; those of conda are in Library/bin.
        return Names("contact_normal.dll", "contact_normal.dll", ("bin", "Library/bin"))
    if platform == "darwin":
        return Names("libcontact_normal.dylib", "libcontact_normal.2.dylib", ("lib",))
    return Names("libcontact_normal.so", "libcontact_normal.so.2", ("lib",))


def places(package: Path, prefixes: list[Path], platform: str) -> list[Path]:
    """The paths where the library may be, the best one first: in the folder of the package (a wheel), in the clone of the repository that has this folder, in
    an installation below one of the prefixes.
    """
    name = names(platform)
    installed = [prefix / folder / name.installed for prefix in prefixes for folder in name.folders]
    return [package / name.built, package.parents[1] / "target" / "release" / name.built, *installed]
