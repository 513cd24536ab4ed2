"""How wrong is the answer, and what would a better one cost? Prints the ledger of the paper's problem as a table and draws it.

    python3 ledger.py [picture.png]
"""

import sys

import numpy as np

import contact_normal

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
CURVATURES = 0.0016681, 0.0030671  # 1/mm
APPROACH = 0.1091
M = 512


def main():
    dx, dy = 20.0 / M, 12.0 / M
    centres = np.arange(M) - 0.5 * (M - 1)
    h = CURVATURES[0] * (centres[None, :] * dx) ** 2 + CURVATURES[1] * (centres[:, None] * dy) ** 2
    result = contact_normal.solve(h, dx, dy, approach=APPROACH, **STEEL)
    exact = contact_normal.hertz(*CURVATURES, approach=APPROACH, **STEEL)

    print(f"{'grid':>9} {'work':>6} {'force':>10} {'estimate':>9} {'true':>7} {'p max':>8} {'estimate':>9} {'true':>7}")
    for row in result.ledger:
        print(
            f"{row['mx']:4}x{row['my']:4} {row['work_units']:6.2f} {row['force']:10.1f} {row['error_force']:9.0e}"
            f" {abs(row['force'] - exact.force):7.0e} {row['max_pressure']:8.2f} {row['error_max_pressure']:9.0e}"
            f" {abs(row['max_pressure'] - exact.max_pressure):7.0e}"
        )
    report = result.report
    print("limited by the grid:", report["limited_by"] == contact_normal.LIMITED_BY_GRID)
    if len(sys.argv) > 1:
        draw(result.ledger, report, exact, sys.argv[1])


def draw(ledger, report, exact, path):
    import matplotlib

    matplotlib.use("Agg")
    axes = ledger.plot()
    seconds = [row["seconds"] for row in ledger]
    true = [abs(row["force"] / exact.force - 1) for row in ledger]
    axes.loglog(seconds, true, "--", color="0.5", label="force: true error")
    if report["halved_seconds"] > 0:
        finer = report["halved_error_force"] / report["force"]
        axes.loglog(report["halved_seconds"], finer, "x", color="0.5", label="advice: half the element")
    axes.legend(frameon=False, fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    axes.figure.savefig(path)


if __name__ == "__main__":
    main()
