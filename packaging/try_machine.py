"""Compiles the examples in C for another machine and runs them there: `try_machine.py TARGET BUILT FOLDER`.

BUILT has the libraries that cargo made for the Rust target TARGET. Linux on another processor runs by qemu-user, Windows by wine, both
from Debian. The output is compared with what is expected, except lines of times: words must agree, whole numbers to one in a hundred (they
count iterations), other numbers to two units of their last printed digit, since vectors of another length round otherwise.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

# Debian 12's wine has no bcryptprimitives.dll, of which Rust takes the seeds of its hash tables; Windows has had it since version 7.
BCRYPTPRIMITIVES = """
#include <windows.h>
#include <ntsecapi.h>
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) { return RtlGenRandom(data, (ULONG)size); }
"""

ROOT = Path(__file__).resolve().parents[1]
ARGUMENTS = {
    "wheel_rail": [ROOT / "data" / "wheel_rail" / "y4_82kN.txt"],
    "gap": [ROOT / "data" / "gaps" / "ground.txt", "1.2288"],
}
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


def machine(target, built):
    """The compiler, what runs a program, and the library that programs load."""
    processor, _, rest = target.partition("-")
    if "windows" in rest:
        return f"{processor}-w64-mingw32-gcc", ["wine"], ["contact_normal.dll", "libcontact_normal.dll.a"]
    gnu = f"{processor}-linux-gnu"
    return f"{gnu}-gcc", [f"qemu-{processor}", "-L", f"/usr/{gnu}", "-E", f"LD_LIBRARY_PATH={built}"], ["libcontact_normal.so"]


def stand_in(compiler, folder):
    """bcryptprimitives.dll in `folder`."""
    command = [compiler, "-shared", "-x", "c", "-", "-o", folder / "bcryptprimitives.dll", "-ladvapi32"]
    subprocess.run(command, input=BCRYPTPRIMITIVES, text=True, check=True)


def agree(printed, expected):
    """Whether two lines have the same words, whole numbers to 1 in 100, and other numbers within two units of their last digit."""
    if NUMBER.sub("#", printed).split() != NUMBER.sub("#", expected).split():
        return False
    for a, b in zip(NUMBER.findall(printed), NUMBER.findall(expected)):
        decimals = re.search(r"\.(\d+)", b)
        exponent = re.search(r"[eE]([-+]?\d+)", b)
        unit = 10.0 ** ((int(exponent[1]) if exponent else 0) - (len(decimals[1]) if decimals else 0))
        allowed = 2.01 * unit if decimals else abs(float(b)) / 100
        if abs(float(a) - float(b)) > allowed:
            return False
    return True


def main(target, built, folder):
    """Raises if an example fails; exits with 1 if it prints something else."""
    built, folder = Path(built).resolve(), Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    compiler, runner, libraries = machine(target, folder)
    for name in libraries:
        shutil.copyfile(built / name, folder / name)
    if (folder / "libcontact_normal.so").exists():
        shutil.copyfile(built / "libcontact_normal.so", folder / "libcontact_normal.so.2")
    if runner == ["wine"]:
        stand_in(compiler, folder)
    failed = 0
    examples = sorted((ROOT / "c_examples").glob("*.c"))
    for example in examples:
        program = folder / f"{example.stem}.exe"
        subprocess.run([compiler, "-std=c99", "-O2", "-I", ROOT / "include", example, "-o", program, "-L", folder, "-lcontact_normal", "-lm"],
                       check=True)
        run = subprocess.run([*runner, program, *ARGUMENTS.get(example.stem, [])], cwd=folder, stdout=subprocess.PIPE, text=True,
                             env={**os.environ, "WINEDEBUG": "-all"})
        lines = [line for line in run.stdout.splitlines() if not line.startswith("time:")]
        expected = example.with_suffix(".expected").read_text().splitlines()
        same = run.returncode == 0 and len(lines) == len(expected) and all(map(agree, lines, expected))
        digits = sum(a != b for a, b in zip(lines, expected))
        print(f"{target} {example.stem:20} {'passed' if same else 'FAILED'}, {len(lines)} lines, {digits} with other digits", flush=True)
        if not same:
            failed += 1
            print(f"exit code {run.returncode}")
            for a, b in zip(lines, expected):
                if not agree(a, b):
                    print(f"  printed  {a}\n  expected {b}")
    print(f"{len(examples) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
