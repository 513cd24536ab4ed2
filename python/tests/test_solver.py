"""The handle frees itself, batches keep their messages, and pictures show the requested quantity."""

import contextlib
import gc
import io
import time
import unittest
from unittest import mock

import numpy as np

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}


def ball(m):
    x = np.arange(m) - 0.5 * (m - 1)
    return 0.002 * (x[None, :] ** 2 + x[:, None] ** 2)


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


class Results(unittest.TestCase):
    def test_friction_takes_arrays_only_where_it_is(self):
        plain = cn.solve(ball(20), 0.1, 0.1, force=100.0, **STEEL)
        self.assertEqual(plain._of_effects, {})
        friction = {"coefficient": 0.3, "force": (10.0, 0.0)}
        slid = cn.solve(ball(20), 0.1, 0.1, force=100.0, friction=friction, **STEEL)
        for result in (plain, slid):
            self.assertEqual((result.traction.shape, result.slip.shape, result.stick_slip.shape), ((2, 20, 20), (2, 20, 20), (20, 20)))
        self.assertFalse(plain.traction.any() or plain.slip.any() or plain.stick_slip.any())
        self.assertAlmostEqual(slid.traction[0].sum() * 0.01, 10.0, places=6)
        self.assertTrue(slid.slip.any())
        np.testing.assert_array_equal(slid.stick_slip > 0, slid.contact)


class Handles(unittest.TestCase):
    def test_a_dropped_solver_is_freed(self):
        def one(size=256):
            solver = cn.Solver(size, size, 0.1, 0.1, **STEEL)
            return solver.solve(ball(size), force=1000.0).report["bytes"]

        held = one()
        gc.collect()
        before = resident_bytes()
        for _ in range(40):
            one()
        gc.collect()
        # Each solver holds `held` bytes. 40 leaked ones would be ten times the allowance, which is for the allocator.
        self.assertLess(resident_bytes() - before, 4 * held)

    def test_close_and_what_comes_after(self):
        solver = cn.Solver(16, 16, 0.1, 0.1, **STEEL)
        solver.close()
        solver.close()
        for call in (lambda: solver.solve(ball(16), force=1.0), lambda: solver.solve_batch([], force=1.0),
                     lambda: solver.set_influence(np.ones((32, 32)))):
            with self.assertRaisesRegex(ValueError, "this solver is closed"):
                call()

    def test_a_refused_set_up_leaves_nothing_behind(self):
        with self.assertRaisesRegex(cn.ContactNormalError, "dx is -1"):
            cn.Solver(16, 16, -1.0, 0.1, **STEEL)

    def test_every_problem_of_a_batch_keeps_its_message(self):
        with cn.Solver(16, 16, 0.1, 0.1, tolerance=1e-14, max_cycles=1, **STEEL) as solver:
            found = solver.solve_batch([ball(16)] * 4, force=[-1.0, 100.0, -3.0, 0.0])
        self.assertEqual([each.status < 0 for each in found], [True, False, True, False])
        self.assertRegex(found[0].message, "^force is -1; it must not be negative")
        self.assertRegex(found[2].message, "^force is -3; it must not be negative")
        # Problems that stop early or are solved have the messages of single calls.
        for each, force in ((found[1], 100.0), (found[3], 0.0)):
            alone = cn.solve(ball(16), 0.1, 0.1, force=force, tolerance=1e-14, max_cycles=1, **STEEL)
            self.assertEqual((each.status, each.message), (alone.status, alone.message))


    def test_no_problem_of_a_batch_goes_on_from_another(self):
        friction = {"coefficient": 0.3, "creepage": (1e-3, 0.0)}
        with cn.Solver(16, 16, 0.1, 0.1, **STEEL) as solver:
            solver.solve(ball(16), force=100.0, friction=friction)
            solver.solve_batch([ball(16)] * 3, force=100.0, friction=friction)
            found = solver.solve_batch([ball(16)] * 3, force=100.0, friction={**friction, "continues": True})
            for each in found:
                self.assertEqual(each.status, -2)
                self.assertRegex(each.message, "friction->continues is 1; in a batch it must be 0")
            # The solver's own tractions remain, and a solve can continue from them.
            self.assertEqual(solver.solve(ball(16), force=100.0, friction={**friction, "continues": True}).status, 0)


