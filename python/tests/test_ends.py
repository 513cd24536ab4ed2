"""Calls at the end of the process, of a worker and of a terminal: they end, and so does the process."""

import gc
import os
import subprocess
import sys
import time
import unittest

import numpy as np

import contact_normal as cn
from contact_normal import _callbacks

M = 48
X = np.arange(M) - 0.5 * (M - 1)
H = 0.002 * (X[None, :] ** 2 + X[:, None] ** 2)
GIVEN = {"force": 1000.0, "shear_modulus": 82000.0, "poisson_ratio": 0.28}


def process(script, **given):
    begin = f"""
import gc, os, sys, threading, time
import numpy as np, contact_normal as cn
x = np.arange({M}) - {0.5 * (M - 1)}
h = 0.002 * (x[None, :] ** 2 + x[:, None] ** 2)
given = {GIVEN}
"""
    # If there is a fault, the process hangs. The time limit ends it.
    return subprocess.run([sys.executable, "-c", begin + script], capture_output=True, text=True, timeout=300, **given)


class Process(unittest.TestCase):
    def check(self, script, printed):
        ended = process(script)
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, printed, ""))

    def test_what_is_ended_with_the_interpreter_solves(self):
        # One solve is so long that a worker makes it. The other one, of a single element, has a message.
        self.check("""
def steps():
    try:
        yield cn.solve(h, 0.1, 0.1, max_cycles=500, **given).status
    finally:
        print(cn.solve(h, 0.1, 0.1, max_cycles=500, **given).status, cn.solve(h[23:24, 23:24], 0.1, 0.1, **given).status)
held = steps()
print(next(held))
""", "0\n0 0\n")

    def test_a_daemon_that_is_told_of_its_cycles(self):
        for more in ("progress=lambda told: None", "progress=True, max_cycles=400"):
            with self.subTest(more):
                ended = process(f"""
def endless():
    while True:
        try:
            cn.solve(h, 0.1, 0.1, {more}, tolerance=1e-300, criterion="UPDATE", method="NORM", **given)
        except cn.ContactNormalError:
            pass
cn.solve(h, 0.1, 0.1, **given)
threading.Thread(target=endless, daemon=True).start()
time.sleep(0.3)
""")
                self.assertEqual((ended.returncode, ended.stdout), (0, ""), ended.stderr)

    def test_a_daemon_whose_messages_are_logged(self):
        # The solves may begin before the callable is set, or after.
        hear, stop = "cn.set_log(lambda level, text: None)", "cn.set_log(None)"
        for before, after in (("", hear), (hear, ""), (hear, stop)):
            self.check(f"""
{before}
def endless():
    while True:
        cn.solve(h, 0.1, 0.1, **given)
threading.Thread(target=endless, daemon=True).start()
time.sleep(0.3)
{after}
""", "")

    def test_a_daemon_that_begins_again_while_the_process_ends(self):
        self.check("""
import atexit
def endless():
    while True:
        try:
            cn.solve(h, 0.1, 0.1, progress=lambda told: None, tolerance=1e-300, criterion="UPDATE", method="NORM", **given)
        except cn.ContactNormalError:
            pass
# Registered after the package's handler, and called before it; the time after that handler is what matters.
from contact_normal import _daemons
atexit.unregister(_daemons.end)
atexit.register(time.sleep, 0.3)
atexit.register(_daemons.end)
threading.Thread(target=endless, daemon=True).start()
time.sleep(0.2)
""", "")

    def test_a_handler_that_runs_after_ours_solves(self):
        self.check("""
import atexit
from contact_normal import _daemons
atexit.unregister(_daemons.end)
atexit.register(lambda: print(cn.solve(h, 0.1, 0.1, progress=lambda told: None, **given).status))
atexit.register(_daemons.end)
""", "0\n")

    def test_stresses_of_a_daemon_are_not_waited_for(self):
        ended = process("""
import contact_normal._daemons as daemons
result = cn.solve(h, 0.1, 0.1, **given)
daemons._LAST_CYCLE = 1000.0
threading.Thread(target=lambda: result.subsurface(np.linspace(0.1, 1.0, 3000)), daemon=True).start()
time.sleep(0.2)
""")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "", ""))

    @unittest.skipUnless(hasattr(os, "fork"), "there is no fork")
    def test_a_fork_that_returns_from_a_callback(self):
        self.check("""
children = []
def fork(told):
    if not children:
        children.append(os.fork())
try:
    status = cn.solve(h, 0.1, 0.1, progress=fork, **given).status
except RuntimeError as error:
    print(str(error)[:42], flush=True)
    os._exit(3)
print(status, os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]))
""", "a process that is forked within a callback\n0 3\n")


class Workers(unittest.TestCase):
    def test_a_worker_that_is_killed(self):
        ended = process("""
import concurrent.futures.process, multiprocessing, signal
if __name__ == "__main__":
    def kill():
        while not (children := multiprocessing.active_children()):
            time.sleep(0.01)
        time.sleep(0.5)
        os.kill(children[0].pid, signal.SIGKILL)
    threading.Thread(target=kill).start()
    axis = np.linspace(0.0, 1.0, 400)
    try:
        cn.creep_force_table(xi=axis, eta=axis, phi=[0.0], axis_ratio=[0.5, 1.0, 2.0], workers=2)
    except concurrent.futures.process.BrokenProcessPool:
        print("broken")
""")
        self.assertEqual((ended.returncode, ended.stdout), (0, "broken\n"), ended.stderr)


class Bars(unittest.TestCase):
    def test_where_there_is_no_terminal(self):
        # Bars by tqdm, which writes as soon as it is made, and by the package itself.
        for tqdm in ("None", "types.SimpleNamespace(tqdm=lambda file, **more: file.write(''))"):
            with self.subTest(tqdm):
                ended = process(f"""
import types
sys.modules["tqdm"] = {tqdm}
class Full:
    def write(self, text):
        raise BrokenPipeError
    flush = write
for there in (None, Full()):
    sys.stderr = there
    print(cn.solve(h, 0.1, 0.1, progress=True, **given).status)
sys.stderr = sys.__stderr__
""")
                self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "0\n0\n", ""))


class Memory(unittest.TestCase):
    def test_what_a_callback_raises_keeps_nothing(self):
        class Enough(Exception):
            pass

        def enough(told):
            raise Enough

        def held():
            gc.collect()
            return sum(isinstance(each, _callbacks.Watched) for each in gc.get_objects())

        before = held()
        for _ in range(5):
            with self.assertRaises(Enough):
                cn.solve(H, 0.1, 0.1, progress=enough, **GIVEN)
        end = time.monotonic() + 10.0
        # A worker thread may still be ending the last call.
        while held() > before and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(held(), before)


if __name__ == "__main__":
    unittest.main()
