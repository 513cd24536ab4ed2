"""Results and stresses as datasets and files, with names and units. Needs xarray and netCDF4."""

import os
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np
import xarray

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
X = (np.arange(24) - 11.5) * 0.1
Y = (np.arange(18) - 8.5) * 0.12
H = 0.02 * ((X[None, :] - 0.22) ** 2 + Y[:, None] ** 2)
FRICTION = {"coefficient": 0.3, "force": (10.0, 0.0)}


class Datasets(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "result.nc")

    def tearDown(self):
        self.folder.cleanup()

    def read(self):
        with xarray.open_dataset(self.path) as dataset:
            return dataset.load()

    def test_a_result(self):
        found = cn.solve(H, 0.1, 0.12, force=100.0, friction=FRICTION, pressure_limit=1e9, units=("mm", "N"), **STEEL)
        found.to_netcdf(self.path)
        self.assertEqual(os.listdir(self.folder.name), ["result.nc"])
        dataset = self.read()
        for name in ("pressure", "deformed_distance", "displacement", "contact", "at_limit", "stick_slip"):
            self.assertEqual(dataset[name].dims, ("y", "x"))
            np.testing.assert_array_equal(dataset[name].values, getattr(found, name))
        for name in ("traction", "slip"):
            np.testing.assert_array_equal(dataset[name].sel(component="y").values, getattr(found, name)[1])
        np.testing.assert_allclose(dataset.x, X, atol=1e-14)
        np.testing.assert_allclose(dataset.y, Y, atol=1e-14)
        units = {name: dataset[name].attrs.get("units") for name in ("pressure", "displacement", "traction", "slip", "x", "y", "contact")}
        self.assertEqual(units, {"pressure": "MPa", "displacement": "mm", "traction": "MPa", "slip": "mm", "x": "mm", "y": "mm", "contact": None})
        self.assertTrue(all(dataset[name].attrs["long_name"] for name in ("pressure", "slip", "contact", "x")))
        self.assertEqual((dataset.attrs["force"], dataset.attrs["status"], dataset.attrs["dy"]), (found.force, 0, 0.12))
        self.assertEqual(tuple(dataset.attrs["tangential_force"]), found.tangential_force)
        self.assertRegex(dataset.attrs["made_by"], "^contact-normal ")
        self.assertEqual(list(dataset.ledger_mx.values), [row["mx"] for row in found.ledger])
        # The place of the largest pressure, by its coordinates.
        self.assertAlmostEqual(float(dataset.pressure.idxmax("x").max("y")), found.x[found.pressure.max(axis=0).argmax()])

    def test_fields_of_effects(self):
        rolling = {"coefficient": 0.3, "motion": "SHIFT", "creepage": (1e-3, 0.0), "layer": {"yield_limit": 1e3}}
        given = {"force": 100.0, "units": ("mm", "N"), **STEEL}
        for effect, names in (({"friction": rolling}, ("friction_coefficient", "yield_limit")),
                              ({"adhesion": {"work": 1e-3, "range": 1e-3}}, ("contact_pressure", "attraction"))):
            found = cn.solve(H, 0.1, 0.12, **effect, **given)
            found.to_netcdf(self.path)
            dataset = self.read()
            for name in names:
                self.assertTrue(dataset[name].values.any())
                np.testing.assert_array_equal(dataset[name].values, getattr(found, name))
                self.assertEqual((dataset[name].dims, dataset[name].attrs.get("units")), (("y", "x"), None if name == "friction_coefficient" else "MPa"))
            others = {"friction_coefficient", "yield_limit", "contact_pressure", "attraction"} - set(names)
            self.assertFalse(others & set(dataset.data_vars))

    def test_without_friction_and_units(self):
        dataset = cn.solve(H, 0.1, 0.12, force=100.0, **STEEL).to_xarray()
        self.assertFalse({"traction", "slip", "stick_slip", "component"} & (set(dataset.data_vars) | set(dataset.coords)))
        self.assertFalse(any("units" in dataset[name].attrs for name in (*dataset.data_vars, *dataset.coords)))

    def test_others(self):
        found = cn.solve(H, 0.1, 0.12, force=100.0, **STEEL)
        tangential = cn.solve_tangential(found.pressure, 0.1, 0.12, friction=FRICTION, **STEEL)
        tangential.to_netcdf(self.path)
        dataset = self.read()
        np.testing.assert_array_equal(dataset.traction.values, tangential.traction)
        self.assertNotIn("deformed_distance", dataset)
        found.units = "m", "N"
        stress = found.subsurface([0.1, 0.3], components=("zz", "von_mises"), principal=True)
        stress.to_netcdf(self.path)
        dataset = self.read()
        self.assertEqual(set(dataset.data_vars), {"zz", "von_mises", "principal", "directions"})
        np.testing.assert_array_equal(dataset.zz.sel(depth=0.3).values, stress.zz[1])
        np.testing.assert_array_equal(dataset.directions.sel(component="z").values, stress.directions[..., 2])
        self.assertEqual((dataset.zz.attrs["units"], dataset.depth.attrs["units"]), ("Pa", "m"))
        given = {"shape": (16, 16), "corner": (3.4, -1.6), "force": 10.0, "target": 0.1, **STEEL}
        accurate = cn.to_accuracy(lambda x, y: 0.02 * ((x - 5) ** 2 + y * y), 0.2, 0.2, **given)
        self.assertAlmostEqual(float(accurate.to_xarray().x.mean()), 5.0)

    def test_without_the_packages(self):
        found = cn.solve(H, 0.1, 0.12, force=100.0, **STEEL)
        def write():
            found.to_netcdf(self.path)

        for missing, call in (("xarray", found.to_xarray), ("xarray", write), ("netCDF4", write)):
            with mock.patch.dict(sys.modules, {missing: None}), self.assertRaisesRegex(ImportError, "contact-normal\\[tables\\]"):
                call()
        with mock.patch.dict(sys.modules, {"netCDF4": None}):
            self.assertIn("pressure", found.to_xarray())
        self.assertEqual(os.listdir(self.folder.name), [])


if __name__ == "__main__":
    unittest.main()
