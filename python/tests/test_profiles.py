"""From two profiles to a gap: profiles of lines and arcs, whose contact is known in closed form."""

import time
import unittest
import warnings
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal import profiles
from contact_normal.surface import Gap

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
# A conical tread, and a head of one arc between two flanks. Lengths in mm.
CONE, HEAD, RADIUS = 1.0 / 20.0, 300.0, 460.0
# The error of cubic splines, 5/384 d^4 f'''' with f'''' = 3/HEAD^3 and points d = 0.5 apart, is 1e-10; with a margin of a hundred:
EXACT = 1e-8


def wheel(cone=CONE):
    """A tread with one slope from y = -35 to 60, with a flange of 65 degrees and a rounded tip."""
    tread = np.linspace(-35.0, 60.0, 191)
    y, z = [tread], [-cone * tread]
    flank = np.linspace(-46.0, -35.5, 40)
    y.insert(0, flank)
    z.insert(0, cone * 35.0 + np.tan(np.deg2rad(65.0)) * (-35.0 - flank))
    tip = np.linspace(-70.0, -46.5, 40)
    y.insert(0, tip)
    z.insert(0, z[0][0] + 0.5 - 0.05 * (tip + 54.0) ** 2)
    return profiles.Profile(np.concatenate(y), np.concatenate(z), "wheel", "a cone")


def rail(head=HEAD, reach=36.0, inner=None):
    """A head of one arc, or with another one towards the track."""
    y = np.linspace(-reach, reach, int(4 * reach) + 1)
    heads = np.where(y < 0.0, head if inner is None else inner, head)
    z = heads - np.sqrt(heads**2 - y**2)
    down = np.linspace(40.0, z[0] + 0.5, 60)
    # Flanks of 20:1, from 40 mm below the top.
    other = np.linspace(40.0, z[-1] + 0.5, 60)
    sides = -reach - (down - z[0]) / 20.0, (reach + (other - z[-1]) / 20.0)[::-1]
    return profiles.Profile(np.concatenate([sides[0], y, sides[1]]), np.concatenate([down, z, other[::-1]]), "rail", "an arc")


TRACK, WHEELSET = profiles.Track(rail()), profiles.Wheelset(wheel(), RADIUS, flange_back=1360.0)
# The gauge point is on the flank, 14 mm below the top; the head is symmetric about MIDDLE.
ARC_END = HEAD - np.sqrt(HEAD**2 - 36.0**2)
MIDDLE = 717.5 + 36.0 + (14.0 - ARC_END) / 20.0


def rotation(roll, yaw):
    roll = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    return np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]]) @ roll


