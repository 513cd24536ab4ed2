"""Objects that can be pickled and copied, and those that cannot; handles and callbacks that are dropped while the library uses them."""

import concurrent.futures
import copy
import gc
import multiprocessing
import os
import pickle
import threading
import unittest

import numpy as np

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
M, D = 24, 0.1
X = (np.arange(M) - 0.5 * (M - 1)) * D
H = 0.02 * (X[None, :] ** 2 + X[:, None] ** 2)
WAYS = [copy.copy, copy.deepcopy, *(lambda x, p=p: pickle.loads(pickle.dumps(x, p)) for p in range(2, pickle.HIGHEST_PROTOCOL + 1))]


def solve(force):
    return cn.solve(H, D, D, force=force, **STEEL)


def arrays(result):
    return [result.pressure, result.deformed_distance, result.displacement, result.contact, result.at_limit, result.traction, result.slip]


class Copies(unittest.TestCase):
    def assert_same(self, one, other):
        self.assertEqual((one.status, one.message, one.dx, one.dy), (other.status, other.message, other.dx, other.dy))
        for a, b in zip(arrays(one), arrays(other)):
            np.testing.assert_array_equal(a, b)
        self.assertEqual(one.report, other.report)
        self.assertEqual((one.ledger, one.ledger.estimated), (other.ledger, other.ledger.estimated))
        self.assertEqual(repr(one), repr(other))
        depths = [0.0, 0.3]
        np.testing.assert_array_equal(one.subsurface(depths, body=2).von_mises, other.subsurface(depths, body=2).von_mises)

    def test_results(self):
        bodies = {"shear_modulus": (82000.0, 1000.0), "poisson_ratio": (0.28, 0.45)}
        halves = (X[None, :] > 0).astype(int) + np.zeros((M, 1), int)
        scenes = [
            {"force": 100.0, "period": "xy", "pressure_limit": 300.0},
            {"approach": 0.01, "patches": (halves, np.array([[1.0, 0.1], [0.1, 1.0]]))},
            {"force": 100.0, "friction": {"coefficient": 0.3 + 0 * H, "motion": "SHIFT", "creepage": (1e-4, 0.0)}},
            {"force": 100.0, "layer": 1e-6, "coating": ((0.1, 1e5, 0.3), None)},
            {"force": 100.0, "max_cycles": 1, "tolerance": 1e-15, "method": "NORM"},
        ]
        for scene in scenes:
            result = cn.solve(H, D, D, **scene, **bodies)
            for way in WAYS:
                self.assert_same(way(result), result)
                self.assert_same(way(way(result)), result)

    def test_other_results(self):
        accurate = cn.solve_to_accuracy(H, D, D, force=100.0, target=0.1, **STEEL)
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            one, bad = solver.solve_batch([H, H], force=[100.0, -1.0])
        stress = accurate.subsurface([0.1], principal=True)
        batch = cn.friction_batch(H, D, D, [(1e-4, 0.0, 0.0)], force=100.0, friction={"coefficient": 0.3}, fields=True, **STEEL)
        table = cn.creep_force_table(xi=[0.0, 0.5], eta=[0.0], phi=[0.0], elements=9)
        for way in WAYS:
            self.assert_same(way(accurate), accurate)
            self.assertEqual((way(accurate).reached, way(accurate).seconds), (accurate.reached, accurate.seconds))
            self.assert_same(way(one), one)
            self.assertEqual((way(bad).status, way(bad).message), (bad.status, bad.message))
            np.testing.assert_array_equal(way(stress).directions, stress.directions)
            np.testing.assert_array_equal(way(batch).traction, batch.traction)
            np.testing.assert_array_equal(way(table).force_x, table.force_x)

    def test_a_pickle_holds_no_more_than_the_arrays(self):
        big = np.zeros((200, 200))
        result = cn.solve(big, D, D, approach=0.0, friction={"coefficient": 0.3, "rigid_slip": (big, big)}, **STEEL)
        # The result has three fields, four of friction, and two of 32-bit integers: 64 bytes an element.
        self.assertLess(len(pickle.dumps(result)), 66 * big.size)

    def test_errors(self):
        with self.assertRaises(cn.ContactNormalError) as caught:
            solve(-1.0)
        error = caught.exception
        error.place = "here"
        for way in WAYS:
            again = way(error)
            self.assertEqual((type(again), again.status, again.message, str(again), again.place),
                             (type(error), error.status, error.message, str(error), "here"))

    @unittest.skipUnless(hasattr(os, "fork"), "its workers are forked")
    def test_workers_send_results_and_errors_back(self):
        with concurrent.futures.ProcessPoolExecutor(1, multiprocessing.get_context("fork")) as pool:
            np.testing.assert_array_equal(pool.submit(solve, 100.0).result().pressure, solve(100.0).pressure)
            with self.assertRaisesRegex(cn.ContactNormalError, "force is -1; it must not be negative"):
                pool.submit(solve, -1.0).result()
            self.assertEqual(pool.submit(abs, -1).result(), 1)

    def test_a_solver_is_neither_pickled_nor_copied(self):
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            for way in WAYS:
                with self.assertRaisesRegex(TypeError, "a Solver can be neither pickled nor copied"):
                    way(solver)


