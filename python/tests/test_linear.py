"""Products and the stiffness of a solver."""

import unittest

import numpy as np

import contact_normal

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
X = (np.arange(32) - 15.5) * 0.1
H = (X[None, :] ** 2 + X[:, None] ** 2) / 100


class Linear(unittest.TestCase):
    def test_a_product_of_the_result_is_its_displacement(self):
        with contact_normal.Solver(32, 32, 0.1, 0.1, layer=1e-6, **STEEL) as solver:
            result = solver.solve(H, force=300.0)
            found = solver.product(result.pressure)
            np.testing.assert_allclose(found, result.displacement, rtol=1e-10)
            with self.assertRaises(ValueError):
                solver.product(result.pressure[1:])
            with self.assertRaises(contact_normal.ContactNormalError):
                solver.product(np.full((32, 32), np.inf))

    def test_the_stiffness_is_that_of_hertz(self):
        with contact_normal.Solver(32, 32, 0.1, 0.1, **STEEL) as solver:
            with self.assertRaises(contact_normal.ContactNormalError):
                solver.stiffness()
            result = solver.solve(H, approach=0.01)
            # F ~ approach^(3/2): dF/d approach = 3/2 F/approach, up to the share of elements at the edge of the contact.
            self.assertAlmostEqual(solver.stiffness() / (1.5 * result.force / result.approach), 1.0, delta=0.05)


if __name__ == "__main__":
    unittest.main()
