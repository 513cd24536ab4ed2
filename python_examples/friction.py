"""Bodies that are pushed sideways: a ball once, the same ball to and fro, and a wheel on a rail. `python3 friction.py [picture]`: with a
picture it draws the tractions over the stick and slip areas, and the hysteresis loop."""

import os
import sys

import numpy as np

import contact_normal as cn

WHEEL_RAIL = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "wheel_rail", "y4_82kN.txt")

# A ball on a plate, of a material with nu = 0: then Cattaneo (1938) and Mindlin (1949) are exact. mm, N, N/mm2.
RADIUS, CONTACT_RADIUS, ELEMENTS, COEFFICIENT = 50.0, 1.0, 80, 0.3
MATERIAL = dict(shear_modulus=82000.0, poisson_ratio=0.0)
NORMAL_FORCE = 4.0 / 3.0 * MATERIAL["shear_modulus"] * CONTACT_RADIUS**3 / RADIUS
MOST = COEFFICIENT * NORMAL_FORCE  # the force at which the ball slides
SLIDING = 0.75 * MOST / (MATERIAL["shear_modulus"] * CONTACT_RADIUS)  # the shift at which it slides


def ball():
    """The undeformed distance of the ball on a grid that is a tenth larger than the contact."""
    d = 2.2 * CONTACT_RADIUS / ELEMENTS
    x = (np.arange(ELEMENTS) - 0.5 * (ELEMENTS - 1)) * d
    return (x[None, :] ** 2 + x[:, None] ** 2) / (2.0 * RADIUS), d


def solved(result):
    if result.status != cn.OK:
        sys.exit(f"stopped early: {result.message}")
    return result


def push():
    """Shifts the ball, and compares the result with the exact solution."""
    h, d = ball()
    stick_radius = 0.5 * CONTACT_RADIUS
    # Body 1 moves to -x over body 2, and the force on body 1 is to +x.
    shift = -SLIDING * (1.0 - (stick_radius / CONTACT_RADIUS) ** 2)
    friction = dict(coefficient=COEFFICIENT, creepage=(shift, 0.0))
    result = solved(cn.solve(h, d, d, force=NORMAL_FORCE, friction=friction, units=("mm", "N"), **MATERIAL))
    found = np.sqrt(result.report["stick_count"] * d * d / np.pi)
    print(f"ball, {ELEMENTS} x {ELEMENTS} elements, pushed sideways by {-1000.0 * shift:.3f} um")
    print(f"{'':20}{'found':>10}{'exact':>10}")
    print(f"{'force / (mu N)':20}{result.report['tangential_force'][0] / MOST:>10.3f}{1.0 - (stick_radius / CONTACT_RADIUS) ** 3:>10.3f}")
    print(f"{'stick radius [mm]':20}{found:>10.2f}{stick_radius:>10.2f}")
    return result


def loading(part):
    """The shift at which a ball that starts from rest carries this part of mu N."""
    return SLIDING * (1.0 - (1.0 - part) ** (2.0 / 3.0))


def rock():
    """Applies forces to and fro, each step from the tractions of the one before: the hysteresis of Mindlin and Deresiewicz (1953)."""
    h, d = ball()
    top = 0.8
    to, fro = np.array([0.2, 0.4, 0.6, top]), np.array([0.6, 0.4, 0.2, 0.0, -0.2, -0.4, -0.6, -top])
    parts = np.concatenate([to, fro, -fro])
    exact = np.concatenate([loading(to), loading(top) - 2.0 * loading(0.5 * (top - fro)), 2.0 * loading(0.5 * (top - fro)) - loading(top)])
    found, lost, shift = [], 0.0, 0.0
    with cn.Solver(ELEMENTS, ELEMENTS, d, d, **MATERIAL) as solver:
        for step, part in enumerate(parts):
            friction = dict(coefficient=COEFFICIENT, force=(part * MOST, 0.0), continues=step > 0)
            result = solved(solver.solve(h, force=NORMAL_FORCE, friction=friction))
            shift -= result.report["creepage"][0]
            found.append(shift)
            if step >= len(to):
                lost -= np.sum(result.traction * result.slip) * d * d
    print("rocked to and fro")
    print(f"{'force / (mu N)':>14}{'shift [um]':>14}{'exact [um]':>14}")
    for row in zip(parts, 1000.0 * np.array(found), 1000.0 * exact):
        print("{:>14.1f}{:>14.2f}{:>14.2f}".format(*(value + 0.0 for value in row)))
    # The area of the loop in closed form: twice the integral of the shift over the force on the way back.
    area = MOST * (4.0 * top * loading(top) - 8.0 * SLIDING * (top - 0.6 * (1.0 - (1.0 - top) ** (5.0 / 3.0))))
    print(f"energy lost in a cycle: {lost:.3f} mJ by friction, {area:.3f} mJ is the area of the exact loop")
    return parts, np.array(found), exact


def wheel():
    """Shifts the wheel of wheel_rail.py along and across the rail."""
    with open(WHEEL_RAIL, encoding="ascii") as file:
        numbers = [next(file) for _ in range(4)][3].split()
        h = np.loadtxt(file)[:, 0]
    mx, my = int(numbers[0]), int(numbers[1])
    dx, dy, _, force, shear_modulus, poisson_ratio = map(float, numbers[2:])
    friction = dict(coefficient=COEFFICIENT, force=(0.6 * COEFFICIENT * force, 0.2 * COEFFICIENT * force))
    result = solved(cn.solve(h.reshape(my, mx), dx, dy, force=force, shear_modulus=shear_modulus, poisson_ratio=poisson_ratio, tolerance=1e-9,
                             friction=friction, units=("mm", "N")))
    report = result.report
    x, y = report["creepage"]
    print(f"wheel on rail, {force / 1000.0:.1f} kN, pushed by 0.6 mu N along the rail and 0.2 mu N across")
    print(f"shift {1000.0 * x:.2f} um along and {1000.0 * y:.2f} um across")
    print(f"of {result.contact.sum()} elements in contact {report['stick_count']} stick and {report['slip_count']} slip")
    return result


def draw(picture, pushed, rocked, rolled):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, ((left, right), (middle, unused)) = pyplot.subplots(2, 2, figsize=(8.6, 7.8), layout="constrained")
    unused.set_axis_off()
    pushed.plot_traction(left).set(title="a ball: stick blue, slip orange", xlabel="x [mm]", ylabel="y [mm]")
    parts, found, exact = rocked
    middle.plot(1000.0 * exact, parts, "-", color="0.5", label="Mindlin and Deresiewicz")
    middle.plot(1000.0 * found, parts, "o", markersize=4, label="found")
    middle.set(title="the ball rocked to and fro", xlabel="shift [µm]", ylabel="force / ($\\mu N$)")
    middle.legend()
    rolled.plot_traction(right).set(title="a wheel on a rail", xlabel="x, along the rail [mm]", ylabel="y, across [mm]")
    figure.savefig(picture)


def main(picture=None):
    pushed, rocked, rolled = push(), rock(), wheel()
    if picture:
        draw(picture, pushed, rocked, rolled)


if __name__ == "__main__":
    main(*sys.argv[1:])
