"""Checks that effects cost nothing in a scene without them: compares instructions and bytes of a plain solve with recorded ones, by callgrind.

    check.py library.so include [--record]

cost.txt has a line for each change that added an effect: instructions, bytes, the compiler, and the effect. The last line is compared. Another
compiler makes other instructions: then only the bytes are compared, and the last line has to be recorded again.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
COST = HERE / "cost.txt"
# The largest allowed ratio. An effect that the scene does not have may cost one test of its pointer: some thousand instructions of fifty million.
MORE = 1.002


def run(command, **more):
    """Runs a program, and returns its output."""
    return subprocess.run(command, check=True, capture_output=True, text=True, **more)


def measured(library, include):
    """Measures the instructions of one cold call, and the bytes of its solver."""
    abi = re.search(r"define CONTACT_NORMAL_ABI_VERSION (\d+)", (pathlib.Path(include) / "contact_normal.h").read_text())[1]
    with tempfile.TemporaryDirectory() as scratch:
        program, out = pathlib.Path(scratch) / "plain", pathlib.Path(scratch) / "callgrind"
        # The program loads the library by the name under which it is installed.
        (pathlib.Path(scratch) / f"{library.name}.{abi}").symlink_to(library.resolve())
        run(["gcc", "-std=c99", "-O2", f"-I{include}", HERE / "plain.c", "-o", program, library.resolve()])
        environment = {**os.environ, "LD_LIBRARY_PATH": scratch}
        found = run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=contact_normal_solve", f"--callgrind-out-file={out}", program], env=environment
        )
        instructions = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)
        return int(instructions[1]), int(found.stdout)


def main(library, include, *options):
    """Compares the costs with the last line of cost.txt, or first records a new line."""
    compiler = run(["rustc", "--version"]).stdout.split(" (")[0].strip()
    instructions, size = measured(pathlib.Path(library), include)
    if options:
        with COST.open("a") as file:
            file.write(f"{instructions} {size} {compiler}; {' '.join(options[1:])}\n")
    last = [line for line in COST.read_text().splitlines() if line[:1] not in ("", "#")][-1]
    numbers, _, what = last.partition(";")
    before, bytes_before, *known = numbers.split()
    ratio = instructions / int(before)
    print(f"a plain solve: {instructions} instructions, {ratio:.4f} of those with{what}; {size} bytes, {size / int(bytes_before):.4f}")
    assert size <= int(bytes_before) * MORE, "a plain solve holds more than before"
    if " ".join(known) != compiler:
        sys.exit(f"recorded with {' '.join(known)}, this is {compiler}: record it anew: make plain-cost RECORD='...'")
    assert ratio <= MORE, "a plain solve takes more instructions than before"


if __name__ == "__main__":
    main(*sys.argv[1:])
