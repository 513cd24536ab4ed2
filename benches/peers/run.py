"""Measures contact-normal and other solvers, and writes docs/performance_peers.md, whose tables `make pictures` draws.

`make bench-peers`, or `python run.py [--quick | --slow] [--report]`. --quick: up to 512; --slow: tamaas and ContactMechanics at 1024
too (an hour more); --report: only writes again what build/peers_*.json hold.
"""

import glob
import importlib.metadata
import json
import os
import platform
import subprocess
import sys
from statistics import median

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
OURS = "contact-normal"
ALL = [OURS, "aspher", "tamaas", "ContactMechanics"]
FAST = [OURS, "aspher"]
ORDER = ["ellipse", "sphere", "rough"]
PEERS = ("aspher", "tamaas", "ContactMechanics")


def jobs(arguments):
    """Yields the problems that are measured: (problem, size, solvers)."""
    yield from [(kind, size, ALL) for size in (256, 512) for kind in ("sphere", "rough", "ellipse")]
    if "--quick" in arguments:
        return
    yield from [(kind, 1024, ALL if "--slow" in arguments else FAST) for kind in ("sphere", "rough")]
    yield from [(kind, 2048, FAST) for kind in ("sphere", "rough")]


def machine():
    """The machine, and the versions of the packages, as text."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        lines = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    names = ["aspher", "tamaas", "ContactMechanics", "numpy", "scipy"]
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in names)
    return f"{lines[0]}, {len(lines)} cores; Python {platform.python_version()}, {versions}"


def processor(result):
    """The median of the processor times of a result."""
    return median(time for time, _ in result["times"])


def ratio_of_clocks(result, ours):
    """The ratio of the median wall-clock times of a result and of ours, as text; "" if the result was measured only once."""
    clocks = [clock for _, clock in result["times"] if clock is not None]
    if not clocks:
        return ""
    return f"{median(clocks) / median(clock for _, clock in ours['times']):.1f}"


def shown(seconds):
    """A time with three figures, as text."""
    return f"{seconds * 1e3:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


def table(measured):
    """The table of medians and ratios."""
    lines = [
        "| problem | accuracy | contact-normal | peer | its setting, tolerance | its time (repeats) | times slower | by the clock |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for one in measured:
        for accuracy in sorted({result["accuracy"] for result in one["results"]}, reverse=True):
            at = {result["solver"]: result for result in one["results"] if result["accuracy"] == accuracy}
            if OURS not in at:
                lines.append(f"| {one['problem']} {one['size']} | {accuracy:.0e} | not reached | | | | | |")
                continue
            ours = processor(at[OURS])
            for peer in PEERS:
                if peer not in one["points"]:
                    continue
                start = f"| {one['problem']} {one['size']} | {accuracy:.0e} | {shown(ours)} | {peer} |"
                if peer not in at:
                    why = "not reached" if one["points"][peer] else "cannot (square elements only)"
                    lines.append(f"{start} {why} | | | |")
                    continue
                result = at[peer]
                ratio = processor(result) / ours
                lines.append(
                    f"{start} {result['setting']}, {result['tolerance']:.1e} | {shown(processor(result))} "
                    f"({len(result['times'])}) | {ratio:.1f} | {ratio_of_clocks(result, at[OURS])} |"
                )
    return "\n".join(lines)


def report():
    """Writes the page, and prints it."""
    measured = []
    for path in glob.glob(os.path.join(ROOT, "build", "peers_*.json")):
        with open(path, encoding="utf-8") as file:
            measured.append(json.load(file))
    measured.sort(key=lambda one: (ORDER.index(one["problem"]), one["size"]))
    text = (
        "# Peers: equal problems, equal checked accuracy\n\n"
        "Written by `make bench-peers`; [Performance](performance.md) has a summary.\n\n"
        f"{machine()}. One thread. The accuracy is max(|e| in contact, penetration outside)/max |u|, checked by a product of the bench's own. "
        "Each solver has its fastest setting and its loosest tolerance that reach the accuracy. Tolerances are half a decade apart for contact-normal and aspher, and a "
        "decade for the others and where a call takes more than 3 s. Calls are whole calls from Python, with set-up. Times are medians of repeats in turns, in seconds of "
        "the processor; with one thread these are the seconds by the clock on a quiet machine. The last column has the ratio by the clock.\n\n"
        f"{table(measured)}\n\n![Time over the size, of each solver, for two accuracies](pictures/performance_peers.svg)\n"
    )
    path = os.path.join(ROOT, "docs", "performance_peers.md")
    # The section on friction, which friction.py writes, is kept.
    friction = ""
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            friction = "".join(file.read().partition("\n## Friction\n")[1:])
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + friction)
    print(text)


def main():
    arguments = sys.argv[1:]
    os.makedirs(os.path.join(ROOT, "docs"), exist_ok=True)
    os.makedirs(os.path.join(ROOT, "build"), exist_ok=True)
    if "--report" not in arguments:
        for kind, size, names in jobs(arguments):
            out = os.path.join(ROOT, "build", f"peers_{kind}_{size}.json")
            subprocess.run(
                [sys.executable, os.path.join(HERE, "measure.py"), kind, str(size), ",".join(names), out], check=True
            )
    report()


if __name__ == "__main__":
    main()
