"""Which effects does my scene call for? Six scenes, and for each effect of theirs what leaving it out changes and whether 1 % calls for it.

    python3 what_matters.py [picture.svg]

The picture, if named, has the changes beside the seconds that are saved, for the wheel on the rail.
"""

import sys

import numpy as np

import contact_normal

TARGET = 1e-2
# With so many seconds the small grids may be refined up to the grid of the scene on any machine, so that the output does not depend on the machine.
WHOLE = {"target": TARGET, "max_seconds": 600.0, "pairs": False}
M = 64


def paraboloid(radius_x, radius_y, side_x, side_y):
    """h, dx and dy of a paraboloid with two radii, over a rectangle with these sides."""
    dx, dy = side_x / M, side_y / M
    x, y = ((np.arange(M) - 0.5 * (M - 1)) * d for d in (dx, dy))
    return x[None, :] ** 2 / (2.0 * radius_x) + y[:, None] ** 2 / (2.0 * radius_y), dx, dy


def rough(rms, side, seed=5):
    """h, dx and dy of a periodic self-affine surface with a Hurst exponent of 0.8."""
    wave = np.hypot(*np.meshgrid(np.fft.rfftfreq(M) * M, np.fft.fftfreq(M) * M))
    amplitude = np.where((wave >= 2) & (wave <= 16), np.maximum(wave, 1.0) ** -1.8, 0.0)
    phase = np.exp(2j * np.pi * np.random.default_rng(seed).random(wave.shape))
    heights = np.fft.irfft2(amplitude * phase, (M, M))
    heights *= rms / heights.std()
    return heights - heights.min(), side / M, side / M


def scenes():
    """Yields for each scene its name, its surface and the other arguments of `what_matters`. Units are mm and N; for the tip nm and nN."""
    steel = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
    # A steel ball of 5 mm radius with 3 um of hard carbon, on steel.
    yield ("coated ball", *paraboloid(5.0, 5.0, 0.3, 0.3)), {
        "force": 20.0, "coating": ((0.003, 82000.0 * 1.1, 0.22), None), **steel,
    }
    # Wheel and rail of steels that differ a little, with creepage and spin.
    yield ("wheel on rail", *paraboloid(460.0, 300.0, 18.0, 15.0)), {
        "force": 80e3, "shear_modulus": (82000.0, 80000.0), "poisson_ratio": (0.28, 0.3),
        "friction": {"coefficient": 0.3, "motion": "STEADY_ROLLING", "creepage": (-1e-3, 0.0), "spin": 2e-4},
        "quantities": ("approach", "max_pressure", "tangential_force"),
    }
    # A seal of PTFE on a lathed face, which yields at 60 N/mm2, with the compliance of a film of 0.1 um.
    yield ("rough seal", *rough(4e-4, 0.2)), {
        "mean_pressure": 8.0, "e_star": 600.0, "period": "xy", "pressure_limit": 60.0, "layer": 2e-8,
        "quantities": ("contact_area", "mean_gap"),
    }
    # A gear tooth with crowning, case-hardened, limited by its hardness.
    yield ("gear tooth", *paraboloid(9.0, 2500.0, 1.0, 16.0)), {
        "force": 2500.0, "coating": ((0.4, 84000.0, 0.28), (0.4, 84000.0, 0.28)), "pressure_limit": 4000.0, **steel,
    }
    # The tip of an AFM on 40 nm of polymer on silicon.
    yield ("AFM tip", *paraboloid(20.0, 20.0, 36.0, 36.0)), {
        "force": 5.0, "shear_modulus": (66.0, 66.0), "poisson_ratio": 0.22, "coating": (None, (40.0, 1.0, 0.4)),
    }
    # A crowned roller on its race, black oxide on it, hardness 3 N/mm2 times 10^3.
    yield ("roller bearing", *paraboloid(5.0, 800.0, 0.8, 14.0)), {
        "force": 3000.0, "layer": 5e-9, "pressure_limit": 6000.0, **steel,
    }


def main(picture=None):
    """Runs the example."""
    print(f"{'scene':16}{'without':20}{'changes most':>18}{'by':>10}  at 1 %")
    for (name, *surface), given in scenes():
        wanted = [{"approach": "force"}.get(each, each) for each in given.pop("quantities", ("approach", "max_pressure", "contact_area"))]
        bill = contact_normal.what_matters(*surface, quantities=wanted, **WHOLE, **given)
        for omitted in dict.fromkeys(row.omitted for row in bill):
            rows = [row for row in bill if row.omitted == omitted and row.change == row.change]
            most = max(rows, key=lambda row: abs(row.relative))
            quantity = "approach" if most.quantity == "force" else most.quantity.replace("_", " ")
            verdict = "needed" if omitted[0] in bill.needed else "negligible" if omitted[0] in bill.negligible else "not decided"
            print(f"{name:16}{omitted[0].replace('_', ' '):20}{quantity:>18}{round(most.relative, 3) + 0.0:10.1%}  {verdict}")
        if picture and name == "wheel on rail":
            import matplotlib

            matplotlib.use("Agg")
            axes = bill.plot()
            axes.set_title("Wheel on rail: what 1 % calls for", fontsize=10)
            axes.figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
