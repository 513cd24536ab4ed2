"""Profiles: their orientation and place, smooth curves through them, and their files."""

import tempfile
import tracemalloc
import unittest
import warnings
from pathlib import Path

import numpy as np

from contact_normal import profiles
from contact_normal.profiles._curve import Curve
from test_profiles import CONE, EXACT, HEAD, MIDDLE, TRACK, rail, wheel


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
        # The head is a symmetric arc. The inclination moves its top by CONE HEAD to the field side, relative to the
        # middle of the gauge faces.
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
            # Between points the spline is cubic and its derivative a parabola, so central differences of the derivative
            # are exact.
            step = 1e-3
            before, after = curve.at(curve.t[1:-1] - 1e-9)[slopes], curve.at(curve.t[1:-1] + 1e-9)[slopes]
            np.testing.assert_allclose(before, after, atol=1e-7)

            def second(t, slopes=slopes):
                return (curve.at(t + step)[slopes] - curve.at(t - step)[slopes]) / (2 * step)

            left = 2 * second(curve.t[1:-1] - step) - second(curve.t[1:-1] - 2 * step)
            right = 2 * second(curve.t[1:-1] + step) - second(curve.t[1:-1] + 2 * step)
            # Second derivatives are linear between points. Extrapolated from both sides they agree, and they are 0 at
            # the ends.
            np.testing.assert_allclose(left, right, atol=1e-8)
            for end, inwards in ((curve.t[0], step), (curve.t[-1], -step)):
                self.assertAlmostEqual(2 * second(end + inwards) - second(end + 2 * inwards), 0.0, delta=1e-8)
            # The derivative of the curve equals central differences of its values.
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
        # Points that are repeated exactly: one of them, or all.
        for often in (np.where(np.arange(len(plain.y)) == 150, 2, 1), 2):
            same = profiles.Profile(np.repeat(plain.y, often), np.repeat(plain.z, often), "wheel").curve()
            self.assertTrue(np.array_equal(same.y, plain.curve().y) and np.array_equal(same.z, plain.curve().z))

    def test_points_out_of_order_and_far_off_are_refused(self):
        plain = rail()
        k = int(np.argmin(np.abs(plain.y + 14.6)))
        for y, z in ((plain.y[k - 1] - 2e-3, plain.z[k - 1]), (plain.y[k], 99.0)):
            with self.subTest(y=y, z=z), self.assertRaisesRegex(ValueError, "out of order, or far off, at y = "):
                profiles.Profile(np.insert(plain.y, k, y), np.insert(plain.z, k, z), "rail").curve()
        for z in (9999.0, -9999.0):
            with self.assertRaisesRegex(ValueError, "stands? for 'not measured'"):
                profiles.Profile(plain.y, np.where(np.arange(len(plain.z)) == k, z, plain.z), "rail")
        # A steep face and a rim below the tread may end a profile, and are no far-off points.
        self.assertEqual(len(wheel().curve().y), len(wheel().y))

    def test_spikes_are_told(self):
        plain = wheel()
        k = int(np.argmin(np.abs(plain.y)))
        for height in (1.0, -0.05):
            dusty = profiles.Profile(plain.y, plain.z + height * (np.arange(len(plain.z)) == k), "wheel", "tread")
            self.assertEqual(list(dusty.spikes()), [k])
            with self.assertWarnsRegex(UserWarning, f"tread has a spike at y = {plain.y[k]:.6g}"):
                dusty.curve()
        noise = np.random.default_rng(3).normal(size=len(plain.z))
        for scale in (0.0, 0.005, 0.02):
            self.assertEqual(len(profiles.Profile(plain.y, plain.z + scale * noise, "wheel").spikes()), 0)
        self.assertEqual(len(rail().spikes()), 0)

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

    def test_a_tread_without_a_flange_is_no_profile_upside_down(self):
        y = np.linspace(-30.0, 60.0, 181)
        # A tread with a chamfer of 5 mm at its outer end.
        z = -y / 20.0 - np.maximum(y - 55.0, 0.0)
        tread = profiles.Profile(y, z, "wheel")
        self.assertEqual(len(tread.curve().y), 181)
        for turned in ((y, -z), (y, z[::-1])):
            with self.assertRaisesRegex(ValueError, "no flange, and its tread is lower on the field side"):
                profiles.Profile(*turned, "wheel")

    def test_noise_is_told(self):
        y = np.linspace(-40.0, 40.0, 801)
        noise = np.random.default_rng(2).normal(0.0, 1e-3, 801)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            profiles.Profile(y, 0.002 * y**2, "rail").curve()
            # Rounding to a hundredth of a micrometre is no noise.
            profiles.Profile(y, np.round(0.002 * y**2, 5), "rail").curve()
            profiles.Profile(y, 0.002 * y**2 + noise, "rail").smoothed(4.0).curve()
        with self.assertWarnsRegex(UserWarning, "noise of the points"):
            profiles.Profile(y, 0.002 * y**2 + noise, "rail").curve()
        with self.assertRaisesRegex(ValueError, "gauge_height is -3"):
            profiles.Track(rail(), gauge_height=-3.0)

    def test_profiles_of_many_points_are_smoothed_in_little_memory(self):
        y = np.linspace(-30.0, 60.0, 20001)
        tread = profiles.Profile(y, -y / 20.0 + 0.01 * np.sin(2 * np.pi * y / 0.5), "wheel")
        tracemalloc.start()
        smooth = tread.smoothed(2.0)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        # Lists of Python numbers would take 32 bytes per number.
        self.assertLess(most, 20001 * 1000)
        inner = slice(2000, -2000)
        self.assertLess(np.abs(smooth.z + smooth.y / 20.0)[inner].max(), 0.01 / (1.0 + 4.0**4) * 1.02)

    def test_smoothing_takes_short_waves_and_leaves_long_ones(self):
        made, length = wheel(0.0), 10.0
        inner = (made.y > -20.0) & (made.y < 45.0)
        for wave in (5.0, 10.0, 20.0):
            waves = np.where(made.y > -35.2, 1e-3 * np.cos(2 * np.pi * made.y / wave), 0.0)
            smooth = profiles.Profile(made.y, made.z + waves, "wheel").smoothed(length)
            kept = (smooth.z - made.smoothed(length).z)[inner] @ waves[inner] / (waves[inner] @ waves[inner])
            # The formula holds for an infinite continuous line.
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
        # As in the benchmark's wheel, the flange is at large y, and flags say that the profile is mirrored and reversed. Lengths are in metres.
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
        for gap in (";", " ; ", "\t"):
            rows = "\n".join(f"{y:.9f}{gap}{z:.9f}".replace(".", ",") for y, z in zip(made.y.tolist(), made.z.tolist()))
            continental = profiles.read(self.written("continental.txt", rows), "wheel")
            # The file has nine decimals.
            np.testing.assert_allclose((continental.y, continental.z), (made.y, made.z), atol=5e-10)
        with self.assertRaisesRegex(ValueError, 'kind is not known; give kind="wheel" or kind="rail"'):
            profiles.read(self.written("b.txt", rows))
        with self.assertRaisesRegex(ValueError, r"has 0 points in the columns \(0, 1\)"):
            profiles.read(self.written("c.whl", head))

    def test_encodings_and_lines_that_are_no_points(self):
        rows = [f"{y:.4f} {0.002 * y * y:.5f}" for y in np.linspace(-40.0, 40.0, 81)]
        text, path = "\n".join(rows), Path(self.folder.name, "a.txt")
        for data in (text.encode("utf-8-sig"), text.encode("utf-16"), text.replace("\n", "\r\n").encode(), f"81\n{text}\n2 of 3".encode()):
            path.write_bytes(data)
            self.assertEqual(len(profiles.read(path, "rail").y), 81)
        for line in ("-20.0000-19.12345", "-20.0 *****", "-20.0 1.2.3"):
            path.write_text("\n".join([*rows[:20], line, *rows[21:]]))
            with self.assertRaisesRegex(ValueError, "among its points"):
                profiles.read(path, "rail")

    def test_a_column_that_counts_is_named_before_a_turn(self):
        for kind, made in (("wheel", wheel()), ("rail", rail())):
            for first, start in (("0 1 2", 0), ("1 2 3", 1)):
                rows = "\n".join(f"{start + k} {y!r} {z!r}" for k, (y, z) in enumerate(zip(made.y.tolist(), made.z.tolist())))
                path = self.written("counted.txt", rows)
                with self.assertRaisesRegex(ValueError, rf"column 0 of counted.txt only counts its lines \({first} ...\).*columns=\(1, 2\)"):
                    profiles.read(path, kind)
                self.assert_same(profiles.read(path, kind, columns=(1, 2)), made)
            # The points of a section have the same x in every line.
            path = self.written("section.txt", "\n".join(f"12.5, {y!r}, {z!r}" for y, z in zip(made.y.tolist(), made.z.tolist())))
            with self.assertRaisesRegex(ValueError, r"column 0 of section.txt is 12.5 in every line; .*columns=\(1, 2\)"):
                profiles.read(path, kind)
            self.assert_same(profiles.read(path, kind, columns=(1, 2)), made)
        # The last of three columns is another quantity. The message names the right columns.
        made = wheel()
        path = self.written("mirrored.txt", "\n".join(f"{-y!r} {z!r} 0.5" for y, z in zip(made.y.tolist(), made.z.tolist())))
        with self.assertRaisesRegex(ValueError, r"mirror=True; or give columns=\(y, z\): the file has 3"):
            profiles.read(path, "wheel")
        # Whole millimetres that do not count the lines are coordinates.
        y = np.arange(-70.0, 61.0)
        path = self.written("whole.txt", "\n".join(f"{a:.0f} {b!r} 0.5" for a, b in zip(y, np.interp(y, made.y, made.z).tolist())))
        np.testing.assert_array_equal(profiles.read(path, "wheel").y, y)
