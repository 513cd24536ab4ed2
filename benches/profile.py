"""Measures which parts of a solve take how much of its time: `python3 benches/profile.py`, after `cargo bench --no-run`; needs perf of Linux.

perf samples the stacks of a process that repeats the same solve. The samples are counted by the part of the solve to which their functions belong.
"""

import collections
import glob
import os
import re
import subprocess

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
RUNS = [
    ("ellipse", "512", "cold"),
    ("ellipse", "64", "cold"),
    ("y4_82kN", "1", "cold"),
    ("rough", "512", "cold"),
    ("rough", "1024", "cold"),
    ("ellipse", "512", "steps"),
    ("rough", "512", "steps"),
]
SECONDS = "8"
# The parts of a solve with patterns of their functions. A sample belongs to the first part whose pattern matches a function of the stack; those of the
# first part, "", are not counted.
PARTS = [
    ("", r"performance::case|heights|wheel_rail\b"),
    ("report", r"close_grid|Measures"),
    ("set-up", r"set_spectrum|Solver::new|Iteration<T>::new|Workspace<T>::new|fill_row|MadeOf|memory::|choose_window|::check\b"),
    ("certificate", r"Survey|Problem::(displace|refresh)|Task<S>::refresh"),
    ("prediction of a time step", r"Predictor|ProjectedCg::predict|take_over"),
    ("deflation direction", r"deflate_by_change|restrict_deflation|step_along_deflation"),
    ("extension of the residual", r"Extension<T, K>::(count|extend|collect)|extension::Extension.*::(count|extend|collect)"),
    ("preconditioner", r"::precondition\b|Preconditioner<T>::apply"),
    ("products", r"Operator<T>::(apply|without_coupling|convolve|forward)|operator::(rows|lane_rows|even_columns|columns)::"),
    ("between grids", r"prolong|::transfer::|Window::(insert|extract)|part::(enter|leave)|take_displacements"),
    ("passes", r"Iteration<T>|projected_cg|Level"),
]


def stacks(data):
    """The stacks of the samples, one text per sample."""
    script = subprocess.run(["perf", "script", "-i", data, "-F", "ip,sym"], capture_output=True, text=True, check=True)
    return [stack for stack in script.stdout.split("\n\n") if stack.strip()]


def main():
    target = os.environ.get("CARGO_TARGET_DIR", os.path.join(ROOT, "target"))
    built = glob.glob(os.path.join(target, "release", "deps", "performance-*"))
    program = max((path for path in built if os.access(path, os.X_OK)), key=os.path.getmtime)
    data = os.path.join(ROOT, "build", "perf.data")
    os.makedirs(os.path.dirname(data), exist_ok=True)
    shares = {}
    for run in RUNS:
        subprocess.run(
            ["perf", "record", "-q", "-F", "99", "--call-graph", "dwarf,32768", "-o", data, program, "--solve-again"]
            + [*run, SECONDS],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        counts = collections.Counter(
            next((part for part, pattern in PARTS if re.search(pattern, stack)), "rest") for stack in stacks(data)
        )
        counts.pop("", None)
        shares[run] = {part: 100 * count / counts.total() for part, count in counts.items()}
    os.remove(data)
    print("| % of the samples | " + " | ".join(" ".join(run) for run in RUNS) + " |")
    print("|---" * (len(RUNS) + 1) + "|")
    for part in [part for part, _ in PARTS if part] + ["rest"]:
        print(f"| {part} | " + " | ".join(f"{shares[run].get(part, 0):.0f}" for run in RUNS) + " |")


if __name__ == "__main__":
    main()
