"""Prints the numbers in the text of docs/smoothers.md from its table: `smoothers.py [docs/smoothers.md]`. `cargo run --release --example smoothers`
writes the table."""

import re
import statistics
import sys


def rows(path):
    """Yields for each row of the table the surface, whether the contact area C is given, the cycle, and the four numbers of each of both smoothers."""
    with open(path, encoding="utf-8") as file:
        for line in file:
            found = re.match(r"(ellipse|rough) (\d+)(, C given)? (V\(\d,\d\)) +(.*)", line)
            if found:
                numbers = [[float(value) for value in cell] for cell in re.findall(r"(\d+) / +(\d+) / +([\d.]+) / +([\d.]+)", found[5])]
                yield found[1], bool(found[3]), found[4], numbers[0], numbers[1]


def main(path):
    """Prints the ratios of the seconds of both smoothers, and the ranges of the numbers of cycles."""
    table = list(rows(path))
    ratios = {
        "the ellipse": [fft[3] / gs[3] for surface, _, _, gs, fft in table if surface == "ellipse"],
        "the rough surface": [fft[3] / gs[3] for surface, _, _, gs, fft in table if surface == "rough"],
        "V(1,0)": [fft[3] / gs[3] for _, _, cycle, gs, fft in table if cycle == "V(1,0)"],
        "all": [fft[3] / gs[3] for _, _, _, gs, fft in table],
    }
    for name, found in ratios.items():
        print(f"time of the FFT smoother over Gauss-Seidel, {name}: median {statistics.median(found):.2f}, {min(found):.2f} to {max(found):.2f}")
    for surface, given in (("ellipse", False), ("ellipse", True), ("rough", False), ("rough", True)):
        for which in ("V(1,0)", "V(0,1)"):
            both = [(int(fft[0]), int(gs[0])) for one, c, cycle, gs, fft in table if (one, c, cycle) == (surface, given, which)]
            fft, gs = zip(*both)
            print(f"cycles {which}, {surface}{', C given' if given else ''}: FFT {min(fft)} to {max(fft)}, Gauss-Seidel {min(gs)} to {max(gs)}")


if __name__ == "__main__":
    main(*(sys.argv[1:] or ["docs/smoothers.md"]))
