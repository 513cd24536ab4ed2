"""Forked processes can solve after a solve with threads; Python threads run during a solve of another one."""

import concurrent.futures
import multiprocessing
import os
import threading
import time
import unittest
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal import _creep_force_table

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
# The child has none of the parent's threads, and would wait for them for ever. The limit is hundreds of times the duration of the solve, so that a
# hang is a failure.
PATIENCE = 60


def ball(m, curvature):
    x = np.arange(m) - 0.5 * (m - 1)
    return curvature * (x[None, :] ** 2 + x[:, None] ** 2)


def forked(work):
    """The result of `work()` in a forked process; None if it hangs or dies."""
    near, far = multiprocessing.get_context("fork").Pipe(duplex=False)
    process = multiprocessing.get_context("fork").Process(target=lambda: far.send(work()))
    process.start()
    # Without this the parent would not notice that a child has died.
    far.close()
    try:
        found = near.recv() if near.poll(PATIENCE) else None
    except EOFError:
        found = None
    process.join(PATIENCE)
    if process.exitcode != 0:
        process.kill()
        return None
    return found


@unittest.skipUnless(hasattr(os, "fork"), "there is no fork")
class Forks(unittest.TestCase):
    # The grid has so many elements that threads share the work.
    M = 281
    H = ball(M, 0.001 * (64 / M) ** 2)
    SIZE = 12.8 / M

    def solve(self, threads):
        return cn.solve(self.H, self.SIZE, self.SIZE, force=1e4, threads=threads, **STEEL).pressure.tobytes()

    def test_a_forked_process_solves_after_a_threaded_solve(self):
        before = self.solve(2)
        for threads in (1, 2):
            self.assertEqual(forked(lambda: self.solve(threads)), before, threads)
        self.assertEqual(self.solve(2), before)

    def test_a_handle_of_before_the_fork_solves_after_it(self):
        before = self.solve(2)
        handle = cn.Solver(self.M, self.M, self.SIZE, self.SIZE, threads=2, **STEEL)
        self.assertEqual(len(handle.solve_batch([self.H, self.H], force=1e4)), 2)

        def with_handle():
            batch = handle.solve_batch([self.H, self.H, self.H], force=1e4)
            return [handle.solve(self.H, force=1e4).pressure.tobytes()] + [found.pressure.tobytes() for found in batch]

        self.assertEqual(forked(with_handle), [before] * 4)
        self.assertEqual(self.solve(2), before)


class Threads(unittest.TestCase):
    H = ball(200, 0.0001)

    def solve(self, force):
        return cn.solve(self.H, 0.2, 0.2, force=force, tolerance=1e-10, **STEEL).pressure.tobytes()

    def test_threads_of_python_solve_at_once(self):
        forces = [1e4 * (k + 1) for k in range(6)]
        expected = [self.solve(force) for force in forces]
        found = [None] * len(forces)

        def run(k):
            for _ in range(5):
                found[k] = self.solve(forces[k])
                if found[k] != expected[k]:
                    return

        threads = [threading.Thread(target=run, args=(k,)) for k in range(len(forces))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, expected)

    def test_python_goes_on_while_a_thread_solves(self):
        # ctypes releases the interpreter's lock during a call, so that another thread runs. With the lock it would stand still in each call, for all
        # the time in the library. On a busy machine it may stand still in some calls.
        self.assertTrue(any(self.longest_standstill() < 0.5 for _ in range(20)))

    def longest_standstill(self):
        """The longest standstill of this thread while another one solves, relative to the time in the library."""
        ended = []

        def call():
            ended.append(cn.solve(ball(800, 0.00001), 0.2, 0.2, force=1e5, **STEEL))

        thread = threading.Thread(target=call)
        times = [time.perf_counter()]
        thread.start()
        while not ended:
            times.append(time.perf_counter())
        times.append(time.perf_counter())
        thread.join()
        return np.diff(times).max() / ended[0].report["solve_seconds"]


class GivenUp(unittest.TestCase):
    def test_jobs_of_processes_that_are_stopped_are_not_cancelled(self):
        # The thread of an executor prints a traceback if a cancelled job's process is gone.
        class Executor:
            def __init__(self, *_given, **_more):
                jobs.clear()

            def submit(self, _work, _plan, index):
                job = concurrent.futures.Future()
                if not jobs:
                    job.set_result(index)
                jobs.append(job)
                return job

            def shutdown(self, wait):
                self.has_waited = wait

        jobs = []
        with mock.patch.object(_creep_force_table.concurrent.futures, "ProcessPoolExecutor", Executor):
            planes = _creep_force_table._computed(None, [0, 1, 2], 2, None)
            self.assertEqual(next(planes), (0, 0))
            planes.close()
        self.assertEqual([job.cancelled() for job in jobs], [False] * 3)


if __name__ == "__main__":
    unittest.main()
