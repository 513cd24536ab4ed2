"""Adhesion: a sphere in the units of Johnson, Kendall and Roberts, R = 1, w = 1/pi, E* = 3/4."""

from __future__ import annotations

import re
import unittest
from typing import Any

import numpy as np

import contact_normal

D = 6.0 / 64
X = (np.arange(64) - 31.5) * D
H = (X[None, :] ** 2 + X[:, None] ** 2) / 2
STICKY = {"work": 1 / np.pi, "range": 0.5647539}
SHIFT = {"coefficient": 0.3, "creepage": (-1e5, 0.0), "motion": "SHIFT"}


def solve(**given: Any) -> contact_normal.Result:
    return contact_normal.solve(H, D, D, **{"e_star": 0.75, "adhesion": STICKY, **given})


class Adhesion(unittest.TestCase):
    def test_pressures_are_those_of_contact_less_the_attraction(self) -> None:
        found = solve(approach=0.2)
        self.assertEqual(found.status, contact_normal.OK)
        self.assertTrue((found.contact_pressure >= -1e-6 * found.max_pressure).all() and (found.attraction >= 0).all())
        self.assertTrue((found.contact_pressure[~found.contact] == 0).all())
        rest = found.pressure - (found.contact_pressure - found.attraction)
        self.assertLess(np.linalg.norm(rest), 2e-6 * np.linalg.norm(found.pressure))
        law = 1 / np.pi / 0.5647539 * np.exp(-np.maximum(found.deformed_distance, 0) / 0.5647539)
        np.testing.assert_allclose(found.attraction, law, rtol=1e-12, atol=1e-15)
        forces = found.report["repulsive_force"] + found.report["adhesive_force"]
        self.assertAlmostEqual(forces, found.force, places=5)

    def test_a_pull_is_held_or_refused(self) -> None:
        found = solve(force=-1.4, adhesion={**STICKY, "stiffness": True})
        self.assertGreater(found.approach, -0.55)
        self.assertGreater(found.report["stiffness"], 0)
        with self.assertRaisesRegex(contact_normal.ContactNormalError, "pull-off force"):
            solve(force=-1.8)

    def test_a_pull_that_is_not_reached_says_what_it_lacks(self) -> None:
        told = 0
        for cycles in (2, 3, 4, 6):
            found = solve(force=-1.4, max_cycles=cycles)
            self.assertIn(found.status, (contact_normal.OK, contact_normal.ITERATION_LIMIT))
            lack = abs(found.pressure.sum() * D * D / -1.4 - 1)
            said = re.search(r"the force is off by (\S+) of the one that is given", found.message)
            self.assertEqual(said is not None, lack > 1e-6, (found.message, lack))
            if said:
                # Numbers in messages have six digits.
                self.assertLess(abs(float(said[1]) / lack - 1.0), 5.1e-6)
                told += 1
        self.assertGreater(told, 0)

    def test_the_pull_off_of_two_patches_is_the_sum_of_both(self) -> None:
        both = np.concatenate([H[::2, ::2], H[::2, ::2]], axis=1)
        patch = np.repeat([[0, 1]], 32, axis=0).repeat(32, axis=1)
        given: Any = {"e_star": 0.75, "adhesion": {**STICKY, "range": 1.0}}
        one = contact_normal.pull_off(H[::2, ::2], 2 * D, 2 * D, **given).force
        two = contact_normal.pull_off(both, 2 * D, 2 * D, patches=(patch, np.eye(2)), mean_pressure=0.0, **given).force
        self.assertAlmostEqual(two / one, 2.0, delta=0.01)

    def test_the_pull_off_is_between_jkr_and_dmt(self) -> None:
        found = contact_normal.pull_off(H, D, D, e_star=0.75, adhesion=STICKY)
        self.assertTrue(-1.67 < found.force < -1.66, found.force)

    def test_arguments_are_refused_by_name(self) -> None:
        for wrong, named in (({}, "no work"), ({"work": 1.0, "rho": 1.0}, "rho"), ({"work": 1.0, "law": "LINEAR"}, "LINEAR")):
            with self.assertRaisesRegex(ValueError, named):
                solve(approach=0.2, adhesion=wrong)
        # Refused, because tractions of unlike bodies would change the pressures.
        with self.assertRaisesRegex(contact_normal.ContactNormalError, "unlike"):
            solve(approach=0.2, friction=SHIFT, e_star=None, shear_modulus=(0.375, 0.75), poisson_ratio=0.0)

    def test_friction_is_bounded_by_contact_pressures_and_a_strength(self) -> None:
        sticky = {**STICKY, "shear_strength": 0.2, "stability": True}
        found = solve(force=-0.5, adhesion=sticky, friction=SHIFT, e_star=None, shear_modulus=0.75, poisson_ratio=0.0)
        bound = 0.3 * found.report["repulsive_force"] + 0.2 * found.report["contact_area"]
        self.assertAlmostEqual(found.report["tangential_force"][0], bound, places=6)
        self.assertTrue(0.0 < found.report["stability"] < 1.0)

    def test_a_table_of_friction_is_bounded_as_one_solve(self) -> None:
        sticky, steel = {**STICKY, "shear_strength": 0.2}, {"shear_modulus": 0.75, "poisson_ratio": 0.0}
        found = contact_normal.friction_batch(H, D, D, [(-1e5, 0.0, 0.0), (-0.05, 0.02, 0.0)], force=-0.5, friction=SHIFT, adhesion=sticky, **steel)
        self.assertTrue((found.status == 0).all(), found.message)
        bound = 0.3 * found.report["repulsive_force"] + 0.2 * found.report["contact_area"]
        self.assertAlmostEqual(found.force[0, 0], bound, places=6)
        alone = solve(force=-0.5, adhesion=sticky, friction={**SHIFT, "creepage": (-0.05, 0.02)}, e_star=None, **steel)
        np.testing.assert_allclose(found.force[1], alone.report["tangential_force"][:2], rtol=1e-4, atol=1e-6 * bound)

    def test_stresses_below_are_those_of_pressures_less_those_of_the_attraction(self) -> None:
        found = solve(force=-0.5)
        self.assertLess(found.pressure.min(), 0)
        points = [(0.0, 0.0, 0.4), (1.1, 0.3, 0.2), (0.2, -1.4, 0.1)]
        parts = [contact_normal.stress_at_points(p, D, D, points, poisson_ratio=0.3) for p in (found.pressure, found.pressure + found.attraction, found.attraction)]
        total, contact, attraction = (np.asarray(part) for part in parts)
        np.testing.assert_allclose(total, contact - attraction, rtol=0, atol=1e-12 * abs(contact).max())
        self.assertGreater(abs(total - contact).max(), 0.1 * abs(contact).max())

    def test_accuracies_and_quantities_take_it(self) -> None:
        scene = {"approach": 0.2, "e_star": 0.75, "adhesion": STICKY}
        rows = contact_normal.quantities(H, D, D, names=["force"], **scene)
        self.assertAlmostEqual(rows.last("force").value, solve(approach=0.2).force, places=4)
        found = contact_normal.to_accuracy(H, D, D, target=3e-3, **scene)
        self.assertEqual(found.status, contact_normal.OK)
        self.assertAlmostEqual(found.force / rows.last("force").value, 1.0, delta=rows.last("force").error / abs(found.force))
        # In contact p = q - sigma, up to the residuals of 1e-6.
        differences = (found.contact_pressure - found.attraction - found.pressure)[found.contact]
        self.assertLess(abs(differences).max(), 1e-5 * found.contact_pressure.max())
        with self.assertRaisesRegex(contact_normal.ContactNormalError, "name a range"):
            contact_normal.to_accuracy(H, D, D, **{**scene, "adhesion": {"work": 0.3}})

    def test_a_handle_follows_a_branch(self) -> None:
        with contact_normal.Solver(64, 64, D, D, e_star=0.75) as solver:
            solver.solve(H, approach=0.2, adhesion=STICKY)
            found = solver.solve(H, approach=0.1, adhesion=STICKY, initial_guess="PREVIOUS")
        self.assertAlmostEqual(found.force, solve(approach=0.1).force, places=4)
        self.assertEqual(found.report["jumped"], 0)


if __name__ == "__main__":
    unittest.main()
