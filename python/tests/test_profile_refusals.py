"""Profiles in other units, files that are probably misread, and arguments out of their range."""

import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

from contact_normal import profiles
from test_profiles import TRACK, WHEELSET, rail, wheel


def scaled(made, factor):
    return profiles.Profile(made.y * factor, made.z * factor, made.kind)


class Units(unittest.TestCase):
    def refused(self, make, text):
        with self.assertRaisesRegex(ValueError, text + ".* lengths are in mm"):
            make()

    def test_a_wheelset_has_one_unit(self):
        for factor in (25.4, 10.0, 1000.0):
            with self.subTest(factor=factor):
                self.refused(lambda f=factor: profiles.Wheelset(wheel(), 460.0, flange_back=1360.0 / f), "flange_back is ")
                self.refused(lambda f=factor: profiles.Wheelset(wheel(), 460.0 / f), "radius is ")
                self.refused(lambda f=factor: profiles.Wheelset(scaled(wheel(), 1.0 / f), flange_back_at=-70.0), "flange_back is ")
        self.refused(lambda: profiles.Wheelset(wheel(), flange_back_at=-7.0), "flange_back_at is -7; it is the y of the back")
        self.refused(lambda: profiles.Wheelset(wheel().moved(y=70.0), flange_back_at=-70.0), "flange_back_at is -70; .* smallest y is 0:")
        # A tread that begins at y = -20 has its back 50 mm away, which is accepted. A model may have a scale of its own.
        tread = wheel().y > -20.0
        profiles.Wheelset(profiles.Profile(wheel().y[tread], wheel().z[tread], "wheel"), flange_back_at=-70.0)
        profiles.Wheelset(scaled(wheel(), 1.0 / 87.0), 460.0 / 87.0, 1360.0 / 87.0)

    def test_a_track_has_one_unit(self):
        for factor in (25.4, 10.0, 1000.0):
            with self.subTest(factor=factor):
                self.refused(lambda f=factor: profiles.Track(rail(), gauge=1435.0 / f), "gauge is ")
                self.refused(lambda f=factor: profiles.Track(rail(), gauge_height=14.0 / f), "gauge_height is ")
        profiles.Track(scaled(rail(), 1.0 / 87.0), 16.5, 14.0 / 87.0)
        with self.assertRaisesRegex(ValueError, "gauge_height is 0.0; it must be positive"):
            profiles.Track(rail(), gauge_height=0.0)

    def test_rails_in_larger_units_are_told(self):
        for factor in (10.0, 25.4, 1000.0):
            self.refused(lambda f=factor: profiles.Track(scaled(rail(), 1.0 / f)), "gauge is 1435.0; it must be 3.5 to 100 times as large as the rail is wide")

    def test_diameters_are_told(self):
        made = wheel()
        with self.assertRaisesRegex(ValueError, "a flange that is 50.9 mm high: are these diameters"):
            profiles.Profile(made.y, 2.0 * made.z, "wheel")

    def test_a_profile_that_ends_before_the_back_is_told(self):
        made = wheel()
        for first, told in ((-60.0, "ends on the tip of its flange, at z = "), (-30.0, "has no flange")):
            part = profiles.Profile(made.y[made.y > first], made.z[made.y > first], "wheel")
            with self.assertWarnsRegex(UserWarning, f"{told}.* is taken for the flange back: give flange_back_at") as found:
                profiles.Wheelset(part)
            self.assertEqual(found.filename, __file__)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                profiles.Wheelset(part, flange_back_at=-70.0)
        with self.assertWarnsRegex(UserWarning, "has no flange, .*Profiles are in mm"):
            profiles.Wheelset(profiles.Profile(made.y, 1e-3 * made.z, "wheel"))

    def test_a_rail_of_two_units_is_told(self):
        with self.assertWarnsRegex(UserWarning, "the rail is 400 high and .* wide: are y and z in one unit"):
            profiles.Track(profiles.Profile(rail().y, 10.0 * rail().z, "rail"))

    def test_an_origin_that_is_not_on_the_tread_is_told(self):
        for z in (-15.0, 8.0):
            with self.assertWarnsRegex(UserWarning, rf"the tread of the wheel, 70 mm from the back, has z = {z:g}, .*: the wheel has {460 + z:g} mm there"):
                profiles.Wheelset(wheel().moved(z=z), 460.0)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            profiles.Wheelset(wheel().moved(z=4.0), 460.0)

    def test_heights_from_the_axle_are_told(self):
        with self.assertRaisesRegex(ValueError, r"the tread of the wheel has z = 457 to 460.2, and radius is that at z = 0"):
            profiles.Wheelset(wheel().moved(z=460.0), 460.0)