class Contact(unittest.TestCase):
    def test_a_cone_touches_an_arc_where_their_slopes_agree(self):
        point = profiles.contact_points(TRACK, WHEELSET)[0]
        gamma = np.arctan(CONE)
        x, y, z = point.place
        # The place of contact is that of a minimum, known to the square root of the round-off of z.
        self.assertAlmostEqual(point.angle, gamma, delta=1e-5 / HEAD)
        self.assertAlmostEqual(x, 0.0, delta=1e-5)
        self.assertAlmostEqual(y, MIDDLE - HEAD * np.sin(gamma), delta=1e-5)
        self.assertAlmostEqual(z, HEAD * (1.0 - np.cos(gamma)), delta=1e-6)
        self.assertEqual(WHEELSET.origin, 750.0)
        radius = RADIUS - CONE * (y - 750.0)
        self.assertAlmostEqual(point.rolling_radius, radius, delta=1e-6)
        # The axle is lowered until the wheel touches at this place.
        self.assertAlmostEqual(point.position.z, z - radius + RADIUS, delta=1e-6)
        self.assertAlmostEqual(point.clearance, 0.0, delta=1e-10)

    def test_the_distance_is_that_of_a_cone_and_an_arc(self):
        for position in (profiles.Position(), profiles.Position(2.0, None, 1e-3, 5e-3), profiles.Position(-3.0, 0.1, -2e-3, -0.02)):
            point = profiles.contact_points(TRACK, WHEELSET, position)[0]
            x, y = np.linspace(-9.0, 9.0, 7), np.linspace(-6.0, 6.0, 5)
            found = point.distance(x, y)
            place, c, s = np.array(point.place), np.cos(point.angle), np.sin(point.angle)
            along, normal = np.array([0.0, c, -s]), np.array([0.0, -s, -c])
            stands = point.position
            turned = rotation(stands.roll, stands.yaw)
            axle = np.array([0.0, stands.y, stands.z - RADIUS])
            for iy, at in enumerate(y):
                # The arc below the plane: the circle around its own middle.
                middle = np.array([0.0, MIDDLE, HEAD]) - place
                from_middle = np.array([at * along[1] - middle[1], at * along[2] - middle[2]])
                half = from_middle @ normal[1:]
                on_rail = -half + np.sqrt(half**2 - from_middle @ from_middle + HEAD**2)
                for ix, ahead in enumerate(x):
                    # The cone: b_x^2 + b_z^2 = (RADIUS - CONE (b_y - 750))^2 along the normal, a quadratic equation.
                    base, step = (place + ahead * np.array([1.0, 0.0, 0.0]) + at * along - axle) @ turned, normal @ turned
                    radius, change = RADIUS - CONE * (base[1] - 750.0), -CONE * step[1]
                    equation = [step[0] ** 2 + step[2] ** 2 - change**2, 2 * (base[0] * step[0] + base[2] * step[2] - radius * change),
                                base[0] ** 2 + base[2] ** 2 - radius**2]
                    on_wheel = min(np.roots(equation), key=abs)
                    self.assertAlmostEqual(found[iy, ix], on_wheel - on_rail, delta=EXACT)

    def test_a_rolled_and_yawed_wheelset_touches_where_a_search_finds_it(self):
        position = profiles.Position(1.5, None, 2e-3, 0.03)
        point = profiles.contact_points(TRACK, WHEELSET, position)[0]
        y, theta = np.meshgrid(np.linspace(715.0, 800.0, 1701), np.linspace(-0.05, 0.05, 1001))
        radius = RADIUS - CONE * (y - 750.0)
        places = rotation(position.roll, position.yaw) @ np.stack([radius * np.sin(theta), y, radius * np.cos(theta)]).reshape(3, -1)
        x, y, z = places[0], places[1] + position.y, places[2] - RADIUS
        clearance = HEAD - np.sqrt(np.maximum(HEAD**2 - (y - MIDDLE) ** 2, 0.0)) - z
        least = clearance.argmin()
        # The test's search has steps of 0.05 mm. The place has this error, and the clearance its square over two radii.
        self.assertAlmostEqual(point.position.z, clearance[least], delta=0.05**2 / (2 * HEAD) + 0.05**2 / (2 * RADIUS))
        self.assertAlmostEqual(point.place[0], x[least], delta=0.3)
        self.assertAlmostEqual(point.place[1], y[least], delta=0.3)
        self.assertGreater(abs(x[least]), 5.0)

    def test_left_and_right_are_mirror_images(self):
        left = profiles.contact_points(TRACK, WHEELSET, profiles.Position(1.5, None, 2e-3, 0.03), "left")[0]
        right = profiles.contact_points(TRACK, WHEELSET, profiles.Position(-1.5, None, -2e-3, -0.03), "right")[0]
        np.testing.assert_allclose(left.place, np.array(right.place) * [1, -1, 1], atol=1e-12)
        self.assertEqual(left.angle, right.angle)
        self.assertEqual(left.position, profiles.Position(1.5, right.position.z, 2e-3, 0.03))
        np.testing.assert_array_equal(left.distance([0.0, 1.0], [2.0]), right.distance([0.0, 1.0], [2.0]))

    def test_a_settled_wheelset_touches_on_both_sides(self):
        self.assertEqual(profiles.settled(TRACK, WHEELSET).roll, 0.0)
        stands = profiles.settled(TRACK, WHEELSET, y=3.0, yaw=0.01)
        self.assertNotEqual(stands.roll, 0.0)
        for side in ("left", "right"):
            # The clearance is 0 up to a few times 2^-52 of the distance of the wheels.
            self.assertAlmostEqual(profiles.contact_points(TRACK, WHEELSET, stands, side)[0].clearance, 0.0, delta=1e-10)

    def test_a_second_place_is_told(self):
        # Two heads side by side, both in contact with the tread.
        y = np.linspace(-36.0, 36.0, 577)
        head = np.where(y < 0, 40.0 - np.sqrt(np.maximum(40.0**2 - (y + 18.0) ** 2, 0.0)), 40.0 - np.sqrt(np.maximum(40.0**2 - (y - 18.0) ** 2, 0.0)))
        plain = rail()
        flank = plain.z > ARC_END + 0.4
        lifted = plain.z[flank] - ARC_END + head[0]
        low, high = plain.y[flank] < 0, plain.y[flank] > 0
        double = profiles.Profile(np.concatenate([plain.y[flank][low], y, plain.y[flank][high]]),
                                  np.concatenate([lifted[low], head + 0.04 * (y > 0), lifted[high]]), "rail")
        flat = profiles.Wheelset(wheel(cone=0.0), RADIUS)
        both = profiles.contact_points(profiles.Track(double), flat, within=0.1)
        self.assertEqual(len(both), 2)
        self.assertAlmostEqual(both[1].clearance, 0.04, delta=1e-4)
        self.assertAlmostEqual(both[1].place[1] - both[0].place[1], 36.0, delta=0.2)
        self.assertEqual(len(profiles.contact_points(profiles.Track(double), flat)), 1)
        # A load whose approach of 0.047 mm would reach the other head has a warning. A light load has none.
        with self.assertWarnsRegex(UserWarning, r"also touches the rail 36\.\d mm beside this patch, where it is 0\.04\d* mm farther off"):
            both[0].press(20e3, 0.4, 0.4, **STEEL)
        with self.assertWarnsRegex(UserWarning, r"also touches the rail -3\d\.\d mm beside this patch"):
            both[1].press(1e3, 0.4, 0.4, **STEEL)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            pressed = both[0].press(5e3, 0.4, 0.4, **STEEL)
        with self.assertRaisesRegex(TypeError, r"gap, result = point.press\("):
            both[0].force_on_wheel(pressed)

    def test_a_wheel_beside_its_rail_is_refused(self):
        with self.assertRaisesRegex(ValueError, "the right wheel is nowhere above its rail"):
            profiles.contact_points(TRACK, WHEELSET, profiles.Position(400.0))
        with self.assertRaisesRegex(ValueError, "one wheel is nowhere above"):
            profiles.settled(TRACK, WHEELSET, y=400.0)
        with self.assertRaisesRegex(ValueError, "side is 'both'"):
            profiles.contact_points(TRACK, WHEELSET, side="both")


