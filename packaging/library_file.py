"""Reads what a shared library is made for and what it asks of the system: for the tag of a wheel, on any machine.

Of ELF (Linux), 64 bits, little-endian; of Mach-O (macOS) and PE (Windows) the machine only.
"""

import os
import struct
from typing import NamedTuple

ELF_MACHINES = {62: "x86_64", 183: "aarch64"}
MACH_O_MACHINES = {0x01000007: "x86_64", 0x0100000C: "arm64"}
PE_MACHINES = {0x8664: "amd64", 0xAA64: "arm64"}

DYNAMIC, VERSIONS_NEEDED = 6, 0x6FFFFFFE
NEEDED = 1


class LibraryFile(NamedTuple):
    """One file."""

    system: str
    """linux, macosx or win: as tags of wheels begin."""
    machine: str
    """As tags of wheels end."""
    libraries: tuple = ()
    """The shared libraries that it loads."""
    versions: tuple = ()
    """The versions of symbols that it needs of them: GLIBC_2.17, ..."""

    def glibc(self):
        """N of the newest GLIBC_2.N that is needed; 0 if none is.

        Raises
        ------
        ValueError
            If a version says nothing of the release of glibc: GLIBC_PRIVATE, GLIBC_ABI_DT_RELR.
        """
        needed = [version for version in self.versions if version.startswith("GLIBC_")]
        for version in needed:
            if not version.startswith("GLIBC_2."):
                raise ValueError(f"the library needs {version}, which no tag of a wheel promises")
        return max((int(version.split(".")[1]) for version in needed), default=0)

    def tag(self):
        """The platform's tag of a wheel that contains it: PEP 600 for Linux."""
        if self.system == "linux":
            glibc = self.glibc()
            return f"manylinux_2_{glibc}_{self.machine}" if glibc else f"linux_{self.machine}"
        if self.system == "macosx":
            # Rust's own oldest versions.
            oldest = os.environ.get("MACOSX_DEPLOYMENT_TARGET") or {"arm64": "11.0", "x86_64": "10.12"}[self.machine]
            return f"macosx_{oldest.replace('.', '_')}_{self.machine}"
        return f"win_{self.machine}"


def read(data):
    """What the bytes of a file say.

    Raises
    ------
    ValueError
        If it is no shared library of a known kind.
    """
    if data[:6] == b"\x7fELF\x02\x01":
        return elf(data)
    if data[:4] == struct.pack("<I", 0xFEEDFACF):
        return LibraryFile("macosx", known(MACH_O_MACHINES, struct.unpack_from("<I", data, 4)[0]))
    if data[:2] == b"MZ":
        header = struct.unpack_from("<I", data, 0x3C)[0]
        if data[header:header + 4] == b"PE\0\0":
            return LibraryFile("win", known(PE_MACHINES, struct.unpack_from("<H", data, header + 4)[0]))
    raise ValueError("no shared library of Linux, macOS or Windows")


def known(machines, number):
    """The machine's name."""
    if number not in machines:
        raise ValueError(f"a library for a machine that has no name here: {number:#x}")
    return machines[number]


def elf(data):
    """An ELF file: by its table of sections."""
    machine = known(ELF_MACHINES, struct.unpack_from("<H", data, 18)[0])
    start, = struct.unpack_from("<Q", data, 40)
    size, count = struct.unpack_from("<HH", data, 58)
    # name, kind, flags, address, offset, size, link, info, alignment, size of an entry
    sections = [struct.unpack_from("<IIQQQQIIQQ", data, start + size * k) for k in range(count)]

    def text(section, offset):
        begin = sections[section[6]][4] + offset
        return data[begin:data.index(b"\0", begin)].decode()

    libraries, versions = [], []
    for section in sections:
        if section[1] == DYNAMIC:
            entries = struct.iter_unpack("<QQ", data[section[4]:section[4] + section[5]])
            libraries += [text(section, value) for tag, value in entries if tag == NEEDED]
        elif section[1] == VERSIONS_NEEDED:
            versions += [text(section, name) for name in needed(data, section[4], section[7])]
    return LibraryFile("linux", machine, tuple(libraries), tuple(versions))


def needed(data, place, count):
    """Offsets of the names in a section of needed versions: `count` libraries, each with a chain of versions."""
    for _ in range(count):
        _, versions, _, first, following = struct.unpack_from("<HHIII", data, place)
        entry = place + first
        for _ in range(versions):
            _, _, _, name, after = struct.unpack_from("<IHHII", data, entry)
            yield name
            entry += after
        place += following
