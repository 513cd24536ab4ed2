"""Quantities with their errors, the bill of effects, neglected effects, and accuracies and prices of scenes with effects."""

import unittest

import numpy as np

import contact_normal as cn

# A ball of radius 50 on a plane, with an approach d of 0.05: a = 1.58, F = 4/3 E* a d (Johnson 1985, section 4.2).
RADIUS, APPROACH, E_STAR = 50.0, 0.05, 1e5
A = np.sqrt(RADIUS * APPROACH)
X = (np.arange(64) - 31.5) * 0.1
H = (X[None, :] ** 2 + X[:, None] ** 2) / (2 * RADIUS)
BALL = {"approach": APPROACH, "e_star": E_STAR, "poisson_ratio": 0.3}


class Quantities(unittest.TestCase):
    def test_errors_cover_what_is_off_from_hertz(self):
        rows = cn.quantities(H, 0.1, 0.1, names=["force", "stiffness", "max_pressure"], **BALL)
        truth = {"force": 4 / 3 * E_STAR * A * APPROACH, "stiffness": 2 * E_STAR * A, "max_pressure": 2 / np.pi * E_STAR * A / RADIUS}
        self.assertEqual([row.shape for row in rows], [(m, m) for m in (16, 32, 64) for _ in truth])
        for name, value in truth.items():
            row = rows.last(name)
            # An estimate from one grid may be too small by a factor of three.
            self.assertLessEqual(abs(row.value - value), 3 * row.error, row)
            self.assertEqual(row.lack, "")
        self.assertEqual(rows[1].lack, "one grid")
        self.assertIn("64 x 64", str(rows))

    def test_a_scene_that_is_not_solved_is_refused(self):
        for given, status in (({"max_seconds": 1e-9}, cn.ITERATION_LIMIT), ({"max_cycles": 1, "method": "NORM", "tolerance": 1e-14}, cn.ITERATION_LIMIT)):
            with self.assertRaises(cn.ContactNormalError) as caught:
                cn.quantities(H, 0.1, 0.1, **BALL, **given)
            self.assertEqual(caught.exception.status, status)
            self.assertTrue(caught.exception.message)

    def test_what_is_no_quantity_is_refused(self):
        with self.assertRaisesRegex(ValueError, "names has 'area'"):
            cn.quantities(H, 0.1, 0.1, names=["area"], **BALL)
        with self.assertRaisesRegex(TypeError, "sequence of names"):
            cn.quantities(H, 0.1, 0.1, names="force", **BALL)

    def test_accuracies_and_prices_of_scenes_with_effects(self):
        friction = {"coefficient": 0.3, "force": (1500.0, None), "creepage": (0.0, 0.0)}
        given = {**BALL, "layer": 1e-7 * np.ones_like(H[::4, ::4]), "friction": friction}
        result = cn.solve_to_accuracy(H[::4, ::4], 0.4, 0.4, target=1e-2, targets={"creepage": 5e-2}, **given)
        self.assertEqual(result.status, cn.OK)
        self.assertEqual(result.traction.shape, (2, *result.pressure.shape))
        force = result.traction[0].sum() * result.dx * result.dy
        self.assertAlmostEqual(force, 1500.0, delta=1e-3 * 1500.0)
        prices = cn.cost_of_accuracy(H[::4, ::4], 0.4, 0.4, quantity="stick_area", targets=[0.1, 0.05], **given)
        self.assertEqual([price.obstacle for price in prices], ["", ""])
        self.assertEqual(prices.quantity, "stick_area")
        with self.assertRaisesRegex(ValueError, "targets has 'area'"):
            cn.solve_to_accuracy(H, 0.1, 0.1, targets={"area": 1e-2}, **BALL)


