"""A Wyko file that does not say the size of its pixels, as SurfaceTopography reads it."""

import struct
import tempfile
import unittest
from pathlib import Path

import numpy as np

from contact_normal import surface

NX, NY = 12, 7
Z = np.random.default_rng(2).integers(-1000, 1000, (NX, NY)) / 1000.0


def opd(path, pixel):
    """A file with heights in wave lengths of 600 nm; `pixel` in mm, None: it has none."""
    items = [("RAW DATA", 3, struct.pack("<HHH", NX, NY, 4) + Z.astype("<f4").tobytes()), ("Wavelength", 7, struct.pack("<f", 600.0)), ("Mult", 6, struct.pack("<h", 1)),
             ("Aspect", 7, struct.pack("<f", 1.0))]
    if pixel is not None:
        items.append(("Pixel_size", 7, struct.pack("<f", pixel)))
    parts = [struct.pack("<16shlH", b"Directory", 1, 24 * (len(items) + 1), 0xFFFF)]
    parts += [struct.pack("<16shlH", name.encode(), kind, len(data), 1) for name, kind, data in items]
    path.write_bytes(b"\1\0" + b"".join(parts) + b"".join(data for *_, data in items))


class Wyko(unittest.TestCase):
    def test_files_without_a_size(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.opd")
            opd(path, 2e-3)
            plain = surface.read(path)
            for pixel in (None, float("nan")):
                opd(path, pixel)
                made = surface.read(path, dx=plain.dx, dy=plain.dy)
                np.testing.assert_array_equal(made.z, plain.z)
                self.assertEqual((made.dx, made.dy, made.units), (plain.dx, plain.dy, plain.units))
                with self.assertRaisesRegex(TypeError, "a.opd does not say the size of an element: give size"):
                    surface.read(path)


if __name__ == "__main__":
    unittest.main()
