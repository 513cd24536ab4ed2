"""Batches and tables have the warnings of their problems, and remarks on values in probably wrong units."""

import unittest

import numpy as np

import contact_normal as cn
from contact_normal._batch_messages import messages_of

M = 16
X = (np.arange(M) - 7.5) * 0.1
BALL = (X[None, :] ** 2 + X[:, None] ** 2) / 10.0
ELASTIC = {"shear_modulus": 1.0, "poisson_ratio": 0.3}


class Batches(unittest.TestCase):
    def test_problems_that_are_ok_warn_as_they_do_alone(self):
        single = np.ones((M, M))
        single[8, 8] = 0.0
        surfaces, forces = [BALL, single, BALL], [1.0, 1e-6, 0.01]
        with cn.Solver(M, M, 0.1, 0.1, **ELASTIC) as solver:
            alone = [solver.solve(h, force=force) for h, force in zip(surfaces, forces)]
            batch = solver.solve_batch(surfaces, force=forces)
            self.assertEqual([one.status for one in batch], [cn.OK] * 3)
            self.assertEqual([one.message for one in batch], [one.message for one in alone])
            self.assertIn("contact reaches the border", batch[0].message)
            self.assertIn("one element is in contact", batch[1].message)
            self.assertEqual(batch[2].message, "")
            late = solver.solve_batch(surfaces[:2], force=forces[:2], max_cycles=1)
            self.assertEqual(late[0].status, cn.ITERATION_LIMIT)

    def test_texts_of_warnings_are_told_apart(self):
        # The texts are separated by semicolons, and the last one contains one itself.
        told = "border; steep; a larger memory"
        self.assertEqual(messages_of([cn.OK] * 3, told, [1, 64, 65]), ["border", "steep; a larger memory", told])
        self.assertEqual(messages_of([cn.OK] * 2, "one", [0, 5]), ["", "one"])
        self.assertEqual(messages_of([cn.OK] * 2, "", [0, 0]), ["", ""])


class Remarks(unittest.TestCase):
    PRESSURE = cn.solve(BALL, 0.1, 0.1, force=0.01, **ELASTIC).pressure

    def told(self, entries, **friction):
        found = cn.friction_batch(None, 0.1, 0.1, entries, pressure=self.PRESSURE, friction={"coefficient": 0.3, **friction}, **ELASTIC)
        self.assertFalse(found.status.any())
        with cn.Solver(M, M, 0.1, 0.1, **ELASTIC) as solver:
            kept = solver.friction_batch(self.PRESSURE, entries, friction={"coefficient": 0.3, **friction})
        self.assertEqual(kept.message, found.message)
        return found.message

    def test_tables_of_friction_say_what_solves_say(self):
        small, rolling = [[1e-4, 0.0, 0.0], [2e-4, 0.0, 0.0]], {"motion": "STEADY_ROLLING"}
        self.assertEqual(self.told(small, coefficient=30.0, **rolling), "a coefficient of 30 is a ratio of forces: 30 % is 0.3")
        self.assertEqual(self.told(small, coefficient=np.full((M, M), 30.0), **rolling), "a coefficient of 30 is a ratio of forces: 30 % is 0.3")
        self.assertRegex(self.told(small), "^the motion of friction is not given: it is a SHIFT")
        self.assertRegex(self.told([[0.0, -0.1, 0.0]], **rolling), "^a creepage of 0.1 is this part of the rolling speed")
        self.assertRegex(self.told([[0.0, 0.0, 0.0], [0.0, 0.0, -0.2]], **rolling), "^a spin of 0.2 makes a creepage of 0.16")
        # No remark: entries replace the creepages of the friction, and prescribed forces are no creepages.
        for quiet in (self.told(small, **rolling), self.told([[0.0, 0.0, 0.0]]), self.told(small, motion="SHIFT"), self.told(np.zeros((0, 3)), **rolling),
                      self.told(small, creepage=(0.2, 0.0), **rolling), self.told([[1e-3, 0.0, 0.0]], force=(0.0, None))):
            self.assertEqual(quiet, "")

    def test_coefficients_of_elements_are_judged_too(self):
        friction = {"coefficient": np.full((M, M), 30.0), "motion": "STEADY_ROLLING", "creepage": (1e-4, 0.0)}
        self.assertIn("a coefficient of 30 is a ratio", cn.solve_tangential(self.PRESSURE, 0.1, 0.1, friction=friction, **ELASTIC).message)

    def test_friction_without_a_coefficient_is_refused(self):
        for friction in ({"creepage": (1e-3, 0.0)}, {}, {"coefficient": None, "spin": 0.1}, {"layer": {"yield_limit": 0.05}, "creepage": (1e-3, 0.0)},
                         {"row_tables": (np.zeros((M * M, M * M)),) * 3, "creepage": (1e-3, 0.0)}):
            with self.assertRaisesRegex(ValueError, "friction has no coefficient; without friction leave it out, or give a coefficient of 0"):
                cn.solve(BALL, 0.1, 0.1, force=0.01, friction=friction, **ELASTIC)
        none = cn.solve(BALL, 0.1, 0.1, force=0.01, friction={"coefficient": 0.0, "creepage": (1e-3, 0.0), "motion": "SHIFT"}, **ELASTIC)
        self.assertEqual((none.status, none.tangential_force), (cn.OK, (0.0, 0.0)))


if __name__ == "__main__":
    unittest.main()
