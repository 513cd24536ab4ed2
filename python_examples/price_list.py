"""The predicted costs of accuracy: the price list of a sphere on a flat, each row of which is solved and compared with Hertz.

    python3 price_list.py [picture.png]

For each wanted error of the force the program shows whether the grid and the tolerance of the price list reach it. The picture, if named, shows the
predicted and the true errors over the seconds; an accuracy of 0.1 % is marked.
"""

import sys

import numpy as np

import contact_normal

APPROACH, CURVATURE, SIDE = 0.02, 0.005, 6.0  # mm, 1/mm, mm
STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
TARGETS = (1e-2, 1e-3, 1e-4)
BOUGHT = 1e-3


def undeformed_distance(x, y):
    """h at the centres (x, y) of elements."""
    return CURVATURE * (x**2 + y**2)


def pay(price):
    """Solves on the grid and with the tolerance of a row of the price list. Returns the seconds, the least of three, and the force."""
    my, mx = price.shape
    x, y = ((np.arange(m) + 0.5) * SIDE / m - 0.5 * SIDE for m in (mx, my))
    h = undeformed_distance(x[None, :], y[:, None])
    results = [contact_normal.solve(h, SIDE / mx, SIDE / my, approach=APPROACH, tolerance=price.tolerance, **STEEL) for _ in range(3)]
    return min(result.report["setup_seconds"] + result.report["solve_seconds"] for result in results), results[0].force


def draw(prices, paid, path):
    """Draws errors over seconds."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(layout="constrained")
    axes.loglog([price.seconds for price in prices], [price.error for price in prices], label="predicted")
    axes.loglog(*zip(*paid), "s", label="measured, true")
    for price in prices:
        label = f"{price.shape[1]} x {price.shape[0]}"
        axes.annotate(label, (price.seconds, price.error), fontsize=8, xytext=(8, 6), textcoords="offset points")
        if price.target == BOUGHT:
            axes.plot(price.seconds, price.error, "o", ms=16, mfc="none", color="tab:red", label="bought")
    axes.set(xlabel="time [s]", ylabel="relative error of the force", title="What accuracy costs: sphere on flat")
    axes.legend()
    figure.savefig(path)


def main(picture=None):
    """Runs the example."""
    exact = contact_normal.hertz(CURVATURE, CURVATURE, approach=APPROACH, **STEEL)
    prices = contact_normal.cost_of_accuracy(
        undeformed_distance, SIDE / 16, SIDE / 16, shape=(16, 16), targets=TARGETS, approach=APPROACH, **STEEL
    )
    paid = []
    print(f"{'target':>8}{'to be had':>12}{'met in fact':>14}")
    for price in prices:
        seconds, force = pay(price)
        error = abs(force / exact.force - 1.0)
        paid.append((seconds, error))
        print(f"{price.target:8.0e}{price.obstacle or 'yes':>12}{'yes' if error <= price.target else 'no':>14}")
    if picture:
        draw(prices, paid, picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
