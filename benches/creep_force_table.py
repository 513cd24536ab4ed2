"""Measures a table of creep forces: 25 a/b x 16 xi x 16 eta x 32 phi = 204800 entries for ellipses of 35 x 35 elements, with estimated errors.

    python benches/creep_force_table.py [--sample 0.01] [--workers 2] [--elements 35] [--path table.nc]
    python benches/creep_force_table.py --errors

With `--sample` only a part of the planes, spread over the whole table, is solved, and the time of the whole table is extrapolated. `--errors`
compares the estimated errors of 1782 entries with the differences from the limit of two finer grids. Needs numpy and the library
(`CONTACT_NORMAL_LIBRARY`, or an installed package).
"""

import argparse
import concurrent.futures
import resource
import time

import numpy as np

import contact_normal as cn
from contact_normal._creep_force_plane import Plan, plane

# The axes reach from Kalker's linear theory to full slip. Values are denser where the creep curves bend.
AXES = {
    "axis_ratio": np.geomspace(0.1, 10.0, 25),
    "xi": 2.0 * np.linspace(0.0, 1.0, 16) ** 2,
    "eta": np.sign(np.linspace(-1.0, 1.0, 16)) * 2.0 * np.linspace(-1.0, 1.0, 16) ** 2,
    "phi": 4.0 * np.linspace(0.0, 1.0, 32) ** 2,
}


def seconds_of_processes():
    return sum(resource.getrusage(who).ru_utime + resource.getrusage(who).ru_stime for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def sample(part, workers, elements):
    """Solves a part of the planes. Returns the seconds, the part of all planes that this was, and the results."""
    axes = {name: tuple(float(value) for value in values) for name, values in AXES.items()}
    plan = Plan(poisson_ratio=(0.28,), elements=elements, tolerance=1e-4, **axes)
    count = max(1, round(part * plan.planes))
    # The planes are spread over the table. The shifts by multiples of 13 avoid that all of them have the same of the 32 values of phi.
    chosen = [(k * plan.planes) // count + (k * 13) % max(1, plan.planes // count) for k in range(count)]
    began = time.monotonic()
    with concurrent.futures.ProcessPoolExecutor(workers) as pool:
        found = list(pool.map(plane, [plan] * count, chosen))
    return time.monotonic() - began, count / plan.planes, found


def errors(workers, elements):
    """Prints the estimated errors beside the true ones, which are the differences from the limit of two finer grids."""
    axes = {"xi": [0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.2], "phi": [0.0, 0.1, 0.2, 0.4, 0.8, 1.5],
            "eta": [-0.6, -0.4, -0.2, -0.1, 0.0, 0.1, 0.2, 0.4, 0.6], "axis_ratio": [0.25, 1.0, 3.3]}
    table, fine, finest = (cn.creep_force_table(elements=m, workers=workers, **axes) for m in (elements, 2 * elements, 3 * elements))
    forces, moments = [], []
    for name, into in (("force_x", forces), ("force_y", forces), ("moment", moments)):
        two, three = getattr(fine, name), getattr(finest, name)
        limit = three + 2.0 * (three - two)  # Richardson's extrapolation at first order, from elements of 1/2 and 1/3 of the size
        into.append(getattr(table, name) - limit)
    for what, off in (("force", np.hypot(*forces)), ("moment", np.abs(moments[0]))):
        part = off / table.error
        print(f"{what}: error {off.mean():.4f} in the mean, {off.max():.4f} at most; estimated {table.error.mean():.4f} and {table.error.max():.4f}; "
              f"error over estimate: median {np.median(part):.2f}, 98 % {np.quantile(part, 0.98):.2f}, largest {part.max():.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", type=float, default=1.0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--elements", type=int, default=35)
    parser.add_argument("--path")
    parser.add_argument("--errors", action="store_true")
    given = parser.parse_args()
    if given.errors:
        errors(given.workers, given.elements)
        return
    entries = int(np.prod([len(axis) for axis in AXES.values()]))
    if given.sample < 1.0:
        seconds, part, found = sample(given.sample, given.workers, given.elements)
        products = np.concatenate([planes["products"].ravel() for planes in found])
        status = np.concatenate([planes["status"].ravel() for planes in found])
    else:
        began, part = time.monotonic(), 1.0
        table = cn.creep_force_table(given.path, elements=given.elements, workers=given.workers, progress=True, **AXES)
        seconds, products, status = time.monotonic() - began, table.products, table.status
        print(f"estimated error: median {np.median(table.error):.4f}, largest {table.error.max():.4f} of mu N")
    cases = products.size
    print(f"{cases} of {entries} entries in {seconds:.1f} s with {given.workers} processes; {np.count_nonzero(status)} not OK")
    print(f"products of an entry, both grids: mean {products.mean():.1f}, largest {products.max():.1f}")
    print(f"processor time of an entry: {1e3 * seconds_of_processes() / cases:.2f} ms; the whole table: {seconds / part / 60:.1f} minutes")


if __name__ == "__main__":
    main()
