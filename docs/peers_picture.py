"""Draws the tables of docs/performance_peers.md, which `make bench-peers` writes: time over the size of each solver. `peers_picture.py FOLDER`."""

import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402

PAGE = Path(__file__).with_name("performance_peers.md")
OURS = "contact-normal"
MARKERS = {OURS: "o", "aspher": "s", "tamaas": "^", "ContactMechanics": "D"}
COLOURS = {name: f"C{k}" for name, k in zip(MARKERS, (1, 0, 2, 3))}
TITLES = {"ellipse": "ellipse", "sphere": "sphere", "rough": "rough, 10 % contact"}
LINES = {"1e-06": "-", "1e-04": "--"}


def rows(heading: str) -> list[list[str]]:
    """The cells of the table whose first column has this heading."""
    text = re.search(rf"^\| {heading} \|.*?(?=\n\n)", PAGE.read_text(), re.MULTILINE | re.DOTALL).group()
    return [[cell.strip() for cell in line.strip("|").split(" |")] for line in text.splitlines()[2:]]


def seconds(cell: str) -> float | None:
    """The time of a cell, "4.84 ms" or "2.01 s (5)"; None if it has none."""
    found = re.match(r"([\d.]+) (m?s)\b", cell)
    return float(found[1]) * (1e-3 if found[2] == "ms" else 1.0) if found else None


def over_size(axes, found: dict) -> None:
    """One line for each solver and accuracy; `found` has the seconds for (solver, accuracy, size)."""
    sizes = sorted({size for _, _, size in found})
    for name in MARKERS:
        for accuracy, line in LINES.items():
            at = [(size, found[name, accuracy, size]) for size in sizes if (name, accuracy, size) in found]
            if at:
                axes.loglog(*zip(*at), line, color=COLOURS[name], marker=MARKERS[name], markersize=5, label=f"{name}, error {accuracy.replace('e-0', 'e-')}")
    axes.set_xticks(sizes, [str(size) for size in sizes])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set(xlabel="elements in each direction")
    axes.grid(True, which="major", color="0.5", alpha=0.2)


def finish(figure, path: Path) -> None:
    """A legend below all panels."""
    handles = {label: handle for axes in figure.axes for handle, label in zip(*axes.get_legend_handles_labels())}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=2)
    figure.savefig(path)


def normal(path: Path) -> None:
    """The problems without friction."""
    found = {kind: {} for kind in TITLES}
    for problem, accuracy, ours, peer, _, its, *_ in rows("problem"):
        kind, size = problem.split()
        for name, cell in ((OURS, ours), (peer, its)):
            if (time := seconds(cell)) is not None:
                found[kind][name, accuracy, int(size)] = time
    figure, panels = pyplot.subplots(1, 3, figsize=(8.6, 4.8), sharey=True, layout="constrained")
    for axes, (kind, title) in zip(panels, TITLES.items()):
        over_size(axes, found[kind])
        axes.set_title(title)
    panels[0].set_ylabel("processor seconds of a whole call")
    finish(figure, path)


def friction(path: Path) -> None:
    """Shifts of half of mu N, for nu = 0, of both programs: the tangential problem alone."""
    found = {surface: {} for surface in ("ball", "rough")}
    for scene, given, accuracy, ours, its, *_ in rows("scene, nu"):
        surface, size, ratio = scene.replace(",", "").split()
        if (ratio, given) == ("0.0", "50%, motion"):
            for name, cell in ((OURS, ours), ("aspher", its)):
                times = re.match(r"[\d.]+, ([\d.]+), ", cell)
                if times:
                    found[surface][name, accuracy, int(size)] = 1e-3 * float(times[1])
    figure, panels = pyplot.subplots(1, 2, figsize=(6.8, 4.6), sharey=True, layout="constrained")
    for axes, (surface, of) in zip(panels, found.items()):
        over_size(axes, of)
        axes.set_title(surface)
    panels[0].set_ylabel("processor seconds, tangential problem")
    finish(figure, path)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    normal(folder / "performance_peers.svg")
    friction(folder / "performance_friction.svg")