class Loaded(unittest.TestCase):
    # A cylinder on an arc of its own radius is a ball on a plane.
    TRACK, WHEELSET = profiles.Track(rail(RADIUS)), profiles.Wheelset(wheel(0.0), RADIUS)

    def test_a_round_contact_is_that_of_hertz(self):
        point = profiles.contact_points(self.TRACK, self.WHEELSET)[0]
        force, e_star = 10e3, STEEL["shear_modulus"] / (1 - STEEL["poisson_ratio"])
        radius = (0.75 * force * RADIUS / e_star) ** (1 / 3)
        gap, result = point.press(force, 0.1 * radius, 0.1 * radius, **STEEL)
        self.assertEqual(result.status, cn.OK)
        # With 10 elements per radius the relative errors of approach and pressure are (1/10)^2.
        self.assertAlmostEqual(result.approach / (radius**2 / RADIUS), 1.0, delta=0.01)
        self.assertAlmostEqual(result.max_pressure / (1.5 * force / (np.pi * radius**2)), 1.0, delta=0.01)
        # No place that is nearer than the approach is left out.
        border = np.concatenate([gap.h[[0, -1]].ravel(), gap.h[:, [0, -1]].ravel()])
        self.assertGreater(border.min(), result.approach)
        self.assertEqual(result.warnings, ())

    def test_a_position_that_overlaps_gives_the_same_pressures(self):
        touching = profiles.contact_points(self.TRACK, self.WHEELSET)[0]
        lower = profiles.Position(z=touching.position.z + 0.02)
        overlapping = profiles.contact_points(self.TRACK, self.WHEELSET, lower)[0]
        self.assertAlmostEqual(overlapping.clearance, -0.02, delta=1e-9)
        (gap, result), (other_gap, other) = (point.press(10e3, 0.3, 0.3, **STEEL) for point in (touching, overlapping))
        self.assertEqual(gap.h.shape, other_gap.h.shape)
        self.assertAlmostEqual(other_gap.h.min(), -0.02, delta=1e-6)
        # A cylinder of 460 mm that is lowered by 0.02 mm has the same shape to 5e-5.
        self.assertAlmostEqual(other.max_pressure / result.max_pressure, 1.0, delta=2e-4)
        self.assertAlmostEqual(other.approach + 0.02, result.approach, delta=1e-5)
        # If the position is given, a further approach of 0 means the overlap itself.
        by_position = overlapping.gap(0.3, 0.3, 0.02).solve(approach=0.0, **STEEL)
        by_approach = touching.gap(0.3, 0.3, 0.02).solve(approach=0.02, **STEEL)
        self.assertAlmostEqual(by_position.force / by_approach.force, 1.0, delta=1e-3)

    def test_a_press_that_is_cancelled_ends(self):
        point, friction = profiles.contact_points(self.TRACK, self.WHEELSET)[0], {"coefficient": 0.3}
        for beside in ({}, {"friction": friction}):
            calls = []

            def once(_, calls=calls):
                calls.append(1)
                return len(calls) == 1

            self.assertEqual(point.press(10e3, 0.3, 0.3, progress=once, **beside, **STEEL)[1].status, cn.CANCELLED)
            self.assertEqual(len(calls), 1)

    def test_a_press_that_is_cancelled_ends_whatever_its_solve_says(self):
        point, told = profiles.contact_points(self.TRACK, self.WHEELSET)[0], []

        def solve(gap, progress, **scene):
            result = solved(gap, **scene)
            told.append(progress(None))
            return result

        solved = Gap.solve
        for given, status in (({}, cn.CANCELLED), ({"max_cycles": 1, "method": "NORM"}, cn.ITERATION_LIMIT)):
            told.clear()
            with mock.patch.object(Gap, "solve", solve):
                result = point.press(10e3, 0.3, 0.3, progress=lambda _: 1, friction={"coefficient": 0.3}, **given, **STEEL)[1]
            self.assertEqual((result.status, told), (status, [True]))
            self.assertEqual(result.message.startswith("the progress callback cancelled"), status == cn.CANCELLED)

    def test_a_limit_of_time_is_that_of_all_solves(self):
        point = profiles.contact_points(self.TRACK, self.WHEELSET)[0]
        given = []

        def solve(gap, **scene):
            given.append(scene["max_seconds"])
            time.sleep(0.01)
            return solved(gap, **{**scene, "max_seconds": 0.0})

        solved = Gap.solve
        with mock.patch.object(Gap, "solve", solve):
            point.press(10e3, 0.3, 0.3, max_seconds=100.0, friction={"coefficient": 0.3}, **STEEL)
            seconds = np.array(given)
            self.assertGreater(len(given), 1)
            self.assertLess(np.diff(seconds).max(), -0.009)
            # If no time is left, the last complete solve is the result: on a grid that is too small or too large, or without friction.
            approach = 0.02111
            for depth, friction, why in ((0.5 * approach, None, "on a grid for an approach of 0.0106 mm; the approach is 0.02"),
                                         (2.0 * approach, None, "on a grid for an approach of 0.0422 mm; the approach is 0.0211 mm"),
                                         (1.2 * approach, {"coefficient": 0.3}, "before friction was solved")):
                given.clear()
                gap, result = point.press(10e3, 0.3, 0.3, depth=depth, friction=friction, max_seconds=0.005, **STEEL)
                self.assertEqual((len(given), result.status), (1, cn.ITERATION_LIMIT))
                self.assertTrue(result.message.startswith(f"max_seconds was reached {why}"), result.message)
                self.assertAlmostEqual(result.force, 10e3, delta=1.0)
                self.assertEqual(result.pressure.shape, gap.h.shape)
                self.assertFalse(result.traction.any())
            given.clear()
            self.assertEqual(point.press(10e3, 0.3, 0.3, depth=1.2 * approach, max_seconds=0.005, **STEEL)[1].status, cn.OK)
        self.assertIn("max_seconds was reached", point.press(10e3, 0.3, 0.3, max_seconds=1e-9, **STEEL)[1].message)

    def test_the_grid_of_a_press_with_a_pressure_limit_is_large_enough(self):
        point = profiles.contact_points(TRACK, WHEELSET)[0]
        free = point.press(3e4, 0.5, 0.5, **STEEL)[1]
        limit = 0.6 * float(free.pressure.max())
        _, first = point.press(3e4, 0.5, 0.5, depth=1e-3, pressure_limit=limit, **STEEL)
        _, wide = point.press(3e4, 0.5, 0.5, depth=0.2, pressure_limit=limit, **STEEL)
        self.assertEqual((first.status, wide.status), (0, 0))
        self.assertLess(abs(first.approach / wide.approach - 1.0), 0.01)
        with self.assertRaises(cn.ContactNormalError):
            point.press(3e4, 2.0, 2.0, pressure_limit=1e-3, **STEEL)

    def test_a_grid_that_cannot_be_large_enough_is_refused(self):
        point = profiles.contact_points(self.TRACK, self.WHEELSET)[0]
        with self.assertRaisesRegex(ValueError, "the grid would need more than 2048 elements"):
            point.gap(1e-4, 1e-4, 1.0)
        with self.assertRaisesRegex(ValueError, "dx is inf; it must be positive and finite"):
            point.gap(np.inf, 0.1, 1.0)
        with self.assertRaisesRegex(ValueError, "depth is 0.0; it must be positive"):
            point.gap(0.1, 0.1, 0.0)

    def test_a_wheel_that_turns_fast_is_pushed_forward(self):
        # The contact is on two arcs, near their common end, so that the middle of the patch is not the contact point.
        point = profiles.contact_points(profiles.Track(rail(inner=80.0)), profiles.Wheelset(wheel(1.0 / 200.0)))[0]
        free = 30e3 / point.rolling_radius
        xi, eta, phi = point.creepages(30e3, pitch_rate=1.001 * free)
        friction = {"coefficient": 0.3, "motion": "STEADY_ROLLING", "creepage": (xi, eta), "spin": phi}
        gap, result = point.press(10e3, 0.4, 0.4, friction=friction, **STEEL)
        self.assertEqual(result.status, cn.OK)
        forward, right, down = point.force_on_wheel(result)
        self.assertGreater(forward, 0.0)
        fx, fy = result.tangential_force
        self.assertEqual(forward, fx)
        c, s = np.cos(point.angle), np.sin(point.angle)
        self.assertAlmostEqual(right, c * fy - s * 10e3, delta=1e-6)
        self.assertAlmostEqual(down, -s * fy - c * 10e3, delta=1e-6)
        # The spin is about the contact point, not about the middle of the grid.
        again = gap.solve(force=10e3, friction={**friction, "spin_centre": (-gap.middle[0], -gap.middle[1])}, **STEEL)
        self.assertEqual(again.tangential_force, result.tangential_force)
        # The left side has the mirrored force.
        left = profiles.contact_points(profiles.Track(rail(inner=80.0)), profiles.Wheelset(wheel(1.0 / 200.0)), side="left")[0]
        self.assertEqual(left.force_on_wheel(result), (forward, -right, down))
        # The coordinates of the result are those of the gap, relative to the contact point.
        self.assertNotEqual(gap.middle[1], 0.0)
        np.testing.assert_array_equal(result.y, gap.y)
        self.assertLess(np.abs(gap.y).min(), 1e-9)


