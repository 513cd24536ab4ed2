"""Tries a wheel as somebody who has only Python: `try_wheel.py WHEEL FOLDER`.

Installs it with matplotlib into an empty environment in FOLDER, prints the force of the paper's problem and runs the examples. Their
output is compared with what is expected: on another machine a last digit may differ, which is printed and is no failure.
"""

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = ("to_accuracy", "price_list", "ledger", "laws", "friction", "creep_force_table")
EXPECTED = "force 81989 N\n"


def environment():
    """This one without what would find the clone's library or package; programs by their paths only."""
    named = ("CONTACT_NORMAL_LIBRARY", "PYTHONPATH", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH")
    return {**{name: value for name, value in os.environ.items() if name not in named}, "MPLBACKEND": "Agg"}


def try_programs(run, folder, examples=EXAMPLES):
    """The paper's problem and the examples, by `run`, which returns what a command of the package's Python prints. Raises if one fails."""
    # wine names a file of this machine Z:\\...
    where = Path(run("-c", "import contact_normal; print(contact_normal.__file__)").strip().removeprefix("Z:").replace("\\", "/"))
    if folder not in where.resolve().parents:
        raise SystemExit(f"not the package of the wheel: {where}")
    printed = run(ROOT / "packaging" / "consumers" / "python" / "force.py")
    if printed != EXPECTED:
        raise SystemExit(f"printed {printed!r}, expected {EXPECTED!r}")
    print(run("-m", "contact_normal", "--version").strip(), "|", printed.strip())
    for name in examples:
        example = ROOT / "python_examples" / f"{name}.py"
        lines, expected = run(example, f"{name}.png").splitlines(), example.with_suffix(".expected").read_text().splitlines()
        others = sum(a != b for a, b in zip(lines, expected)) + abs(len(lines) - len(expected))
        print(f"{name:20} {len(lines)} lines, {others} other than expected")
    print(f"{len(examples) + 1} passed, 0 failed")


def main(wheel, folder):
    """Raises if a program fails."""
    wheel, folder = Path(wheel).resolve(), Path(folder).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    venv.create(folder / "python", with_pip=True)
    python = folder / "python" / ("Scripts/python.exe" if os.name == "nt" else "bin/python")

    def run(*command):
        return subprocess.run([python, *command], cwd=folder, env=environment(), check=True, stdout=subprocess.PIPE, text=True).stdout

    run("-m", "pip", "install", "--quiet", "--disable-pip-version-check", f"{wheel}[plot]")
    try_programs(run, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
