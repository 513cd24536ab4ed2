"""Stresses below the surface and coatings, as Python has them."""

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
        # The largest shear is .310 p0 at .48 a (Johnson, section 4.2); some 18 elements to the radius: .1 % of it.
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
            # sxz = -qx at the surface, to round-off of the sum over the elements.
            np.testing.assert_allclose(stress.xz[0], -sign * result.traction[0], atol=1e-12 * result.traction.max())

    def test_pictures(self):
        import matplotlib

        matplotlib.use("Agg")
        stress = cn.solve(H, D, D, force=1000.0, **STEEL).subsurface(np.linspace(0.0, 1.5, 31))
        axes = stress.plot_section(y=0.0)
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x", "depth z"))
        self.assertEqual(len(stress.plot_depth().get_lines()), 6)
        with self.assertRaisesRegex(ValueError, "x is 9"):
            stress.plot_section(x=9.0)


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


if __name__ == "__main__":
    unittest.main()