class Sides(unittest.TestCase):
    def test_a_rail_that_leans_to_the_field_is_told(self):
        upright = rail()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            inclined = profiles.Track(upright.rotated(0.025)).rail
            profiles.Track(upright)
            profiles.Track(upright, inclination=0.05)
        with self.assertWarnsRegex(UserWarning, r"the rail leans to the field side by 0\.025 rad: .* mirror=True"):
            profiles.Track(profiles.Profile(-inclined.y[::-1], inclined.z[::-1], "rail"))
        with self.assertWarnsRegex(UserWarning, r"leans to the track by 0.025 rad, and inclination=0.05 is added: leave it out"):
            profiles.Track(inclined, inclination=0.05)
        with self.assertWarnsRegex(UserWarning, "leans to the field side by 0.05 rad"):
            profiles.Track(upright, inclination=-0.05)


class Play(unittest.TestCase):
    def test_a_wheelset_fits_its_track(self):
        # The flank of 65 degrees is 10 mm below the origin at y = -35 - (10 - 1.75)/tan 65.
        across = 2.0 * (750.0 - 35.0 - (10.0 - 1.75) / np.tan(np.deg2rad(65.0)))
        self.assertAlmostEqual(profiles.Wheelset(wheel()).across_flanges(), across, delta=0.6)
        for gauge, back in ((1435.0, 1360.0), (1520.0, 1440.0), (1000.0, 925.0)):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                profiles.contact_points(profiles.Track(rail(), gauge), profiles.Wheelset(wheel(), flange_back=back))
        with self.assertWarnsRegex(UserWarning, r"14\d\d(\.\d)? mm across its flanges, has a play of 9\d(\.\d)? mm in a gauge of 1520: look at gauge, flange_back=1360"):
            profiles.contact_points(profiles.Track(rail(), 1520.0), profiles.Wheelset(wheel()))
        with self.assertWarnsRegex(UserWarning, r"has \d\d(\.\d)? mm too little room in a gauge of 1435"):
            profiles.contact_points(TRACK, profiles.Wheelset(wheel(), flange_back=1390.0))


class Moduli(unittest.TestCase):
    def test_those_in_gpa_are_refused(self):
        point = profiles.contact_points(profiles.Track(rail()), profiles.Wheelset(wheel(), 460.0), profiles.Position(y=4.0))[0]
        with self.assertRaisesRegex(ValueError, "moduli in N/mm2"):
            point.press(80e3, 0.4, 0.4, shear_modulus=82.0, poisson_ratio=0.28)


