"""Files of the command line by other packages: xarray and netCDF4, meshio, SurfaceTopography."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy as np
import xarray

from contact_normal._command import main

MY, MX, DX, DY = 20, 30, 0.1, 0.2
X, Y = (np.arange(MX) - 12.0) * DX, (np.arange(MY) - 8.0) * DY
HEIGHTS = -0.01 * (X[None, :] ** 2 + Y[:, None] ** 2)
SCENE = ("--force", "1000", "--e-star", "1e5")


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def solve(self, *arguments):
        told = io.StringIO()
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(told):
            code = main(["solve", *map(str, arguments), *SCENE])
        return code, told.getvalue()

    def test_netcdf_goes_in_and_out(self):
        mm = {"units": "mm"}
        heights = xarray.DataArray(HEIGHTS, {"y": ("y", Y, mm), "x": ("x", X, mm)}, ("y", "x"), attrs=mm)
        path, out = self.folder / "heights.nc", self.folder / "fields.nc"
        xarray.Dataset({"z": heights}).to_netcdf(path)
        code, told = self.solve(path, "-o", out)
        self.assertEqual((code, "lengths in mm" in told), (0, True))
        with xarray.open_dataset(out) as fields:
            self.assertAlmostEqual(float(fields.dx), DX, places=12)
            self.assertAlmostEqual(float(fields.dy), DY, places=12)
            self.assertAlmostEqual(float(fields.pressure.sum()) * DX * DY, 1000.0, places=6)
            h = (fields.deformed_distance - fields.displacement).values
        np.testing.assert_allclose(h - h.min(), HEIGHTS.max() - HEIGHTS, atol=1e-12)
        xarray.Dataset({"z": heights.assign_coords(x=X**3)}).to_netcdf(path)
        code, told = self.solve(path)
        self.assertEqual((code, "x is not evenly spaced" in told), (3, True), told)

    def test_vtk_has_each_element_where_it_is(self):
        np.save(self.folder / "z.npy", HEIGHTS)
        for name in ("fields.vtu", "fields.vtk"):
            out, arrays = self.folder / name, self.folder / "fields.npz"
            self.assertEqual(self.solve(self.folder / "z.npy", "--dx", DX, "--dy", DY, "-o", out, "-o", arrays)[0], 0)
            mesh, pressure = meshio.read(out), np.load(arrays)["pressure"]
            corners = mesh.points[mesh.cells[0].data]
            centres, found = corners.mean(axis=1), mesh.cell_data["pressure"][0].ravel()
            ix = np.round((centres[:, 0] / DX) + 0.5 * MX - 0.5).astype(int)
            iy = np.round((centres[:, 1] / DY) + 0.5 * MY - 0.5).astype(int)
            self.assertEqual(len(set(zip(iy, ix))), MY * MX)
            np.testing.assert_array_equal(found, pressure[iy, ix])
            # The corners are counterclockwise, and each cell has the area of an element: the shoelace formula.
            after = np.roll(corners, -1, axis=1)
            areas = 0.5 * (corners[..., 0] * after[..., 1] - corners[..., 1] * after[..., 0]).sum(axis=1)
            np.testing.assert_allclose(areas, DX * DY, rtol=1e-12)

    def test_files_of_instruments(self):
        path, out = self.folder / "z.xyz", self.folder / "fields.npz"
        np.savetxt(path, [(x, y, z) for y, line in zip(Y - Y[0], HEIGHTS) for x, z in zip(X - X[0], line)])
        self.assertEqual(self.solve(path, "-o", out)[0], 0)
        fields = np.load(out)
        self.assertAlmostEqual(float(fields["dx"]), DX)
        self.assertAlmostEqual(float(fields["dy"]), DY)
        h = fields["deformed_distance"] - fields["displacement"]
        np.testing.assert_allclose(h - h.min(), HEIGHTS.max() - HEIGHTS, atol=1e-9)
        (self.folder / "z.sur").write_text("no surface")
        code, told = self.solve(self.folder / "z.sur")
        self.assertEqual((code, "z.sur" in told), (3, True), told)


if __name__ == "__main__":
    unittest.main()
