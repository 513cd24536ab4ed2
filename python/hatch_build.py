"""Puts the shared library into the wheel, stripped, and tags the wheel py3-none-<platform>.

The library is built by `cargo build --release --locked`, or is the one that the environment variable CONTACT_NORMAL_LIBRARY names.
"""

import os
import re
import shutil
import subprocess
import sysconfig
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Library(BuildHookInterface):
    """What hatchling calls before it writes a wheel."""

    def initialize(self, version, build_data):
        root = Path(self.root)
        library = Path(os.environ.get("CONTACT_NORMAL_LIBRARY") or built_by_cargo(root))
        self.folder = tempfile.TemporaryDirectory()
        stripped = Path(self.folder.name) / "libcontact_normal.so"
        shutil.copyfile(library, stripped)
        subprocess.run(["strip", "--strip-unneeded", stripped], check=True)
        build_data["force_include"][str(stripped)] = "contact_normal/libcontact_normal.so"
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{platform_of(stripped)}"

    def finalize(self, version, build_data, artifact_path):
        self.folder.cleanup()


def built_by_cargo(root):
    """The library of a release build in this clone."""
    cargo = shutil.which("cargo")
    if cargo is None:
        raise SystemExit("contact-normal is built from source by Rust: install it from https://rustup.rs, or install a wheel")
    subprocess.run([cargo, "build", "--release", "--locked", "--lib"], cwd=root, check=True)
    return Path(os.environ.get("CARGO_TARGET_DIR") or root / "target") / "release" / "libcontact_normal.so"


def platform_of(library):
    """manylinux_2_N_<machine>, for the newest version of glibc that the library asks for: PEP 600."""
    machine = sysconfig.get_platform()
    if not machine.startswith("linux-"):
        return re.sub(r"[-.]", "_", machine)
    symbols = subprocess.run(["objdump", "-T", library], check=True, capture_output=True, text=True).stdout
    newest = max(int(minor) for minor in re.findall(r"GLIBC_2\.(\d+)", symbols))
    return f"manylinux_2_{newest}_{machine[len('linux-'):]}"
