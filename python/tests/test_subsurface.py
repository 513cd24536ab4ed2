"""Stresses below the surface and coatings in Python."""

import pickle
import unittest
import warnings

import numpy as np

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.3}
M, D = 65, 0.05
X = (np.arange(M) - M // 2) * D
H = (X[None, :] ** 2 + X[:, None] ** 2) / (2 * 50.0)


class Subsurface(unittest.TestCase):
    def test_under_a_ball(self):
        result = cn.solve(H, D, D, force=1000.0, **STEEL)
        p0 = result.report["max_pressure"]
        depths = np.linspace(0.0, 1.5, 61)
        stress = result.subsurface(depths, principal=True)
        np.testing.assert_allclose(stress.zz[0], -result.pressure, atol=1e-12 * p0)
        # The largest shear is .310 p0 at .48 a (Johnson, section 4.2); with some 18 elements per radius the error is .1 %.
        a = cn.hertz(0.01, 0.01, force=1000.0, **STEEL).semi_axis_x
        self.assertAlmostEqual(stress.largest_shear["value"] / p0, 0.310, delta=1e-3)
        self.assertAlmostEqual(stress.largest_shear["z"] / a, 0.48, delta=0.03)
        self.assertEqual((stress.largest_shear["x"], stress.largest_shear["ix"]), (0.0, M // 2))
        trace = stress.xx + stress.yy + stress.zz
        np.testing.assert_allclose(stress.principal.sum(axis=0), trace, atol=1e-12 * p0)
        np.testing.assert_allclose((stress.directions**2).sum(axis=-1), 1.0, atol=1e-14)
        self.assertIsNone(result.subsurface([0.0]).principal)

    def test_depths_that_miss_the_largest_stress_are_told(self):
        result = cn.solve(H, D, D, force=1000.0, **STEEL)
        for depths, text in ((np.linspace(0.0, 0.2, 5), "at an end of the depths, 0.2: deeper it may be larger"),
                             (np.linspace(0.6, 1.5, 5), "at an end of the depths, 0.6: higher it may be larger"),
                             ([100.0, 200.0], r"depths are 100 and more, and the contact is 1.\d wide: are depths in the unit of x and y")):
            with self.assertWarnsRegex(UserWarning, text):
                result.subsurface(depths)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result.subsurface(np.linspace(0.0, 1.5, 5))
            result.subsurface([0.1])
            result.subsurface(np.linspace(0.0, 0.2, 5), components=["xx"])

    def test_tractions_and_bodies(self):
        result = cn.solve(H, D, D, force=1000.0, shear_modulus=82000.0, poisson_ratio=(0.3, 0.1))
        q = 0.2 * result.pressure
        stress = result.subsurface([0.0, 0.2], traction=(q, np.zeros_like(q)), body=1)
        np.testing.assert_allclose(stress.xz[0], -q, atol=1e-12 * q.max())
        other = result.subsurface([0.0, 0.2], body=2)
        self.assertGreater(abs(other.xx - result.subsurface([0.0, 0.2]).xx).max(), 0.01 * q.max())
        for bad, words in (({"body": 3}, "body is 3"), ({"depths": [-1.0]}, r"depths\[0\] is -1"),
                           ({"traction": (q[1:], q)}, r"traction\[0\] has shape")):
            with self.assertRaisesRegex((ValueError, cn.ContactNormalError), words):
                result.subsurface(**{"depths": [0.0], **bad})

    def test_tractions_of_friction(self):
        result = cn.solve(H, D, D, force=1000.0, **STEEL, friction={"coefficient": 0.3, "force": (250.0, None)})
        for body, sign in ((1, 1.0), (2, -1.0)):
            stress = result.subsurface([0.0], body=body)
            # At the surface sxz = -qx, to the round-off of a sum over the elements.
            np.testing.assert_allclose(stress.xz[0], -sign * result.traction[0], atol=1e-12 * result.traction.max())

    def test_a_result_of_an_accuracy_keeps_period_and_patches(self):
        given = {"shape": (16, 16), "mean_pressure": 0.02, "target": 1e-2, "shear_modulus": 1.0, "poisson_ratio": 0.3}
        wavy = cn.solve_to_accuracy(lambda x, y: 0.05 * (2.0 - np.cos(2 * np.pi * x / 3.2) - np.cos(2 * np.pi * y / 3.2)), 0.2, 0.2,
                                    period="xy", **given)
        # On each plane the mean of szz is minus the mean pressure.
        np.testing.assert_allclose(wavy.subsurface([0.5, 1.6], components=["zz"]).zz.mean(axis=(1, 2)), -0.02, rtol=1e-6)
        # Two balls on independent patches: pressures on the right have no effect on the left.
        patch = np.where(np.arange(16) < 8, 0, 1) + np.zeros((16, 1), dtype=int)
        balls = cn.solve_to_accuracy(lambda x, y: (np.abs(x) - 0.8) ** 2 + y**2, 0.2, 0.2, patches=(patch, np.eye(2)), **given)
        left = np.where(balls.x < 0.0, balls.pressure, 0.0)
        alone = cn.subsurface_stress(left, balls.dx, balls.dy, [0.1], poisson_ratio=0.3, components=["zz"]).zz
        found = balls.subsurface([0.1], components=["zz"]).zz
        half = balls.pressure.shape[1] // 2
        self.assertGreater(len(balls.x), 16)
        np.testing.assert_allclose(found[..., :half], alone[..., :half], atol=1e-12 * balls.max_pressure)

    def test_a_result_is_its_own_when_the_callers_arrays_change(self):
        patch, factors, layer = (X > 0.0).astype(np.int32) + np.zeros((M, 1), np.int32), np.array([[1.0, 0.5], [0.5, 1.0]]), np.full((M, M), 1e-7)
        layered = cn.solve(H, D, D, force=1000.0, layer=layer, pressure_limit=(limit := np.full((M, M), 900.0)), **STEEL)
        patched = cn.solve(H, D, D, force=1000.0, patches=(patch, factors), **STEEL)
        nu = [0.3, 0.3]
        solver = cn.Solver(M, M, D, D, layer=layer, patches=[memoryview(patch), factors.tolist()], shear_modulus=82000.0, poisson_ratio=nu)
        listed = cn.solve(H, D, D, force=1000.0, patches=(lists := [patch.tolist(), factors.tolist()]), shear_modulus=82000.0, poisson_ratio=nu)
        of_solver = solver.solve(H, force=1000.0)
        before = [result.subsurface([0.3]).von_mises for result in (layered, patched, listed, of_solver)]
        # The stresses of this result are first computed after the arrays have changed.
        unasked = cn.solve(H, D, D, force=1000.0, patches=(patch, factors), **STEEL)
        patch[:], factors[:], layer[:], limit[:] = 0, 1.0, -1.0, -1.0
        lists[1][0][1], nu[:] = 0.0, (0.0, 0.0)
        for result, expected in zip((unasked, layered, patched, listed, of_solver, solver.solve(H, force=1000.0)), (before[1], *before, before[-1])):
            np.testing.assert_array_equal(result.subsurface([0.3]).von_mises, expected)

    def test_a_solver_knows_that_its_coefficients_are_no_half_space(self):
        h, bodies = H[::2, ::2], {"shear_modulus": 1.0, "poisson_ratio": 0.3}
        m = len(h)
        table = cn.influence_half_space(m, m, D, D, shear_modulus=1e3, poisson_ratio=0.3)
        with cn.Solver(m, m, D, D, influence=table, **bodies) as solver:
            found = solver.solve(h, force=1.0)
        for result in (found, pickle.loads(pickle.dumps(found)), cn.solve(h, D, D, force=1.0, influence=table, **bodies)):
            # The constants of the half-space are not used, so that pressures above E*/5 cause no warning.
            self.assertEqual(result.warnings, ())
            for call in (lambda: result.subsurface([0.1]), lambda: result.stress_at_points([(0.0, 0.0, 0.1)])):
                with self.assertRaisesRegex(cn.ContactNormalError, "influence is given; subsurface stresses are those of a half-space"):
                    call()

    def test_pictures(self):
        import matplotlib

        matplotlib.use("Agg")
        stress = cn.solve(H, D, D, force=1000.0, **STEEL).subsurface(np.linspace(0.0, 1.5, 31))
        axes = stress.plot_section(y=0.0)
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x", "depth z"))
        self.assertEqual(len(stress.plot_depth().get_lines()), 6)
        with self.assertRaisesRegex(ValueError, "x is 9"):
            stress.plot_section(x=9.0)
        result = cn.solve(H, D, D, force=1000.0, **STEEL)
        with self.assertRaisesRegex(ValueError, f"along x has 1 depths of {M} elements; it must have two of each"):
            result.subsurface([0.1]).plot_section()
        line = cn.subsurface_stress(result.pressure[:, :1], D, D, [0.1, 0.2], poisson_ratio=0.3)
        with self.assertRaisesRegex(ValueError, "along x has 2 depths of 1 elements"):
            line.plot_section()


class Coatings(unittest.TestCase):
    def test_a_stiff_coating_and_none(self):
        plain = cn.solve(H, D, D, force=1000.0, **STEEL)
        none = cn.solve(H, D, D, force=1000.0, coating=(None, None), **STEEL)
        np.testing.assert_array_equal(plain.pressure, none.pressure)
        stiff = cn.solve(H, D, D, force=1000.0, coating=((0.1, 4 * 82000.0, 0.3), None), **STEEL)
        self.assertGreater(stiff.report["max_pressure"], plain.report["max_pressure"])
        with cn.Solver(M, M, D, D, coating=((0.1, 4 * 82000.0, 0.3), None), **STEEL) as solver:
            np.testing.assert_array_equal(solver.solve(H, force=1000.0).pressure, stiff.pressure)
        with self.assertRaisesRegex(ValueError, r"coating\[0\] has 2 parts"):
            cn.solve(H, D, D, force=1000.0, coating=((0.1, 1.0), None), **STEEL)
        with self.assertRaisesRegex(cn.ContactNormalError, "coating"):
            stiff.subsurface([0.1])
        accurate = cn.solve_to_accuracy(H, D, D, force=1000.0, coating=((0.1, 4 * 82000.0, 0.3), None), target=0.1, **STEEL)
        with self.assertRaisesRegex(cn.ContactNormalError, "coating"):
            accurate.subsurface([0.1])


if __name__ == "__main__":
    unittest.main()
