"""Creep forces of ellipses: a table is computed once, and then read at any creepage. `python3 creep_force_table.py [picture]`: with a
picture it draws the longitudinal force over the creepage for three spins, with the estimated errors, and Kalker's linear theory."""

import sys

import numpy as np

import contact_normal as cn

# A wheel on a rail: semi-axes along and across the rolling direction in mm, the normal force in N, mu, and the shear modulus in N/mm2.
CONTACT = dict(semi_axes=(6.4, 4.5), normal_force=82000.0, coefficient=0.3, shear_modulus=82000.0, poisson_ratio=0.28)
# Kalker's coefficient C11 of a circular contact for nu = 0.25 (Kalker 1990, appendix E).
C11 = 4.12


def table(progress=None):
    """The table, with creepages up to full slip. It has only xi >= 0 and phi >= 0, because symmetry gives the other signs."""
    return cn.creep_force_table(xi=1.6 * np.linspace(0.0, 1.0, 13) ** 2, eta=[-0.3, -0.1, 0.0, 0.1, 0.3], phi=[0.0, 0.25, 0.5, 1.0],
                                axis_ratio=[1.0, 2.0], poisson_ratio=[0.25, 0.3], elements=25, progress=progress)


def draw(found, picture):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(layout="constrained")
    xi = np.linspace(-1.6, 1.6, 201)
    for phi in (0.0, 0.5, 1.0):
        force, _, _, error = found.forces(xi, 0.0, phi, poisson_ratio=0.25)
        (line,) = axes.plot(xi, force, label=f"spin {phi}")
        axes.fill_between(xi, force - error, force + error, color=line.get_color(), alpha=0.3, linewidth=0)
    linear = np.array([-1.0, 1.0]) / C11
    axes.plot(linear, -C11 * linear, "--", color="0.5", linewidth=1.0, label="Kalker's linear theory")
    axes.set(xlabel=r"creepage $G c^2 \xi/(\mu N)$", ylabel=r"$F_x/(\mu N)$", title="Longitudinal creep force of a circle, with estimated errors")
    axes.legend()
    figure.savefig(picture)


def main(picture=None):
    found = table()
    print(f"{found.error.size} entries, {np.count_nonzero(found.status)} not solved")
    print(f"estimated error: median {np.median(found.error):.3f}, largest {found.error.max():.3f} of mu N")
    for creepage, spin in (((-1e-3, 2e-4), 0.0), ((-1e-3, 5e-4), 1e-4), ((2e-3, 0.0), -1e-4)):
        x, y, moment = found.wheel_rail(creepage, spin, **CONTACT)
        print(f"creepage {creepage[0]:+.4f} {creepage[1]:+.4f}, spin {spin:+.4f}/mm: Fx {x / 1e3:+.1f} kN, Fy {y / 1e3:+.1f} kN, Mz {moment / 1e3:+.1f} Nm")
    if picture:
        draw(found, picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
