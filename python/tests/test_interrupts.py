"""Signals end calls of the library: Ctrl-C, Jupyter's Interrupt, handlers that raise. Otherwise each call here would last for hours."""

import ctypes
import os
import signal
import subprocess
import sys
import threading
import unittest
import warnings
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal import _callbacks, _calls

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
M, D = 64, 0.1
X = (np.arange(M) - 0.5 * (M - 1)) * D
H = 0.2 * (X[None, :] ** 2 + X[:, None] ** 2)
# Sweeps that hardly change the pressures, and billions of cycles: such a solve does not end by itself.
ENDLESS = {"method": "MULTIGRID", "smoother": "JACOBI", "relaxation": 1e-9, "max_cycles": 2**31 - 1}


def setUpModule():
    if os.name == "nt":
        raise unittest.SkipTest("os.kill sends no signals on Windows: it ends the process")
    # A shell may start this process with SIGINT ignored, as a background process.
    unittest.addModuleCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))


def send(number=signal.SIGINT, seconds=0.2):
    """Sends this process a signal after a short time."""
    timer = threading.Timer(seconds, os.kill, (os.getpid(), number))
    timer.start()
    return timer


class Interrupts(unittest.TestCase):
    def interrupted(self, call):
        timer = send()
        with self.assertRaises(KeyboardInterrupt):
            call()
        timer.join()

    def test_a_solve(self):
        self.interrupted(lambda: cn.solve(H, D, D, force=1000.0, **ENDLESS, **STEEL))

    def test_a_solve_with_progress(self):
        told = []
        # The signal arrives within the callback or outside. It is sent many times, because an exception in a callback of ctypes may be lost.
        for _ in range(20):
            timer = send(seconds=0.05)
            with self.assertRaises(KeyboardInterrupt):
                cn.solve(H, D, D, force=1000.0, progress=told.append, **ENDLESS, **STEEL)
            timer.join()
        self.assertTrue(told)

    def test_what_a_callback_raises_that_is_no_error(self):
        for kind in (KeyboardInterrupt, SystemExit):

            def stop(_told, kind=kind):
                raise kind

            with self.assertRaises(kind):
                cn.solve(H, D, D, force=1000.0, progress=stop, **ENDLESS, **STEEL)

    def test_a_handler_that_raises(self):
        def expired(_number, _frame):
            raise TimeoutError("too long")

        before = signal.signal(signal.SIGALRM, expired)
        try:
            for progress in (None, lambda told: None):
                timer = send(signal.SIGALRM)
                with self.assertRaisesRegex(TimeoutError, "too long"):
                    cn.solve(H, D, D, force=1000.0, progress=progress, **ENDLESS, **STEEL)
                timer.join()
        finally:
            signal.signal(signal.SIGALRM, before)

    def test_a_solver_solves_again_afterwards(self):
        expected = cn.solve(H, D, D, force=1000.0, method="PROJECTED_CG", **STEEL).pressure
        with cn.Solver(M, M, D, D, **ENDLESS, **STEEL) as solver:
            for _ in range(3):
                self.interrupted(lambda: solver.solve(H, force=1000.0))
                again = solver.solve(H, force=1000.0, method="PROJECTED_CG")
                np.testing.assert_array_equal(again.pressure, expected)

    def test_a_solver_waits_for_what_was_given_up(self):
        def slow(watched, told, user, call=_callbacks.Watched._call):
            # The callback sleeps in C, so that no signal wakes it.
            ctypes.CDLL(None).usleep(400000)
            return call(watched, told, user)

        with cn.Solver(M, M, D, D, **ENDLESS, **STEEL) as solver:
            with mock.patch.object(_callbacks.Watched, "_call", slow):
                self.interrupted(lambda: solver.solve(H, force=1000.0))
            self.assertEqual(solver.solve(H, force=1000.0, method="PROJECTED_CG").status, cn.OK)

    def test_a_batch(self):
        with cn.Solver(M, M, D, D, **{**ENDLESS, "max_cycles": 50}, **STEEL) as solver:
            self.interrupted(lambda: solver.solve_batch([H] * 10000, force=1000.0))

    def test_accuracies(self):
        self.interrupted(lambda: cn.solve_to_accuracy(H, D, D, force=1000.0, **ENDLESS, **STEEL))
        self.interrupted(lambda: cn.solve_to_accuracy(lambda x, y: 0.2 * (x**2 + y**2), D, D, shape=(M, M), force=1000.0, **ENDLESS, **STEEL))
        slow = threading.Event()
        self.interrupted(lambda: cn.solve_to_accuracy(lambda x, y: slow.wait(3600), D, D, shape=(M, M), force=1000.0, **STEEL))

    def test_what_is_given_up_ends(self):
        effects = {"force": 1000.0, "layer": 1e-7, "pressure_limit": 3000.0}
        with cn.Solver(M, M, D, D, **ENDLESS, **STEEL) as solver:
            for call in (lambda: cn.quantities(H, D, D, force=1000.0, **ENDLESS, **STEEL),
                         lambda: cn.what_matters(H, D, D, max_seconds=1e6, **effects, **ENDLESS, **STEEL),
                         lambda: cn.cost_of_accuracy(H, D, D, force=1000.0, **ENDLESS, **STEEL),
                         lambda: solver.solve_batch([H, H], force=1000.0)):
                self.interrupted(call)
                for given_up in list(_calls._given_up):
                    given_up.wait(5.0)
                self.assertFalse(_calls._given_up)

    def test_adhesion_is_never_short(self):
        x = (np.arange(16) - 7.5) * 0.4
        pull_off = {"h": 0.5 * (x[None, :] ** 2 + x[:, None] ** 2), "dx": 0.4, "dy": 0.4, "e_star": 0.75, "adhesion": {"work": 0.3, "range": 0.56}}
        for call in (cn.pull_off, lambda **given: cn.solve(force=-0.1, **given)):
            with mock.patch.object(_calls, "Call", wraps=_calls.Call) as by_a_worker:
                call(**pull_off)
            by_a_worker.assert_called()

    def test_friction_batches(self):
        entries = np.random.default_rng(3).uniform(-1e-3, 1e-3, (1000000, 3))
        self.interrupted(lambda: cn.friction_batch(H, D, D, entries, force=1000.0, friction={"coefficient": 0.3}, **STEEL))

    def test_tables(self):
        axis = np.linspace(0.0, 1.0, 400)
        for workers in (1, 2):
            self.interrupted(lambda: cn.creep_force_table(xi=axis, eta=axis, phi=[0.0], axis_ratio=[0.5, 1.0, 2.0], workers=workers))


