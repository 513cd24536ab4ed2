"""Runs a notebook and writes it as a page, with what its cells print and draw: `run_notebook.py NOTEBOOK.ipynb FOLDER`.

The cells run one after the other, as in Jupyter, in the notebook's folder; Jupyter is not needed. Pictures are drawn as light and as
dark ones. A cell that raises ends the program.
"""

import contextlib
import io
import json
import os
import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

from contact_normal._style import matplotlib_style  # noqa: E402


def cells_of(notebook: Path) -> list[tuple[str, str]]:
    """The kind and the text of each cell."""
    return [(cell["cell_type"], "".join(cell["source"])) for cell in json.loads(notebook.read_text())["cells"]]


def run(notebook: Path, pictures: Path, dark: bool) -> list[list[str]]:
    """Of each cell the lines of the page below it: what it printed, and its pictures, which are written into a folder."""
    below, names, heading = [], {"__name__": "__main__"}, ""
    before = Path.cwd()
    os.chdir(notebook.parent)
    try:
        with matplotlib_style(dark):
            for number, (kind, source) in enumerate(cells_of(notebook)):
                printed = io.StringIO()
                heading = (re.findall(r"^#+ (.*)$", source, re.MULTILINE) or [heading])[-1] if kind == "markdown" else heading
                if kind == "code":
                    with contextlib.redirect_stdout(printed):
                        exec(compile(source, f"{notebook.name}, cell {number}", "exec"), names)
                lines = ["```text", printed.getvalue().rstrip(), "```", ""] if printed.getvalue() else []
                for figure in pyplot.get_fignums():
                    name = f"{notebook.stem}_{number}.svg"
                    pyplot.figure(figure).savefig(pictures / name)
                    lines += [f"![{heading}]({pictures.name}/{name})", ""]
                pyplot.close("all")
                below.append(lines)
    finally:
        os.chdir(before)
    return below


def page(notebook: Path, below: list[list[str]]) -> str:
    """The page of a notebook."""
    out = []
    for number, ((kind, source), lines) in enumerate(zip(cells_of(notebook), below)):
        out += [source, ""] if kind == "markdown" else ["```python", source, "```", "", *lines]
        if number == 0:
            out += [f"The notebook is `notebooks/{notebook.name}` of the project.", ""]
    return "\n".join(out)


def main(notebook: Path, folder: Path) -> None:
    """Writes the page and its pictures."""
    pictures = folder / "pictures"
    (pictures / "dark").mkdir(parents=True, exist_ok=True)
    run(notebook, pictures / "dark", dark=True)
    (folder / f"{notebook.stem}.md").write_text(page(notebook, run(notebook, pictures, dark=False)))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
