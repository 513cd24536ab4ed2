"""Tables of creep forces in files and on a cluster: a killed computation goes on from the written parts. Needs xarray, netCDF4, distributed, tqdm."""

import contextlib
import io
import os
import re
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal._bar import Bar

AXES = {"xi": [0.0, 0.1, 0.3], "eta": [-0.2, 0.0], "phi": [0.0, 0.1, 0.2, 0.4], "axis_ratio": [0.5, 1.0], "elements": 13}
PLANES = 8
NAMES = ("axis_ratio", "poisson_ratio", "phi", "eta", "xi", "force_x", "force_y", "moment", "error", "residual", "products", "status")
WHOLE = cn.creep_force_table(**AXES)

# A program that kills itself when `planes` planes are done.
KILLED = """
import os, signal, sys
import contact_normal as cn

def told(done, total):
    if done >= 6 * {planes}:
        os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    cn.creep_force_table({path!r}, workers={workers}, progress=told, **{axes!r})
"""


def kill_when_done(path, planes, workers):
    script = Path(path).with_suffix(".py")
    script.write_text(KILLED.format(path=str(path), planes=planes, workers=workers, axes=AXES))
    return subprocess.run([sys.executable, str(script)]).returncode


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "table.nc"
        self.parts = Path(folder.name) / "table.nc.parts"

    def assert_whole(self, table):
        for name in NAMES:
            np.testing.assert_array_equal(getattr(table, name), getattr(WHOLE, name))

    def test_a_file_has_all_of_the_table(self):
        self.assert_whole(cn.creep_force_table(self.path, **AXES))
        self.assertFalse(self.parts.exists())
        table = cn.CreepForceTable.read(self.path)
        self.assert_whole(table)
        point = (-0.2, 0.1, -0.15)
        np.testing.assert_array_equal(table.forces(*point, axis_ratio=0.8), WHOLE.forces(*point, axis_ratio=0.8))
        import xarray

        with xarray.open_dataset(self.path) as dataset:
            self.assertEqual(dataset.force_x.dims, ("axis_ratio", "poisson_ratio", "phi", "eta", "xi"))
            self.assertIn("G c^2", dataset.attrs["units"])
            np.testing.assert_array_equal(dataset.force_x.sel(xi=0.3, eta=0.0, phi=0.2).values, WHOLE.force_x[:, :, 2, 1, 2])
        # A second call only reads the file: computing would call progress.
        cn.creep_force_table(self.path, progress=self.fail, **AXES)

    def test_another_table_is_not_overwritten(self):
        cn.creep_force_table(self.path, **AXES)
        with self.assertRaisesRegex(ValueError, "has another table"):
            cn.creep_force_table(self.path, **{**AXES, "tolerance": 1e-5})
        other = self.path.with_name("other.nc")
        self.assertEqual(kill_when_done(other, 2, 1), -signal.SIGKILL)
        with self.assertRaisesRegex(ValueError, "parts of another table"):
            cn.creep_force_table(other, **{**AXES, "elements": 14})

    def test_what_was_killed_goes_on_from_its_parts(self):
        for workers in (1, 2):
            with self.subTest(workers=workers):
                path = self.path.with_name(f"table_{workers}.nc")
                self.assertEqual(kill_when_done(path, 3, workers), -signal.SIGKILL)
                parts = path.with_name(path.name + ".parts")
                written = {file.name: file.stat().st_mtime_ns for file in parts.glob("*.npz")}
                self.assertEqual(len(written), 3)
                # An unfinished file, left by a process that died while writing, is no part.
                (parts / "000007.unfinished").write_bytes(b"PK")
                told = []
                self.assert_whole(cn.creep_force_table(path, workers=workers, progress=lambda done, total: told.append(done), **AXES))
                self.assertEqual(told, [6 * k for k in range(4, PLANES + 1)])
                self.assertFalse(parts.exists())

    def test_without_xarray_nothing_is_computed(self):
        with mock.patch.dict(sys.modules, {"xarray": None}), self.assertRaisesRegex(ImportError, "contact-normal\\[tables\\]"):
            cn.creep_force_table(self.path, progress=self.fail, **AXES)

    def test_the_bar(self):
        told = io.StringIO()
        bar = Bar(told)
        bar.draw(0.5, "6 of 12 entries")
        bar.close()
        self.assertRegex(told.getvalue(), " 50%.*6 of 12 entries")
        with mock.patch.dict(sys.modules, {"tqdm": None}), contextlib.redirect_stderr(io.StringIO()) as plain:
            cn.creep_force_table(progress=True, **AXES)
        drawn = re.findall(r"\r\[(#*)(\.*)\] [0-9.]+ s, (\d+) of (\d+) entries", plain.getvalue())
        total = 6 * PLANES
        wanted = [(round(30 * done / total), 30 - round(30 * done / total), done, total) for done in range(6, total + 1, 6)]
        self.assertEqual([(len(full), len(empty), int(done), int(of)) for full, empty, done, of in drawn], wanted)


class Cluster(unittest.TestCase):
    def setUp(self):
        from distributed import Client, LocalCluster

        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "table.nc"
        self.cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=folder.name)
        self.addCleanup(self.cluster.close)
        self.client = Client(self.cluster)
        self.addCleanup(self.client.close)

    def test_a_worker_that_is_killed_loses_nothing(self):
        killed = []

        def told(done, total):
            if done >= 12 and not killed:
                killed.append(next(iter(self.client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)

        table = cn.creep_force_table(self.path, client=self.client, progress=told, **AXES)
        self.assertTrue(killed)
        for name in NAMES:
            np.testing.assert_array_equal(getattr(table, name), getattr(WHOLE, name))

    def test_a_killed_table_goes_on_on_the_cluster(self):
        self.assertEqual(kill_when_done(self.path, 5, 1), -signal.SIGKILL)
        told = []
        table = cn.creep_force_table(self.path, client=self.client, progress=lambda done, total: told.append(done), **AXES)
        self.assertEqual(told, [36, 42, 48])
        for name in NAMES:
            np.testing.assert_array_equal(getattr(table, name), getattr(WHOLE, name))


if __name__ == "__main__":
    unittest.main()