class Threads(unittest.TestCase):
    def setUp(self):
        # Calls that other tests gave up may still be in a cycle.
        _calls._wait_for_given_up()

    def test_callbacks_run_on_the_thread_that_asks(self):
        def threads_of(solve):
            found = set()
            solve(lambda *told: found.add(threading.get_ident()))
            return found

        def solve(note):
            cn.solve(H, D, D, force=1000.0, progress=lambda told: note(), **STEEL)
            cn.solve_to_accuracy(lambda x, y: note() or 0.2 * (x**2 + y**2), D, D, shape=(M, M), force=1000.0, target=0.1, **STEEL)
            cn.set_log(note)
            cn.solve(H, D, D, force=1000.0, **STEEL)
            cn.set_log(None)

        self.assertEqual(threads_of(solve), {threading.get_ident()})
        found = []
        thread = threading.Thread(target=lambda: found.append((threads_of(solve), threading.get_ident())))
        thread.start()
        thread.join()
        self.assertEqual(found[0][0], {found[0][1]})

    def test_other_threads_call_the_library_themselves(self):
        _calls._end_workers()
        names = []

        def solve():
            cn.solve(H, D, D, force=1000.0, progress=lambda told: names.extend(one.name for one in threading.enumerate()), **STEEL)

        thread = threading.Thread(target=solve)
        thread.start()
        thread.join()
        self.assertTrue(names)
        self.assertNotIn("contact-normal", names)
        solve()
        self.assertIn("contact-normal", names)

    def test_a_call_that_no_worker_begins(self):
        class Lost:
            def give(self, call):
                raise KeyboardInterrupt

        call = _calls.Call(lambda: self.fail("it was given up"))
        self.addCleanup(_calls._given_up.discard, call)
        with self.assertRaises(KeyboardInterrupt):
            call.result(Lost())
        # Otherwise the end of the process would wait for this call.
        self.assertNotIn(call, _calls._given_up)
        call.make()
        self.assertIsNone(call._error)

    def test_where_no_thread_is_to_be_had(self):
        _calls._end_workers()
        with mock.patch.object(_calls, "_Worker", side_effect=RuntimeError("can't start new thread")):
            self.assertEqual(cn.solve(H, D, D, force=1000.0, progress=lambda told: None, **STEEL).status, cn.OK)

    def test_a_solve_within_a_callback(self):
        alone = cn.solve(H, D, D, force=500.0, **STEEL).pressure
        found = []

        def within(told):
            if len(found) < 3:
                found.append(cn.solve(H, D, D, force=500.0, progress=lambda told: None, **STEEL).pressure)

        outer = cn.solve(H, D, D, force=1000.0, progress=within, **STEEL)
        self.assertEqual(outer.status, cn.OK)
        self.assertEqual(len(found), 3)
        for pressure in found:
            np.testing.assert_array_equal(pressure, alone)

    @unittest.skipUnless(hasattr(os, "fork"), "there is no fork")
    def test_a_fork_has_no_threads_of_ours(self):
        cn.solve(H, D, D, force=1000.0, **STEEL)
        with warnings.catch_warnings():
            # From Python 3.12 on there is a warning if a process with threads is forked.
            warnings.simplefilter("error")
            child = os.fork()
            if child == 0:
                os._exit(0 if cn.solve(H, D, D, force=1000.0, **STEEL).status == cn.OK else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertNotIn("contact-normal", [thread.name for thread in threading.enumerate()])


class Ends(unittest.TestCase):
    def end_of(self, script, **process):
        script = f"""
import os, signal, threading
import numpy as np, contact_normal as cn
x = np.arange({M}) - {0.5 * (M - 1)}
h = 0.002 * (x[None, :] ** 2 + x[:, None] ** 2)
given = {({"force": 1000.0, **ENDLESS, **STEEL})}
def send():
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
""" + script
        # If the process waits for a solve, it hangs instead of failing. The runner of the tests then ends it.
        return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, **process)

    def test_the_process_ends_after_an_interrupt(self):
        ended = self.end_of("send(); cn.solve(h, 0.1, 0.1, **given)")
        self.assertEqual(ended.returncode, -signal.SIGINT)
        self.assertTrue(ended.stderr.strip().endswith("KeyboardInterrupt"), ended.stderr)

    def test_the_process_ends_with_a_solve_that_goes_on_for_a_while(self):
        # The callback sleeps in C, so that the worker outlasts the interpreter.
        ended = self.end_of("""
import atexit, ctypes
from contact_normal import _callbacks, _calls
def asleep(told, user):
    ctypes.CDLL(None).usleep(600000)
    return _callbacks.given_up()
_callbacks.Watched._call = lambda self, told, user: asleep(told, user)
send()
try:
    cn.solve(h, 0.1, 0.1, **given)
except KeyboardInterrupt:
    print("interrupted,", len(_calls._given_up))
atexit._run_exitfuncs()
print("ended,", len(_calls._given_up))
""")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "interrupted, 1\nended, 0\n", ""))

    def test_a_terminal_interrupts_all_processes_of_a_table(self):
        ended = self.end_of("""
axis = np.linspace(0.0, 1.0, 400)
threading.Timer(0.5, os.killpg, (0, signal.SIGINT)).start()
try:
    cn.creep_force_table(xi=axis, eta=axis, phi=[0.0], axis_ratio=[0.5, 1.0, 2.0], workers=2)
except KeyboardInterrupt:
    print("interrupted")
""", start_new_session=True)
        # The worker processes print nothing.
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "interrupted\n", ""))

    def test_a_solve_at_the_end_of_the_process(self):
        ended = self.end_of("""
import atexit
given = dict(force=1000.0, shear_modulus=82000.0, poisson_ratio=0.28)
atexit.register(lambda: print(cn.solve(h, 0.1, 0.1, **given).status))
print(cn.solve(h, 0.1, 0.1, **given).status)
""")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "0\n0\n", ""))


if __name__ == "__main__":
    unittest.main()
