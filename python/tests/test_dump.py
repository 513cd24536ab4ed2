"""Dumps of calls that fail."""

import os
import re
import tempfile
import unittest
from pathlib import Path

import numpy as np

import contact_normal
from contact_normal import _constants
from contact_normal._library import library

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
X = (np.arange(16) - 7.5) * 0.5
H = (X[None, :] ** 2 + X[:, None] ** 2) / 100


def page():
    """The function of docs/dump.md that reads a dump."""
    text = (Path(__file__).parents[2] / "docs" / "dump.md").read_text()
    names = {}
    exec(re.search(r"```python\n(from pathlib.*?)```", text, re.DOTALL).group(1), names)
    return names["arrays"]


class Dumps(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_a_failing_call_leaves_what_it_was_given(self):
        path = Path(self.folder.name) / "failed-%p"
        result = contact_normal.solve(H, 0.5, 0.5, force=500.0, max_cycles=1, tolerance=1e-18, dump=path, **STEEL)
        self.assertGreater(result.status, 0)
        written = Path(self.folder.name) / f"failed-{os.getpid()}"
        self.assertIn(str(written), result.message)
        arrays = page()(written)
        self.assertTrue(any(np.array_equal(array, H.ravel()) for array in arrays.values()))
        self.assertTrue(written.read_bytes().startswith(b"contact-normal dump 1\n"))

    def test_a_solver_and_a_refusal_leave_one_too(self):
        path = os.path.join(self.folder.name, "failed")
        with contact_normal.Solver(16, 16, 0.5, 0.5, **STEEL) as solver:
            with self.assertRaises(contact_normal.ContactNormalError) as refused:
                solver.solve(np.full((16, 16), np.nan), force=500.0, dump=path)
        self.assertIn(path, str(refused.exception))
        self.assertIn(b"call contact_normal_solver_solve\n", Path(path).read_bytes())

    def test_the_unfinished_file_of_another_process_is_left(self):
        path = os.path.join(self.folder.name, "failed")
        solve = lambda: contact_normal.solve(H, 0.5, 0.5, force=500.0, max_cycles=1, tolerance=1e-18, dump=path + "-%n", **STEEL)
        solve()
        number = int(os.listdir(self.folder.name)[0].rpartition("-")[2])
        # Processes on other machines may have the same number, so that their unfinished files must stay.
        others = Path(self.folder.name) / f"contact_normal.{os.getpid()}.{number + 1}.0.part"
        others.write_text("not finished")
        solve()
        self.assertEqual(sorted(os.listdir(self.folder.name)), sorted([others.name, f"failed-{number}", f"failed-{number + 1}"]))
        self.assertEqual(others.read_text(), "not finished")

    def test_what_is_solved_leaves_none(self):
        path = os.path.join(self.folder.name, "failed")
        self.assertEqual(contact_normal.solve(H, 0.5, 0.5, force=500.0, dump=path, **STEEL).status, 0)
        contact_normal.solve(H, 0.5, 0.5, force=500.0, dump=None, **STEEL)
        self.assertEqual(os.listdir(self.folder.name), [])
        with self.assertRaises(TypeError):
            contact_normal.solve(H, 0.5, 0.5, force=500.0, dump=3, **STEEL)


class Constants(unittest.TestCase):
    def test_constants_are_those_that_the_library_has_by_name(self):
        from ctypes import byref, c_int32

        value = c_int32()
        names = [name for name in vars(_constants) if name.isupper() and name != "NAMED_OPTIONS"]
        self.assertGreater(len(names), 40)
        for name in names:
            self.assertEqual(library.contact_normal_constant(name.encode(), byref(value)), 0, name)
            self.assertEqual(value.value, getattr(_constants, name), name)


if __name__ == "__main__":
    unittest.main()
