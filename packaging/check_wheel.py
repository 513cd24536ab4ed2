"""Fails if a wheel's tag is not true: `check_wheel.py WHEEL [NEWEST]`.

The library inside must be one for the platform and the machine of the tag, need no symbol of a newer glibc than the tag promises, and
load nothing but what every Linux has. With NEWEST, such as manylinux_2_28, the tag may not ask for a newer glibc than that one.
"""

import re
import sys
import zipfile
from pathlib import Path

from library_file import read

# Of those that PEP 600 lets a wheel expect of the system, the ones that Rust links.
EXPECTED = re.compile(r"lib(c|m|dl|rt|pthread|gcc_s|util)\.so\.\d|ld-linux-(x86-64|aarch64)\.so\.\d")
LIBRARY = re.compile(r"contact_normal/(lib)?contact_normal\.(so|dylib|dll)")


def check(wheel, newest=None):
    """The tag and the library's own.

    Raises
    ------
    ValueError
        If the tag is not true.
    """
    tag = Path(wheel).stem.split("-")[-1]
    with zipfile.ZipFile(wheel) as files:
        listed = files.namelist()
        found = [name for name in listed if LIBRARY.fullmatch(name)]
        if len(found) != 1:
            raise ValueError(f"{len(found)} libraries in the wheel: {found}")
        file = read(files.read(found[0]))
        description = next(files.read(name).decode() for name in listed if name.endswith(".dist-info/WHEEL"))
    if f"Tag: py3-none-{tag}\n" not in description:
        raise ValueError(f"the name says {tag}, its description:\n{description}")
    if file.system != "linux":
        if file.tag() != tag:
            raise ValueError(f"the tag is {tag}, the library's {file.tag()}")
        return tag, file.tag()
    promised, machine = parts(tag)
    if machine != file.machine:
        raise ValueError(f"the tag is for {machine}, the library for {file.machine}")
    too_new = sorted(version for version in file.versions if version.startswith("GLIBC_2.") and int(version.split(".")[1]) > promised)
    if too_new or file.glibc() > promised:
        raise ValueError(f"the tag promises GLIBC_2.{promised}; the library needs {', '.join(too_new)}")
    if newest is not None and promised > parts(f"{newest}_{machine}")[0]:
        raise ValueError(f"the tag is {tag}, newer than {newest}")
    others = [name for name in file.libraries if not EXPECTED.fullmatch(name)]
    if others:
        raise ValueError(f"the library loads {', '.join(others)}")
    return tag, file.tag()


def parts(tag):
    """N and the machine of manylinux_2_N_machine."""
    found = re.fullmatch(r"manylinux_2_(\d+)_(\w+)", tag)
    if not found:
        raise ValueError(f"{tag} is no tag of the form manylinux_2_N_machine")
    return int(found[1]), found[2]


if __name__ == "__main__":
    try:
        print("{}: the library asks for {}".format(*check(*sys.argv[1:])))
    except ValueError as error:
        sys.exit(f"{sys.argv[1]}: {error}")
