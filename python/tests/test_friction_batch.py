"""Batches of tangential problems of one scene in Python."""

import unittest
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal._bar import SolveBar

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
M, D = 24, 0.1
X = (np.arange(M) - 0.5 * (M - 1)) * D
H = (X[None, :] ** 2 + X[:, None] ** 2) / (2 * 50.0)
FRICTION = {"coefficient": 0.3, "motion": "SHIFT"}
ENTRIES = [(1e-3 * x, 2e-4, 1e-4) for x in np.linspace(-2.0, 2.0, 20)]


class FrictionBatches(unittest.TestCase):
    def test_entries_are_what_single_solves_find(self):
        batch = cn.friction_batch(H, D, D, ENTRIES, force=1000.0, friction=FRICTION, fields=True, threads=2, **STEEL)
        self.assertEqual((batch.message, set(batch.status)), ("", {cn.OK}))
        for i in (0, 7, 19):
            x, y, spin = ENTRIES[i]
            one = cn.solve(H, D, D, force=1000.0, friction={**FRICTION, "creepage": (x, y), "spin": spin}, **STEEL)
            # A residual of 1e-6 leaves an error of some 1e-7 of mu N in the forces (docs/friction.md).
            np.testing.assert_allclose(batch.force[i], one.report["tangential_force"], atol=1e-5 * 300)
            np.testing.assert_allclose(batch.traction[i].sum(axis=(1, 2)) * D * D, batch.force[i], atol=1e-9 * 300)
            self.assertLess(np.count_nonzero(batch.stick_slip[i] != one.stick_slip), 3)
        self.assertTrue((batch.residual <= 1e-6).all() and (batch.products > 0).all())
        self.assertAlmostEqual(batch.report["force"], 1000.0, delta=1e-3)
        pressure = cn.solve(H, D, D, force=1000.0, **STEEL).pressure
        given = cn.friction_batch(None, D, D, ENTRIES, pressure=pressure, friction=FRICTION, **STEEL)
        np.testing.assert_array_equal(given.force, batch.force)
        self.assertIsNone(given.traction)

    def test_a_refused_entry_and_a_refused_call(self):
        entries = [(10.0, 0.0, 0.0), (1e6, 0.0, 0.0), (20.0, 0.0, 0.0)]
        given = {"force": 1000.0, **STEEL}
        batch = cn.friction_batch(H, D, D, entries, friction={**FRICTION, "force": (0.0, None)}, **given)
        self.assertEqual(list(batch.status), [cn.OK, cn.INFEASIBLE, cn.OK])
        self.assertRegex(batch.message, "^entry 1: ")
        self.assertTrue(np.isnan(batch.force[1]).all() and abs(batch.force[2, 0] - 20.0) < 1e-3)
        for bad, words in (({"entries": [(1.0, 2.0)]}, "entries has shape"), ({"friction": {"coefficient": -1.0}}, "coefficient is -1")):
            with self.assertRaisesRegex((ValueError, cn.ContactNormalError), words):
                cn.friction_batch(H, D, D, **{"entries": entries, "friction": FRICTION, **given, **bad})
        with self.assertRaisesRegex(TypeError, "give either h or pressure"):
            cn.friction_batch(None, D, D, entries, friction=FRICTION, **STEEL)

    def test_progress_cancels_and_raises(self):
        done = []
        batch = cn.friction_batch(None, D, D, ENTRIES, pressure=np.ones((M, M)), friction=FRICTION, **STEEL,
                                  progress=lambda told: done.append(told.cycles) or told.cycles >= 3)
        self.assertEqual(done, [1, 2, 3])
        self.assertEqual(list(batch.status), [cn.OK] * 3 + [cn.CANCELLED] * 17)
        self.assertTrue(np.isnan(batch.force[3:]).all())
        none = cn.friction_batch(H, D, D, ENTRIES, force=1000.0, friction=FRICTION, progress=lambda told: True, **STEEL)
        self.assertEqual(set(none.status), {cn.CANCELLED})
        with self.assertRaisesRegex(ValueError, "no entry is solved: there is nothing to draw"):
            none.plot()

        def fail(told):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            cn.friction_batch(None, D, D, ENTRIES, pressure=np.ones((M, M)), friction=FRICTION, progress=fail, **STEEL)

    def test_the_bar_counts_entries(self):
        for normal in ({"h": H, "force": 1000.0}, {"h": None, "pressure": cn.solve(H, D, D, force=1000.0, **STEEL).pressure}):
            told, drawn = [], []
            cn.friction_batch(dx=D, dy=D, entries=ENTRIES[:5], friction=FRICTION, progress=told.append, **normal, **STEEL)
            bar = SolveBar(M * M, 1e-6, 5)
            with mock.patch.object(bar._bar, "draw", lambda part, text, drawn=drawn: drawn.append(part)):
                for one in told:
                    bar._due = 0.0
                    bar.tell(one)
            # The bar is told of the cycles of the normal problem, if there is one, and then of the entries.
            self.assertEqual(drawn, [0.0] * (len(told) - 5) + [0.2, 0.4, 0.6, 0.8, 1.0])
            self.assertEqual(len(told) > 5, normal["h"] is not None)


if __name__ == "__main__":
    unittest.main()
