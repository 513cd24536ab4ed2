"""Refusals of tables of creep forces, and the errors of surfaces with one row."""

import unittest

import numpy as np

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}


def surface(rows, columns, force):
    x, y = ((np.arange(n) - 0.5 * (n - 1)) * 0.3 for n in (columns, rows))
    return {"h": 0.005 * x[None, :] ** 2 + 0.005 * y[:, None] ** 2, "dx": 0.3, "dy": 0.3, "force": force, "coefficient": 0.3, **STEEL}


class Reads(unittest.TestCase):
    def test_a_surface_has_no_forces_beside_an_axis_of_one_value(self):
        table = cn.creep_force_table(xi=[0.0, 2e-3], eta=[0.0], phi=[0.0], surface=surface(17, 17, 1e4))
        for given, name in (((1e-3, 2e-3, 0.0), "eta"), ((1e-3, 0.0, 1e-3), "phi")):
            with self.assertRaisesRegex(ValueError, f"{name} has values outside the table, which has 0.0 only"):
                table.forces(*given)
            held = table.forces(*given, hold=True)
            np.testing.assert_array_equal(held, table.forces(1e-3, 0.0, 0.0))
        self.assertEqual(table.forces(2e-3, 0.0, 0.0)[0], table.force_x[0, 0, 0, 0, 1])

    def test_semi_axes_are_positive(self):
        table = cn.creep_force_table(xi=[0.0, 0.3], eta=[0.0], phi=[0.0], axis_ratio=[1.0, 2.0], elements=9)
        given = {"coefficient": 0.3, "shear_modulus": 82000.0, "hold": True}
        for axes in ((0.0, 4.5), (-1.0, 4.5), (-6.0, -4.0), (6.0, np.inf), (6.0, [4.0, 0.0])):
            with self.assertRaisesRegex(ValueError, "semi_axes is .* they must be positive and finite where there is a load"):
                table.wheel_rail((1e-3, 0.0), 0.0, semi_axes=axes, normal_force=82e3, **given)
        for modulus in (0.0, -82e3, [82e3, 0.0]):
            with self.assertRaisesRegex(ValueError, "shear_modulus is .* it must be positive"):
                table.wheel_rail((1e-3, 0.0), 0.0, semi_axes=(6.0, 4.0), normal_force=82e3, **{**given, "shear_modulus": modulus})
        with self.assertRaisesRegex(TypeError, "semi_axes is 6.0; it must be a pair"):
            table.wheel_rail((1e-3, 0.0), 0.0, semi_axes=6.0, normal_force=82e3, **given)
        # A wheel without load has no contact ellipse, and no force.
        found = table.wheel_rail((1e-3, 0.0), 0.0, semi_axes=([6.0, 0.0], [4.0, 0.0]), normal_force=[82e3, 0.0], **given)
        alone = table.wheel_rail((1e-3, 0.0), 0.0, semi_axes=(6.0, 4.0), normal_force=82e3, **given)
        np.testing.assert_array_equal(found, np.transpose([np.ravel(alone), np.zeros(3)]))
        np.testing.assert_array_equal(table.wheel_rail((1e-3, 0.0), 0.0, semi_axes=(0.0, 0.0), normal_force=0.0, **given), np.zeros(3))
        self.assertTrue(np.isnan(table.wheel_rail((1e-3, 0.0), 0.0, semi_axes=(np.nan, 4.0), normal_force=82e3, **given)).all())
        # For a wheel without load the table need not have a circle, or creepages of 0.
        table = cn.creep_force_table(xi=[0.1, 0.3], eta=[0.1, 0.2], phi=[0.1, 0.2], axis_ratio=[1.5, 2.0], elements=9)
        modulus = 82e3 / 8.2e4 / 100.0
        motion, given = ((0.2 * modulus, 0.1 * modulus), 0.1 * modulus / 10.0), {"semi_axes": (10.0 * 1.75**0.5, 10.0 / 1.75**0.5), **given, "hold": False}
        given["coefficient"], given["shear_modulus"] = 1.0, 8.2e4
        found = table.wheel_rail(*motion, normal_force=[82e3, 0.0], **given)
        alone = table.wheel_rail(*motion, normal_force=82e3, **given)
        self.assertGreater(abs(np.ravel(alone)).min(), 0.0)
        np.testing.assert_array_equal(found, np.transpose([np.ravel(alone), np.zeros(3)]))
        # For a wheel without load, semi-axes and Poisson ratios outside the table have no effect.
        lifted = {**given, "semi_axes": ([given["semi_axes"][0], np.nan], [given["semi_axes"][1], 1e200]), "poisson_ratio": [table.poisson_ratio[0], 0.4]}
        with np.errstate(all="raise"):
            for of_lifted in (np.nan, 1e200, 1e-200):
                lifted["semi_axes"][0][1] = of_lifted
                found = table.wheel_rail(*motion, normal_force=[82e3, 0.0], **lifted)
                np.testing.assert_array_equal(found, np.transpose([np.ravel(alone), np.zeros(3)]))


class Errors(unittest.TestCase):
    def test_bodies_of_one_row_are_halved_along_it(self):
        axes = {"xi": [0.0, 2e-3], "eta": [0.0], "phi": [0.0]}
        row = surface(1, 33, 2e3)
        found = cn.creep_force_table(surface=row, **axes)
        # The reference has four times as many elements along the row, of the same width.
        x = (np.arange(132) - 65.5) * 0.075
        fine = cn.creep_force_table(surface={**row, "h": 0.005 * x[None, :] ** 2, "dx": 0.075}, **axes)
        off = abs(found.force_x - fine.force_x).max() / 600.0
        self.assertLess(off, 1.5 * found.error.max())
        self.assertLess(found.error.max(), 0.06)
        column = {**row, "h": row["h"].T, "rolling_direction": 0.5 * np.pi}
        turned = cn.creep_force_table(surface=column, xi=[0.0], eta=axes["xi"], phi=[0.0])
        np.testing.assert_allclose(turned.error.ravel(), found.error.ravel(), rtol=1e-4)
        alone = cn.creep_force_table(surface=surface(1, 1, 2e3), **axes)
        self.assertLess(alone.error.max(), 1e-3)


if __name__ == "__main__":
    unittest.main()
