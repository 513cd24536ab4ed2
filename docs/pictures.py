"""Draws the pictures of the pages by the example programs, others from tables that are kept, in the package's style: `pictures.py [--dark] FOLDER`.

Those in docs/pictures are for light pages, `pictures.py docs/pictures`. `make docs` draws the dark ones, which are not kept.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

root = Path(__file__).resolve().parent.parent
STYLES = root / "python" / "contact_normal"
WHEEL_RAIL = root / "data" / "wheel_rail" / "y4_82kN.txt"


class Example(NamedTuple):
    """An example: the names of its pictures, its first arguments, and whether it is given a folder for them or the name of one."""

    pictures: tuple[str, ...]
    arguments: tuple[Path, ...] = ()
    takes_folder: bool = False


STEPS = ("array", "faults", "level", "gap", "pressures")
EFFECTS = ("layer", "pressure_limit", "period", "patches", "row_tables", "coating")
EXAMPLES = {
    "wheel_rail": Example(("wheel_rail",), (WHEEL_RAIL,)),
    "rough_surface": Example(("rough_surface",)),
    "heights_to_gap": Example(tuple(f"heights_to_gap_{step}" for step in STEPS), takes_folder=True),
    "profiles_to_gap": Example(tuple(f"profiles_to_gap_{name}" for name in ("place", "shift", "gap", "forces")), takes_folder=True),
    "friction": Example(("friction_shifts",)),
    "rolling": Example(("friction_rolling",)),
    "laws": Example(("friction_laws",)),
    "creep_force_table": Example(("creep_force_table",)),
    "subsurface": Example(("stress_depth", "stress_sliding", "stress_wheel_rail"), (WHEEL_RAIL,), takes_folder=True),
    "effects": Example(tuple(f"effects_{name}" for name in EFFECTS), takes_folder=True),
    "ledger": Example(("ledger",)),
    "price_list": Example(("price_list",)),
    "what_matters": Example(("what_matters",)),
    "visco": Example(("visco",)),
    "wear": Example(("wear",)),
    "coated_wheels": Example(("coated_wheels",)),
    "hot_friction": Example(("flash_temperature",)),
    "adhesion": Example(("adhesion_loop", "adhesion_rough"), takes_folder=True),
}

# Programs of other folders that draw, and their arguments.
BENCHES = (("benches/adhesion_challenge.py", ("--largest", "512"), "adhesion_challenge.svg"),)

# What is measured is not measured again: these draw tables of the pages and of local_fourier_analysis/results.
TABLES = (
    ("docs/accuracy_picture.py", "accuracy.svg"),
    ("docs/peers_picture.py", ""),
    ("local_fourier_analysis/picture.py", "local_fourier_analysis.svg"),
)


def draw(folder: Path, dark: bool) -> None:
    """Runs every example; what it draws is there afterwards."""
    folder.mkdir(parents=True, exist_ok=True)
    styles = ["contact_normal.mplstyle"] + ["dark.mplstyle"] * dark
    with tempfile.TemporaryDirectory() as scratch:
        style = Path(scratch) / "matplotlibrc"
        # What a later file says replaces what an earlier one says.
        lines = {line.split(":")[0]: line for name in styles for line in (STYLES / name).read_text().splitlines() if line[:1] not in ("", "#")}
        style.write_text("\n".join([*lines.values(), "savefig.format: svg", ""]))
        environment = {**os.environ, "MATPLOTLIBRC": str(style), "MPLBACKEND": "Agg", "SOURCE_DATE_EPOCH": "0"}
        for name, example in EXAMPLES.items():
            to = folder if example.takes_folder else folder / f"{example.pictures[0]}.svg"
            command = [sys.executable, root / "python_examples" / f"{name}.py", *example.arguments, to]
            subprocess.run(command, cwd=scratch, env=environment, check=True, stdout=subprocess.DEVNULL)
        for script, arguments, name in BENCHES:
            subprocess.run([sys.executable, root / script, *arguments, folder / name], env=environment, check=True, stdout=subprocess.DEVNULL)
        for script, name in TABLES:
            subprocess.run([sys.executable, root / script, folder / name], env=environment, check=True)
    for picture in folder.glob("*.svg"):
        picture.write_text("\n".join(line.rstrip() for line in picture.read_text().splitlines()) + "\n")


if __name__ == "__main__":
    draw(Path(sys.argv[-1]).resolve(), "--dark" in sys.argv)