class Closing(unittest.TestCase):
    def setUp(self):
        self.solver = cn.Solver(M, M, D, D, **STEEL)
        self.is_freed = lambda free=self.solver._handle._free: not free.alive

    def test_while_the_arguments_are_read(self):
        solver = self.solver

        class Closes:
            def __array__(self, *_args, **_kwargs):
                solver.close()
                return H

        for call in (lambda: solver.solve(Closes(), force=100.0), lambda: solver.solve_batch([Closes()], force=100.0),
                     lambda: solver.set_influence(np.ones((2 * M, 2 * M)))):
            with self.assertRaisesRegex(ValueError, "this solver is closed"):
                call()
        self.assertTrue(self.is_freed())

    def test_in_a_callback(self):
        expected = cn.solve(H, D, D, force=100.0, **STEEL)
        found = self.solver.solve(H, force=100.0, progress=lambda told: self.assertFalse(self.solver.close() or self.is_freed()))
        np.testing.assert_array_equal(found.pressure, expected.pressure)
        self.assertTrue(self.is_freed())
        with self.assertRaisesRegex(ValueError, "this solver is closed"):
            self.solver.solve(H, force=100.0)

    def test_while_another_thread_solves(self):
        begun, closed, found = threading.Event(), threading.Event(), []

        def progress(told):
            begun.set()
            closed.wait()

        thread = threading.Thread(target=lambda: found.append(self.solver.solve(H, force=100.0, progress=progress)))
        thread.start()
        begun.wait()
        with self.assertRaisesRegex(cn.ContactNormalError, "in use"):
            self.solver.solve(H, force=100.0)
        self.solver.close()
        self.assertFalse(self.is_freed())
        closed.set()
        thread.join()
        self.assertEqual(found[0].status, cn.OK)
        self.assertTrue(self.is_freed())

    def test_dropped_in_a_callback(self):
        def drop(told):
            self.solver = None
            gc.collect()

        self.assertEqual(self.solver.solve(H, force=100.0, progress=drop).status, cn.OK)
        gc.collect()
        self.assertTrue(self.is_freed())

    def test_a_set_up_that_is_refused_has_nothing_to_free(self):
        with self.assertRaises(cn.ContactNormalError):
            cn.Solver(M, M, D, -D, **STEEL)


class Logs(unittest.TestCase):
    def tearDown(self):
        cn.set_log(None)

    def test_levels_and_none(self):
        lines = {}
        for level in (cn.LOG_INFO, cn.LOG_WARNING, cn.LOG_OFF):
            found = lines.setdefault(level, [])
            cn.set_log(lambda at, text, found=found: found.append((at, text)), level)
            refuse_to_converge()
        # An early stop is logged as information, not as a warning, because the status reports it, too.
        self.assertEqual({at for at, _ in lines[cn.LOG_INFO]}, {cn.LOG_INFO})
        self.assertRegex(lines[cn.LOG_INFO][0][1], "^Norm on 24 x 24: IterationLimit after 2 cycles")
        self.assertEqual((lines[cn.LOG_WARNING], lines[cn.LOG_OFF]), ([], []))
        found = []
        cn.set_log(lambda at, text: found.append(text))
        cn.set_log(None)
        refuse_to_converge()
        self.assertEqual(found, [])

    def test_what_is_refused_changes_nothing(self):
        found = []
        cn.set_log(lambda at, text: found.append(text))
        refused = cn.ContactNormalError
        for bad, kind in ((("print", 2), TypeError), ((print, 7), refused), ((print, 1.5), TypeError), ((None, 7), refused)):
            with self.assertRaises(kind):
                cn.set_log(*bad)
        refuse_to_converge()
        self.assertTrue(found)

    def test_one_that_replaces_itself(self):
        told = []

        def first(at, text):
            cn.set_log(lambda at, text: told.append("second"))
            gc.collect()
            told.append("first")

        cn.set_log(first)
        del first
        for _ in range(3):
            refuse_to_converge()
        self.assertEqual(told[0], "first")
        self.assertEqual(set(told[1:]), {"second"})

    def test_replaced_while_others_solve(self):
        solved = threading.Event()

        def solves():
            for _ in range(300):
                refuse_to_converge()
            solved.set()

        threads = [threading.Thread(target=solves) for _ in range(3)]
        for thread in threads:
            thread.start()
        told = []
        while not solved.is_set():
            cn.set_log(lambda level, text: told.append(text))
            cn.set_log(None)
        for thread in threads:
            thread.join()


def refuse_to_converge():
    """A solve with messages."""
    return cn.solve(H, D, D, force=100.0, method="NORM", tolerance=1e-15, max_cycles=2, **STEEL)


if __name__ == "__main__":
    unittest.main()
