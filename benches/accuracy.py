"""Prints the tables of docs/accuracy.md and docs/notes/2026-11-accuracy.md from the file that `cargo run --release --example accuracy` wrote.

    accuracy.py accuracy.csv
"""

import csv
import sys

LABELS = {"Auto": "AUTO", "FullMultigrid": "FULL_MULTIGRID", "Multigrid": "MULTIGRID", "Norm": "NORM"}


def read(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["mx"] = int(row["mx"])
        for name in ("tolerance", "seconds", "work", "error"):
            row[name] = float(row[name])
    return rows


TARGETS = ((1e-2, "1 %"), (1e-3, "0.1 %"), (1e-4, "0.01 %"))


def price(rows, case, target):
    """The row of the coarsest grid with an error below the target on this and all finer grids, with a tolerance of a tenth of the target."""
    some = [r for r in rows if r["case"] == case and r["method"] == "Auto"]
    on_grid = {m: min((r for r in some if r["mx"] == m), key=lambda r: r["tolerance"]) for m in {r["mx"] for r in some}}
    enough = [m for m in sorted(on_grid) if all(on_grid[n]["error"] <= target for n in on_grid if n >= m)]
    good = [r for r in some if enough and r["mx"] == enough[0] and abs(r["tolerance"] / (0.1 * target) - 1) < 1e-6]
    return good[0] if good else None


def tables(rows):
    print("| surface | " + " | ".join(label for _, label in TARGETS) + " |")
    print("|---|---|---|---|")
    for case in dict.fromkeys(r["case"] for r in rows):
        cells = []
        for target, _ in TARGETS:
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
    tables(read(sys.argv[1]))


if __name__ == "__main__":
    main()