class Shown(unittest.TestCase):
    def drawn(self, tqdm):
        with contextlib.redirect_stderr(io.StringIO()) as err, mock.patch.dict("sys.modules", {"tqdm": tqdm}):
            found = cn.solve(ball(64), 0.1, 0.1, force=1000.0, progress=True, **STEEL)
        self.assertEqual(found.status, cn.OK)
        return err.getvalue()

    def test_a_bar_without_tqdm(self):
        drawn = self.drawn(None)  # None: an import of it fails
        self.assertRegex(drawn, r"\r\[[#.]{30}\] \d+\.\d s, \d+ x \d+, cycle \d+, residual ")
        self.assertTrue(drawn.endswith("\n"))

    def test_a_bar_with_tqdm(self):
        tqdm = mock.MagicMock()
        self.assertEqual(self.drawn(tqdm), "")
        bar = tqdm.tqdm.return_value
        self.assertRegex(bar.set_postfix_str.call_args[0][0], r"\d+ x \d+, cycle \d+, residual ")
        bar.close.assert_called_once_with()

    def test_progress_says_what_happens(self):
        told = []
        found = cn.solve(ball(64), 0.1, 0.1, force=1000.0, progress=told.append, method="NORM", **STEEL)
        self.assertEqual({(each.mx, each.my) for each in told}, {(64, 64)})
        self.assertEqual(len(told), found.report["cycles"])

    def test_plots(self):
        import matplotlib

        matplotlib.use("Agg")
        found = cn.solve(ball(64), 0.1, 0.1, force=1000.0, **STEEL)
        axes = found.plot()
        shown = axes.images[0].get_array()
        self.assertTrue(np.array_equal(shown.filled(0.0), found.pressure))
        self.assertEqual(tuple(axes.images[0].get_extent()), (-3.2, 3.2, -3.2, 3.2))
        found = cn.solve(ball(256), 0.05, 0.05, force=10000.0, **STEEL)
        axes = found.ledger.plot()
        labels = [line.get_label() for line in axes.lines]
        self.assertIn("approach", labels)  # the force is prescribed
        line = axes.lines[labels.index("approach")]
        row = found.ledger[-1]
        self.assertAlmostEqual(line.get_ydata()[-1], row["error_force"] / row["approach"])
        axes.figure.canvas.draw()

    def test_a_result_says_what_it_is(self):
        found = cn.solve(ball(16), 0.1, 0.1, force=1000.0, **STEEL)
        self.assertRegex(repr(found), r"^<Result: solved; 16 x 16 elements, force 1000, approach 0\.\d+, max_pressure \d+\.\d, contact_area 0\.\d+ "
                                      r"\(\d\.\d+ % of the grid\), residual \d\.\de-\d\d>$")
        self.assertIs(cn.to_accuracy, cn.solve_to_accuracy)


class Batches(unittest.TestCase):
    def test_a_limit_of_time_is_that_of_the_whole_batch(self):
        endless = {"method": "MULTIGRID", "smoother": "JACOBI", "relaxation": 1e-9, "max_cycles": 2**31 - 1}
        with cn.Solver(64, 64, 0.1, 0.1, **endless, **STEEL) as solver:
            began = time.monotonic()
            found = solver.solve_batch([ball(64)] * 30, force=1000.0, max_seconds=0.2)
        # The problems are solved one after the other, and each alone would take 0.2 s.
        self.assertLess(time.monotonic() - began, 2.0)
        self.assertEqual({result.status for result in found}, {cn.ITERATION_LIMIT})

    def test_elements_of_messages_are_counted_as_those_of_arrays(self):
        h = ball(16)
        h[3, 5] = np.nan
        with cn.Solver(16, 16, 0.1, 0.1, **STEEL) as solver:
            found = solver.solve_batch([ball(16), h], force=100.0)
        self.assertEqual([result.status for result in found], [cn.OK, cn.NOT_FINITE])
        self.assertIn("element [3, 5]", found[1].message)


if __name__ == "__main__":
    unittest.main()
