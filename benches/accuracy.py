"""Draws what `cargo run --release --example accuracy` printed, and prints the tables of docs/accuracy.md.

    accuracy.py accuracy.csv folder
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MARKERS = {"Auto": "o", "FullMultigrid": "s", "Multigrid": "^", "Norm": "x"}
LABELS = {"Auto": "AUTO", "FullMultigrid": "FULL_MULTIGRID", "Multigrid": "MULTIGRID", "Norm": "NORM"}


def read(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["mx"] = int(row["mx"])
        for name in ("tolerance", "seconds", "work", "error"):
            row[name] = float(row[name])
    return rows


def tolerances(rows, path):
    """Error against seconds and work units at one grid: tolerances from 1e-2 on."""
    cases = [("ellipse", 128), ("sphere", 256)]
    figure, axes = plt.subplots(2, 2, figsize=(9.6, 7.2), layout="constrained", sharey="row")
    for line, (case, m) in zip(axes, cases):
        for ax, cost in zip(line, ("seconds", "work")):
            for method, marker in MARKERS.items():
                some = [r for r in rows if (r["case"], r["mx"], r["method"]) == (case, m, method)]
                some.sort(key=lambda r: -r["tolerance"])
                ax.loglog([r[cost] for r in some], [r["error"] for r in some], marker + "-", label=LABELS[method], ms=5)
            ax.set(xlabel="seconds" if cost == "seconds" else "work units", title=f"{case}, {m} x {m}: tolerance 1e-2 to 1e-12")
            ax.grid(alpha=0.3)
        line[0].set_ylabel("relative error of the force")
    axes[0][0].legend()
    figure.savefig(path, dpi=110)


def grids(rows, path):
    """Error against seconds over the grids, AUTO at tolerance 1e-8."""
    figure, ax = plt.subplots(figsize=(8, 5.2), layout="constrained")
    for case in dict.fromkeys(r["case"] for r in rows):
        some = [r for r in rows if r["case"] == case and r["method"] == "Auto" and r["tolerance"] == 1e-8]
        some.sort(key=lambda r: r["mx"])
        ax.loglog([r["seconds"] for r in some], [r["error"] for r in some], "o-", ms=4, label=case)
        for r in some[:: max(1, len(some) - 1)]:
            ax.annotate(r["mx"], (r["seconds"], r["error"]), fontsize=7, xytext=(3, 3), textcoords="offset points")
    ax.set(xlabel="seconds (AUTO, tolerance 1e-8)", ylabel="relative error of what is found",
           title="What the grid gives (numbers: elements in a direction)")
    ax.grid(alpha=0.3)
    ax.legend(ncols=2)
    figure.savefig(path, dpi=110)


def tables(rows):
    print("| case | for 1 % | for 0.1 % | for 0.01 % |")
    print("|---|---|---|---|")
    for case in dict.fromkeys(r["case"] for r in rows):
        cells = []
        for target in (1e-2, 1e-3, 1e-4):
            some = [r for r in rows if r["case"] == case and r["method"] == "Auto"]
            # From this grid on the error stays below.
            sizes = sorted({r["mx"] for r in some})
            best = lambda m: min(r["error"] for r in some if r["mx"] == m)
            enough = [m for m in sizes if all(best(n) <= target for n in sizes if n >= m)]
            good = [r for r in some if enough and r["mx"] == enough[0] and r["error"] <= target]
            good.sort(key=lambda r: r["seconds"])
            if good:
                r = max(good, key=lambda r: r["tolerance"])
                cells.append(f"{r['mx']}, tolerance {r['tolerance']:.0e}: {r['seconds'] * 1e3:.2g} ms")
            else:
                cells.append("finer than studied")
        print(f"| {case} | " + " | ".join(cells) + " |")
    print()
    print("| tolerance | " + " | ".join(LABELS.values()) + " |")
    print("|---|" + "---|" * len(LABELS))
    for tolerance in sorted({r["tolerance"] for r in rows}, reverse=True):
        line = []
        for method in MARKERS:
            some = [r for r in rows if (r["case"], r["mx"], r["method"], r["tolerance"]) == ("ellipse", 128, method, tolerance)]
            line.append(f"{some[0]['error']:.1e}, {some[0]['work']:.0f} work units" if some else "not reached")
        print(f"| {tolerance:.0e} | " + " | ".join(line) + " |")


def main():
    rows, folder = read(sys.argv[1]), sys.argv[2]
    tolerances(rows, f"{folder}/accuracy_tolerances.png")
    grids(rows, f"{folder}/accuracy_grids.png")
    tables(rows)


if __name__ == "__main__":
    main()
