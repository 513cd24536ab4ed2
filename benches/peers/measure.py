"""Measures solvers on one problem: `python measure.py PROBLEM SIZE SOLVER,SOLVER,... OUT.json`.

First every setting of every solver is called with a sequence of tighter and tighter tolerances, and each result is checked. Then for each wanted
accuracy the fastest setting of each solver, with its loosest tolerance that reaches the accuracy, is repeated, all solvers in turns.
"""

import gc
import json
import os
import signal
import sys
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"
os.environ["OMP_WAIT_POLICY"] = "passive"

from problems import PROBLEMS
from solvers import SOLVERS

ACCURACIES = [1e-4, 1e-6]
TIGHTEST = 1e-7  # fast settings are called until this error is reached, for the picture
REPEATS = 5
LONG, REPEATS_OF_LONG = 8.0, 2  # calls of more than LONG seconds are repeated less often
LONGEST = 120.0  # a call of more seconds is the last one of its setting, and is not repeated
COARSE_STEPS = 3.0  # if calls take more seconds than this, only every second tolerance is tried
HOPELESS = 2.0  # a setting is given up if it takes this many times as long as another setting of the solver for the tightest accuracy


class TooLong(Exception):
    """Raised by the alarm signal during a call. Python handles the signal as soon as the solver returns to Python."""


def _alarm(_signal, _frame):
    raise TooLong


def timed(call, problem, tolerance):
    """Makes a call. Returns its processor time, its wall-clock time and the pressures.

    With one thread the processor time is what the wall-clock time would be on a quiet machine.
    """
    gc.collect()
    signal.setitimer(signal.ITIMER_REAL, LONGEST)
    clock, processor = time.perf_counter(), time.process_time()
    try:
        p = call(problem, tolerance)
        return time.process_time() - processor, time.perf_counter() - clock, p
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def ladder(name, setting, call, tolerances, problem, least):
    """Calls a setting with tighter and tighter tolerances until it is accurate enough, or takes much longer than `least` seconds.

    Returns the points: setting, tolerance, seconds, error.
    """
    points = []
    halves = len(tolerances) > 1 and tolerances[0] / tolerances[1] < 5
    for step, tolerance in enumerate(tolerances):
        if halves and step % 2 == 1 and points and points[-1]["seconds"] > COARSE_STEPS:
            continue
        try:
            seconds, _, p = timed(call, problem, tolerance)
        except (TooLong, RuntimeError, ValueError, ArithmeticError, AssertionError) as error:
            print(f"  {name} ({setting}) at {tolerance:.0e}: {type(error).__name__} {error}", flush=True)
            if isinstance(error, TooLong):
                break
            continue
        if p is None:
            return []
        error = problem.error(p)
        print(f"  {name:16} {setting:24} {tolerance:8.1e} {seconds:9.4f} s  error {error:.1e}", flush=True)
        points.append(dict(setting=setting, tolerance=tolerance, seconds=seconds, error=error))
        enough = TIGHTEST if seconds < COARSE_STEPS else min(ACCURACIES)
        if error <= enough or seconds > min(LONGEST, HOPELESS * least):
            break
    return points


def main():
    kind, size, names, out = sys.argv[1], int(sys.argv[2]), sys.argv[3].split(","), sys.argv[4]
    signal.signal(signal.SIGALRM, _alarm)
    problem = PROBLEMS[kind](size)
    print(f"{kind} {size}", flush=True)
    points, chosen = {}, {}
    for name in names:
        settings, tolerances = SOLVERS[name]
        small = PROBLEMS[kind](64)
        for setting, call in settings.items():
            call(small, 1e-2)  # A first call loads libraries, whose time must not count.
        points[name] = []
        for setting, call in settings.items():
            reached = [point["seconds"] for point in points[name] if point["error"] <= min(ACCURACIES)]
            points[name] += ladder(name, setting, call, tolerances, problem, min(reached, default=float("inf")))
        for accuracy in ACCURACIES:
            good = [point for point in points[name] if point["error"] <= accuracy]
            loosest = {}
            for point in good:
                loosest.setdefault(point["setting"], point)
            if loosest:
                chosen[name, accuracy] = min(loosest.values(), key=lambda point: point["seconds"])
    runs = {}
    for (name, _), point in chosen.items():
        runs.setdefault((name, point["setting"], point["tolerance"]), [point["seconds"], []])
    for turn in range(REPEATS):
        for (name, setting, tolerance), (first, times) in runs.items():
            if first <= LONGEST and turn < (REPEATS if first <= LONG else REPEATS_OF_LONG):
                times.append(timed(SOLVERS[name][0][setting], problem, tolerance)[:2])
    results = []
    for (name, accuracy), point in chosen.items():
        first, times = runs[name, point["setting"], point["tolerance"]]
        results.append(dict(solver=name, accuracy=accuracy, **{**point, "times": times or [(first, None)]}))
    with open(out, "w", encoding="utf-8") as file:
        json.dump(dict(problem=kind, size=size, points=points, results=results), file)


if __name__ == "__main__":
    main()
