"""Tangential problems with a handle, their start, a layer between the bodies, weights of creepages."""

from __future__ import annotations

import unittest

import numpy as np

import contact_normal as cn

M, D = 24, 0.1
X = (np.arange(M) - 0.5 * (M - 1)) * D
PRESSURE = 100.0 * np.sqrt(np.maximum(0.0, 1.0 - X[None, :] ** 2 - X[:, None] ** 2))
STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
SHIFT = {"coefficient": 0.3, "motion": "SHIFT", "creepage": (-5e-4, 1e-4)}


def alone(friction: dict, **given: object) -> cn.TangentialResult:
    return cn.solve_tangential(PRESSURE, D, D, friction=friction, **STEEL, **given)


class HandlesOfTangentialProblems(unittest.TestCase):
    def test_a_handle_has_the_bits_of_single_calls(self) -> None:
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            for creepage in (-5e-4, -7e-4):
                friction = {**SHIFT, "creepage": (creepage, 0.0)}
                self.assertTrue((solver.solve_tangential(PRESSURE, friction=friction).traction == alone(friction).traction).all())
            first = alone(friction)
            goes_on = solver.solve_tangential(PRESSURE, friction={**SHIFT, "continues": True})
            given = alone({**SHIFT, "previous_traction": tuple(first.traction)})
            self.assertTrue((goes_on.traction == given.traction).all())

    def test_tables_are_kept_until_others_are_set(self) -> None:
        offsets = np.arange(-M, M)
        decay = 1e-6 / (1.0 + np.hypot(offsets[None, :], offsets[:, None]))
        tables = (decay, decay, np.zeros_like(decay))
        friction = {**SHIFT, "influence": tables}
        others = {**SHIFT, "influence": (*tables, 2.0)}
        with cn.Solver(M, M, D, D, friction=friction, **STEEL) as solver:
            self.assertTrue((solver.solve_tangential(PRESSURE, friction=SHIFT).traction == alone(friction).traction).all())
            with self.assertRaises(cn.ContactNormalError) as refused:
                solver.solve_tangential(PRESSURE, friction=others)
            self.assertEqual(refused.exception.status, cn.INFLUENCE_CHANGED)
            solver.set_influence(friction=others)
            self.assertTrue((solver.solve_tangential(PRESSURE, friction=SHIFT).traction == alone(others).traction).all())

    def test_a_table_of_entries_is_that_without_a_handle(self) -> None:
        entries = [(-5e-4, 0.0, 0.0), (-6e-4, 1e-4, 1e-5)]
        expected = cn.friction_batch(None, D, D, entries, pressure=PRESSURE, friction=SHIFT, **STEEL)
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            for _ in range(2):
                found = solver.friction_batch(PRESSURE, entries, friction=SHIFT)
                self.assertTrue((found.force == expected.force).all() and (found.status == 0).all())

    def test_a_start_near_the_solution_saves_products(self) -> None:
        cold = alone(SHIFT, tolerance=1e-8)
        warm = alone({**SHIFT, "initial_traction": tuple(cold.traction)}, tolerance=1e-8)
        self.assertLess(warm.report["tangential_products"], 0.3 * cold.report["tangential_products"])
        np.testing.assert_allclose(warm.traction, cold.traction, atol=1e-5)
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            solver.solve_tangential(PRESSURE, friction=SHIFT, tolerance=1e-8)
            again = solver.solve_tangential(PRESSURE, friction=SHIFT, tolerance=1e-8, initial_guess="PREVIOUS")
        self.assertLess(again.report["tangential_products"], 0.3 * cold.report["tangential_products"])


class CoatedBodies(unittest.TestCase):
    COATED = {**STEEL, "coating": ((0.3, 8200.0, 0.35),) * 2}

    def test_pressures_of_coated_bodies_have_the_tractions_of_the_whole_solve(self) -> None:
        h = (X[None, :] ** 2 + X[:, None] ** 2) / 100.0
        whole = cn.solve(h, D, D, force=50.0, friction=SHIFT, tolerance=1e-8, **self.COATED)
        found = cn.solve_tangential(whole.pressure, D, D, friction=SHIFT, tolerance=1e-8, **self.COATED)
        np.testing.assert_allclose(found.traction, whole.traction, atol=1e-6 * whole.pressure.max())
        plain = cn.solve_tangential(whole.pressure, D, D, friction=SHIFT, tolerance=1e-8, **STEEL)
        self.assertGreater(np.abs(plain.traction - found.traction).max(), 0.01 * whole.pressure.max())
        entries = [(*SHIFT["creepage"], 0.0), (1e-4, 0.0, 1e-4)]
        for surface, of in ((None, {"pressure": whole.pressure}), (h, {"force": 50.0})):
            batch = cn.friction_batch(surface, D, D, entries, friction=SHIFT, tolerance=1e-8, **of, **self.COATED)
            np.testing.assert_allclose(batch.force[0], whole.tangential_force, atol=1e-6 * 0.3 * 50.0)

    def test_bodies_with_unlike_coatings_are_refused(self) -> None:
        with self.assertRaises(cn.ContactNormalError) as refused:
            cn.solve_tangential(PRESSURE, D, D, friction=SHIFT, coating=((0.3, 8200.0, 0.35), None), **STEEL)
        self.assertEqual(refused.exception.status, cn.UNSUPPORTED)


class LayersAndWeights(unittest.TestCase):
    def test_a_stiff_pair_of_bodies_has_the_layer_alone(self) -> None:
        # The bodies are nearly rigid, so that a sticking element has the traction of its own part of the layer.
        compliance = np.full((M, M), 1e-3) * (1.0 + 0.5 * (X[None, :] > 0.0))
        friction = {"coefficient": 1e6, "motion": "SHIFT", "creepage": (-1e-3, 0.0), "compliance": compliance}
        found = cn.solve_tangential(PRESSURE, D, D, friction=friction, shear_modulus=1e12, poisson_ratio=0.28, tolerance=1e-10)
        expected = np.where(PRESSURE > 0.0, 1e-3 / compliance, 0.0)
        np.testing.assert_allclose(found.traction[0], expected, atol=1e-6)

    def test_forces_are_sums_of_weighted_tractions(self) -> None:
        weight = np.cos(np.linspace(-1.0, 1.0, M))[:, None] * np.ones((1, M))
        friction = {"coefficient": 0.3, "motion": "SHIFT", "force": (10.0, 20.0), "creepage_weight": (np.ones((M, M)), weight)}
        found = alone(friction, tolerance=1e-8)
        self.assertAlmostEqual(float((found.traction[0]).sum() * D * D), 10.0, places=5)
        self.assertAlmostEqual(float((weight * found.traction[1]).sum() * D * D), 20.0, places=5)


if __name__ == "__main__":
    unittest.main()
