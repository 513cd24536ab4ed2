"""Files of numpy with wrong bytes are refused with their name; who reads many files catches one kind of error."""

import io
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np

from contact_normal import surface

Z = np.random.default_rng(4).normal(size=(7, 12)).round(4)


class Corrupt(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refused(self, name, data):
        """Whether a file is refused; it is told by its name, or the heights are read."""
        path = self.folder / name
        path.write_bytes(data)
        try:
            self.assertEqual(surface.read(path, dx=10.0, dy=10.0).z.ndim, 2)
            return False
        except ValueError as error:
            # Other errors are those of heights, such as a wrong dtype, which do not depend on the file.
            self.assertTrue(name in str(error) or str(error).startswith("values "), error)
            return True
        except TypeError as error:
            self.assertIn("values has dtype", str(error))
            return True

    def test_any_wrong_bytes(self):
        random = np.random.default_rng(1)
        for name, save, within in (("a.npz", np.savez_compressed, None), ("b.npz", np.savez, None), ("c.npy", np.save, 128)):
            written = io.BytesIO()
            save(written, Z)
            whole, count = written.getvalue(), 0
            for _ in range(400):
                data = bytearray(whole)
                for _ in range(random.integers(1, 4)):
                    data[random.integers(within or len(data))] = random.integers(256)
                if random.random() < 0.3:
                    data = data[: random.integers(len(data))]
                count += self.refused(name, bytes(data))
            self.assertGreater(count, 200)

    def test_known_ones(self):
        written = io.BytesIO()
        np.save(written, Z)
        whole = written.getvalue()
        for wrong in (b"", whole[:5], whole[:100], whole[:-3], whole.replace(b"(7, 12)", b"(7, 12 "), whole.replace(b"{'", b"(("), whole.replace(b"<f8", b"<q9")):
            self.assertTrue(self.refused("a.npy", wrong), wrong[:80])
        for member, data in (("z.npy", b"no array"), ("notes.txt", b"no array"), ("z.npy", whole[:90])):
            packed = io.BytesIO()
            with zipfile.ZipFile(packed, "w") as file:
                file.writestr(member, data)
            self.assertTrue(self.refused("a.npz", packed.getvalue()), member)
        with self.assertRaises(FileNotFoundError):
            surface.read(self.folder / "none.npy", dx=1.0, dy=1.0)


if __name__ == "__main__":
    unittest.main()
