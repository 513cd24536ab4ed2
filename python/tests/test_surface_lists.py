"""Lists of points are read if they form a grid, and refused with advice otherwise. Large tilts of rough surfaces are
balanced."""

import tempfile
import unittest
import warnings
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np

from contact_normal import surface
from test_surface_files import instruments


class Lists(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "points.txt")
        self.x, self.y = np.arange(9) * 0.5 - 2.0, np.arange(7) * 0.25 + 1.0
        self.z = 0.1 * np.sin(self.x[None, :] + self.y[:, None] ** 2)
        self.columns = [one.ravel() for one in (*np.meshgrid(self.x, self.y), self.z)]
        self.random = np.random.default_rng(5)

    def read(self, *columns, **given):
        np.savetxt(self.path, np.stack(columns, axis=1))
        return surface.read(self.path, **given)

    def assert_grid(self, found):
        np.testing.assert_allclose(found.z, self.z, rtol=1e-15)
        self.assertEqual((found.dx, found.dy), (0.5, 0.25))

    def test_a_full_grid_is_read_in_any_order(self):
        x, y, z = self.columns
        order = self.random.permutation(63)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for columns in ((x, y, z), (x[order], y[order], z[order]), (z[order], x[order], y[order]), (np.arange(63.0), x, y, z)):
                self.assert_grid(self.read(*columns))
            # The heights of a plane are evenly spaced, too, but are not taken for coordinates.
            np.testing.assert_allclose(self.read(x, y, 0.1 * x).z, np.tile(0.1 * self.x, (7, 1)))
        self.path = self.path.with_suffix(".xyz")
        self.assert_grid(self.read(*(one[order] for one in (x, y, z))))
        self.path = self.path.with_suffix(".txt")
        colours = self.random.integers(0, 255, (3, 63)).astype(float)
        with self.assertWarnsRegex(UserWarning, "of 6 columns, numbers 1 and 2 are read as x and y, and number 3 as the heights"):
            self.assert_grid(self.read(x, y, z, *colours))
        with self.assertRaisesRegex(ValueError, "has x, y and z of points, and no indices: leave out axes"):
            self.read(x, y, z, axes="xy")
        stage = self.random.normal(0.0, 1e-4, 63)
        self.assertAlmostEqual(self.read(x + stage, y, z).dx, 0.5, delta=1e-4)

    def test_units_above_the_columns_are_obeyed(self):
        rows = "".join(f"{x} {y} {z:.17g}\n" for x, y, z in zip(*self.columns))
        for end in (".txt", ".xyz"):
            path = self.path.with_suffix(end)
            for head in ("# x [{0}] y [{0}] z [{1}]\n", "# File of 2020\n# X({0}), Y({0}), Z({1})\n", "# x/{0} y/{0} z/{1}\r\n"):
                path.write_text(head.format("mm", "mm") + rows, encoding="utf-8")
                self.assert_grid(found := surface.read(path))
                self.assertEqual(found.units, ("mm", "N"))
                with self.assertRaisesRegex(ValueError, "lengths are in mm in the file"):
                    surface.read(path, units=("m", "N"))
                path.write_text(head.format("mm", "\u00b5m") + rows, encoding="utf-8")
                with self.assertRaisesRegex(ValueError, "has x in mm, y in mm, z in \u00b5m: convert them to one unit"):
                    surface.read(path)
            path.write_text("# x y z of 2020\n" + rows)
            self.assertIsNone(surface.read(path).units)

    def test_a_header_says_which_column_is_y(self):
        x, y, z = self.columns
        for end in (".txt", ".xyz", ".csv"):
            path = self.path.with_suffix(end)
            for head, columns, unit in (("y [mm] x [mm] z [mm]", (y, x, z), "mm"), ("y x z", (y, x, z), None), ("Y, X, Z", (y, x, z), None),
                                        ("z/mm y/mm x/mm", (z, y, x), "mm"), ("x y z", (x, y, z), None), ("z x y", (z, x, y), None)):
                np.savetxt(path, np.stack(columns, axis=1), header=head, delimiter="," if end == ".csv" else " ")
                with self.subTest(head, end=end):
                    self.assert_grid(found := surface.read(path))
                    self.assertEqual(found.units, (unit, "N") if unit else None)

    def test_lines_above_the_points_need_no_mark_in_texts_of_instruments(self):
        x, y, z = self.columns
        for end in (".tsv", ".asc", ".xyz"):
            path = self.path.with_suffix(end)
            for head, columns, unit in (("x [mm]\ty [mm]\tz [mm]", (x, y, z), "mm"), ('"Y (mm)"\t"X (mm)"\t"Height (mm)"', (y, x, z), "mm"),
                                        ("Monday\nX(mm) Y(mm) Z(mm)", (x, y, z), "mm"), ("% z/mm y/mm x/mm", (z, y, x), "mm"), ("row\tcol\theight", (y, x, z), None),
                                        ("// y x z", (y, x, z), None), ("40\na comment", (x, y, z), None)):
                np.savetxt(path, np.stack(columns, axis=1), header=head, comments="", delimiter="\t")
                with self.subTest(head, end=end):
                    self.assert_grid(found := surface.read(path))
                    self.assertEqual(found.units, (unit, "N") if unit else None)
            np.savetxt(path, np.stack(self.columns, axis=1), header="x [mm]\ty [mm]\tz [um]", comments="", delimiter="\t")
            with self.assertRaisesRegex(ValueError, "has x in mm, y in mm, z in um: convert them to one unit"):
                surface.read(path)
            np.savetxt(path, np.stack(self.columns, axis=1), header="x\ty\tz\nmm\tmm\tum", comments="", delimiter="\t")
            with self.assertWarnsRegex(UserWarning, "the unit in the line 'mm\tmm\tum' is not read"):
                surface.read(path)

    def test_points_without_a_height_are_no_header(self):
        x, y, z = self.columns
        z = np.where(y == y.min(), -np.nan, z)
        for end, word in ((".txt", "-nan"), (".tsv", "-nan"), (".asc", "inf"), (".xyz", "+nan")):
            path = self.path.with_suffix(end)
            order = np.argsort(y, kind="stable")
            path.write_text("".join(f"{x[k]} {y[k]} {word if np.isnan(z[k]) else format(z[k], '.17g')}\n" for k in order))
            found = surface.read(path)
            self.assertEqual((found.z.shape, int((~np.isfinite(found.z)).sum())), ((7, 9), 9), end)

    def test_options_that_a_list_contradicts_are_refused(self):
        for end in (".txt", ".xyz"):
            path = self.path.with_suffix(end)
            np.savetxt(path, np.stack(self.columns, axis=1))
            with self.assertRaisesRegex(ValueError, "y rises: .* leave out top_first"):
                surface.read(path, top_first=True)
            with self.assertRaisesRegex(ValueError, "holds one array; give variable for files of several"):
                surface.read(path, variable="z")

    def test_lists_of_numpy_are_lists_too(self):
        path = self.path.with_suffix(".npy")
        np.save(path, np.stack(self.columns, axis=1))
        self.assert_grid(surface.read(path))
        with self.assertRaisesRegex(ValueError, "has x, y and z of 63 points"):
            surface.read(path, dx=0.5, dy=0.25)
        np.savez(self.path.with_suffix(".npz"), points=np.stack(self.columns, axis=1), other=self.x)
        self.assert_grid(surface.read(self.path.with_suffix(".npz"), "points"))

    def test_places_that_are_missing_are_holes(self):
        x, y, z = self.columns
        hidden = (x > 0.9) & (x < 1.6) & (y > 1.3) | (y == self.y[2])
        order = self.random.permutation(np.flatnonzero(~hidden))
        stage = self.random.normal(0.0, 2e-4, 63)
        for name, columns in (("exact", (x, y, z)), ("of a stage", (x + stage, y, z)), ("z first", (z, x, y))):
            with self.subTest(name), self.assertWarnsRegex(UserWarning, rf"{hidden.sum()} of 63 places of the grid of 7 x 9 have no point: they are holes"):
                found = self.read(*(one[order] for one in columns))
            np.testing.assert_allclose(found.z, np.where(hidden.reshape(7, 9), np.nan, self.z), rtol=1e-15)
            np.testing.assert_allclose((found.dx, found.dy), (0.5, 0.25), rtol=1e-3)
        self.assertEqual(np.isinf(surface.gap(found).h).sum(), hidden.sum())

    def test_others_are_refused(self):
        x, y, z = self.columns
        some = self.random.permutation(63)[:25]
        for name, columns in (
            ("a part", (x[some], y[some], z[some])), ("indices beside them", (np.round(x * 2), np.round(y * 4), x, y, z)),
            ("scattered", self.random.random((3, 200))), ("a line", (np.cumsum(self.random.random(200)), self.random.normal(size=200))),
        ):
            with self.subTest(name), self.assertRaisesRegex(ValueError, "points.*places of a grid, at least half of them and none twice.*griddata"):
                self.read(*columns)
        with self.assertRaisesRegex(ValueError, "of 63 points of a grid, which say the size of an element: leave out dx and dy"):
            self.read(x, y, z, dx=0.5, dy=0.25)
        with self.assertRaisesRegex(ValueError, "has x, y and z of 63 points"):
            self.read(x + 0.02 * (x == self.x[4]), y, z)

    def test_a_list_is_no_map_of_an_instrument(self):
        x, y, z = (one[:40] for one in self.columns)
        points = SimpleNamespace(dim=2, is_uniform=True, is_periodic=False, unit=None, physical_sizes=(1.0, 1.0),
                                 heights=lambda: np.stack([x, y, z]))
        with instruments(lambda **_: points):
            with self.assertRaisesRegex(ValueError, "a.asc has x, y and z of 40 points"):
                surface.read(self.path.with_name("a.asc"), dx=0.5, dy=0.25)

    def test_maps_of_other_packages_are_parsed_by_them_alone(self):
        z = self.random.normal(size=(12, 9))
        topography = SimpleNamespace(dim=2, is_uniform=True, is_periodic=False, unit=None, physical_sizes=(1.0, 1.0), heights=lambda: z.T)
        text = "\n".join("\t".join(f"{one:.17g}" for one in row) for row in z)
        # Maps with several tabs between some numbers, and with a column of holes.
        uneven, empty = text.replace("\t", "\t\t", 1), "\n".join(line.replace("\t", "\t\t", 1) for line in text.split("\n"))
        for end in (".tsv", ".asc", ".xyz"):
            path = self.path.with_suffix(end)
            for rows, told in ((text, []), (uneven, ["some numbers are parted by several tabs"]), (empty, ["column 1, counted from 0, has no number"])):
                path.write_text("# a map\n" + rows)
                with self.subTest(end, told=told), instruments(lambda **_: topography), warnings.catch_warnings(record=True) as caught, \
                     mock.patch("contact_normal.surface._lists.of_text", side_effect=AssertionError("it is parsed")):
                    warnings.simplefilter("always")
                    found = surface.read(path, dx=50.0, dy=50.0)
                    np.testing.assert_array_equal(found.z, np.insert(z, 1, np.nan, axis=1) if rows is empty else z)
                    self.assertEqual([str(one.message)[: len(told[0])] if told else str(one.message) for one in caught], told)
                    self.assertEqual({one.filename for one in caught}, {__file__} if told else set())

    def test_a_narrow_map_is_told(self):
        with self.assertWarnsRegex(UserWarning, "is read as a map of 60 x 3 heights"):
            self.assertEqual(self.read(*self.random.normal(size=(3, 60)), dx=1, dy=1).z.shape, (60, 3))
        for strip in (self.random.normal(size=(4, 1000)), np.cumsum(self.random.normal(size=1000)) + self.random.normal(size=(4, 1000))):
            with self.assertWarnsRegex(UserWarning, "is read as a map of 1000 x 4 heights"):
                np.testing.assert_array_equal(self.read(*strip, dx=5, dy=5).z, strip.T)
        x, y = self.random.random((2, 1000))
        with self.assertRaisesRegex(ValueError, "has 1000 lines of 4 numbers: a list of points"):
            self.read(x, y, 0.1 * self.random.normal(size=1000), np.ones(1000), dx=5, dy=5)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.read(*self.random.normal(size=(12, 60)), dx=5, dy=5)


