"""Bodies that roll steadily: a cylinder on a plane, and a wheel on a rail. `python3 rolling.py [picture]`: with a picture it draws Carter's
tractions, the creep-force curve of the wheel with Kalker's linear theory as its tangent, and the tractions over the stick and slip areas."""

import os
import sys

import numpy as np

import contact_normal as cn

PROFILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "friction", "wheel_rail_profile.txt")
STEEL = dict(shear_modulus=82000.0, poisson_ratio=0.28)  # N/mm2; lengths are in mm, forces in N.
ROLLING = dict(coefficient=0.3, motion="STEADY_ROLLING")  # Towards +x.


def solved(result):
    if np.any(result.status != cn.OK):
        sys.exit(f"stopped early: {result.message}")
    return result


def carter(x, a, stick):
    """Carter's tractions, over mu times the largest pressure: the difference of two half-ellipses with a common leading edge x = a."""
    slip = np.sqrt(np.maximum(1.0 - (x / a) ** 2, 0.0))
    return slip - stick / a * np.sqrt(np.maximum(1.0 - ((x - a) / stick + 1.0) ** 2, 0.0))


def cylinder(radius=500.0, width=200.0, force=35780.0, creepage=-0.00024, elements=55):
    """Compares a cylinder, one row of elements that are long across, with Carter (1926), whose solution is exact for a cylinder without ends."""
    dx = 2.2 / elements
    x = (np.arange(elements) + 0.5) * dx - 1.07
    friction = dict(ROLLING, creepage=(creepage, 0.0))
    result = solved(cn.solve((x**2 / (2.0 * radius))[None, :], dx, width, force=force, friction=friction, **STEEL))
    found, report = result.traction[0, 0], result.report
    # The half-width a of the contact, and that of the stick area.
    mu, modulus = ROLLING["coefficient"], STEEL["shear_modulus"] / (1.0 - STEEL["poisson_ratio"])
    a = np.sqrt(4.0 * force / width * radius / (np.pi * modulus))
    stick = a - radius * abs(creepage) / mu
    most = 2.0 * mu * force / (np.pi * a * width)
    fine = np.linspace(x[0], x[-1], 2001)
    exact = most * carter(fine, a, stick)
    print(f"cylinder, {elements} elements in a row: {report['stick_count']} stick, {report['slip_count']} slip")
    print(f"{'':28}{'found':>10}{'Carter':>10}")
    print(f"{'Fx / (mu N)':28}{report['tangential_force'][0] / (mu * force):>10.4f}{1.0 - (stick / a) ** 2:>10.4f}")
    print(f"{'width of the stick area [mm]':28}{report['stick_count'] * dx:>10.2f}{2.0 * stick:>10.2f}")
    print(f"{'largest traction [N/mm2]':28}{found.max():>10.2f}{exact.max():>10.2f}")
    print(f"the tractions differ by {np.sqrt(np.mean((found - most * carter(x, a, stick)) ** 2)):.2f} N/mm2 (rms)")
    return x, result, fine, exact


def wheel():
    """The undeformed distance of a wheel and a rail, and the scene."""
    x, y = (np.arange(71) + 0.5) * 0.1 - 3.55, (np.arange(81) + 0.5) * 0.1 - 6.15
    across = np.interp(y, *np.loadtxt(PROFILE).T)
    return (x[None, :] ** 2 / (2.0 * 483.931) + across[:, None], 0.1, 0.1), dict(STEEL, approach=0.02084)


def curve():
    """The forces for longitudinal creepages from zero to full slip, and the slope at zero, where nothing slips: that of Kalker's linear theory."""
    surface, scene = wheel()
    creepages = -2.5e-3 * np.linspace(0.0, 1.0, 25) ** 2
    entries = np.outer(creepages, (1.0, 0.0, 0.0))
    found = solved(cn.friction_batch(*surface, entries, friction=ROLLING, **scene))
    at_zero = solved(cn.solve(*surface, friction=dict(ROLLING, sensitivities=True), **scene)).report
    slope = at_zero["sensitivities"][0]
    # Fx = -G a b C11 xi, with pi a b the contact area.
    kalker = -slope * np.pi / (STEEL["shear_modulus"] * at_zero["contact_area"])
    most = ROLLING["coefficient"] * at_zero["force"]
    forces, linear = found.force[:, 0] / most, slope * creepages / most
    print(f"wheel on rail, {at_zero['force'] / 1000.0:.2f} kN: near zero Fx = {slope / 1e6:.3f} MN xi, as of an ellipse of this area with C11 = {kalker:.2f}")
    print(f"{'-xi [1e-3]':>10}{'Fx/(mu N)':>12}{'linear':>10}{'stick':>8}")
    for k in range(0, len(creepages), 4):
        print(f"{abs(1000.0 * creepages[k]):>10.3f}{forces[k]:>12.4f}{linear[k]:>10.4f}{found.stick_count[k]:>8}")
    return -1000.0 * creepages, forces, linear


def spinning():
    """Solves a creepage with a spin, and prints the results beside those that CONTACT prints."""
    surface, scene = wheel()
    friction = dict(ROLLING, creepage=(0.0005, 0.0), spin=0.0003, spin_centre=(0.0, 2.1))
    result = solved(cn.solve(*surface, friction=friction, tolerance=1e-9, units=("mm", "N"), **scene))
    x, y = np.array(result.report["tangential_force"]) / (ROLLING["coefficient"] * result.force)
    print(f"{'creepage and spin':24}{'found':>12}{'CONTACT':>12}")
    print(f"{'Fx / (mu N)':24}{x:>12.7f}{-0.5729502:>12.7f}\n{'Fy / (mu N)':24}{y:>12.7f}{-0.3269461:>12.7f}")
    print(f"{'elements that slip':24}{result.report['slip_count']:>12}{1872:>12}")
    return result


def draw(picture, rolled, forces, spun):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, ((left, middle), (right, unused)) = pyplot.subplots(2, 2, figsize=(8.6, 7.8), layout="constrained")
    unused.set_axis_off()
    x, result, fine, exact = rolled
    left.plot(x, ROLLING["coefficient"] * result.pressure[0], ":", color="0.5", label="$\\mu p$")
    left.plot(fine, exact, "-", color="0.5", label="Carter")
    for side, colour, label in ((1, "tab:blue", "found, stick"), (2, "tab:orange", "found, slip")):
        chosen = result.stick_slip[0] == side
        left.plot(x[chosen], result.traction[0, 0, chosen], "o", color=colour, markersize=4, label=label)
    left.set(title="a cylinder that rolls to the right", xlabel="x [mm]", ylabel="traction [N/mm²]", ylim=(0.0, 47.0))
    left.legend(ncols=2, loc="upper center", fontsize="small")
    creepages, found, linear = forces
    middle.plot(creepages, linear, "--", color="0.5", label="Kalker's linear theory")
    middle.plot(creepages, found, "o-", markersize=4, label="found")
    middle.set(title="creep force of a wheel on a rail", xlabel="creepage −ξ [0.001]", ylabel="force $F_x/(\\mu N)$", ylim=(0.0, 1.1))
    middle.legend(loc="lower right")
    spun.plot_traction(right).set(title="the wheel with creepage and spin", xlabel="x, along the rail [mm]", ylabel="y, across [mm]")
    figure.savefig(picture)


def main(picture=None):
    rolled, forces, spun = cylinder(), curve(), spinning()
    if picture:
        draw(picture, rolled, forces, spun)


if __name__ == "__main__":
    main(*sys.argv[1:])
