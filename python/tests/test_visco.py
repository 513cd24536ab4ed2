"""Viscoelastic bodies: a ball on one body with two branches."""

from __future__ import annotations

import unittest

import numpy as np

import contact_normal

X = (np.arange(32) - 15.5) * 0.02
H = (X[None, :] ** 2 + X[:, None] ** 2) / 2
MODULI, TIMES = [4.0, 3.0], [0.3, 3.0]
BRANCHES = {"modulus": (None, MODULI), "time": (None, TIMES)}
BODIES = {"shear_modulus": (np.inf, 8.0), "poisson_ratio": (0.0, 0.5)}


def modulus(t: float) -> float:
    return 8.0 - sum(g * (1 - np.exp(-t / k)) for g, k in zip(MODULI, TIMES))


class Visco(unittest.TestCase):
    def test_a_held_approach_relaxes_as_the_modulus(self) -> None:
        with contact_normal.Solver(32, 32, 0.02, 0.02, visco=BRANCHES, tolerance=1e-9, **BODIES) as solver:
            first = solver.solve(H, approach=0.02)
            self.assertEqual((first.report["time"], first.report["compliance"]), (0.0, 1.0))
            for k, step in enumerate((0.4, 0.1, 2.0)):
                found = solver.solve(H, approach=0.02, visco={"time_step": step, "continues": True})
                time = sum((0.4, 0.1, 2.0)[: k + 1])
                self.assertAlmostEqual(found.report["time"], time, places=12)
                self.assertLess(abs(found.force / first.force / (modulus(time) / 8.0) - 1), 1e-8)
                self.assertGreater(found.report["time_error"], found.report["step_error"] if k else 0)
            # A step may begin from rest again. On another handle a step that continues is refused.
            again = solver.solve(H, approach=0.02, visco={"time_step": 0.4})
            self.assertEqual(again.report["time"], 0.4)

    def test_one_call_is_a_step_from_rest(self) -> None:
        jump = contact_normal.solve(H, 0.02, 0.02, force=0.05, visco=BRANCHES, **BODIES)
        plain = contact_normal.solve(H, 0.02, 0.02, force=0.05, **BODIES)
        np.testing.assert_array_equal(jump.pressure, plain.pressure)
        slow = contact_normal.solve(H, 0.02, 0.02, force=0.05, visco={**BRANCHES, "time_step": 5.0, "form": "creep"}, **BODIES)
        self.assertGreater(slow.approach, 1.2 * plain.approach)

    def test_what_is_wrong_is_named(self) -> None:
        wrong = [
            (TypeError, 3, "visco is 3"),
            (ValueError, {"times": (None, TIMES)}, "visco has times"),
            (ValueError, {"modulus": (None, MODULI)}, "of body 2 must both be given"),
            (ValueError, {"modulus": (None, MODULI), "time": (None, [1.0])}, "time"),
            (ValueError, {**BRANCHES, "form": "EULER"}, "form is 'EULER'"),
            (contact_normal.ContactNormalError, {**BRANCHES, "continues": True}, "holds no step in time"),
            (contact_normal.ContactNormalError, {**BRANCHES, "time_step": -1.0}, "visco->time_step is -1"),
        ]
        for kind, visco, words in wrong:
            with self.assertRaisesRegex(kind, words):
                contact_normal.solve(H, 0.02, 0.02, approach=0.02, visco=visco, **BODIES)


if __name__ == "__main__":
    unittest.main()