class Units(unittest.TestCase):
    def test_heights_in_another_unit_than_the_elements_are_told(self):
        nanometres = 5.0 * np.random.default_rng(1).normal(size=(64, 64))
        with self.assertWarnsRegex(UserWarning, "half of the slopes in x are steeper than 6[12]: heights and sizes of elements must be in one unit"):
            surface.heights(nanometres, size=(5.0, 5.0))
        # A ground face of .02 um: heights in um, element sizes (20 um) in mm.
        with self.assertWarnsRegex(UserWarning, "half of the slopes in x are steeper than 0.9"):
            surface.heights(0.004 * nanometres, size=(1.28, 1.28))
        # An AFM: heights in m, element sizes in um.
        with self.assertWarnsRegex(UserWarning, "nine of ten slopes in x are below 1.5e-07: heights and sizes of elements must be in one unit"):
            surface.heights(1e-9 * nanometres, size=(5.0, 5.0))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            surface.heights(nanometres, size=(5e3, 5e3))
            # Accepted: a flat to a twentieth of a wavelength with noise of .5 nm, in mm; and an exact plane.
            x = np.linspace(-1.0, 1.0, 64)
            surface.heights(25e-6 * x[None, :] ** 2 + 1e-7 * nanometres, size=(100.0, 100.0))
            surface.heights(np.zeros((64, 64)), size=(100.0, 100.0))
            # Accepted: a fifth of the elements has a fill value.
            surface.heights(np.where(np.arange(64) % 5 == 0, -9999.0, nanometres), size=(5e3, 5e3))


class Tilts(unittest.TestCase):
    def test_a_tilt_of_100_times_the_roughness_is_balanced(self):
        rough, u = 1e-3 * self.random.normal(size=(32, 32)), np.linspace(-0.48, 0.48, 32)
        level = surface.balance(surface.gap(surface.heights(rough, 0.03, 0.03)), 10.0, young_modulus=210e3, poisson_ratio=0.3)
        tilted = surface.gap(surface.heights(rough + 0.2 * u[None, :] - 0.1 * u[:, None], 0.03, 0.03))
        found = surface.balance(tilted, 10.0, young_modulus=210e3, poisson_ratio=0.3)
        # The body is the same, so that the tilts differ by the added tilt. The tolerance follows from that of the centre of the pressures, 1e-4 of
        # the grid.
        slope = u[1] - u[0]
        np.testing.assert_allclose(np.subtract(found.tilt, level.tilt), (-0.2 * slope / 0.03, 0.1 * slope / 0.03), atol=1e-5)

    random = np.random.default_rng(7)


if __name__ == "__main__":
    unittest.main()