class Creepages(unittest.TestCase):
    def test_a_speed_in_metres_is_told(self):
        point = profiles.contact_points(TRACK, WHEELSET)[0]
        with self.assertWarnsRegex(UserWarning, "speeds are in mm/s"):
            point.creepages(30.0, pitch_rate=65.0)

    def test_of_a_cone_that_rolls_straight_ahead(self):
        point = profiles.contact_points(TRACK, WHEELSET)[0]
        xi, eta, phi = point.creepages(20e3)
        gamma = np.arctan(CONE)
        self.assertAlmostEqual(xi, 1.0 - point.rolling_radius / RADIUS, delta=1e-12)
        self.assertAlmostEqual(eta, 0.0, delta=1e-12)
        self.assertAlmostEqual(phi, -np.sin(gamma) / RADIUS, delta=1e-5 / HEAD / RADIUS)

    def test_they_are_velocities_of_material_points(self):
        speed, pitch_rate, yaw_rate, roll_rate, lateral, down = 20e3, 44.0, 0.3, -0.2, 15.0, -8.0
        for side in ("left", "right"):
            point = profiles.contact_points(TRACK, WHEELSET, profiles.Position(2.0, None, 1e-3, 0.02), side)[0]
            stands, sign = point.position, 1.0 if side == "right" else -1.0

            def moved(place, time):
                """The later place of the material point of the wheel that is at `place` now."""
                axle = np.array([0.0, stands.y, stands.z - RADIUS])
                body = rotation(stands.roll, stands.yaw).T @ (np.asarray(place) - axle)
                c, s = np.cos(pitch_rate * time), np.sin(pitch_rate * time)
                turned = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) @ body
                return rotation(stands.roll + roll_rate * time, stands.yaw + yaw_rate * time) @ turned + axle + np.array([speed, lateral, down]) * time

            def velocity(place):
                return (moved(place, 1e-6) - moved(place, -1e-6)) / 2e-6

            c, s = np.cos(point.angle), np.sin(point.angle)
            along = np.array([0.0, sign * c, -s])
            found = point.creepages(speed, pitch_rate=pitch_rate, yaw_rate=yaw_rate, roll_rate=roll_rate, lateral_speed=lateral, vertical_speed=down)
            here = velocity(point.place)
            # The test's velocities are differences over 2e-6 s. Their errors are 1e-16 times 1 m over this time, and (rate 1e-6 s)^2 of the speed.
            self.assertAlmostEqual(found[0], here[0] / speed, delta=1e-7)
            self.assertAlmostEqual(found[1], here @ along / speed, delta=1e-7)
            ahead, aside = (velocity(np.asarray(point.place) + move) for move in (np.array([1.0, 0.0, 0.0]), along))
            self.assertAlmostEqual(found[2], (ahead - here) @ along / speed, delta=1e-7)
            self.assertAlmostEqual(found[2], -(aside - here)[0] / speed, delta=1e-7)

    def test_a_wheelset_that_stands_is_refused(self):
        with self.assertRaisesRegex(ValueError, "speed is 0.0; it must be positive"):
            profiles.contact_points(TRACK, WHEELSET)[0].creepages(0.0)
