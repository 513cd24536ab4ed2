"""Heights from datasets of xarray and NetCDF files."""

import tempfile
import unittest
from pathlib import Path

import numpy as np
import xarray

from contact_normal import surface

Z = np.random.default_rng(5).normal(size=(5, 7))


class Heights(unittest.TestCase):
    def test_dimensions_in_any_order_and_falling_coordinates(self):
        x, y = 0.5 * np.arange(7), 0.25 * np.arange(5)
        for array, expected in (
            (xarray.DataArray(Z, dims=("y", "x"), coords={"x": x, "y": y}), Z),
            (xarray.DataArray(Z.T, dims=("x", "y"), coords={"x": x, "y": y}), Z),
            (xarray.DataArray(Z, dims=("row", "column"), coords={"column": x, "row": y[::-1]}), Z[::-1]),
        ):
            made = surface.from_xarray(array)
            np.testing.assert_array_equal(made.z, expected)
            self.assertEqual((made.dx, made.dy, made.units), (0.5, 0.25, None))

    def test_units_are_told_if_all_agree(self):
        told = {"units": "um"}
        array = xarray.DataArray(Z, dims=("y", "x"), coords={"x": ("x", np.arange(7.0), told), "y": ("y", np.arange(5.0), told)}, attrs=told)
        self.assertEqual(surface.from_xarray(array).units, ("um", "N"))
        self.assertEqual(surface.from_xarray(array, units=("um", "mN")).units, ("um", "mN"))
        self.assertIsNone(surface.from_xarray(array.assign_attrs(units="")).units)

    def test_units_that_disagree_are_refused(self):
        told = {"units": "um"}
        array = xarray.DataArray(Z, dims=("y", "x"), coords={"x": ("x", np.arange(7.0), told), "y": ("y", np.arange(5.0), told)}, attrs=told)
        with self.assertRaisesRegex(ValueError, "lengths are in um in the file"):
            surface.from_xarray(array, units=("m", "kN"))
        with self.assertRaisesRegex(ValueError, "the heights are in nm, and x in um"):
            surface.from_xarray(array.assign_attrs(units="nm"))

    def test_what_has_no_grid_is_refused(self):
        with self.assertRaisesRegex(ValueError, "the dimension x has no coordinates"):
            surface.from_xarray(xarray.DataArray(Z, dims=("y", "x"), coords={"y": np.arange(5)}))
        with self.assertRaisesRegex(ValueError, "heights have two"):
            surface.from_xarray(xarray.DataArray(Z[0], dims=("x",), coords={"x": np.arange(7)}))

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.nc")
            array = xarray.DataArray(Z, dims=("y", "x"), coords={"x": np.arange(7) * 0.1, "y": np.arange(5) * 0.2})
            xarray.Dataset({"z": array, "other": array + 1}).to_netcdf(path, engine="netcdf4")
            made = surface.read(path, "z")
            np.testing.assert_array_equal(made.z, Z)
            self.assertAlmostEqual(made.dy, 0.2, delta=1e-12)
            with self.assertRaisesRegex(ValueError, "has z, other; give variable"):
                surface.read(path)

    def test_a_word_in_a_row_of_numbers_is_refused(self):
        plain = [[f"{value:.4f}" for value in row] for row in Z]
        header = ["# Channel: Main", "# Width: 7 um", "# Height: 5 um", "# Value units: um"]
        # A row with a word alone, in the middle and at both ends; a row of words; words within comments are read over.
        changes = [(row, lambda cells, word=word: [word, *cells[1:]]) for word in ("***", "---", "N/A", "#N/A", "1.#QNAN", "No Data", "1e") for row in (0, 2, 4)]
        changes += [(row, lambda cells: ["***"] * len(cells)) for row in (0, 2, 4)] + [(1, lambda cells: [*cells, "# the second row"])]
        with tempfile.TemporaryDirectory() as folder:
            for end, tab in ((".asc", " "), (".asc", "\t"), (".tsv", "\t"), (".xyz", " ")):
                path = Path(folder, f"map{end}")
                for row, change in changes:
                    cells = [*plain[:row], change(plain[row]), *plain[row + 1:]]
                    path.write_text("\n".join([*header, *map(tab.join, cells)]))
                    with self.assertRaisesRegex(ValueError, f"line {row + 5} has '.*' among its numbers"):
                        surface.read(path)
                # Units over the columns, places of columns with a word, and comments are lines of a header; "infinite" is a hole.
                for above in (["um " * 7], ["y\\x 0 0.5 1 1.5 2 2.5"], ["Measured 2024 1 15 12 30 by hand"]):
                    path.write_text("\n".join([*header, *above, *map(tab.join, plain)]))
                    self.assertEqual(surface.read(path).z.shape, (5, 7))
                path.write_text("\n".join([*header, *map(tab.join, plain)]).replace(plain[0][3], "infinite"))
                self.assertEqual(int(np.isnan(surface.read(path).z).sum()), 1)
                path.write_text("\n".join([*header, "# 1 2 3 4 5 6 7", *map(tab.join, plain)]), encoding="utf-8-sig")
                made = surface.read(path)
                self.assertEqual((made.z.shape, made.units, round(made.dx, 9)), ((5, 7), ("um", "N"), 1.0))
                path.write_text("\n".join(map(tab.join, plain)), encoding="utf-8-sig")
                np.testing.assert_allclose(surface.read(path, dx=1.0, dy=1.0).z, Z, atol=1e-4)

    def test_axes_are_those_of_the_lines_of_a_text(self):
        lines = "\n".join("\t".join(f"{z:.6f}" for z in row) for row in Z)
        text = f"# Channel: Height\n# Width: 14 um\n# Height: 15 um\n# Value units: um\n{lines}\n"
        with tempfile.TemporaryDirectory() as folder:
            for end in ("txt", "asc", "tsv"):
                path = Path(folder, f"map.{end}")
                path.write_text(text)
                for axes, z, steps in (("yx", Z, (2.0, 3.0)), ("xy", Z.T, (3.0, 2.0)), (None, Z, (2.0, 3.0))):
                    made = surface.read(path, **({"axes": axes} if axes else {}))
                    np.testing.assert_allclose(made.z, z, atol=1e-6, err_msg=f"{end} {axes}")
                    np.testing.assert_allclose((made.dx, made.dy), steps)
                    np.testing.assert_allclose(surface.read(path, size=(21.0, 35.0), axes=axes or "yx").dx, 21.0 / z.shape[1])
