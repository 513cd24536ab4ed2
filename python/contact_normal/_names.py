"""The file names of the library on each platform, and their places in an installation."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class Names(NamedTuple):
    """File names of the shared library on one platform."""

    built: str
    """The file that cargo builds, and that a wheel contains."""
    installed: str
    """The file that a linked program loads: its name changes when the ABI breaks."""
    folders: tuple[str, ...]
    """The folders of the file in an installation, below the prefix."""


def names(platform: str) -> Names:
    """The names on `platform`, a value of `sys.platform`."""
    if platform in ("win32", "cygwin"):
        # DLLs stand beside the programs; conda has them in Library.
        return Names("contact_normal.dll", "contact_normal.dll", ("bin", "Library/bin"))
    if platform == "darwin":
        return Names("libcontact_normal.dylib", "libcontact_normal.2.dylib", ("lib",))
    return Names("libcontact_normal.so", "libcontact_normal.so.2", ("lib",))


def places(package: Path, prefixes: list[Path], platform: str) -> list[Path]:
    """Where the library may be, the best place first: in the package's folder (a wheel), in the clone that has this folder, in an
    installation below one of the prefixes.
    """
    name = names(platform)
    installed = [prefix / folder / name.installed for prefix in prefixes for folder in name.folders]
    return [package / name.built, package.parents[1] / "target" / "release" / name.built, *installed]
