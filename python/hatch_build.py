"""Puts the shared library into the wheel, stripped, and tags the wheel py3-none-<platform>.

The library is built by `cargo build --release --locked`, or is the one that the environment variable CONTACT_NORMAL_LIBRARY names.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "packaging"), str(ROOT / "python" / "contact_normal")]
from _names import names  # noqa: E402
from library_file import read  # noqa: E402

# sys.platform of the systems on which a library of this kind runs.
PLATFORMS = {"linux": "linux", "macosx": "darwin", "win": "win32"}


class Library(BuildHookInterface):
    """The hook that hatchling calls before it writes a wheel."""

    def initialize(self, version, build_data):
        root = Path(self.root)
        library = Path(os.environ.get("CONTACT_NORMAL_LIBRARY") or built_by_cargo(root))
        file = read(library.read_bytes())
        name = names(PLATFORMS[file.system]).built
        self.folder = tempfile.TemporaryDirectory()
        stripped = Path(self.folder.name) / name
        shutil.copyfile(library, stripped)
        # On macOS the debug information is not in the library. On Windows strip is MinGW-w64's, if the library was built with it.
        strip = os.environ.get("STRIP", "strip")
        if file.system == "linux" or file.system == "win" and shutil.which(strip):
            subprocess.run([strip, "--strip-unneeded", stripped], check=True)
        build_data["force_include"][str(stripped)] = f"contact_normal/{name}"
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{file.tag()}"

    def finalize(self, version, build_data, artifact_path):
        self.folder.cleanup()


def built_by_cargo(root):
    """The library of a release build in this clone."""
    cargo = shutil.which("cargo")
    if cargo is None:
        raise SystemExit("contact-normal is built from source by Rust: install it from https://rustup.rs, or install a wheel")
    subprocess.run([cargo, "build", "--release", "--locked", "--lib"], cwd=root, check=True)
    return Path(os.environ.get("CARGO_TARGET_DIR") or root / "target") / "release" / names(sys.platform).built
