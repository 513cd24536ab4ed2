"""The library that is loaded must suit the package: which one is tried, its ABI version, the sizes of its structs."""

import ctypes
import os
import threading
import unittest
from unittest import mock

from contact_normal import _library
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
    """This library with some of its functions exchanged."""

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

    def test_one_that_is_missing(self):
        with mock.patch.dict(os.environ, {"CONTACT_NORMAL_LIBRARY": "/nowhere/libcontact_normal.so"}):
            self.assertEqual(_library.candidates(), ["/nowhere/libcontact_normal.so"])
            with self.assertRaisesRegex(ImportError, "/nowhere/libcontact_normal.so: .*; name the library in CONTACT_NORMAL_LIBRARY"):
                _library.load()

    def test_threads_meet_no_struct_that_is_half_initialised(self):
        begun, ended = threading.Event(), threading.Event()

        def slow(struct):
            begun.set()
            ended.wait()
            LIBRARY.contact_normal_scene_init(struct)

        with mock.patch.dict(_library._INITIALISED, clear=True), mock.patch.object(_library, "library", Another(scene_init=slow)) as another:
            thread = threading.Thread(target=_library.initialised, args=("scene",))
            thread.start()
            begun.wait()
            another.functions["contact_normal_scene_init"].call = LIBRARY.contact_normal_scene_init
            size = _library.initialised("scene").struct_size
            ended.set()
            thread.join()
        self.assertEqual(size, ctypes.sizeof(_library.SIZED["scene"]))

    def test_sizes_of_structs(self):
        for name, kind in _library.SIZED.items():

            def larger(struct, kind=kind):
                struct.contents.struct_size = ctypes.sizeof(kind) + 8

            with self.assertRaisesRegex(ImportError, f"contact_normal_{name} has {ctypes.sizeof(kind) + 8} bytes, here {ctypes.sizeof(kind)}"):
                loaded(Another(**{f"{name}_init": larger}))


if __name__ == "__main__":
    unittest.main()
