"""Warnings of results, and time limits."""

import pickle
import unittest

import numpy as np

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
X = (np.arange(32) - 15.5) * 0.1
BALL = 0.02 * (X[None, :] ** 2 + X[:, None] ** 2)


class Warnings(unittest.TestCase):
    def test_a_contact_that_is_resolved_has_none(self) -> None:
        result = cn.solve(BALL, 0.1, 0.1, force=100.0, **STEEL)
        self.assertEqual((result.warnings, result.message), ((), ""))
        self.assertNotIn("warnings", repr(result))

    def test_one_element_in_contact(self) -> None:
        h = BALL.copy()
        h[16, 16] -= 1e-3
        result = cn.solve(h, 0.1, 0.1, force=1e-3, **STEEL)
        self.assertEqual((result.status, result.warnings), (cn.OK, ("ONE_ELEMENT", "ERROR_UNKNOWN")))
        self.assertIn("one element is in contact", result.message)
        self.assertIn("ONE_ELEMENT", repr(result))
        self.assertEqual(result.report["warnings"], cn.WARNING_ONE_ELEMENT | cn.WARNING_ERROR_UNKNOWN)

    def test_a_contact_of_few_elements(self) -> None:
        # The half-width of the contact is 0.025: 0.25 elements of 0.1, or four of 0.006.
        for d, ends in ((0.1, "x"), (0.006, None)):
            x = (np.arange(31) - 15.0) * d
            line = np.tile(0.5 * x**2 / 25.0, (8, 1))
            found = cn.solve(line, d, 1.0, force=8.0 * np.pi * 115385.0 * 0.025**2 / 100.0, e_star=115385.0, period="y")
            self.assertEqual("NARROW" in found.warnings, ends is not None)
            self.assertRegex(found.message, "contact is at most 2 elements wide in x: take smaller" if ends else "^((?!wide in).)*$")
            self.assertEqual(pickle.loads(pickle.dumps(found)).warnings, found.warnings)
        # With moduli in Pa and lengths in mm only four elements of the ball are in contact.
        found = cn.solve(BALL, 0.1, 0.1, force=100.0, shear_modulus=82e9, poisson_ratio=0.28)
        self.assertIn("wide in x and y", found.message)
        # No warning: the contact of a punch of two columns is as wide as the punch, and a grid of two columns has no others.
        punch = np.where(np.abs(X[None, :]) < 0.1, 0.0, np.inf) + 0.0 * X[:, None]
        for h in (punch, np.zeros((32, 2))):
            self.assertNotIn("NARROW", cn.solve(h, 0.1, 0.1, force=100.0, **STEEL).warnings)

    def test_contact_at_the_border(self) -> None:
        self.assertIn("BORDER", cn.solve(BALL, 0.1, 0.1, force=1e6, **STEEL).warnings)
        for h, given, ends in ((BALL, {}, "x and y"), (BALL[:12], {}, "y"), (BALL[:, 20:], {}, "x"), (BALL, {"period": "x"}, "y")):
            force = 3e3 if ends != "x and y" and not given else 1e5
            message = cn.solve(h, 0.1, 0.1, force=force, **given, **STEEL).message
            self.assertRegex(message, f"contact is at the ends of the grid in {ends}(\n|$)")

    def test_strains_that_are_not_small(self) -> None:
        # Hertz: the largest pressure is 2 a/(pi R) E*, with R = 25 and a^3 = 3/4 F R/E*.
        e_star = 1.0 / (2.0 * (1.0 - 0.28) / (2.0 * 82000.0))
        for part, is_told in ((0.19, False), (0.21, True)):
            radius = 25.0 * np.pi * part / 2.0
            x = (np.arange(64) - 31.5) * (radius / 25.0)
            ball = (x[None, :] ** 2 + x[:, None] ** 2) / 50.0
            result = cn.solve(ball, radius / 25.0, radius / 25.0, force=4.0 / 3.0 * e_star * radius**3 / 25.0, **STEEL)
            self.assertAlmostEqual(result.max_pressure / e_star, part, delta=0.002)
            self.assertEqual("STRAIN" in result.warnings, is_told)
        self.assertRegex(result.message, r"the largest pressure is 0\.21 E\*, and linear elasticity is for small strains: .* in one system of units")
        self.assertEqual(pickle.loads(pickle.dumps(result)).warnings, result.warnings)
        # With moduli in GPa, forces in N and lengths in mm strains are large.
        self.assertIn("STRAIN", cn.solve(BALL, 0.1, 0.1, force=100.0, shear_modulus=82.0, poisson_ratio=0.28).warnings)

    def test_moduli_of_no_solid_in_the_units_that_are_named(self) -> None:
        # E* of steel on steel is 115 GPa.
        for modulus, units, told in ((82e9, ("m", "N"), None), (82e3, ("m", "N"), None), (82.0, ("m", "N"), "114 Pa in the units"), (82e3, ("mm", "N"), None),
                                     (82e9, ("mm", "N"), r"1\.14e\+17 Pa"), (82.0, ("um", "mN"), None), (82e9, ("furlong", "N"), None), (82e9, None, None)):
            result = cn.solve(BALL, 0.1, 0.1, approach=1e-3, shear_modulus=modulus, poisson_ratio=0.28, units=units)
            self.assertEqual("MODULUS" in result.warnings, told is not None)
            self.assertRegex(result.message, rf"E\* is {told}" if told else "^((?!E\\* is).)*$")
            self.assertEqual(pickle.loads(pickle.dumps(result)).warnings, result.warnings)

    def test_coated_bodies_have_no_modulus_of_their_own(self) -> None:
        # Gel on steel, and steel on gel.
        given = {"approach": 1e-3, "units": ("m", "N"), "poisson_ratio": 0.28}
        for below, coating, told in ((82.0, (5.0, 82e4, 0.3), ()), (82.0, None, ("MODULUS",))):
            result = cn.solve(BALL, 0.1, 0.1, shear_modulus=below, coating=(coating, None), **given)
            self.assertEqual(tuple(name for name in result.warnings if name in ("MODULUS", "STRAIN")), told)

    def test_tangential_problems_tell_of_a_law(self) -> None:
        law = {"kind": "LINEAR", "kinetic": 0.1, "falling": 0.2, "half_speed": 1e-6, "speed": 1.0, "memory_distance": 1e-9, "memory_speed": 1e-9}
        friction = {"coefficient": 0.3, "motion": "STEADY_ROLLING", "law": law, "creepage": (1e-4, 0.0)}
        pressure = cn.solve(BALL, 0.1, 0.1, force=100.0, **STEEL).pressure
        found = cn.solve_tangential(pressure, 0.1, 0.1, friction=friction, **STEEL)
        self.assertEqual((found.status, found.warnings), (cn.OK, ("LAW",)))
        self.assertIn("friction falls so steeply", found.message)
        batch = cn.friction_batch(None, 0.1, 0.1, [(1e-4, 0.0, 0.0)], pressure=pressure, friction=friction, **STEEL)
        self.assertEqual(batch.status[0], cn.OK)
        self.assertTrue(batch.report["warnings"] & cn.WARNING_LAW)
        self.assertIn("friction falls so steeply", batch.message)

    def test_a_limit_of_time(self) -> None:
        result = cn.solve(BALL, 0.1, 0.1, force=100.0, max_seconds=1e-9, tolerance=1e-14, method="NORM", **STEEL)
        self.assertEqual(result.status, cn.ITERATION_LIMIT)
        self.assertIn("max_seconds was reached", result.message)


if __name__ == "__main__":
    unittest.main()
