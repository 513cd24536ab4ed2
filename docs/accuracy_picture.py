"""Draws the table of docs/accuracy.md, which `make accuracy` prints: seconds for each accuracy. `accuracy_picture.py PICTURE`."""

import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

PAGE = Path(__file__).with_name("accuracy.md")


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
    """Error against seconds: a line for each surface, with the elements in a direction of its points in the legend."""
    targets, surfaces = table()
    figure, axes = pyplot.subplots(figsize=(6.8, 4.6), layout="constrained")
    errors = [float(target.strip(" %")) / 100.0 for target in targets]
    for k, (name, prices) in enumerate(surfaces.items()):
        points = [(1e-3 * price[1], error) for price, error in zip(prices, errors) if price]
        grids = ", ".join(str(price[0]) for price in prices if price)
        axes.plot(*zip(*points), "o-", color=f"C{k}", label=f"{name}: {grids}", markersize=5)
    axes.set(xscale="log", yscale="log", xlabel="time of a call, one thread [s]", ylabel="relative error of the force")
    axes.set_ylim(0.4 * min(errors), 2.5 * max(errors))
    axes.grid(True, which="major", color="0.5", alpha=0.2)
    axes.legend(title="elements in a direction", loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(path)


if __name__ == "__main__":
    draw(sys.argv[1])
