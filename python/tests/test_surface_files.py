"""Heights and gaps in files, and pictures of them."""

import sys
import tempfile
import unittest
import warnings
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import matplotlib
import numpy as np

from contact_normal import surface
from test_surface import rough

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402


class DataArray:
    """The members of an xarray.DataArray that the reader uses."""

    def __init__(self, values, dims, unit, of_coordinates):
        self.values, self.dims, self.attrs = values, dims, {"units": unit} if unit else {}
        if len(dims) == 2:
            self.coords = {name: DataArray(1e-3 * np.arange(4), (name,), of_coordinates, None) for name in dims}

    def __getitem__(self, name):
        return self.coords[name]

    def transpose(self, *dims):
        return self if dims == self.dims else DataArray(self.values.T, dims, self.attrs.get("units"), None)


def instruments(topography, **channels):
    """Replaces SurfaceTopography: a reader whose topography is made by a function, with channels of these shapes."""
    named = [SimpleNamespace(name=name, dim=2, nb_grid_pts=shape) for name, shape in (channels or {"height": (5, 16)}).items()]
    reader = mock.MagicMock(channels=named, default_channel=named[0], topography=topography)
    reader.__enter__.return_value = reader
    return mock.patch.dict(sys.modules, {"SurfaceTopography": mock.Mock(open_topography=lambda path: reader)})


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_header_of_gwyddion_says_size_and_unit(self):
        z = 1e-8 * np.cumsum(rough(64)[:32], axis=1)
        rows = "".join("\t".join(f"{value:.17g}" for value in row) + "\n" for row in z)
        head = "# Channel: Topography\n# Width: 10{point}50 {unit}\n# Height: 5.00 {unit}\n# Value units: {value}\n"
        for encoding, point, unit in (("utf-8", ".", "\u00b5m"), ("latin-1", ",", "\u00b5m"), ("utf-8", ".", "\u03bcm"), ("utf-8", ".", "um")):
            for end in ("\n", "\r\n"):
                text = (head.format(point=point, unit=unit, value="m") + rows).replace("\n", end)
                (self.folder / "a.txt").write_bytes(text.encode(encoding))
                made = surface.read(self.folder / "a.txt")
                np.testing.assert_array_equal(made.z, z)
                np.testing.assert_allclose((made.dx, made.dy), (10.5e-6 / 64, 5e-6 / 32), rtol=1e-14)
                self.assertEqual(made.units, ("m", "N"))
        self.assertEqual(surface.read(self.folder / "a.txt", dx=2e-7, dy=3e-7).dy, 3e-7)
        with self.assertWarnsRegex(UserWarning, "says that the field is 1.05e-05 m long in x, and 10.5 is given: lengths are in m, as the heights"):
            surface.read(self.folder / "a.txt", size=(10.5, 5.0))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            surface.read(self.folder / "a.txt", span=(10.5e-6, 5e-6))
        with self.assertRaisesRegex(ValueError, "lengths are in m in the file"):
            surface.read(self.folder / "a.txt", units=("um", "N"))
        for text, told in ((head.format(point=".", unit="um", value="V"), "values are in V: they are no heights"),
                           (head.format(point=".", unit="um", value=""), "values are in no unit"),
                           (head.format(point=".", unit="deg", value="m"), "Width: 10.50 deg, which is no unit of length"),
                           (head.format(point=",000.", unit="um", value="m"), "a.txt says Width: 10,000.50 um; it must be a positive number without"),
                           (head.replace("10{point}50", "0.00").format(unit="um", value="m"), "says Width: 0.00 um; it must be a positive number")):
            (self.folder / "a.txt").write_text(text + rows)
            with self.assertRaisesRegex(ValueError, told):
                surface.read(self.folder / "a.txt")
        (self.folder / "a.txt").write_text(head.format(point=".", unit="\u212b", value="\u00c5") + rows, encoding="utf-8")
        self.assertEqual(surface.read(self.folder / "a.txt").units, ("\u00c5", "N"))
        # A character that is cut at the end of the read part must not change the encoding.
        for more in range(4):
            (self.folder / "a.txt").write_bytes((head.format(point=".", unit="\u00b5m", value="m") + "# " + "x" * more + "\u20ac" * 2000 + "\n" + rows).encode())
            self.assertAlmostEqual(surface.read(self.folder / "a.txt").dy, 5e-6 / 32, delta=1e-18)

    def test_a_bad_size_of_a_header_gives_way_to_one_that_is_given(self):
        np.savetxt(self.folder / "z.txt", 1e-8 * rough(4)[:3], fmt="%.17g")
        rows = (self.folder / "z.txt").read_text()
        places = {"x": 2e-6 * np.arange(4), "y": 1e-6 * np.arange(3)}
        for width in ("0.00 um", "-10 um", "10,000.50 um", "10 px"):
            (self.folder / "a.txt").write_text(f"# Width: {width}\n# Height: 5.00 um\n# Value units: m\n" + rows)
            for given in ({"size": (8e-6, 3e-6)}, {"dx": 2e-6, "dy": 1e-6}, {"span": (6e-6, 2e-6)}, places, {"size": (6e-6, 4e-6), "axes": "xy"}):
                with self.subTest(width, given=given):
                    made = surface.read(self.folder / "a.txt", **given)
                    np.testing.assert_allclose((made.dx, made.dy), (2e-6, 1e-6), rtol=1e-14)
                    self.assertEqual(made.units, ("m", "N"))
            with self.assertRaisesRegex(ValueError, r"; or give size=\(...\)"):
                surface.read(self.folder / "a.txt")

    def test_the_size_of_a_header_stays_with_its_indices(self):
        z = 1e-8 * rough(4)[:3]
        np.savetxt(self.folder / "a.txt", z, fmt="%.17g", header="Width: 10.00 um\nHeight: 5.00 um\nValue units: m")
        made = surface.read(self.folder / "a.txt", axes="xy")
        np.testing.assert_array_equal(made.z, z.T)
        np.testing.assert_allclose((made.dx, made.dy), (5e-6 / 3, 10e-6 / 4), rtol=1e-14)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            surface.read(self.folder / "a.txt", axes="xy", size=(5e-6, 10e-6))
        with self.assertWarnsRegex(UserWarning, "says that the field is 5e-06 m long in x, and 1e-05 is given"):
            surface.read(self.folder / "a.txt", axes="xy", size=(10e-6, 5e-6))

    def test_an_empty_cell_between_tabs_is_a_hole(self):
        z = rough(16)[:5]
        for holes in (z * 0.0 == 1.0, np.arange(16) == 6 + 0 * z, np.arange(16)[None] == np.arange(5)[:, None], np.arange(16) == 15 + np.arange(5)[:, None] % 2):
            for end in ("", "\t"):
                rows = ["\t".join("" if hole else f"{value:.17g}" for value, hole in zip(*row)) + end for row in zip(z, holes)]
                (self.folder / "a.txt").write_text("\n".join(rows))
                made = surface.read(self.folder / "a.txt", size=(16.0, 5.0))
                np.testing.assert_array_equal(made.z, np.where(holes, np.nan, z))
        # Rows without values, a line with one more tab, and files that SurfaceTopography would read with other columns.
        holes = (np.arange(16) == 6) | (np.arange(5)[:, None] == 2)
        rows = ["\t".join("" if hole else f"{value:.17g}" for value, hole in zip(*row)) for row in zip(z, holes)]
        rows[3] += "\t"
        for name in ("a.txt", "a.tsv", "a.asc"):
            (self.folder / name).write_text("\r\n".join(rows))
            made = surface.read(self.folder / name, size=(16.0, 5.0))
            np.testing.assert_array_equal(made.z, np.where(holes, np.nan, z))
        # A cell of blanks counts as empty. The first cell of a line may be empty, too, if lines have other holes.
        for holes, cell in ((np.arange(16) == 6 + 0 * z, " "), ((np.arange(16) == 0) | (np.arange(16)[None] == 3 + np.arange(5)[:, None]), "")):
            rows = ["\t".join(cell if hole else f"{value:.17g}" for value, hole in zip(*row)) for row in zip(z, holes)]
            (self.folder / "a.txt").write_text("\n".join(rows))
            with self.assertWarnsRegex(UserWarning, "has no number: a column of holes"):
                made = surface.read(self.folder / "a.txt", size=(16.0, 5.0))
            np.testing.assert_array_equal(made.z, np.where(holes, np.nan, z))
        # Several tabs that align columns, or a tab that begins all lines, do not make empty cells.
        for begin, between in (("", "\t\t"), ("\t", "\t"), ("\t", " \t\t ")):
            (self.folder / "a.txt").write_text("\n".join(begin + between.join(f"{value:.17g}" for value in row) for row in z))
            np.testing.assert_array_equal(surface.read(self.folder / "a.txt", dx=1.0, dy=1.0).z, z)

    def test_attributes_of_surface_topographys_files(self):
        z = rough(4)
        for periodic, given, period in (((1, 1), {}, "xy"), ((0, 1), {}, "y"), ((0, 0), {}, None), ((1, 1), {"period": None}, None), ((1, 1), {"dx": 1.0, "dy": 1.0}, "xy")):
            array = DataArray(z.T, ("x", "y"), None, None)
            for name, one in zip(array.dims, periodic):
                array.coords[name].attrs = {"length": 4e-3, "periodic": one, "unit": "mm"}
            array.attrs = {"unit": "mm"}
            made = surface.from_xarray(array, **given)
            np.testing.assert_array_equal(made.z, z)
            self.assertEqual((made.period, made.units), (period, ("mm", "N")))
            with self.assertRaisesRegex(ValueError, "lengths are in mm in the file"):
                surface.from_xarray(array, **given, units=("um", "N"))

    def test_arrays_of_numpy_and_text(self):
        z = rough(16)[:5]
        np.save(self.folder / "a.npy", z)
        np.savez(self.folder / "one.npz", heights=z)
        np.savez(self.folder / "two.npz", heights=z, other=z)
        np.savetxt(self.folder / "a.txt", z, fmt="%.17g")
        np.savetxt(self.folder / "a.csv", z, fmt="%.17g", delimiter=",")
        for name, given in (("a.npy", {}), ("one.npz", {}), ("two.npz", {"variable": "heights"}), ("a.txt", {}), ("a.csv", {})):
            made = surface.read(self.folder / name, dx=1.0, dy=2.0, **given)
            np.testing.assert_array_equal(made.z, z)
            self.assertEqual((made.dx, made.dy), (1.0, 2.0))
        with self.assertRaisesRegex(ValueError, "has heights, other; give variable, one of them"):
            surface.read(self.folder / "two.npz", dx=1.0, dy=2.0)

    def test_units_that_differ_are_refused(self):
        def array(heights, length):
            return DataArray(np.eye(4), ("y", "x"), heights, length)

        self.assertEqual(surface.from_xarray(array("mm", "mm"), units=("mm", "kN")).units, ("mm", "kN"))
        self.assertEqual(surface.from_xarray(array("um", "\u00b5m")).units, ("um", "N"))
        with self.assertRaisesRegex(ValueError, "heights are in um, and x in mm"):
            surface.from_xarray(array("um", "mm"))
        with self.assertRaisesRegex(ValueError, "lengths are in mm in the file"):
            surface.from_xarray(array("mm", "mm"), units=("m", "N"))
        # Units may be words of the NetCDF conventions.
        self.assertEqual(surface.from_xarray(array("micrometers", "\u00b5m")).units, ("micrometers", "N"))
        for one, other in (("meter", "m"), ("Metres", "m"), ("microns", "um"), ("millimetre", "mm"), ("nanometers", "nm")):
            surface.from_xarray(array(one, other))
        with self.assertWarnsRegex(UserWarning, "heights in um, x in no unit"):
            surface.from_xarray(array("um", None))
        uneven = array(None, "mm")
        uneven.coords["y"].attrs["units"] = "m"
        with self.assertRaisesRegex(ValueError, "x is in mm, and y in m"):
            surface.from_xarray(uneven)
        plain = DataArray(np.eye(4), ("a", "b"), None, None)
        plain.coords = {}
        self.assertEqual(surface.from_xarray(plain, dx=1e-6, dy=2e-6).dy, 2e-6)
        with self.assertRaisesRegex(ValueError, "no coordinates: give dx"):
            surface.from_xarray(plain)

    def test_units_of_two_surfaces_agree(self):
        one, other = (surface.heights(np.eye(4), dx=1.0, dy=1.0, units=units) for units in (("mm", "N"), ("um", "mN")))
        with self.assertRaisesRegex(ValueError, "one unit of length"):
            surface.gap(one, other)
        unnamed = surface.heights(np.eye(4), dx=1.0, dy=1.0)
        self.assertEqual(surface.gap(unnamed, one).units, ("mm", "N"))
        for units in (("m", "m"), ("N", "m")):
            with self.assertRaisesRegex(ValueError, "first is that of lengths"):
                surface.heights(np.eye(4), dx=1.0, dy=1.0, units=units)

    def test_one_array_has_no_names(self):
        np.save(self.folder / "b.npy", np.eye(4))
        with self.assertRaisesRegex(ValueError, "holds one array"):
            surface.read(self.folder / "b.npy", "q", dx=1.0, dy=1.0)

    def test_files_keep_every_bit(self):
        path = self.folder / "gap.txt"
        gap = surface.gap(surface.heights(np.where(rough() > 1, np.nan, rough())[:40], 1 / 3, 1 / 7))
        gap.write(path, "rough")
        lines = path.read_text().splitlines()
        self.assertEqual(lines[1:3], ["# rough", f"64 40 {1 / 3!r} {1 / 7!r}"])
        self.assertEqual(len(lines), 3 + 64 * 40)
        self.assertIn("inf", lines)
        read = surface.Gap.read(path)
        np.testing.assert_array_equal(read.h, gap.h)
        self.assertEqual((read.dx, read.dy), (1 / 3, 1 / 7))
        path.write_text("\n".join(lines[:-1]))
        with self.assertRaisesRegex(ValueError, "has 2559 distances; 64 x 40 elements need 2560"):
            surface.Gap.read(path)
        path.write_text("1 2 3\n")
        with self.assertRaisesRegex(ValueError, "it is no file of a gap"):
            surface.Gap.read(path)
        with self.assertRaisesRegex(ValueError, "comment has several lines"):
            gap.write(path, "a\nb")

    def test_a_missing_package_is_named(self):
        with mock.patch.dict(sys.modules, {"SurfaceTopography": None}):
            with self.assertRaisesRegex(ImportError, r"files \.x3p need SurfaceTopography: pip install 'contact-normal\[surface\]'"):
                surface.read(self.folder / "a.x3p")
        with mock.patch.dict(sys.modules, {"xarray": None, "netCDF4": None}):
            with self.assertRaisesRegex(ImportError, "xarray and netCDF4: pip install"):
                surface.read(self.folder / "a.nc")

    def test_points_with_holes_are_no_map(self):
        x, y = (one.ravel() for one in np.meshgrid(np.arange(8) * 0.5, np.arange(6) * 0.5))
        kept = np.arange(48) != 17
        np.savetxt(self.folder / "points.txt", np.stack([x, y, np.sin(x + y)], axis=1)[kept])
        with self.assertRaisesRegex(ValueError, "has x, y and z of 47 points"):
            surface.read(self.folder / "points.txt", dx=1, dy=1)
        with self.assertWarnsRegex(UserWarning, "1 of 48 places of the grid of 6 x 8 have no point: they are holes"):
            made = surface.read(self.folder / "points.txt")
        np.testing.assert_array_equal(np.argwhere(made.holes), [[2, 1]])
        np.savetxt(self.folder / "narrow.txt", rough(64)[:, :3])
        with self.assertWarnsRegex(UserWarning, "a map of 64 x 3"):
            self.assertEqual(surface.read(self.folder / "narrow.txt", dx=1, dy=1).z.shape, (64, 3))

    def test_lists_of_points_in_any_order_are_no_map(self):
        x, y = (one.ravel() for one in np.meshgrid(np.arange(9) * 0.5, np.arange(7) * 0.3))
        z, random = np.sin(x + y * y), np.random.default_rng(3)
        moved, some = x + random.normal(0, 1e-4, x.size), random.permutation(63)[:25]
        lists = {
            "z x y": (z, x, y), "x z y": (x, z, y), "with an intensity": (x, y, z, random.normal(size=63)), "numbered": (np.arange(63.0), x, y, z),
            "of a stage": (moved, y, z), "twice": [np.append(one, one[5]) for one in (x, y, z)], "a part": (x[some], y[some], z[some]),
            "a line": (np.arange(9) * 0.5, np.sin(np.arange(9.0))),
        }
        for name, columns in lists.items():
            with self.subTest(name):
                np.savetxt(self.folder / "points.txt", np.stack(columns, axis=1))
                with self.assertRaisesRegex(ValueError, "a list of points|x, y and z of"):
                    surface.read(self.folder / "points.txt", dx=1, dy=1)

    def test_coordinates_beside_the_heights_are_told(self):
        heights = rough(24)[:12, :12]
        for name, table, which in (
            ("both", np.block([[np.zeros((1, 1)), np.arange(12)[None] * 0.5], [np.arange(12)[:, None] * 0.3, heights]]), "line"),
            ("a line", np.vstack([np.arange(12) * 0.5, heights]), "line"), ("a column", np.column_stack([np.arange(12), heights]), "column"),
        ):
            # The step of the line in its unit or in another one, from the size of an element or of the field.
            for given in ({"dx": 0.5, "dy": 0.1}, {"dx": 5e-4, "dy": 0.1}, {"size": (6.0, 6.0)}, {"span": (5.5, 5.5)}):
                with self.subTest(name, given=given):
                    np.savetxt(self.folder / "table.txt", table)
                    with self.assertRaisesRegex(ValueError, f"has coordinates in its first {which}"):
                        surface.read(self.folder / "table.txt", **given)
                if which == "line" and name != "both":
                    # The first index is x: a line has the coordinates of y.
                    turned = {"dx": 0.1, "dy": 0.5} if "dx" in given else {"span": (12.0, 5.5)}
                    with self.assertRaisesRegex(ValueError, "has coordinates in its first line"):
                        surface.read(self.folder / "table.txt", axes="xy", **turned)
        np.savetxt(self.folder / "plain.txt", heights)
        for wrong in (10.0, None, (10.0,)):
            with self.assertRaisesRegex((TypeError, ValueError), "two numbers|in one way"):
                surface.read(self.folder / "plain.txt", size=wrong)
        # This line has no coordinates: its step is unrelated to the size of an element.
        far = np.vstack([0.0137 * np.arange(12) + 40.0, heights])
        np.savetxt(self.folder / "far.txt", far)
        with self.assertWarnsRegex(UserWarning, "a straight first line, which is read as heights"):
            self.assertEqual(surface.read(self.folder / "far.txt", dx=0.5, dy=0.5).z.shape, far.shape)
        with self.assertRaisesRegex(ValueError, "has coordinates in its first line"):
            surface.read(self.folder / "far.txt", x=np.arange(12), y=np.arange(13))
        # A faulty line of a scan is straight after levelling, and is not taken for coordinates.
        broken = heights.copy()
        broken[0] = np.linspace(-0.31, 0.42, heights.shape[1]) * np.ptp(heights)
        np.savetxt(self.folder / "broken.txt", broken)
        for name, table in (("line", broken), ("column", broken.T)):
            with self.subTest(name), self.assertWarnsRegex(UserWarning, f"a straight first {name}, which is read as heights"):
                np.savetxt(self.folder / "broken.txt", table)
                self.assertEqual(surface.read(self.folder / "broken.txt", dx=1, dy=1).z.shape, table.shape)
        # All lines of a wedge rise evenly, so that the first one is not taken for coordinates.
        np.savetxt(self.folder / "wedge.txt", np.add.outer(np.arange(12.0), np.arange(9.0)))
        self.assertEqual(surface.read(self.folder / "wedge.txt", dx=1, dy=1).z.shape, (12, 9))

    def test_esri_grids_are_refused_by_name(self):
        for end in ("asc", "txt"):
            path = self.folder / f"grid.{end}"
            path.write_text("NCOLS 3\nNROWS 2\nXLLCORNER 0\nYLLCORNER 0\nCELLSIZE 2\nNODATA_value -9999\n1 2 3\n4 -9999 6\n")
            with self.assertRaisesRegex(ValueError, "is an ESRI grid: .* NODATA_value as fill"):
                surface.read(path, dx=2, dy=2)

    def test_decimal_commas_between_commas_are_told(self):
        (self.folder / "d.csv").write_text("0,1257,-0,0321,1,5\n0,5,0,7,0,3\n")
        with self.assertRaisesRegex(ValueError, "begin with zeros between its commas"):
            surface.read(self.folder / "d.csv", dx=1, dy=1)

    def test_texts_as_instruments_and_spreadsheets_write_them(self):
        z = np.round(0.1 * rough(16)[:5], 6)
        rows = [[f"{value:.6f}" for value in row] for row in z]
        hole = np.where(np.arange(80).reshape(5, 16) == 37, np.nan, z)
        parted = ["\t".join(row) for row in rows]
        empty = [",".join("" if np.isnan(hole[iy, ix]) else cell for ix, cell in enumerate(row)) for iy, row in enumerate(rows)]
        for name, end, lines, encoding, expected in (
            ("UTF-16", ".txt", parted, "utf-16", z), ("minus", ".txt", [line.replace("-", "\u2212") for line in parted], "utf-8", z),
            ("Fortran", ".dat", [" ".join(f"{value:.6E}".replace("E", "D") for value in row) for row in z], "ascii", z),
            ("Latin", ".dat", ["# H\u00f6he in \u00b5m", *parted], "latin-1", z), ("tabs", ".csv", parted, "ascii", z),
            ("quoted", ".csv", [",".join(f'"{cell}"' for cell in row) for row in rows], "ascii", z),
            ("an end", ".csv", [",".join(row) + "," for row in rows], "ascii", z),
            ("empty", ".csv", empty, "ascii", hole), ("empty, commas", ".txt", [line.replace(",", ";").replace(".", ",") for line in empty], "ascii", hole),
        ):
            with self.subTest(name):
                path = self.folder / f"a{end}"
                path.write_text("\n".join(lines) + "\n", encoding=encoding)
                np.testing.assert_array_equal(surface.read(path, dx=1, dy=1).z, expected)

    def test_a_binary_file_is_an_instruments(self):
        (self.folder / "zygo.dat").write_bytes(bytes([0x88, 0x1B, 0x03, 0x6F]) + bytes(100))
        z = rough(16)[:5]
        made = mock.Mock(dim=2, is_uniform=True, physical_sizes=(1.0, 2.0), is_periodic=False, unit="um", heights=lambda: z)
        with instruments(lambda channel_index: made):
            np.testing.assert_array_equal(surface.read(self.folder / "zygo.dat").z, z.T)

    def test_decimal_commas_are_named(self):
        for name, text in (("a.txt", "0,5 0,7\n1,5 1,7\n"), ("b.csv", "0,5\t0,7\n1,5\t1,7\n"), ("q.csv", '"1,05","0,03"\n"2,1","0,4"\n')):
            (self.folder / name).write_text(text)
            with self.assertRaisesRegex(ValueError, "decimal commas need semicolons between the numbers"):
                surface.read(self.folder / name, dx=1, dy=1)
        (self.folder / "c.csv").write_text("0.5,0.7\nx,1.7\n")
        with self.assertRaisesRegex(ValueError, "could not convert") as raised:
            surface.read(self.folder / "c.csv", dx=1, dy=1)
        self.assertNotIn("decimal commas", str(raised.exception))

    def test_an_instruments_file_may_not_say_its_size(self):
        def topography(physical_sizes=None, channel_index=None):
            if physical_sizes is None:
                raise KeyError("`physical_sizes` could not be extracted from file")
            return mock.Mock(dim=2, is_uniform=True, physical_sizes=physical_sizes, is_periodic=False, unit=None, heights=lambda: rough(16)[:5])

        with instruments(topography):
            for given in ({"size": (10.0, 32.0)}, {"dx": 2.0, "dy": 2.0}, {"span": (8.0, 30.0)}):
                made = surface.read(self.folder / "a.asc", **given)
                self.assertEqual((made.dx, made.dy, made.z.shape), (2.0, 2.0, (16, 5)))
            with self.assertRaisesRegex(TypeError, "does not say the size of an element: give size, the lengths of the field, or dx and dy"):
                surface.read(self.folder / "a.asc")
        with instruments(mock.Mock(side_effect=RuntimeError("tried A:\n no\n\ntried B"))), self.assertRaises(ValueError) as raised:
            surface.read(self.folder / "a.gsf", dx=1, dy=1)
        self.assertIn("a.gsf is no file of heights that SurfaceTopography reads: RuntimeError, tried A:", str(raised.exception))
        self.assertEqual(len(str(raised.exception).splitlines()), 1)

    def test_a_fill_value_that_no_element_has_is_told(self):
        with self.assertWarnsRegex(UserWarning, "no element has the value -9998 that stands for 'not measured'"):
            surface.heights(np.where(np.eye(4) > 0, -9999.0, 1.0), 1, 1, fill=-9998)

    def test_a_topography_has_x_first(self):
        z = rough(16)[:5]
        topography = mock.Mock(dim=2, is_uniform=True, physical_sizes=(1.0, 2.0), is_periodic=True, unit="um", heights=lambda: z)
        with instruments(lambda channel_index: topography):
            made = surface.read(self.folder / "a.x3p")
        np.testing.assert_array_equal(made.z, z.T)
        self.assertEqual((made.dx, made.dy, made.period, made.units), (1.0 / 5, 2.0 / 16, "xy", ("um", "N")))
        self.assertIsNone(surface.from_topography(topography, period=None).period)
        # The physical sizes belong to the indices, also if these are exchanged.
        turned = surface.from_topography(topography, axes="yx")
        np.testing.assert_array_equal(turned.z, z)
        self.assertEqual((turned.dx, turned.dy), (2.0 / 16, 1.0 / 5))
        with self.assertRaisesRegex(ValueError, "a line scan or not uniform"):
            surface.from_topography(mock.Mock(dim=1, is_uniform=True))

    def test_sizes_and_axes_of_arrays_with_coordinates(self):
        z = 1e-4 * np.arange(16.0).reshape(4, 4)
        array = DataArray(z, ("y", "x"), None, None)
        for given in ({"span": (3.0, 6.0)}, {"x": np.arange(4.0), "y": 2.0 * np.arange(4.0)}, {"dx": 1.0, "dy": 2.0}):
            made = surface.from_xarray(array, **given)
            self.assertEqual((made.dx, made.dy), (1.0, 2.0))
        with self.assertRaisesRegex(TypeError, "give dx, too"):
            surface.from_xarray(array, dy=1.0)
        for dims, axes in ((("x", "y"), "xy"), (("a", "b"), "xy")):
            np.testing.assert_array_equal(surface.from_xarray(DataArray(z, dims, None, None), axes=axes).z, z.T)
        for dims, axes in ((("x", "y"), "yx"), (("y", "x"), "xy")):
            with self.assertRaisesRegex(ValueError, f"axes is '{axes}', but the array has the dimensions .*: leave axes out"):
                surface.from_xarray(DataArray(z, dims, None, None), axes=axes)


    def test_matrices_have_y_by_rows_and_one_of_several_is_named(self):
        z = 0.1 * rough(16)[:5]
        made = mock.Mock(dim=2, is_uniform=True, physical_sizes=(1.0, 1.0), is_periodic=False, unit=None)

        def topography(channel_index, physical_sizes=(1.0, 1.0)):
            self.assertEqual(channel_index, 2)
            return made

        made.heights = lambda: z
        with instruments(topography, x=(1, 16), X=(5, 16), Z=(5, 16)):
            with self.assertRaisesRegex(ValueError, "a.mat has X, Z; give variable, one of them"):
                surface.read(self.folder / "a.mat", dx=0.5, dy=0.25)
            read = surface.read(self.folder / "a.mat", "Z", dx=0.5, dy=0.25)
            np.testing.assert_array_equal(read.z, z)
            self.assertEqual(surface.read(self.folder / "a.mat", "Z", dx=0.5, dy=0.25, axes="xy").z.shape, (16, 5))
            # The first channel of an instrument's file has the heights.
            np.testing.assert_array_equal(surface.read(self.folder / "a.gwy", "Z").z, z.T)
        with instruments(lambda channel_index: made, forward=(5, 16), backward=(5, 16)):
            with self.assertWarnsRegex(UserWarning, "a.gwy has forward, backward; forward is read: variable= names another one"):
                surface.read(self.folder / "a.gwy")
        with instruments(lambda channel_index, **_: made, x=(1, 16), Z=(5, 16)), warnings.catch_warnings():
            warnings.simplefilter("error")
            np.testing.assert_array_equal(surface.read(self.folder / "a.mat", dx=0.5, dy=0.25).z, z)

    def test_what_has_no_two_dimensions_is_no_map(self):
        z = DataArray(np.eye(4), ("y", "x"), "mm", "mm")

        def series(count):
            """Maps at several times."""
            sizes = {"t": count, "y": 4, "x": 4}
            return SimpleNamespace(dims=tuple(sizes), sizes=sizes, shape=(count, 4, 4), ndim=3, squeeze=lambda *_, **__: z)

        # A series of a single map is read as this map.
        self.assertEqual(surface.from_xarray(series(1)).z.shape, (4, 4))
        with self.assertRaisesRegex(ValueError, "heights have two: choose one map by isel"):
            surface.from_xarray(series(2))
        z.ndim, z.shape = 2, (4, 4)
        projection = SimpleNamespace(ndim=0, shape=())
        for arrays, variable in (({"z": z, "crs": projection}, None), ({"z": series(1), "crs": projection}, None), ({"z": series(1), "mask": z}, "z")):
            dataset = mock.MagicMock(data_vars=arrays, __getitem__=lambda _, name, arrays=arrays: arrays[name])
            with mock.patch("contact_normal._netcdf.read", return_value=dataset):
                self.assertEqual(surface.read(self.folder / "a.nc", variable=variable).z.shape, (4, 4))
        with mock.patch("contact_normal._netcdf.read", return_value=dataset), self.assertRaisesRegex(ValueError, "has z, mask; give variable"):
            surface.read(self.folder / "a.nc")

    def test_a_mask_by_surface_topography_is_no_map(self):
        z = DataArray(np.eye(4), ("y", "x"), "mm", "mm")
        z.ndim, z.shape = 2, (4, 4)
        for attributes, names in (({"maskandscale": 0}, "heights"), ({}, "heights, mask")):
            mask = SimpleNamespace(ndim=2, shape=(4, 4), attrs=attributes)
            arrays = {"heights": z, "mask": mask}
            dataset = mock.MagicMock(data_vars=arrays, __getitem__=lambda _, name, arrays=arrays: arrays[name])
            with mock.patch("contact_normal._netcdf.read", return_value=dataset):
                if names == "heights":
                    self.assertEqual(surface.read(self.folder / "a.nc").z.shape, (4, 4))
                else:
                    with self.assertRaisesRegex(ValueError, f"has {names}; give variable"):
                        surface.read(self.folder / "a.nc")
                self.assertEqual(surface.read(self.folder / "a.nc", variable="heights").z.shape, (4, 4))


class Pictures(unittest.TestCase):
    def tearDown(self):
        pyplot.close("all")

    def test_they_name_quantities_and_units(self):
        z = rough()
        z[5, 7], z[20:22, 20] = 9.0, np.nan
        made = surface.heights(z, 0.5, 0.5, units=("um", "N"))
        axes = surface.faults(made).plot()
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x [um]", "y [um]"))
        self.assertEqual(axes.figure.axes[1].get_ylabel(), "height z [um]")
        (marked,) = axes.get_lines()
        np.testing.assert_allclose(marked.get_xydata(), [(made.x[7], made.y[5])])
        shown = axes.images[0].get_array()
        self.assertEqual(shown.mask.sum(), 3)
        drawn = surface.gap(made).plot(largest=2.0)
        self.assertEqual(drawn.figure.axes[1].get_ylabel(), "undeformed distance h [um]")
        self.assertEqual(drawn.images[0].get_clim()[1], 2.0)
