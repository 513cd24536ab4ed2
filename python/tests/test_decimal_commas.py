"""Decimal commas in texts whose columns are parted by commas, too: each number would be read as two."""

import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

from contact_normal import profiles, surface

HEIGHTS = np.random.default_rng(0).uniform(-9.0, 99.0, (40, 20))
TOLD = "digits behind decimal commas, it seems: decimal commas need semicolons between the numbers"


def text_of(rows, digits, between):
    """Numbers with decimal commas."""
    return "\n".join(between.join(f"{value:.{digits}f}".replace(".", ",") for value in row) for row in rows) + "\n"


class DecimalCommas(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "a.csv")

    def read(self, text):
        self.path.write_text(text)
        return surface.read(self.path, dx=1e3, dy=1e3)

    def test_maps_are_refused(self):
        for digits in (1, 2, 3):
            for between in (",", ", ", ",\t"):
                # With two digits behind the comma few numbers differ in length.
                for rows in (HEIGHTS, abs(HEIGHTS), HEIGHTS[:, :1], HEIGHTS[:12, : 2 if digits == 1 else 20]):
                    with self.subTest(digits=digits, between=between, shape=rows.shape), self.assertRaisesRegex(ValueError, f"{TOLD}|begin with zeros between its commas"):
                        self.read(text_of(rows, digits, between))
        # Few heights, of one digit before the comma: blanks separate the pairs of digits.
        with self.assertRaisesRegex(ValueError, TOLD):
            self.read("1,2, 3,4\n5,6, 7,8\n")
        with self.assertRaisesRegex(ValueError, "columns changed.*decimal commas need semicolons"):
            self.read("1,2, 3,4, nan\n5,6, 7,8, 2,0\n")

    def test_others_are_read(self):
        digits = np.random.default_rng(1).integers(0, 10, (40, 20))
        counts = np.random.default_rng(2).integers(-300, 3000, (40, 20))
        even = counts.copy()
        even[:, 1::2] = abs(even[:, 1::2]) % 900 + 100
        even[:, ::2] = abs(even[:, ::2]) % 900 + 100
        even[3, 4], even[5, 6] = 1000, 99
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for name, values in (("digits", digits), ("counts", counts), ("three digits", even), ("an odd count of columns", counts[:, :19])):
                for between in (",", ", "):
                    with self.subTest(name, between=between):
                        text = "\n".join(between.join(map(str, row)) for row in values)
                        np.testing.assert_array_equal(self.read(text).z, values)
            for between in (",", ", "):
                np.testing.assert_allclose(self.read("\n".join(between.join(f"{value:.1f}" for value in row) for row in HEIGHTS)).z, HEIGHTS, atol=0.051)
            # With the same digits, a decimal point shows that the commas separate numbers.
            text = text_of(HEIGHTS, 1, ",")
            self.assertEqual(self.read(text.replace(",", ".0,", 1)).z.shape, (40, 40))
            np.testing.assert_allclose(self.read(text_of(HEIGHTS, 1, ";")).z, HEIGHTS, atol=0.051)

    def test_integers_with_one_odd_column_are_read(self):
        counts = np.random.default_rng(3).integers(20000, 40000, (48, 64))
        zeros = np.zeros((48, 64), dtype=int)
        for name, values, odd in (("a dead column", counts, 0), ("a rib", zeros, 10), ("a scratch", zeros, -1)):
            for column in (20, 21):
                with self.subTest(name, column=column):
                    values = values.copy()
                    values[10:30, column] = odd
                    np.testing.assert_array_equal(self.read("\n".join(",".join(map(str, row)) for row in values)).z, values)

    def test_counts_beside_points_of_profiles_are_no_decimals(self):
        y = np.linspace(-35.0, 35.0, 60)
        for begin, end in (("{:04d},", ",1"), ("", ",2024,05,17"), ("", ",00,07,17"), ("", ",007,1")):
            with self.subTest(begin=begin, end=end):
                self.path.write_text("".join(f"{begin.format(k)}{one:.3f},{-one**2 / 600:.4f}{end}\n" for k, one in enumerate(y)))
                found = profiles.read(self.path, kind="wheel", columns=(1, 2) if begin else (0, 1))
                np.testing.assert_allclose(found.y, y, atol=6e-4)

    def test_profiles_are_refused(self):
        y = np.linspace(-36.0, 36.0, 145)
        points = np.stack([y, 300.0 - np.sqrt(300.0**2 - y**2)], axis=1)
        for between in (",", ", "):
            self.path.write_text(text_of(points, 1, between))
            for columns in ((0, 1), (0, 2)):
                with self.subTest(between=between, columns=columns), self.assertRaisesRegex(ValueError, TOLD):
                    profiles.read(self.path, kind="rail", columns=columns)
        for between in (";", "\t", " ", "; "):
            self.path.write_text(text_of(points, 3, between))
            np.testing.assert_allclose(profiles.read(self.path, kind="rail").z, points[:, 1], atol=6e-4)
        for between in (",", ", "):
            self.path.write_text("\n".join(between.join(f"{one:.3f}" for one in point) for point in points))
            np.testing.assert_allclose(profiles.read(self.path, kind="rail").z, points[:, 1], atol=6e-4)


if __name__ == "__main__":
    unittest.main()