class WhatMatters(unittest.TestCase):
    def test_a_bill_tells_what_is_needed(self):
        # The largest pressure of the ball is 2013, above the limit of 1000.
        bill = cn.what_matters(H, 0.1, 0.1, target=1e-2, layer=1e-12, pressure_limit=1000.0, **BALL)
        self.assertEqual((bill.needed, bill.negligible), (["pressure_limit"], ["layer"]))
        self.assertEqual({row.omitted for row in bill}, {("layer",), ("pressure_limit",), ("layer", "pressure_limit")})
        change = next(row for row in bill if row.omitted == ("pressure_limit",) and row.quantity == "max_pressure")
        whole = cn.solve(H, 0.1, 0.1, layer=1e-12, **BALL).max_pressure
        self.assertLessEqual(abs(change.value + change.change - whole), change.error + 1e-3 * whole)
        self.assertIn("verdict at 0.01", str(bill))
        self.assertEqual(list(cn.what_matters(H, 0.1, 0.1, **BALL)), [])

    def test_a_bill_that_is_cut_short_says_so(self):
        bill = cn.what_matters(H, 0.1, 0.1, layer=1e-7, max_seconds=1e-9, **BALL)
        self.assertEqual({row.lack for row in bill}, {"unsolved"})
        self.assertEqual(bill.message, "max_seconds was reached")
        self.assertTrue(str(bill).endswith("\nmax_seconds was reached"))
        self.assertEqual(cn.what_matters(H, 0.1, 0.1, layer=1e-7, **BALL).message, "")

    def test_all_that_may_be_left_out_is_told(self):
        for name in cn._bill.OMISSIONS.values():
            self.assertIn(f'"{name}"', cn._bill.BillRow.__doc__)

    def test_the_force_is_called_an_approach_where_it_is_one(self):
        given = {"e_star": E_STAR, "layer": 1e-7, "pairs": False}
        for load, last in (({"approach": APPROACH}, "layer"), ({"force": 1e4}, "force is that of the approach: the force is prescribed")):
            self.assertTrue(str(cn.what_matters(H, 0.1, 0.1, **load, **given)).splitlines()[-1].startswith(last))

    def test_what_is_negligible_is_left_out(self):
        result = cn.solve(H, 0.1, 0.1, layer=1e-12, pressure_limit=1000.0, neglect_below=1e-2, **BALL)
        self.assertEqual(result.neglected, ("layer",))
        self.assertTrue(0 < result.neglected_error < 1e-2)
        self.assertEqual(result.max_pressure, 1000.0)
        self.assertEqual(cn.solve(H, 0.1, 0.1, layer=1e-12, **BALL).neglected, ())
        self.assertEqual(cn.solve(H, 0.1, 0.1, layer=1e-12, **BALL).neglected_error, 0.0)

    def test_pictures(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("Agg")
        bill = cn.what_matters(H, 0.1, 0.1, layer=1e-7, pressure_limit=1000.0, pairs=False, **BALL)
        labels = [label.get_text() for label in bill.plot().get_yticklabels()]
        self.assertEqual([label.split("\n")[0] for label in labels], ["layer", "pressure limit"])
        drawn = cn.quantities(H, 0.1, 0.1, names=["force", "stiffness"], **BALL).plot()
        self.assertEqual([line.get_label() for line in drawn.get_lines() if line.get_label()[0] != "_"], ["force", "stiffness"])
        prices = cn.cost_of_accuracy(H, 0.1, 0.1, targets=[1e-2, 1e-3], **BALL)
        self.assertEqual(prices.plot(measured=[(1e-3, 1e-2)]).get_xscale(), "log")
        by_force = {**BALL, "approach": None, "force": 1e4}
        axes = cn.cost_of_accuracy(H, 0.1, 0.1, targets=[1e-2, 1e-3], **by_force).plot()
        self.assertEqual((prices.plot().get_ylabel(), axes.get_ylabel()), ("relative error of the force", "relative error of the approach"))
        drawn = cn.what_matters(H, 0.1, 0.1, layer=1e-7, pairs=False, **by_force).plot()
        self.assertEqual(drawn.get_legend_handles_labels()[1], ["approach", "max pressure", "contact area"])


if __name__ == "__main__":
    unittest.main()
