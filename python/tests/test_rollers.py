"""Rollers: their gaps in closed form, and the design pressures of their profiles."""

import pickle
import unittest
import warnings

import numpy as np

import contact_normal as cn
from contact_normal import rollers

E_STAR = 210e3 / (2 * (1 - 0.3**2))  # N/mm2; lengths in mm, forces in N.
LENGTH, RADII = 14.0, (6.0, 25.0)


class Gaps(unittest.TestCase):
    def test_circles_are_exact(self):
        gap = rollers.gap((2.0, 10.0), (20, 10), (6.0, -9.0), crown_radii=(100.0, np.inf), tilt=1e-3, units=("mm", "N"))
        x, y = (np.arange(20) - 9.5) * 0.1, np.arange(10) - 4.5
        expected = (6.0 - np.sqrt(36.0 - x**2)) - (9.0 - np.sqrt(81.0 - x**2)) + (100.0 - np.sqrt(1e4 - y[:, None] ** 2)) + 1e-3 * y[:, None]
        np.testing.assert_allclose(gap.h, expected, atol=1e-14 * 100)
        self.assertEqual((gap.dx, gap.dy, gap.units), (0.1, 1.0, ("mm", "N")))
        # There is no surface beyond a roller.
        self.assertTrue(np.isinf(rollers.gap((14.0, 1.0), (14, 1), (6.0,)).h[0, [0, -1]]).all())

    def test_beyond_a_hollow_there_is_no_surface(self):
        gap = rollers.gap((2.0, 20.0), (4, 20), (6.0,), crown_radii=(8.0, -9.0))
        np.testing.assert_array_equal(np.isposinf(gap.h[:, 0]), np.abs(np.arange(20) - 9.5) > 8.0)
        self.assertEqual(rollers.circle(9.5, -9.0), np.inf)
        self.assertTrue(np.isposinf(rollers.gap((20.0, 4.0), (20, 10), (6.0, -6.1)).h[0, [0, -1]]).all())
        with self.assertRaisesRegex(ValueError, "tilt is 2.0; it is an angle in rad"):
            rollers.gap((2.0, 10.0), (20, 10), (6.0,), tilt=2.0)

    def test_profiles(self):
        y = np.array([-8.0, -7.0, -3.0, 0.0, 2.0, 6.5])
        np.testing.assert_array_equal(rollers.no_drop(LENGTH)(y), [np.inf, 0, 0, 0, 0, 0])
        np.testing.assert_allclose(rollers.crown(LENGTH, 500.0, 4.0)(y[1:]), 500.0 - np.sqrt(500.0**2 - np.array([5.0, 1.0, 0.0, 0.0, 4.5]) ** 2), atol=1e-12)
        lundberg = rollers.logarithmic(LENGTH, 9000.0, E_STAR)(y)
        np.testing.assert_array_equal(np.isinf(lundberg), [True, True, False, False, False, False])
        np.testing.assert_allclose(lundberg[2:], 9000.0 / (np.pi * LENGTH * E_STAR) * np.log(1 / (1 - (y[2:] / 7.0) ** 2)), rtol=1e-13)
        np.testing.assert_allclose(rollers.iso_16281(LENGTH, 12.0)(y)[2:], 0.00035 * 12.0 * np.log(1 / (1 - (y[2:] / 7.0) ** 2)), rtol=1e-13)

    def test_the_standard_is_the_profile_of_lundberg_for_3000(self):
        # A roller on a plane: p0^2 = force E*/(pi length radius).
        force = np.pi * LENGTH * 6.0 * 3000.0**2 / E_STAR
        ratio = rollers.iso_16281(LENGTH, 12.0)(np.array([3.0])) / rollers.logarithmic(LENGTH, force, E_STAR)(np.array([3.0]))
        # The standard rounds its factors to two digits.
        self.assertAlmostEqual(ratio[0], 1.0, delta=0.05)

    def test_what_is_no_roller_is_refused(self):
        for wrong, message in (
            (lambda: rollers.gap((1, 1), (4, 4), (6.0, -5.0)), "their curvatures add up to"),
            (lambda: rollers.gap((1, 1), (4, 4), (np.inf,)), "their curvatures add up to 0.0"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), crown_radii=(6.0, -5.0)), r"crown_radii are \(6.0, -5.0\): their curvatures add up to -0.03"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0, np.nan)), r"radii are \(6.0, nan\); none may be 0 or nan"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), tilt=np.nan), "tilt is nan"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), drop=lambda y: np.zeros(3)), r"drop has the shape \(3,\); it must be a number for each of 4 places"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), drop=lambda y: np.where(y > 0.2, np.nan, 0.0)), "drop has nan at y = 0.375"),
            (lambda: rollers.gap((1, 1), (4, 0), (6.0,)), "elements are 4 and 0"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0, 25.0, 3.0)), r"radii are \(6.0, 25.0, 3.0\): two bodies have two radii at most"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), crown_radii=(5.0, 5.0, 5.0)), "crown_radii are .*: two bodies have two radii at most"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), drop=[rollers.no_drop(1.0)] * 3), "drop has 3 functions; two bodies have two at most"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), drop=lambda y: np.full(len(y), -np.inf)), "drop is -inf; it is positive where the roller is thinner"),
            (lambda: rollers.gap((1, 1), (4, 4), (6.0,), drop=lambda y: np.full(len(y), np.inf)), "no element has a surface"),
            (lambda: rollers.gap((0, 1), (4, 4), (6.0,)), r"size\[0\] is 0.0; it must be positive"),
            (lambda: rollers.iso_16281(40.0, 12.0), "lengths of up to 2.5 times the diameter, 30.0"),
            (lambda: rollers.crown(14.0, 500.0, 14.0), "straight is 14.0"),
            (lambda: rollers.logarithmic(14.0, 0.0, E_STAR), "force is 0.0; it must be positive"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                wrong()
        with self.assertRaisesRegex(TypeError, "give either drop or crown_radii"):
            rollers.gap((1, 1), (4, 4), (6.0,), drop=rollers.no_drop(1.0), crown_radii=(5.0,))
        for drop in (0.1, [0.1]):
            with self.assertRaisesRegex(TypeError, "drop has a number; it must be a function of places y"):
                rollers.gap((1, 1), (4, 4), (6.0,), drop=drop)

    def test_a_groove_is_no_bump(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            gap = rollers.gap((1.0, 10.0), (4, 20), (6.0,), drop=lambda y: np.where(np.abs(y) < 1.0, np.inf, 0.0))
        self.assertEqual(np.isinf(gap.h).sum(), 4 * 4)

    def test_drops_go_to_other_processes(self):
        y = np.linspace(-8.0, 8.0, 33)
        for drop in (rollers.no_drop(LENGTH), rollers.crown(LENGTH, 500.0, 4.0), rollers.logarithmic(LENGTH, 9000.0, E_STAR), rollers.iso_16281(LENGTH, 12.0)):
            again = pickle.loads(pickle.dumps(drop))
            np.testing.assert_array_equal(again(y), drop(y))
            self.assertEqual(again.half, 0.5 * LENGTH)

    def test_units_are_a_pair_of_names(self):
        for units, kind, text in (("mm", TypeError, "units is 'mm'; it must be a pair"), (("N", "mm"), ValueError, "the first is that of lengths")):
            with self.assertRaisesRegex(kind, text):
                rollers.gap((1, 1), (4, 4), (6.0,), units=units)

    def test_a_radius_of_zero_is_refused(self):
        for name, radii, crown in (("radii", (0.0, 1.0), ()), ("radii", (np.inf, -0.0), ()), ("crown_radii", (6.0, 5.0), (1.0, 0.0))):
            with self.assertRaisesRegex(ValueError, f"{name} are .*none may be 0"):
                rollers.gap((1.0, 1.0), (4, 4), radii, crown_radii=crown)


class Pressures(unittest.TestCase):
    FORCE = 9000.0
    LINE = np.sqrt(FORCE / LENGTH * E_STAR / np.pi * (1 / RADII[0] + 1 / RADII[1]))

    def along(self, drop, elements=(48, 56)):
        result = rollers.gap((1.2, LENGTH), elements, RADII, drop=drop).solve(force=self.FORCE, e_star=E_STAR)
        self.assertEqual(result.status, cn.OK)
        return result.pressure.max(axis=1)

    def test_lundbergs_profile_has_even_pressures(self):
        p = self.along(rollers.logarithmic(LENGTH, self.FORCE, E_STAR))
        # The middle half has the pressure of Hertz' line contact. With 24 elements per half-width the error is 0.2 %.
        np.testing.assert_allclose(p[14:42], self.LINE, rtol=2e-3)
        # Elsewhere the pressure is at most a few per cent larger, except in the last two rows, where the drop is unbounded.
        self.assertLess(p.max() / self.LINE, 1.03)

    def test_moduli_of_another_system_of_units_are_told(self):
        with self.assertWarnsRegex(UserWarning, r"the drop is \S+ ln\(.*force, length and e_star must be in one system of units"):
            rollers.logarithmic(LENGTH, 9000.0, 1e-3 * E_STAR)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            rollers.logarithmic(2.0, 3000.0, E_STAR)

    def test_a_grid_that_ends_within_the_roller_is_told(self):
        log = rollers.logarithmic(LENGTH, 9000.0, E_STAR)
        for size, drop in (((1.2, 10.0), log), ((1.2e-3, 14e-3), log), ((1.2, 12.0), [rollers.no_drop(LENGTH), rollers.no_drop(20.0)]),
                           ((1.2, 10.0), rollers.crown(LENGTH, 1000.0, 8.0)), ((1.2, LENGTH), rollers.iso_16281(24.0, 12.0))):
            with self.subTest(size), self.assertWarnsRegex(UserWarning, "the grid is .* long in y, and the roller .*: nothing touches beyond the grid"):
                rollers.gap(size, (48, 56), tuple(1e-3 * r if size[0] < 1.0 else r for r in RADII), drop=drop)
        with self.assertWarnsRegex(UserWarning, "radius is 1, and the crowned part is 3 long .* in one unit"):
            rollers.crown(LENGTH, 1.0, 8.0)
        with self.assertWarnsRegex(UserWarning, r"the drop at the ends is -0\.00\S+ beside the middle: it is positive where the roller is thinner"):
            rollers.gap((1.2, LENGTH), (48, 56), RADII, drop=lambda y: -0.005 * (y / 7.0) ** 2)
        # A force in kN, or E* in Pa, with lengths in mm.
        for force, e_star in ((9.0, E_STAR), (9000.0, 1e6 * E_STAR)):
            with self.assertWarnsRegex(UserWarning, "must be in one system of units"):
                rollers.logarithmic(LENGTH, force, e_star)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            rollers.gap((1.2, LENGTH), (48, 56), RADII, drop=log)
            rollers.gap((1.2, 20.0), (48, 80), RADII, drop=log, tilt=1e-3)
            rollers.gap((1.2, LENGTH), (48, 56), RADII, drop=[log, rollers.no_drop(40.0)])
            # No warning: the contact of a ball is far from the ends of the crown.
            rollers.gap((0.6, 0.6), (60, 60), (8.0,), drop=rollers.crown(16.0, 8.0))

    def test_sharp_ends_and_crowns_do_not(self):
        sharp = self.along(rollers.no_drop(LENGTH))
        self.assertGreater(sharp[0] / self.LINE, 1.4)
        crowned = self.along(rollers.crown(LENGTH, 500.0))
        self.assertEqual(crowned[0], 0.0)
        self.assertGreater(crowned[28] / self.LINE, 1.15)

    def test_a_crowned_contact_is_that_of_hertz(self):
        gap = rollers.gap((0.6, 0.6), (60, 60), (8.0, -24.0), crown_radii=(12.0,))
        # 1/8 - 1/24 = 1/12: equivalent to a ball of 12 mm.
        radius = 0.2
        force = radius**3 / 12.0 * E_STAR / 0.75
        result = gap.solve(force=force, e_star=E_STAR)
        # The errors: 20 elements per radius, and circles that differ from parabolas by (0.2/8)^2/4.
        self.assertAlmostEqual(result.max_pressure / (1.5 * force / (np.pi * radius**2)), 1.0, delta=5e-3)
        self.assertAlmostEqual(result.approach / (radius**2 / 12.0), 1.0, delta=5e-3)
