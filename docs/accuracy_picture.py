"""Draws the table of docs/accuracy.md, which `make accuracy` prints: seconds for each accuracy. `accuracy_picture.py PICTURE`."""

import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

PAGE = Path(__file__).with_name("accuracy.md")
MARKERS = ("o", "s", "D")


def table() -> tuple[list[str], dict[str, list[tuple[int, float] | None]]]:
    """The accuracies, and of each surface the elements in a direction and the milliseconds for each; None: finer than studied."""
    text = re.search(r"^\| surface .*?(?=\n\n)", PAGE.read_text(), re.MULTILINE | re.DOTALL).group()
    head, _, *rows = (line.strip("|").split("|") for line in text.splitlines())
    found = {}
    for name, *cells in rows:
        numbers = [re.match(r" *(\d+): ([\d.]+) ms", cell) for cell in cells]
        found[name.strip()] = [(int(number[1]), float(number[2])) if number else None for number in numbers]
    return [cell.strip() for cell in head[1:]], found


def draw(path: str) -> None:
    """One line for each surface, with the elements in a direction beside the markers."""
    targets, surfaces = table()
    figure, axes = pyplot.subplots(figsize=(6.8, 4.2), layout="constrained")
    for y, (name, prices) in enumerate(reversed(surfaces.items())):
        paid = [price for price in prices if price]
        axes.plot([ms for _, ms in paid], [y] * len(paid), "-", color="0.5", alpha=0.4, zorder=0)
        for k, price in enumerate(prices):
            if price:
                axes.plot(price[1], y, MARKERS[k], color=f"C{k}", markersize=8)
        # Grids once, where several accuracies have the same.
        grids = list(dict.fromkeys(m for m, _ in paid))
        told = ", ".join(map(str, grids)) + (", finer than studied" if None in prices else "")
        axes.annotate(told, (max(ms for _, ms in paid), y), xytext=(9, 0), textcoords="offset points", va="center", fontsize=9)
    for k, target in enumerate(targets):
        axes.plot([], [], MARKERS[k], color=f"C{k}", label=target)
    axes.set_yticks(range(len(surfaces)), list(reversed(surfaces)))
    axes.set(xscale="log", xlabel="time of a call, one thread [ms]; numbers: elements in a direction", ylim=(-0.6, len(surfaces) - 0.4))
    axes.set_xlim(right=20 * axes.get_xlim()[1])
    axes.grid(axis="x", alpha=0.3)
    axes.legend(title="error of the force", loc="upper center", bbox_to_anchor=(0.5, 1.22), ncols=len(targets))
    figure.savefig(path)


if __name__ == "__main__":
    draw(sys.argv[1])
