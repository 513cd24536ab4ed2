"""The caller's own tangential coefficients in Python."""

import unittest

import numpy as np

import contact_normal as cn

M, D = 20, 0.1
X = (np.arange(M) - 0.5 * (M - 1)) * D
H = (X[None, :] ** 2 + X[:, None] ** 2) / (2 * 50.0)
BODIES = {"shear_modulus": 1.0, "poisson_ratio": 0.0}


def corner_differences(function):
    """Differences of `function(x, y)` over the corners of an element, at the offsets -M..M-1 in both directions."""
    y, x = np.meshgrid((np.arange(2 * M) - M) * D, (np.arange(2 * M) - M) * D, indexing="ij")
    corners = ((1, 1, 1), (-1, 1, -1), (1, -1, -1), (-1, -1, 1))
    return sum(sign * function(x + i * D / 2, y + j * D / 2) for i, j, sign in corners)


class TangentialInfluence(unittest.TestCase):
    def test_tables_of_a_half_space_give_its_tractions(self):
        # For nu = 0 and 1/G = 1: Axx = Ayy = (a + b)/pi, Axy = 0 (Kalker 1990, appendix B).
        both = corner_differences(lambda x, y: x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))) / np.pi
        none = np.zeros_like(both)
        friction = {"coefficient": 0.3, "creepage": (-0.004, 0.001)}
        known = cn.solve(H, D, D, force=0.05, friction=friction, **BODIES)
        # Both bodies have G = 1, so that 1/G = (1 + 1)/2 = 1.
        for influence in ((both, both, none), (4 * both, 4 * both, none, 0.25)):
            found = cn.solve(H, D, D, force=0.05, friction={**friction, "influence": influence}, **BODIES)
            self.assertEqual(found.status, cn.OK)
            # Round-off of the corner differences, some 1e-13, and the error with a residual of 1e-6.
            np.testing.assert_allclose(found.traction, known.traction, atol=1e-4 * np.abs(known.traction).max())
            self.assertGreater(np.count_nonzero(found.stick_slip == 1), 0)

    def test_a_solver_is_set_up_by_tables_of_bodies_that_roll_backwards(self):
        visco = {"modulus": [0.5, 0.5], "time": [0.2, 0.2]}
        tables = cn.influence_rolling_tangential(M + 2, M, D, D, shear_modulus=1.0, poisson_ratio=0.3, visco=visco, speed=-1.0)
        step = {"motion": "STEADY_ROLLING", "rolling_direction": np.pi}
        with cn.Solver(M, M, D, D, shear_modulus=1.0, poisson_ratio=0.3, friction={"influence": tables, **step}) as solver:
            found = solver.solve(H, force=0.05, friction={"coefficient": 0.3, "creepage": (1e-3, 0.0), **step})
        self.assertEqual(found.status, cn.OK)
        self.assertGreater(abs(found.tangential_force[0]), 0.0)

    def test_tables_of_unlike_bodies(self):
        # As above with K/G = (1/G1 - 1/G2)/4 = 1/4: Axz = -K/(pi G) c, where c is the integral of x/(x^2 + y^2) over an element; Ayz likewise.
        unlike = {"shear_modulus": (1 / 1.5, 1 / 0.5), "poisson_ratio": 0.0}
        both = corner_differences(lambda x, y: x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))) / np.pi
        xz = -0.25 / np.pi * corner_differences(lambda x, y: 0.5 * y * np.log(x**2 + y**2) + x * np.arctan(y / x))
        friction = {"coefficient": 0.3, "creepage": (-0.004, 0.001)}
        known, alike = (cn.solve(H, D, D, force=0.05, friction=friction, **bodies) for bodies in (unlike, BODIES))
        largest = np.abs(known.traction).max()
        self.assertGreater(np.abs(known.traction - alike.traction).max(), 0.05 * largest)
        for scale in (1.0, 0.25):
            tables = [table / scale for table in (both, both, np.zeros_like(both), xz, xz.T)]
            own = {"influence": (*tables[:3], scale), "influence_cross": tables[3:]}
            found = cn.solve(H, D, D, force=0.05, friction={**friction, **own}, **unlike)
            self.assertEqual(found.status, cn.OK)
            np.testing.assert_allclose(found.traction, known.traction, atol=1e-4 * largest)

    def test_a_batch_takes_tables_for_both_problems(self):
        # With nu = 0 the normal displacements by a pressure are those in x by a traction in x (Kalker 1990, appendix B).
        both = corner_differences(lambda x, y: x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))) / np.pi
        entries = [(-0.004, 0.001, 0.0), (0.002, 0.0, 0.001)]
        known = cn.friction_batch(H, D, D, entries, force=0.05, friction={"coefficient": 0.3}, **BODIES)
        # The constants of the bodies are not read, because 1/G is in the tables.
        found = cn.friction_batch(H, D, D, entries, force=0.05, influence=both, shear_modulus=7.0, poisson_ratio=0.2,
                                  friction={"coefficient": 0.3, "influence": (both, both, np.zeros_like(both))})
        np.testing.assert_array_equal(found.status, cn.OK)
        # The tolerance covers the errors of forces with residuals of 1e-6.
        np.testing.assert_allclose(found.force, known.force, atol=1e-5 * np.abs(known.force).max())

    def test_tables_per_row_of_a_half_space_give_its_tractions(self):
        both = corner_differences(lambda x, y: x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))) / np.pi
        rows = np.array([[both[M + row - loaded] for row in range(M)] for loaded in range(M)])
        friction = {"coefficient": 0.3, "creepage": (-0.004, 0.001)}
        known = cn.solve(H, D, D, force=0.05, friction=friction, **BODIES)
        for tables in ((rows, rows, 0 * rows), (4 * rows, 4 * rows, 0 * rows, 0.25)):
            found = cn.solve(H, D, D, force=0.05, friction={**friction, "row_tables": tables}, **BODIES)
            self.assertEqual(found.status, cn.OK)
            # Round-off of the corner differences, some 1e-13, and the error with a residual of 1e-6.
            np.testing.assert_allclose(found.traction, known.traction, atol=1e-4 * np.abs(known.traction).max())
        with cn.Solver(M, M, D, D, friction={"row_tables": (rows, rows, 0 * rows)}, **BODIES) as solver:
            solver.set_influence(friction={"row_tables": (2 * rows, 2 * rows, 0 * rows)})
            found = solver.solve(H, force=0.05, friction={"coefficient": 0.3, "force": (0.005, None)})
            # The tables have twice the compliance, so that the force needs twice the creepage.
            stiff = cn.solve(H, D, D, force=0.05, friction={"coefficient": 0.3, "force": (0.005, None)}, **BODIES)
            self.assertAlmostEqual(found.report["creepage"][0] / stiff.report["creepage"][0], 2, delta=1e-4)
        for tables, words in (((rows, rows), "2 entries"), ((rows, rows, rows[1:]), "shapes")):
            with self.assertRaisesRegex(ValueError, words):
                cn.solve(H, D, D, force=0.05, friction={**friction, "row_tables": tables}, **BODIES)

    def test_tables_of_the_wrong_shape_are_refused(self):
        table = np.ones((2 * M, 2 * M))
        for influence, words in (((table, table), "2 entries"), ((table, table, table[1:]), "shapes")):
            with self.assertRaisesRegex(ValueError, words):
                cn.solve(H, D, D, force=0.05, friction={"coefficient": 0.3, "influence": influence}, **BODIES)


if __name__ == "__main__":
    unittest.main()
