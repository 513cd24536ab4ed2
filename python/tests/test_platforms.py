"""Names of the library on each platform, and true tags of wheels."""

import contextlib
import fnmatch
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path
from unittest import mock

import numpy as np

from contact_normal import _command_replay, _library
from contact_normal._command import main
from contact_normal._names import names, places

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "packaging"))
from check_wheel import check  # noqa: E402
from library_file import LibraryFile, read  # noqa: E402

BUILT = Path(_library.candidates()[0]).resolve()


class Places(unittest.TestCase):
    package, prefix = Path("/clone/python/contact_normal"), Path("/prefix")

    def test_names(self):
        # The name that cargo gives a cdylib on each platform.
        for platform, built in (("linux", "libcontact_normal.so"), ("freebsd14", "libcontact_normal.so"),
                                ("darwin", "libcontact_normal.dylib"), ("win32", "contact_normal.dll"), ("cygwin", "contact_normal.dll")):
            self.assertEqual(names(platform).built, built, platform)
            found = places(self.package, [self.prefix], platform)
            self.assertEqual(found[:2], [self.package / built, Path("/clone/target/release") / built], platform)

    def test_the_soname_is_that_of_the_build(self):
        build = (Path(__file__).resolve().parents[2] / "build.rs").read_text()
        for platform in ("linux", "darwin"):
            self.assertIn(f'"{names(platform).installed}"', build)

    def test_cargo_cinstall_has_all_headers(self):
        root = Path(__file__).resolve().parents[2]
        section = (root / "Cargo.toml").read_text().split("[package.metadata.capi.install.include]")[1].split("\n[")[0]
        patterns = re.findall(r'from = "([^"]+)"', section)
        headers = [f"include/{path.name}" for path in (root / "include").iterdir() if path.suffix in (".h", ".hpp", ".f90", ".inc")]
        self.assertGreater(len(headers), 20)
        self.assertEqual([name for name in headers if not any(fnmatch.fnmatch(name, pattern) for pattern in patterns)], [])

    def test_installations(self):
        for platform, expected in (("linux", ["lib/libcontact_normal.so.2"]), ("darwin", ["lib/libcontact_normal.2.dylib"]),
                                   ("win32", ["bin/contact_normal.dll", "Library/bin/contact_normal.dll"])):
            found = places(self.package, [self.prefix, Path("/other")], platform)[2:]
            self.assertEqual(found, [prefix / name for prefix in (self.prefix, Path("/other")) for name in expected], platform)

    def test_only_what_is_there_is_tried_and_the_system_is_asked_where_nothing_is(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix = Path(folder)
            for platform in ("linux", "darwin", "win32"):
                place = places(Path(_library.__file__).resolve().parent, [prefix], platform)[2]
                place.parent.mkdir(exist_ok=True)
                place.write_bytes(b"")
                with mock.patch.object(_library.sys, "platform", platform), mock.patch.object(_library.sys, "prefix", folder), \
                        mock.patch.dict(_library.os.environ), mock.patch.object(_library.ctypes.util, "find_library", return_value=None):
                    _library.os.environ.pop("CONTACT_NORMAL_LIBRARY", None)
                    found = _library.candidates()
                    self.assertIn(str(place), found, platform)
                    # find_library, which starts other programs, is not called if a file is found.
                    _library.ctypes.util.find_library.assert_not_called()
                    with mock.patch.object(_library, "places", return_value=[]):
                        self.assertEqual(_library.candidates(), [names(platform).installed], platform)


def portable_executable(machine):
    """The beginning of a DLL: the place of the header is at 0x3C."""
    return b"MZ" + bytes(0x3A) + struct.pack("<I", 0x80) + bytes(0x40) + b"PE\0\0" + struct.pack("<H", machine)


class Files(unittest.TestCase):
    @unittest.skipUnless(sys.platform == "linux" and shutil.which("readelf"), "readelf is of Linux")
    def test_needs_are_those_that_readelf_prints(self):
        file = read(BUILT.read_bytes())
        needed = subprocess.run(["readelf", "-W", "--version-info", BUILT], capture_output=True, text=True, check=True).stdout
        self.assertEqual(sorted(file.versions), sorted(re.findall(r"Name: (\S+)  Flags", needed)))
        loaded = subprocess.run(["readelf", "-d", BUILT], capture_output=True, text=True, check=True).stdout
        self.assertEqual(list(file.libraries), re.findall(r"Shared library: \[(.*)\]", loaded))

    def test_other_platforms(self):
        self.assertEqual(read(portable_executable(0x8664)).tag(), "win_amd64")
        self.assertEqual(read(portable_executable(0xAA64)).tag(), "win_arm64")
        with mock.patch.dict(_library.os.environ, {"MACOSX_DEPLOYMENT_TARGET": ""}):
            self.assertEqual(read(struct.pack("<II", 0xFEEDFACF, 0x0100000C)).tag(), "macosx_11_0_arm64")
            self.assertEqual(read(struct.pack("<II", 0xFEEDFACF, 0x01000007)).tag(), "macosx_10_12_x86_64")
        with mock.patch.dict(_library.os.environ, {"MACOSX_DEPLOYMENT_TARGET": "13.3"}):
            self.assertEqual(read(struct.pack("<II", 0xFEEDFACF, 0x0100000C)).tag(), "macosx_13_3_arm64")
        for data in (b"", b"MZ" + bytes(100), b"!<arch>\n" + bytes(100)):
            with self.assertRaises(ValueError):
                read(data)

    def test_the_newest_glibc_counts_by_number(self):
        self.assertEqual(LibraryFile("linux", "x86_64", (), ("GLIBC_2.4", "GLIBC_2.17", "GCC_4.2.0", "GLIBC_2.2.5")).glibc(), 17)
        self.assertEqual(LibraryFile("linux", "aarch64").tag(), "linux_aarch64")
        with self.assertRaisesRegex(ValueError, "GLIBC_ABI_DT_RELR"):
            LibraryFile("linux", "x86_64", (), ("GLIBC_2.17", "GLIBC_ABI_DT_RELR")).glibc()


@unittest.skipUnless(sys.platform == "linux", "the tags of Linux")
class Wheels(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = read(BUILT.read_bytes())

    def wheel(self, tag, inside=None):
        path = Path(self.folder.name) / f"contact_normal-0.0.0-py3-none-{tag}.whl"
        with zipfile.ZipFile(path, "w") as files:
            files.write(BUILT, "contact_normal/libcontact_normal.so")
            files.writestr("contact_normal-0.0.0.dist-info/WHEEL", f"Wheel-Version: 1.0\nTag: py3-none-{inside or tag}\n")
        return path

    def test_true_tags(self):
        tag = self.file.tag()
        self.assertEqual(check(self.wheel(tag)), (tag, tag))
        newer = f"manylinux_2_{self.file.glibc() + 1}_{self.file.machine}"
        self.assertEqual(check(self.wheel(newer)), (newer, tag))

    def test_false_tags(self):
        glibc, machine = self.file.glibc(), self.file.machine
        with self.assertRaisesRegex(ValueError, f"promises GLIBC_2.{glibc - 1}; the library needs GLIBC_2.{glibc}"):
            check(self.wheel(f"manylinux_2_{glibc - 1}_{machine}"))
        with self.assertRaisesRegex(ValueError, f"the tag is for sparc, the library for {machine}"):
            check(self.wheel(f"manylinux_2_{glibc}_sparc"))
        with self.assertRaisesRegex(ValueError, "its description"):
            check(self.wheel(self.file.tag(), f"manylinux_2_{glibc + 1}_{machine}"))
        with self.assertRaisesRegex(ValueError, "no tag of the form"):
            check(self.wheel(f"linux_{machine}"))
        with self.assertRaisesRegex(ValueError, "newer than manylinux_2_5"):
            check(self.wheel(self.file.tag()), "manylinux_2_5")


class Commands(unittest.TestCase):
    @unittest.skipIf(sys.platform == "win32", "its program is a shell script")
    def test_a_replay_is_looked_for_beside_a_library_that_has_a_folder(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
            here = os.getcwd()
            stack.callback(os.chdir, here)
            os.chdir(folder)
            program = Path(folder, "contact-normal-replay")
            program.write_text("#!/bin/sh\nkill -SEGV $$\n")
            program.chmod(0o755)
            stack.enter_context(mock.patch.dict(os.environ, {"PATH": ""}))
            candidates = stack.enter_context(mock.patch.object(_command_replay, "candidates", return_value=["libcontact_normal.so.2"]))
            with self.assertRaises(FileNotFoundError):
                _command_replay.program()
            candidates.return_value = [f"{folder}/libcontact_normal.so.2"]
            self.assertEqual(main(["replay", "failed.dump"]), 128 + signal.SIGSEGV)

    def test_a_terminal_without_a_sign_of_micro(self):
        with tempfile.TemporaryDirectory() as folder:
            place, fields = Path(folder, "h.npy"), Path(folder, "fields.npz")
            x = (np.arange(16) - 7.5) * 0.1
            np.save(place, -0.1 * (x[None, :] ** 2 + x[:, None] ** 2))
            given = ["--dx", "0.1", "--dy", "0.1", "--e-star", "1", "--approach", "0.02", "--units", "\u00b5m", "mN", "-o", str(fields)]
            environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
            ended = subprocess.run([sys.executable, "-m", "contact_normal", "solve", str(place), *given], capture_output=True, env=environment, check=False)
            self.assertEqual((ended.returncode, fields.exists()), (0, True), ended.stderr)
            self.assertIn(b"?m", ended.stdout)


if __name__ == "__main__":
    unittest.main()
