"""Lines above the columns of lists of points: units, the order of the columns, and lines that are not understood."""

import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

from contact_normal import surface

X, Y = np.meshgrid(0.5 * np.arange(9), 0.25 * np.arange(7))
Z = 0.1 * np.sin(X + Y**2)
ENDS = (".txt", ".dat", ".csv", ".xyz", ".asc", ".tsv")


class Headers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def read(self, head, columns, end=".txt", kept=slice(None), **given):
        path = self.folder / f"points{end}"
        between = {".csv": ",", ".tsv": "\t"}.get(end, " ")
        rows = [between.join(f"{one:.17g}" for one in row) for row in zip(*(np.ravel(column) for column in columns))]
        path.write_text("\n".join([head, *rows[kept]]) + "\n", encoding="utf-8")
        return surface.read(path, **given)

    def assert_grid(self, found, unit=None):
        self.assertEqual(found.z.shape, Z.shape)
        np.testing.assert_allclose(found.z, Z, rtol=1e-14)
        self.assertEqual((found.dx, found.dy, found.units), (0.5, 0.25, (unit, "N") if unit else None))

    def silent(self):
        caught = warnings.catch_warnings()
        caught.__enter__()
        self.addCleanup(caught.__exit__, None, None, None)
        warnings.simplefilter("error")

    def test_a_width_without_a_unit_is_quoted_whole(self):
        path = self.folder / "map.txt"
        for width, told in (("30.00", "30.00, which has no unit of length"), ("30", "30, which has no unit of length"), ("3.0e1  ", "3.0e1, which has no unit of length"),
                            ("30.00 px", "30.00 px, which is no unit of length"), ("30.00px", "30.00 px, which is no unit of length")):
            path.write_text(f"# Width: {width}\n# Height: {width}\n# Value units: m\n1e-9 2e-9 4e-9\n3e-9 1e-9 5e-9\n")
            with self.subTest(width), self.assertRaisesRegex(ValueError, rf"says Width: {told}; or give size="):
                surface.read(path)
            self.assertEqual(surface.read(path, dx=1e-5, dy=1e-5).units, ("m", "N"))
        path.write_text("# Width: 30.00um\n# Height: 2e1 um\n# Value units: m\n1e-9 2e-9 4e-9\n3e-9 1e-9 5e-9\n")
        found = surface.read(path)
        np.testing.assert_allclose((found.dx, found.dy), (1e-5, 1e-5))

    def test_all_ends_obey_the_header(self):
        self.silent()
        for end in ENDS:
            with self.subTest(end):
                self.assert_grid(self.read("# x [um] y [um] z [um]", (X, Y, Z), end), "um")
                self.assert_grid(self.read("# y [um] x [um] z [um]", (Y, X, Z), end), "um")
                self.assert_grid(self.read("# y x z", (Y, X, Z), end))
                with self.assertRaisesRegex(ValueError, "x in um, y in um, z in mm: convert them to one unit"):
                    self.read("# x [um] y [um] z [mm]", (X, Y, Z), end)
                with self.assertRaisesRegex(ValueError, "lengths are in um in the file"):
                    self.read("# x [um] y [um] z [um]", (X, Y, Z), end, units=("mm", "N"))
                with self.assertRaisesRegex(ValueError, "of 63 points of a grid, which say the size of an element: leave out dx and dy"):
                    self.read("# x [um] y [um] z [um]", (X, Y, Z), end, dx=0.5, dy=0.25)

    def test_all_ends_have_holes_where_places_are_missing(self):
        for end in ENDS:
            with self.subTest(end), self.assertWarnsRegex(UserWarning, "3 of 63 places of the grid of 7 x 9 have no point: they are holes") as told:
                found = self.read("# x [um] y [um] z [um]", (X, Y, Z), end, kept=slice(3, None))
            self.assertEqual((found.units, found.holes.sum(), found.holes[0, :3].all()), (("um", "N"), 3, True))
            self.assertEqual(told.filename, __file__)

    def test_names_of_columns(self):
        self.silent()
        for head in ("# x [{0}], y [{0}], Height [{1}]", "# X ({0})\tY ({0})\tHeight ({1})", "# x [{0}] y [{0}] h [{1}]", "# x-axis [{0}] y-axis [{0}] z-axis [{1}]",
                     "# x_{0} y_{0} z_{1}", "#x {0} y {0} z {1}", "# x in {0}, y in {0}, z in {1}", "# X, {0}; Y, {0}; Z, {1}", "#x[{0}]y[{0}]z[{1}]",
                     "# Spalte 1: x [{0}]\n# Spalte 2: y [{0}]\n# Spalte 3: z [{1}]", "# Position X [{0}] Position Y [{0}] Position Z [{1}]",
                     "# x{{{0}}} y{{{0}}} z{{{1}}}", "# x<{0}> y<{0}> z<{1}>", "# X/{0} Y/{0} H\u00f6he/{1}", "# X [{0}] Y [{0}] Topography [{1}]"):
            with self.subTest(head):
                self.assert_grid(self.read(head.format("um", "um"), (X, Y, Z)), "um")
                with self.assertRaisesRegex(ValueError, "x in um, y in um, z in mm: convert them to one unit"):
                    self.read(head.format("um", "mm"), (X, Y, Z))
        for head, columns in (("# Y[um],X[um],Height[um]", (Y, X, Z)), ("# Height/um Y/um X/um", (Z, Y, X)), ("# Spalte 1: y [um]\n# Spalte 2: x [um]\n# Spalte 3: z [um]", (Y, X, Z))):
            self.assert_grid(self.read(head, columns), "um")

    def test_the_order_without_units(self):
        self.silent()
        light = 200.0 + np.cos(7.0 * X * Y)
        for head, columns in (("# Y X Height", (Y, X, Z)), ("# y,x,height", (Y, X, Z)), ("# row col z", (Y, X, Z)), ("# iy ix z", (Y, X, Z)), ("# y; x; h", (Y, X, Z)),
                              ("# Y\tX\tZ\tI", (Y, X, Z, light)), ("# x y intensity z", (X, Y, light, Z)), ("# index y x z", (np.arange(63.0), Y, X, Z))):
            with self.subTest(head):
                self.assert_grid(self.read(head, columns))
        warnings.simplefilter("ignore")
        for end in ENDS:
            for columns in ((Y, X, Z, light), (np.arange(63.0), Y, X, Z)):
                self.assert_grid(self.read("# y x z", columns, end))
                self.assert_grid(self.read("# y x z of a stage\n# y x z", columns, end))
        warnings.simplefilter("error")
        # These lines do not name columns.
        for head in ("# y and x of the stage, z of the sensor", "# lines along y, steps along x, heights", "# 20 x 30"):
            with self.subTest(head):
                self.assert_grid(self.read(head, (X, Y, Z)))

    def test_values_are_of_no_column(self):
        self.silent()
        for head in ("# Size x (mm): 7\n# Size y (mm): 10\n# Resolution z (nm): 0.1", "# Step y [mm]: 2\n# Step x [mm] = 1\n# Step z [mm]: .001",
                     "# stage x/mm: 10\n# stage y/mm: -5\n# stage z/mm: 0"):
            for more in ("", "\n# x y z"):
                with self.subTest(head + more):
                    self.assert_grid(self.read(head + more, (X, Y, Z)))
                    self.assert_grid(self.read(head + more, (X, Y, Z), units=("um", "N")), "um")

    def test_of_two_columns_of_heights_the_first_one_counts(self):
        with self.assertWarnsRegex(UserWarning, "number 3 as the heights"):
            self.assert_grid(self.read("# x [mm] y [mm] z [mm] height [um]", (X, Y, Z, np.cos(7.0 * X * Y))), "mm")

    def test_a_map_has_no_columns_of_points(self):
        path = self.folder / "map.txt"
        np.savetxt(path, np.random.default_rng(1).normal(size=(20, 30)), header="x [um] y [um] z [nm]")
        with self.assertRaisesRegex(TypeError, "give the size of an element"):
            surface.read(path)

    def test_units_that_are_not_understood_are_told(self):
        for head, line in (("# units: um um mm", "units: um um mm"), ("# Lateral unit: um\n# Height unit: mm", "Lateral unit: um"), ("# xunit=um\n# zunit=mm", "xunit=um"),
                           ("# x [1e-6 m] y [1e-6 m] z [1e-3 m]", "x .1e-6 m. y"), ("# x y z [mm]", "x y z .mm."), ("# Breite [um] L\u00e4nge [um] Wert [mm]", "Breite .um."),
                           ("# Lengths in micrometers", "Lengths in micrometers")):
            with self.subTest(head), self.assertWarnsRegex(UserWarning, f"the unit in the line '# {line}.*' is not read: x, y and z are taken to be in one unit") as told:
                self.assert_grid(self.read(head, (X, Y, Z)))
            self.assertEqual(told.filename, __file__)
        with self.assertWarnsRegex(UserWarning, "the unit in the line"):
            self.assert_grid(self.read("# y x z [mm]", (Y, X, Z)))
        self.silent()
        for head in ("# x y z", "# objective 50x, distance 3 mm, slope 2 um/s", "# Sample no. 7 of m and s", "# x [mm] y [mm] z [mm]\n# heights in mm"):
            self.read(head, (X, Y, Z))
        # Ignored: units of other quantities and of values, folders, names.
        for head in ("Feed rate mm/min: 5", "Speed [mm/s]: 2", "gain nm/V: 3", "File: C:/data/mm/a.txt", "Stylus tip radius [um]: 2", "Filter cutoff [mm] 0.8",
                     "wavelength (nm): 633", "z-range, um: 10", "dx [mm] = 0.5", "Created by Meter X", "Micron Inc."):
            with self.subTest(head):
                self.assert_grid(self.read(f"# {head}", (X, Y, Z)))
        # With a unit from the caller there is no message.
        self.assert_grid(self.read("# units: um", (X, Y, Z), units=("um", "N")), "um")


if __name__ == "__main__":
    unittest.main()
