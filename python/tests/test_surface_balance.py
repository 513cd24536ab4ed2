"""Rough bodies under light loads rest on a few elements."""

import unittest
from unittest import mock

import numpy as np
from test_surface import rough

import contact_normal as cn
from contact_normal import surface
from contact_normal.surface._rest import resting


class LightLoads(unittest.TestCase):
    def test_elements_in_an_askew_line_are_balanced(self):
        h = np.full((20, 18), np.inf)
        h[15, 6], h[16, 7] = 0.0, 0.1
        at = (0.25 * (6.5 - 8.5), 2.0 * (15.5 - 9.5))
        found = surface.balance(surface.Gap(h, 0.25, 2.0), 1.0, at=at, e_star=1.0)
        np.testing.assert_allclose(found.centre, at, atol=1e-3)
        # Balls on elements of any size are balanced, too.
        for dy in (1e-6, 1e6):
            y, x = np.indices((9, 9)) - 4.0
            ball = surface.Gap(0.01 * (x**2 + y**2) + 0.002 * x, 1.0, dy)
            centre = surface.balance(ball, 1.0, e_star=1.0 / dy, at=(0.3, 0.2 * dy)).centre
            np.testing.assert_allclose(centre / np.array([1.0, dy]), [0.3, 0.2], atol=1e-2)

    def test_rough_bodies_are_balanced(self):
        for seed in range(6):
            made = surface.heights(0.2e-6 * rough(64, seed), 1e-6, 1e-6)
            gap = surface.gap(surface.level(made))
            for mean_pressure in (1e7, 1e6, 1e5, 1e4, 1e2, 1.0):
                with mock.patch.object(surface.Gap, "solve", autospec=True, side_effect=surface.Gap.solve) as solve:
                    found = surface.balance(gap, made.force(mean_pressure), e_star=115e9)
                self.assertEqual(found.result.status, cn.OK)
                np.testing.assert_allclose(found.centre, 0.0, atol=64e-6 * 1e-4)
                self.assertLess(solve.call_count, 60, (seed, mean_pressure))

    def test_a_search_that_leads_nowhere_is_begun_once_more(self):
        made = surface.heights(0.2e-6 * rough(64, 2), 1e-6, 1e-6)
        gap, begun = surface.gap(surface.level(made)), []

        def resting_at(*given):
            begun.append(resting(*given))
            return begun[-1]

        with mock.patch("contact_normal.surface._pair.resting", resting_at):
            found = surface.balance(gap, made.force(1e4), e_star=115e9)
            self.assertEqual(len(begun), 1)
            np.testing.assert_allclose(found.tilt, begun[0], atol=1e-3)
            with self.assertRaisesRegex(ValueError, "are there elements all around it"):
                surface.balance(gap, made.force(1e4), at=(40e-6, 0.0), e_star=115e9)
        self.assertIsNone(begun[1])


class Rests(unittest.TestCase):
    def test_three_elements_carry_a_rigid_body(self):
        rng = np.random.default_rng(3)
        for shape in ((1, 30), (30, 1), (2, 2), (24, 36)):
            for _ in range(10):
                h = rng.random(shape)
                h[rng.random(shape) < 0.1] = np.inf
                gap = surface.Gap(h, 0.5, 0.25)
                iy, ix = np.nonzero(np.isfinite(h))
                inside = rng.random(len(ix))
                aim = np.array([inside @ gap.x[ix], inside @ gap.y[iy]]) / inside.sum()
                slopes = resting(gap, aim)
                if slopes is None:
                    # The elements are in one line across the grid, or there is only one.
                    self.assertLess(len(ix), 4)
                    continue
                below = (h - slopes[0] * (gap.x - aim[0]) - slopes[1] * (gap.y[:, None] - aim[1]))[iy, ix]
                on = np.flatnonzero(below < below.min() + 1e-9)
                # The aim must be a mean of the places of the elements that carry the body, with non-negative weights.
                places = np.stack([gap.x[ix[on]] - aim[0], gap.y[iy[on]] - aim[1], np.ones(len(on))])
                weights = np.linalg.lstsq(places, [0.0, 0.0, 1.0], rcond=None)[0]
                np.testing.assert_allclose(places @ weights, [0.0, 0.0, 1.0], atol=1e-9)
                self.assertGreaterEqual(weights.min(), -1e-9)

    def test_nothing_rests_beside_its_elements(self):
        gap = surface.Gap(np.zeros((4, 4)), 1.0, 1.0)
        self.assertIsNone(resting(gap, np.array([1.6, 0.0])))
        np.testing.assert_allclose(resting(gap, np.array([1.4, 1.4])), 0.0, atol=1e-12)
        self.assertIsNone(resting(surface.Gap(np.zeros((1, 1)), 1.0, 1.0), np.zeros(2)))


if __name__ == "__main__":
    unittest.main()
