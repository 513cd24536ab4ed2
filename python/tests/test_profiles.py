"""From two profiles to a gap: profiles of lines and arcs, whose contact is known in closed form."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

import contact_normal as cn
from contact_normal import profiles
from contact_normal.profiles._curve import Curve

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
# A conical tread, and a head that is one arc between two flanks. Lengths in mm.
CONE, HEAD, RADIUS = 1.0 / 20.0, 300.0, 460.0
# Interpolation by cubic splines, 5/384 d^4 f'''' with f'''' = 3/HEAD^3 and points d = 0.5 apart, is good to 1e-10; with a hundredfold reserve:
EXACT = 1e-8


def wheel(cone=CONE):
    """A tread of one slope from y = -35 to 60, with a flange of 65 degrees and a rounded tip."""
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
    """A head of one arc, or of another one towards the track."""
    y = np.linspace(-reach, reach, int(4 * reach) + 1)
    heads = np.where(y < 0.0, head if inner is None else inner, head)
    z = heads - np.sqrt(heads**2 - y**2)
    down = np.linspace(40.0, z[0] + 0.5, 60)
    # Flanks of 20:1, from 40 mm below the top.
    other = np.linspace(40.0, z[-1] + 0.5, 60)
    sides = -reach - (down - z[0]) / 20.0, (reach + (other - z[-1]) / 20.0)[::-1]
    return profiles.Profile(np.concatenate([sides[0], y, sides[1]]), np.concatenate([down, z, other[::-1]]), "rail", "an arc")


TRACK, WHEELSET = profiles.Track(rail()), profiles.Wheelset(wheel(), RADIUS, flange_back=1360.0)
# The gauge point lies on the flank, 14 mm below the top; the head is symmetric about its middle, MIDDLE.
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
        # A place is that of a minimum: good to the root of a rounding of z.
        self.assertAlmostEqual(point.angle, gamma, delta=1e-5 / HEAD)
        self.assertAlmostEqual(x, 0.0, delta=1e-5)
        self.assertAlmostEqual(y, MIDDLE - HEAD * np.sin(gamma), delta=1e-5)
        self.assertAlmostEqual(z, HEAD * (1.0 - np.cos(gamma)), delta=1e-6)
        self.assertEqual(WHEELSET.origin, 750.0)
        radius = RADIUS - CONE * (y - 750.0)
        self.assertAlmostEqual(point.rolling_radius, radius, delta=1e-6)
        # The axle is lowered until the wheel stands on that place.
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
        # The search has steps of 0.05 mm: a place is off by so much, and the clearance by its square over two radii.
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
            # Some 2^-52 times the distance of the wheels, a few times.
            self.assertAlmostEqual(profiles.contact_points(TRACK, WHEELSET, stands, side)[0].clearance, 0.0, delta=1e-10)

    def test_a_second_place_is_told(self):
        # Two heads side by side: the tread lies on both.
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
        # With 10 elements to a radius approach and pressure are good to the square of an element.
        self.assertAlmostEqual(result.approach / (radius**2 / RADIUS), 1.0, delta=0.01)
        self.assertAlmostEqual(result.max_pressure / (1.5 * force / (np.pi * radius**2)), 1.0, delta=0.01)
        # Nothing that is nearer than the approach was left out.
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
        # A cylinder that is lowered by 0.02 mm on 460 mm has the same shape to 5e-5.
        self.assertAlmostEqual(other.max_pressure / result.max_pressure, 1.0, delta=2e-4)
        self.assertAlmostEqual(other.approach + 0.02, result.approach, delta=1e-5)
        # By position: no further approach is the overlap.
        by_position = overlapping.gap(0.3, 0.3, 0.02).solve(approach=0.0, **STEEL)
        by_approach = touching.gap(0.3, 0.3, 0.02).solve(approach=0.02, **STEEL)
        self.assertAlmostEqual(by_position.force / by_approach.force, 1.0, delta=1e-3)

    def test_a_grid_that_cannot_be_large_enough_is_refused(self):
        point = profiles.contact_points(self.TRACK, self.WHEELSET)[0]
        with self.assertRaisesRegex(ValueError, "the grid would need more than 2048 elements"):
            point.gap(1e-4, 1e-4, 1.0)
        with self.assertRaisesRegex(ValueError, "depth is 0.0; it must be positive"):
            point.gap(0.1, 0.1, 0.0)

    def test_a_wheel_that_turns_fast_is_pushed_forward(self):
        # Of two arcs, near the place where they meet: the middle of the patch is not the contact point.
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
        # The spin is about the contact point, wherever the middle of the grid is.
        again = gap.solve(force=10e3, friction={**friction, "spin_centre": (-gap.middle[0], -gap.middle[1])}, **STEEL)
        self.assertEqual(again.tangential_force, result.tangential_force)
        # On the left side the same force, mirrored.
        left = profiles.contact_points(profiles.Track(rail(inner=80.0)), profiles.Wheelset(wheel(1.0 / 200.0)), side="left")[0]
        self.assertEqual(left.force_on_wheel(result), (forward, -right, down))
        # Places are those of the gap, around the contact point.
        self.assertNotEqual(gap.middle[1], 0.0)
        np.testing.assert_array_equal(result.y, gap.y)
        self.assertLess(np.abs(gap.y).min(), 1e-9)


class Creepages(unittest.TestCase):
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
                """Where a material point of the wheel that is at `place` now will be."""
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
            # Differences over 2e-6 s: 1e-16 times 1 m over that, and (rate 1e-6 s)^2 of the speed.
            self.assertAlmostEqual(found[0], here[0] / speed, delta=1e-7)
            self.assertAlmostEqual(found[1], here @ along / speed, delta=1e-7)
            ahead, aside = (velocity(np.asarray(point.place) + move) for move in (np.array([1.0, 0.0, 0.0]), along))
            self.assertAlmostEqual(found[2], (ahead - here) @ along / speed, delta=1e-7)
            self.assertAlmostEqual(found[2], -(aside - here)[0] / speed, delta=1e-7)

    def test_a_wheelset_that_stands_is_refused(self):
        with self.assertRaisesRegex(ValueError, "speed is 0.0; it must be positive"):
            profiles.contact_points(TRACK, WHEELSET)[0].creepages(0.0)


class Profiles(unittest.TestCase):
    def test_the_track_puts_the_gauge_point_in_its_place(self):
        placed = TRACK.placed()
        self.assertAlmostEqual(placed.z.min(), 0.0, delta=EXACT)
        below = np.argsort(placed.z[:60])
        self.assertAlmostEqual(np.interp(14.0, placed.z[:60][below], placed.y[:60][below]), 717.5, delta=1e-9)
        with self.assertRaisesRegex(ValueError, "gauge_height is 50.0; the rail ends 40 mm below its top"):
            profiles.Track(rail(), gauge_height=50.0).placed()

    def test_an_inclined_rail_turns_its_top_to_the_track(self):
        inclined = profiles.Track(rail(), inclination=CONE).placed().curve()
        y, z, _, _ = inclined.at(inclined.between(20))
        self.assertAlmostEqual(z.min(), 0.0, delta=1e-6)
        # The head was symmetric: an arc whose top is now CONE HEAD further to the field side in it than before, from gauge face to gauge face.
        inner, outer = np.interp(10.0, z[: z.argmin()][::-1], y[: z.argmin()][::-1]), np.interp(10.0, z[z.argmin() :], y[z.argmin() :])
        self.assertAlmostEqual(y[z.argmin()] - 0.5 * (inner + outer), np.arctan(CONE) * HEAD, delta=1.0)

    def test_splines_pass_where_the_arc_does(self):
        curve = TRACK.placed().curve()
        y = np.linspace(MIDDLE - 30.0, MIDDLE + 30.0, 977)
        t = curve.where(y, near=curve.t[len(curve.t) // 2])
        found_y, z, dy, dz = curve.at(t)
        np.testing.assert_allclose(found_y, y, atol=1e-11)
        np.testing.assert_allclose(z, HEAD - np.sqrt(HEAD**2 - (y - MIDDLE) ** 2), atol=EXACT)
        np.testing.assert_allclose(dz / dy, (y - MIDDLE) / np.sqrt(HEAD**2 - (y - MIDDLE) ** 2), atol=1e-6)
        self.assertTrue(np.isnan(curve.where(MIDDLE + 50.0)))

    def test_a_curve_is_the_natural_spline(self):
        rng = np.random.default_rng(3)
        y, z = np.cumsum(rng.uniform(0.2, 1.0, 12)), rng.normal(size=12)
        curve = Curve(y, z)
        np.testing.assert_allclose(np.diff(curve.t), np.hypot(np.diff(y), np.diff(z)), rtol=1e-13)
        for points, values, slopes in ((y, 0, 2), (z, 1, 3)):
            np.testing.assert_allclose(curve.at(curve.t)[values], points, atol=1e-13)
            # It is a cubic between points, so differences of its derivative, a parabola, are exact second derivatives at the middle of two places.
            step = 1e-3
            before, after = curve.at(curve.t[1:-1] - 1e-9)[slopes], curve.at(curve.t[1:-1] + 1e-9)[slopes]
            np.testing.assert_allclose(before, after, atol=1e-7)

            def second(t, slopes=slopes):
                return (curve.at(t + step)[slopes] - curve.at(t - step)[slopes]) / (2 * step)

            left = 2 * second(curve.t[1:-1] - step) - second(curve.t[1:-1] - 2 * step)
            right = 2 * second(curve.t[1:-1] + step) - second(curve.t[1:-1] + 2 * step)
            # Second derivatives are linear: from both sides to one value, and to 0 at the ends.
            np.testing.assert_allclose(left, right, atol=1e-8)
            for end, inwards in ((curve.t[0], step), (curve.t[-1], -step)):
                self.assertAlmostEqual(2 * second(end + inwards) - second(end + 2 * inwards), 0.0, delta=1e-8)
            # The derivative is that of the values.
            at = np.linspace(curve.t[0] + 0.01, curve.t[-1] - 0.01, 50)
            np.testing.assert_allclose((curve.at(at + 1e-5)[values] - curve.at(at - 1e-5)[values]) / 2e-5, curve.at(at)[slopes], atol=1e-7)

    def test_a_place_is_searched_around_another_one(self):
        y = np.linspace(0.0, 4.0 * np.pi, 200)
        curve = Curve(y, -np.cos(y))
        for near, expected in ((0.25, 0.5 * np.pi), (0.75, 2.5 * np.pi)):
            found = curve.where(0.0, (0.0, 1.0), near * curve.t[-1])
            self.assertAlmostEqual(float(curve.at(found)[0]), expected, delta=1e-6)
        self.assertTrue(np.isnan(curve.where(1.5, (0.0, 1.0), 0.25 * curve.t[-1])))

    def test_points_that_lie_on_each_other_count_once(self):
        plain = wheel()
        twice = profiles.Profile(np.insert(plain.y, 180, plain.y[180] - 2e-5), np.insert(plain.z, 180, plain.z[180] + 1e-6), "wheel")
        self.assertEqual(len(twice.curve().y), len(plain.curve().y))
        self.assertLess(np.abs(np.diff(twice.curve().at(twice.curve().between(7))[3][1200:])).max(), 1e-4)

    def test_turned_profiles_are_refused_by_the_argument_that_turns_them(self):
        for kind, made in (("wheel", wheel()), ("rail", rail())):
            with self.assertRaisesRegex(ValueError, "upside_down=True"):
                profiles.Profile(made.y, -made.z, kind)
            with self.assertRaisesRegex(ValueError, "in the order of growing y"):
                profiles.Profile(made.y[::-1], made.z[::-1], kind)
        made = wheel()
        with self.assertRaisesRegex(ValueError, "mirror=True"):
            profiles.Profile(-made.y[::-1], made.z[::-1], "wheel")
        with self.assertRaisesRegex(ValueError, 'kind is \'tyre\'; it must be "wheel" or "rail"'):
            profiles.Profile(made.y, made.z, "tyre")
        for y, z in ((made.y[1:], made.z), (made.y[:3], made.z[:3]), (made.y[:20].reshape(2, 10), made.z[:20].reshape(2, 10))):
            with self.assertRaisesRegex(ValueError, "they must be rows of at least 4 points"):
                profiles.Profile(y, z, "wheel")
        with self.assertRaisesRegex(ValueError, "points that are not finite"):
            profiles.Profile(np.where(made.y > 0, np.nan, made.y), made.z, "wheel")
        with self.assertRaisesRegex(ValueError, "rail is a wheel"):
            profiles.Track(made).placed()
        with self.assertRaisesRegex(ValueError, "wheel is a rail"):
            profiles.Wheelset(rail()).tread()

    def test_smoothing_takes_short_waves_and_leaves_long_ones(self):
        made, length = wheel(0.0), 10.0
        inner = (made.y > -20.0) & (made.y < 45.0)
        for wave in (5.0, 10.0, 20.0):
            waves = np.where(made.y > -35.2, 1e-3 * np.cos(2 * np.pi * made.y / wave), 0.0)
            smooth = profiles.Profile(made.y, made.z + waves, "wheel").smoothed(length)
            kept = (smooth.z - made.smoothed(length).z)[inner] @ waves[inner] / (waves[inner] @ waves[inner])
            # The formula is that of a continuous line without ends.
            self.assertAlmostEqual(kept, 1.0 / (1.0 + (length / wave) ** 4), delta=0.01)
        with self.assertRaisesRegex(ValueError, "wave_length is 0.0"):
            made.smoothed(0.0)


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def written(self, name, text):
        path = Path(self.folder.name, name)
        path.write_text(text)
        return path

    def simpack(self, name, header, y, z):
        points = "\n".join(f"  {a!r}  {b!r}   ! {k}" for k, (a, b) in enumerate(zip(y.tolist(), z.tolist())))
        return self.written(name, f"! units.len.f = 7 in a comment\nspline.begin\n{header}\n    point.begin\n    ! y z\n{points}\n    point.end\nspline.end\n")

    def assert_same(self, found, expected):
        np.testing.assert_allclose(found.y, expected.y, atol=1e-12)
        np.testing.assert_allclose(found.z, expected.z, atol=1e-12)
        self.assertEqual(found.kind, expected.kind)

    def test_the_header_of_simpack_is_obeyed(self):
        made = wheel()
        self.assert_same(profiles.read(self.simpack("a.prw", "", made.y, made.z)), made)
        # As the benchmark's wheel: the flange at large y, mirrored and reversed by flags; in metres.
        header = "mirror.y = 1 ! mirrored\n inversion = 1\n units.len.f = +1.000e+00"
        self.assert_same(profiles.read(self.simpack("b.prw", header, -made.y / 1000.0, made.z / 1000.0)), made)
        self.assert_same(profiles.read(self.simpack("c.PRW", "mirror.z = 1", made.y, -made.z)), made)
        self.assert_same(profiles.read(self.simpack("d.prw", "shift.y = 2.5\nshift.z = -1", made.y - 2.5, made.z + 1.0)), made)
        c, s = np.cos(0.1), np.sin(0.1)
        self.assert_same(profiles.read(self.simpack("e.prw", "rotate = 0.1", c * made.y + s * made.z, c * made.z - s * made.y)), made)
        bounded = profiles.read(self.simpack("f.prw", "bound.y.min = -1e3\nbound.y.max = 40.0", made.y, made.z))
        self.assertEqual(bounded.y.max(), 40.0)
        with self.assertRaisesRegex(ValueError, "mirror=True"):
            profiles.read(self.simpack("g.prw", "", -made.y[::-1], made.z[::-1]))
        with self.assertRaisesRegex(ValueError, "no points between point.begin and point.end"):
            profiles.read(self.written("h.prr", "header.begin\nheader.end\n"))

    def test_columns_below_a_header(self):
        made = rail()
        head = "ProgramName=own\nXYPOINTS=3\nColumnDef=X,Y,A,C\n\n"
        rows = "\n".join(f"{y!r}\t{-z!r}\t0.1\t0" for y, z in zip(made.y.tolist(), made.z.tolist()))
        self.assert_same(profiles.read(self.written("a.ban", head + rows)), made)
        rows = "\n".join(f"{k} {z!r} {y!r}" for k, (y, z) in enumerate(zip((made.y / 25.4).tolist(), (made.z / 25.4).tolist())))
        self.assert_same(profiles.read(self.written("inches.txt", "points\n" + rows), "rail", columns=(2, 1), scale=25.4), made)
        made = wheel()
        rows = "\n".join(f"{-y!r}, {z!r}" for y, z in zip(made.y.tolist(), made.z.tolist()))
        self.assert_same(profiles.read(self.written("mirrored.csv", rows), "wheel", mirror=True), made)
        with self.assertRaisesRegex(ValueError, 'kind is not known; give "wheel" or "rail"'):
            profiles.read(self.written("b.txt", rows))
        with self.assertRaisesRegex(ValueError, r"has 0 points in the columns \(0, 1\)"):
            profiles.read(self.written("c.whl", head))
