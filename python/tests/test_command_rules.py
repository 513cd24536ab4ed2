"""The command line: periods of files, and problems that do not fit into memory."""

import dataclasses
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
from test_command import called

from contact_normal import surface


class Rules(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_the_period_of_a_file_is_kept(self):
        wave = 0.01 * np.cos(2 * np.pi * np.arange(16) / 16) + 0.002 * np.arange(16) + np.zeros((16, 1))
        scene = ("--mean-pressure", "0.01", "--e-star", "1", "-o", self.folder / "out.npz")
        with mock.patch("contact_normal._command_scene.read", lambda *_, **given: surface.heights(wave, 1.0, 1.0, **{"period": "xy", **given})):
            for more, period in (((), "xy"), (("--period", "y"), "y"), (("--period", "none"), None)):
                code, _, told = called("solve", "wave.nc", "--level", "plane", *scene, *more)
                self.assertEqual((code, "repeats itself in xy, as wave.nc says" in told), (0, not more), told)
                found = np.load(self.folder / "out.npz")["pressure"]
                level = surface.level(surface.heights(wave, 1.0, 1.0))
                expected = surface.gap(dataclasses.replace(level, period=period)).solve(force=0.01 * 256, e_star=1.0, threads=0).pressure
                np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)
            code, out, _ = called("prices", "wave.nc", "--level", "plane", *scene[:4])
            self.assertEqual(code, 0)

    def test_what_does_not_fit_into_memory_is_refused(self):
        for options in (("--elements", "20000000"), ("--xi", "0:1:100000000000000")):
            code, out, told = called("creep-table", *options)
            self.assertEqual((code, out, told.count("\n")), (3, "", 1), told)


if __name__ == "__main__":
    unittest.main()