class Arguments(unittest.TestCase):
    def test_within_is_a_length(self):
        for within in (-1.0, float("nan")):
            with self.assertRaisesRegex(ValueError, "within"):
                profiles.contact_points(TRACK, WHEELSET, within=within)

    def test_angles_are_in_radians_and_a_position_is_no_number(self):
        for name in ("roll", "yaw"):
            with self.assertRaisesRegex(ValueError, f"{name} is 2.0; it is an angle in rad"):
                profiles.Position(**{name: 2.0})
        for given, text in (((TRACK, WHEELSET, 4.0), r"position is a float; it must be a Position, as profiles.Position\(y=4.0\)"),
                            ((WHEELSET, TRACK), "track is a Wheelset; it must be a Track"), ((TRACK, wheel()), "wheelset is a Profile; it must be a Wheelset")):
            with self.assertRaisesRegex(TypeError, text):
                profiles.contact_points(*given)

    def test_waves_are_shorter_than_the_profile(self):
        with self.assertRaisesRegex(ValueError, "wave_length is 100.0; it must be less than half of the width of a cone, 130 mm"):
            wheel().smoothed(100.0)

    def test_two_profiles_are_told(self):
        made = rail()
        with self.assertRaisesRegex(ValueError, "goes back from y = .* to y = .*: are these two profiles"):
            profiles.Profile(np.tile(made.y, 2), np.tile(made.z, 2), "rail")


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "points.txt")
        self.rows = [f"{y:.4f} {0.002 * y * y:.5f}" for y in np.linspace(-40.0, 40.0, 81)]

    def read(self, lines, **given):
        self.path.write_text("\n".join(lines), encoding="utf-8")
        return profiles.read(self.path, "rail", **given)

    def test_points_that_run_together_are_told_wherever_they_stand(self):
        glued = [row.replace(" ", "") for row in self.rows]
        for lines in ([*glued[:20], *self.rows[20:]], [*self.rows[:60], *glued[60:]], [f"{k:.4f} ****" for k in range(-40, -30)] + self.rows[10:]):
            with self.assertRaisesRegex(ValueError, r"has \d+ lines of numbers beside its \d+ points, as '-?\d+"):
                self.read(lines)
        for line in ("nan 1.0", "**** 1.0", "-20.0 nan"):
            with self.assertRaisesRegex(ValueError, "among its points"):
                self.read([*self.rows[:20], line, *self.rows[21:]])
        # Titles, a count and a date are not taken for points.
        titles = ["*** a rail ***", "2 cuts, of which the first", "81", "12.05.2023 10:11"]
        self.assertEqual(len(self.read([*titles, *self.rows, "81 points"]).y), 81)

    def test_marks_around_numbers_and_signs_of_minus(self):
        plain = self.read(self.rows)
        for change in (lambda y, z: f"({y}, {z})", lambda y, z: f'"{y}";"{z}"', lambda y, z: f"[{y} {z}]", lambda y, z: f"{y} {z}".replace("-", "\u2212")):
            lines = [change(*row.split()) for row in self.rows]
            np.testing.assert_array_equal(self.read(["a rail in \u00b5m"] + lines).y, plain.y)
        self.path.write_bytes("Ma\u00dfe\n".encode("latin-1") + "\n".join(self.rows).encode())
        np.testing.assert_array_equal(profiles.read(self.path, "rail").y, plain.y)

    def test_a_header_names_columns(self):
        self.path = self.path.with_suffix(".ban")
        for names, order in (("X,Y", "{y} {z}"), ("A,X,Y", "9 {y} {z}"), ("Y, X, N", "{z} {y} 5"), ('"*X","*Y"', "{y} {z}"), ("A,C", "{y} {z}")):
            rows = [order.format(y=y, z=-float(z)) for y, z in map(str.split, self.rows)]
            with self.subTest(names):
                self.assertEqual(self.read([f"ColumnDef={names}", *rows]).y[0], -40.0)

    def test_columns_and_scale(self):
        for columns, error, text in (((0,), TypeError, "it must be two numbers"), ((0.0, 1.0), TypeError, r"columns\[0\] is 0.0; it must be an integer"),
                                     ("01", TypeError, "columns is '01'; it must be two"), ((1, 1), ValueError, "two different"),
                                     ((0, -1), ValueError, "counted from 0")):
            with self.subTest(columns=columns), self.assertRaisesRegex(error, text):
                self.read(self.rows, columns=columns)
        for scale in (0.0, -1.0, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "scale"):
                self.read(self.rows, scale=scale)


class Simpack(unittest.TestCase):
    def read(self, header, kind="rail", before=""):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.prr" if kind == "rail" else "a.prw")
            points = "\n".join(f"{y!r} {z!r}" for y, z in zip(self.made.y.tolist(), self.made.z.tolist()))
            path.write_text(f"{before}\nspline.begin\n{header}\nPOINT.BEGIN\n{points}\nPoint.End\nspline.end\n")
            return profiles.read(path)

    def setUp(self):
        made = rail(inner=80.0)
        self.made = made

    def test_names_in_any_case_and_numbers_with_remarks(self):
        for header in ("MIRROR.Y = 1\ninversion = 1", "mirror.y = '1'\ninversion=1", "mirror.y = 1 ;\ninversion = 1 # yes", "mirror.y = 1 // yes\nInversion = 1"):
            with self.subTest(header=header):
                np.testing.assert_array_equal(self.read(header).y, -self.made.y[::-1])

    def test_what_is_no_number_is_refused(self):
        for value in ("$_MIRROR", "1/40", "1 + 1", "true"):
            with self.assertRaisesRegex(ValueError, r"rotate = .* in its header; it must be a number: expressions"):
                self.read(f"rotate = {value}")
        # Texts and other names have no effect.
        self.read("comment = 'a rail'\nfile = x\nversion = one")

    def test_units_bounds_and_kinds(self):
        for name in ("units.len.f", "units.ang.f"):
            with self.assertRaisesRegex(ValueError, f"{name} = 0 in its header; it must be positive"):
                self.read(f"{name} = 0")
        with self.assertRaisesRegex(ValueError, "has 0 points within its bounds"):
            self.read("bound.y.min = 300\nbound.y.max = 600")
        with self.assertRaisesRegex(ValueError, 'says type = 1, a wheel: kind="wheel"'):
            self.read("", before="header.begin\n type = 1\nheader.end")
        self.read("type = 1", before="header.begin\n type = 0\nheader.end")
        with self.assertWarnsRegex(UserWarning, "approx.smooth = 0.5 in its header, which is not obeyed"):
            self.read("approx.smooth = 0.5")


if __name__ == "__main__":
    unittest.main()
