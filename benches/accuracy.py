"""Draws what `cargo run --release --example accuracy` printed, and prints the tables of docs/accuracy.md and docs/notes/2026-11-accuracy.md.

    accuracy.py accuracy.csv folder
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LABELS = {"Auto": "AUTO", "FullMultigrid": "FULL_MULTIGRID", "Multigrid": "MULTIGRID", "Norm": "NORM"}


def read(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["mx"] = int(row["mx"])
        for name in ("tolerance", "seconds", "work", "error"):
            row[name] = float(row[name])
    return rows


TARGETS = ((1e-2, "1 %", "o"), (1e-3, "0.1 %", "s"), (1e-4, "0.01 %", "D"))


def price(rows, case, target):
    """The coarsest grid from which on the error stays below the target, with a tolerance of a tenth of it."""
    some = [r for r in rows if r["case"] == case and r["method"] == "Auto"]
    on_grid = {m: min((r for r in some if r["mx"] == m), key=lambda r: r["tolerance"]) for m in {r["mx"] for r in some}}
    enough = [m for m in sorted(on_grid) if all(on_grid[n]["error"] <= target for n in on_grid if n >= m)]
    good = [r for r in some if enough and r["mx"] == enough[0] and abs(r["tolerance"] / (0.1 * target) - 1) < 1e-6]
    return good[0] if good else None


def picture(rows, path):
    """Seconds that 1 %, 0.1 % and 0.01 % of the force or the approach cost."""
    cases = list(dict.fromkeys(r["case"] for r in rows))
    figure, ax = plt.subplots(figsize=(8, 3.6), layout="constrained")
    for y, case in enumerate(reversed(cases)):
        prices = [price(rows, case, target) for target, *_ in TARGETS]
        paid = [r["seconds"] for r in prices if r]
        ax.plot(paid, [y] * len(paid), "-", color="0.8", zorder=0)
        for color, (_, label, marker), r in zip(("tab:green", "tab:orange", "tab:red"), TARGETS, prices):
            if r:
                ax.plot(r["seconds"], y, marker, color=color, label=label if y == 0 else None, ms=8)
                ax.annotate(r["mx"], (r["seconds"], y), fontsize=7, xytext=(0, 7), textcoords="offset points", ha="center")
        if None in prices:
            ax.annotate(" finer than studied", (paid[-1] if paid else 1e-4, y), fontsize=8, va="center", xytext=(9, 0), textcoords="offset points")
    labels = [ax.plot([], [], m, color=c, label=l)[0] for c, (_, l, m) in zip(("tab:green", "tab:orange", "tab:red"), TARGETS)]
    ax.legend(handles=labels, title="error of the force", loc="center left", bbox_to_anchor=(1.16, 0.5))
    ax.set_yticks(range(len(cases)), list(reversed(cases)))
    ax.set(xscale="log", xlabel="seconds, one thread (numbers: elements in a direction)", ylim=(-0.6, len(cases) - 0.4))
    ax.grid(axis="x", alpha=0.3)
    figure.savefig(path, dpi=120)


def tables(rows):
    print("| surface | " + " | ".join(label for _, label, _ in TARGETS) + " |")
    print("|---|---|---|---|")
    for case in dict.fromkeys(r["case"] for r in rows):
        cells = []
        for target, *_ in TARGETS:
            r = price(rows, case, target)
            milliseconds = f"{1e3 * r['seconds']:.2g}" if r else ""
            cells.append(f"{r['mx']}: {float(milliseconds):g} ms" if r else "finer than studied")
        print(f"| {case} | " + " | ".join(cells) + " |")
    print()
    print("| tolerance | " + " | ".join(LABELS.values()) + " |")
    print("|---|" + "---|" * len(LABELS))
    for tolerance in sorted({r["tolerance"] for r in rows}, reverse=True):
        line = []
        for method in LABELS:
            some = [r for r in rows if (r["case"], r["mx"], r["method"], r["tolerance"]) == ("ellipse", 128, method, tolerance)]
            line.append(f"{some[0]['error']:.1e}, {some[0]['work']:.0f} work units" if some else "not reached")
        print(f"| {tolerance:.0e} | " + " | ".join(line) + " |")


def main():
    rows, folder = read(sys.argv[1]), sys.argv[2]
    picture(rows, f"{folder}/accuracy.png")
    tables(rows)


if __name__ == "__main__":
    main()
