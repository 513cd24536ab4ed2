"""Laws of friction and plastic layers."""

import unittest

import numpy as np

import contact_normal as cn

SHAPE, DX, DY, FORCE = (44, 48), 0.289, 0.6304, 106700.0
LAW = {"kind": "EXPONENTIAL", "kinetic": 0.14, "falling": 0.19, "half_speed": 1250.0, "speed": 1e4, "memory_distance": 0.003, "memory_speed": 1.0}


def solved(**friction):
    """A wheel of steel on a rail; the friction is .33 at rest."""
    x, y = ((np.arange(m) - 0.5 * (m - 1)) * d for m, d in ((SHAPE[1], DX), (SHAPE[0], DY)))
    h = 8e-4 * x**2 + 2.8142e-4 * y[:, None] ** 2
    rolling = {"coefficient": 0.33, "motion": "STEADY_ROLLING", "compliance": 1.25 / 8200.0, **friction}
    return cn.solve(h, DX, DY, force=FORCE, shear_modulus=82000.0, poisson_ratio=0.28, friction=rolling)


class Laws(unittest.TestCase):
    def test_a_creep_curve_falls_beyond_its_maximum(self):
        # The printed numbers are forces over .33 N from CONTACT's example tractcurv, whose elements differ by 4e-4.
        for creepage, printed in ((0.004, -0.6101), (0.016, -0.9445), (0.1, -0.7559)):
            found = solved(creepage=(creepage, 0.0), law=LAW)
            self.assertEqual((found.status, found.message), (cn.OK, ""))
            self.assertAlmostEqual(found.tangential_force[0] / (0.33 * FORCE), printed, delta=1e-3)
            self.assertTrue(0.2 < found.report["law_slope"] < 0.3)
            self.assertAlmostEqual(found.friction_coefficient.max(), 0.33, delta=1e-12)
            self.assertLess(found.friction_coefficient.min(), 0.33)

    def test_a_layer_bounds_tractions_and_hands_its_limits_on(self):
        shift = {"motion": "SHIFT", "creepage": (-0.05, 0.0), "layer": {"yield_limit": 100.0, "hardening": 2e3}}
        first = solved(**shift)
        plastic = first.stick_slip == 3
        self.assertTrue(plastic.any())
        # At the yield limit tractions equal it, to the tolerance of the solve.
        np.testing.assert_allclose(np.hypot(*first.traction)[plastic], first.yield_limit[plastic], rtol=1e-5)
        self.assertTrue((first.yield_limit[plastic] > 100.0).all())
        again = solved(**shift, previous_traction=first.traction, previous_yield_limit=first.yield_limit)
        self.assertGreater(again.yield_limit.max(), first.yield_limit.max())

    def test_what_is_no_law_is_refused(self):
        for error, words, friction in (
            (ValueError, "has colour", {"law": {**LAW, "colour": 1}}),
            (ValueError, "no kind", {"law": {"kinetic": 0.1}}),
            (TypeError, "mapping", {"layer": 3.0}),
        ):
            with self.assertRaisesRegex(error, words):
                solved(**friction)

    def test_accuracies_have_what_particles_carry(self):
        x = (np.arange(16) - 7.5) * 0.2
        given = {"h": 0.1 * (x[None, :] ** 2 + x[:, None] ** 2), "dx": 0.2, "dy": 0.2, "force": 0.1, "shear_modulus": 1.0, "poisson_ratio": 0.3}
        shift = {"coefficient": 0.3, "creepage": (1e-3, 0.0), "motion": "SHIFT", "layer": {"yield_limit": 10.0}}
        found = cn.solve_to_accuracy(target=0.5, friction=shift, **given)
        one = cn.solve(friction=shift, **given)
        self.assertEqual((found.friction_coefficient.max(), found.yield_limit.max()), (one.friction_coefficient.max(), one.yield_limit.max()))
        self.assertEqual(found.yield_limit.max(), 10.0)
