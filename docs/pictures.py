"""Draws the pictures of the pages by the example programs, in the package's style: `pictures.py [--dark] FOLDER`.

Those in docs/pictures are for light pages, `pictures.py docs/pictures`. `make docs` draws the dark ones, which are not kept.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parent.parent
STYLES = root / "python" / "contact_normal"
WHEEL_RAIL = root / "data" / "wheel_rail" / "y4_82kN.txt"
# Of each example its arguments; {} is the folder.
EXAMPLES = {
    "wheel_rail": (WHEEL_RAIL, "{}/wheel_rail.svg"),
    "effects": ("{}",),
    "friction": ("{}/friction_shifts.svg",),
    "rolling": ("{}/friction_rolling.svg",),
    "subsurface": (WHEEL_RAIL, "{}"),
    "creep_force_table": ("{}/creep_force_table.svg",),
    "ledger": ("{}/ledger.svg",),
    "price_list": ("{}/price_list.svg",),
    "rough_surface": ("{}/rough_surface.svg",),
}


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
        for name, arguments in EXAMPLES.items():
            command = [sys.executable, root / "python_examples" / f"{name}.py", *(str(part).format(folder) for part in arguments)]
            subprocess.run(command, cwd=scratch, env=environment, check=True, stdout=subprocess.DEVNULL)
    for picture in folder.glob("*.svg"):
        picture.write_text("\n".join(line.rstrip() for line in picture.read_text().splitlines()) + "\n")


if __name__ == "__main__":
    draw(Path(sys.argv[-1]).resolve(), "--dark" in sys.argv)
