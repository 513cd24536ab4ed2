"""Measures how sensitive the solvers are to their constants: `run.py LIBRARY`, with a library that instrument.py has made adjustable.

Each constant that a group of scenes uses is doubled and halved, one constant at a time. Prints one line per constant: its value; the ratio of the
products of all scenes of the group with and without the change, in brackets the largest ratio of one scene; the number of scenes whose status
changes. "the same": no number of products changes. Takes two hours on one core.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PATIENCE = 60.0  # the longest time for a group of scenes in seconds; it usually takes ten


def run(group, library, **more):
    """Solves the scenes of a group in a process, and returns their results; None if it does not end in time, or fails."""
    path = str(HERE.parents[1] / "python")
    env = {**os.environ, "CONTACT_NORMAL_LIBRARY": library, "PYTHONPATH": path, **more}
    try:
        done = subprocess.run([sys.executable, str(HERE / "scenes.py"), group], env=env, capture_output=True, timeout=PATIENCE, check=True)
    except (subprocess.TimeoutExpired, subprocess.CalledProcessError):
        return None
    return json.loads(done.stdout)


def compared(base, changed):
    """A cell of the table: the results with a changed constant compared with those without the change."""
    if changed is None:
        return "does not end"
    pairs = [(base[name], changed[name]) for name in base]
    if all(a[:2] == b[:2] for a, b in pairs):
        return "the same"
    ratio = sum(b[0] for _, b in pairs) / sum(a[0] for a, _ in pairs)
    worst = max(b[0] / a[0] for a, b in pairs if a[0])
    other = sum(a[1] != b[1] for a, b in pairs)
    return f"{ratio:.3f} ({worst:.2g})" + (f", {other} other status{'es' if other > 1 else ''}" if other else "")


def main():
    """Prints the table."""
    library = sys.argv[1]
    print("| constant | value | scenes | doubled | halved |\n|---|---:|---|---|---|")
    for group in ("normal", "friction", "adhesion"):
        with tempfile.TemporaryDirectory() as folder:
            read = pathlib.Path(folder) / "read"
            base = run(group, library, CN_CONSTANTS_READ=str(read))
            used = dict(line.split() for line in read.read_text().splitlines())
        for name, value in sorted(used.items()):
            cells = [compared(base, run(group, library, CN_CONSTANT=f"{name}={factor * float(value)!r}")) for factor in (2, 0.5)]
            print(f"| `{name}` | {float(value):g} | {group} | {' | '.join(cells)} |", flush=True)


main()
