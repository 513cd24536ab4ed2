"""`contact-normal replay`: replays the call of a dump, by the program contact-normal-replay."""

from __future__ import annotations

import argparse
import shutil
import subprocess
from pathlib import Path
from typing import Any

from ._library import candidates

PROGRAM = "contact-normal-replay"
# The exit code is this plus the number of the signal that ended the program, as in shells.
SIGNAL = 128


def add(commands: Any) -> None:
    """Adds the command and its options."""
    command = commands.add_parser("replay", help="makes the call of a dump again",
                                  description="Makes the call of a dump again, by contact-normal-replay, whose exit code it returns.")
    command.add_argument("file", help="what a call with the option dump has written")
    command.set_defaults(run=run)


def program() -> str:
    """The path of contact-normal-replay: beside the library, in `bin` beside the library's folder, or in PATH."""
    library = Path(candidates()[0])
    folder = library.resolve().parent
    # A library without a folder in its name is found by the system's loader; then its folder is not known.
    for place in (folder, folder.parent / "bin") if library.name != str(library) else ():
        found = shutil.which(PROGRAM, path=str(place))
        if found:
            return found
    found = shutil.which(PROGRAM)
    if not found:
        raise FileNotFoundError(f"{PROGRAM} is not beside the library and not in PATH: `make install` of the project installs it")
    return found


def run(given: argparse.Namespace) -> int:
    """Runs the program on the dump, and returns its exit code."""
    code = subprocess.run([program(), given.file], check=False).returncode
    return code if code >= 0 else SIGNAL - code
