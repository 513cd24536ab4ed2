"""The loaded library must suit the package: the choice of the library, its ABI version, structs of other versions."""

import ctypes
import os
import threading
import unittest
from unittest import mock

import numpy as np

import contact_normal
from contact_normal import _library, _structs
from contact_normal._constants import ABI_VERSION

LIBRARY = _library.library


class Function:
    """A function of another library."""

    restype = argtypes = None

    def __init__(self, call):
        self.call = call

    def __call__(self, *given):
        return self.call(*given)


class Another:
    """This library with some functions replaced."""

    def __init__(self, **functions):
        self.functions = {f"contact_normal_{name}": Function(call) for name, call in functions.items()}

    def __getattr__(self, name):
        return self.functions[name] if name in self.functions else getattr(LIBRARY, name)


def loaded(another):
    with mock.patch.object(ctypes, "CDLL", return_value=another):
        return _library.load()


class Libraries(unittest.TestCase):
    def test_versions(self):
        with self.assertRaisesRegex(ImportError, f"has ABI version {ABI_VERSION - 1}; this package needs {ABI_VERSION} or newer"):
            loaded(Another(abi_version=lambda: ABI_VERSION - 1))
        for version in (ABI_VERSION, ABI_VERSION + 1):
            another = Another(abi_version=lambda: version)
            self.assertIs(loaded(another), another)

    def test_an_older_library_of_the_same_abi(self):
        for version, serves in ((b"0.2.0", True), (b"0.2.1", True), (b"0.10.0", True), (b"1.0.0-rc1", True), (b"0.1.9", False)):
            another = Another(version=lambda: version)
            if serves:
                self.assertIs(loaded(another), another)
                continue
            with self.assertRaisesRegex(ImportError, "is version 0.1.9 of the library; this package needs 0.2.0 or newer"):
                loaded(another)

    def test_a_library_without_a_function(self):
        class Without(Another):
            def __getattr__(self, name):
                if name == "contact_normal_keep":
                    raise AttributeError(name)
                return super().__getattr__(name)

        with self.assertRaisesRegex(ImportError, "has no contact_normal_keep"):
            loaded(Without())

    def test_another_library(self):
        with mock.patch.dict(os.environ, {"CONTACT_NORMAL_LIBRARY": "libother.so"}):
            with self.assertRaisesRegex(ImportError, "libother.so has no contact_normal_abi_version: it is another library"):
                loaded(object())

    def test_one_that_is_missing(self):
        with mock.patch.dict(os.environ, {"CONTACT_NORMAL_LIBRARY": "/nowhere/libcontact_normal.so"}):
            self.assertEqual(_library.candidates(), ["/nowhere/libcontact_normal.so"])
            with self.assertRaisesRegex(ImportError, "/nowhere/libcontact_normal.so: .*; name the library in CONTACT_NORMAL_LIBRARY"):
                _library.load()

    def test_threads_meet_no_struct_that_is_half_initialised(self):
        begun, ended = threading.Event(), threading.Event()

        def slow(*given):
            begun.set()
            ended.wait()
            LIBRARY.contact_normal_init(*given)

        with mock.patch.dict(_library._INITIALISED, clear=True), mock.patch.object(_library, "library", Another(init=slow)) as another:
            thread = threading.Thread(target=_library.initialised, args=("scene",))
            thread.start()
            begun.wait()
            another.functions["contact_normal_init"].call = LIBRARY.contact_normal_init
            size = _library.initialised("scene").struct_size
            ended.set()
            thread.join()
        self.assertEqual(size, ctypes.sizeof(_structs.Scene))

    def test_the_sizes_of_all_structs_are_told(self):
        for name, (_, kind) in _structs.KINDS.items():
            self.assertEqual(_library.initialised(name).struct_size, ctypes.sizeof(kind), name)


X = (np.arange(16) - 7.5) * 0.2
H = 0.01 * (X[None, :] ** 2 + X[:, None] ** 2)


def solved(**given):
    return contact_normal.solve(H, 0.2, 0.2, force=100.0, shear_modulus=82000.0, poisson_ratio=0.28, **given)


class OtherVersions(unittest.TestCase):
    """Structs grow at their end: those of a newer package are longer than those of the library."""

    def test_a_newer_package(self):
        expected = solved()
        for name in ("scene", "options", "fields", "report"):
            number, kind = _structs.KINDS[name]
            longer = type(kind.__name__, (kind,), {"_fields_": [("later", ctypes.c_double)]})
            with mock.patch.dict(_structs.KINDS, {name: (number, longer)}), mock.patch.dict(_library._INITIALISED, clear=True):
                found = solved()
                np.testing.assert_array_equal(found.pressure, expected.pressure)
                self.assertEqual((found.force, found.report["cycles"]), (expected.force, expected.report["cycles"]))
                self.assertEqual(_library._INITIALISED[name].later, 0.0)
                _library._INITIALISED[name].later = 1.0
                with self.assertRaisesRegex(contact_normal.ContactNormalError, f"{name} sets the member at byte") as caught:
                    solved()
                self.assertEqual(caught.exception.status, contact_normal.STRUCT_SIZE)


if __name__ == "__main__":
    unittest.main()
