"""The command line: its inputs, output, files and exit codes. Files that need more than numpy: tests_tables/test_command_files.py."""

import contextlib
import importlib
import io
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal._command import main
from contact_normal.surface import Gap

# A steel ball of 50 mm on steel, off the middle, so that no transposed or mirrored grid passes; in mm and N.
MY, MX, DX, DY, RADIUS, FORCE = 40, 56, 0.06, 0.05, 50.0, 1000.0
MODULUS, RATIO = 82000.0, 0.28
X, Y = (np.arange(MX) - 30.0) * DX, (np.arange(MY) - 17.0) * DY
HEIGHTS = 3.0 - (X[None, :] ** 2 + Y[:, None] ** 2) / (2 * RADIUS)
STEEL = ("--shear-modulus", str(MODULUS), "--poisson-ratio", str(RATIO))
BALL = ("--dx", str(DX), "--dy", str(DY), "--force", str(FORCE), *STEEL)


def called(*arguments):
    """The exit code and the output on stdout and on stderr."""
    out, told = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(told):
        try:
            code = main([str(argument) for argument in arguments])
        except SystemExit as ended:
            code = ended.code
    return code, out.getvalue(), told.getvalue()


def without(name):
    """Makes imports of this package fail."""
    imported = importlib.import_module

    def refused(wanted, *more):
        if wanted == name:
            raise ImportError(f"No module named {name!r}")
        return imported(wanted, *more)

    return mock.patch("importlib.import_module", refused)


class Commands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.npy = self.folder / "ball.npy"
        np.save(self.npy, HEIGHTS)

    def solved(self, file, *options):
        """The arrays of a solve by the command line."""
        written = self.folder / "out.npz"
        code, _, told = called("solve", file, *options, "-o", written)
        self.assertEqual((code, told), (0, ""))
        with np.load(written) as arrays:
            return dict(arrays)

    def undeformed(self, found):
        """h - approach, by e = h - approach + u."""
        return found["deformed_distance"] - found["displacement"]

    def test_without_stderr_the_result_is_written(self):
        written = self.folder / "out.npz"
        with mock.patch("sys.stderr", None), contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(main(["solve", str(self.npy), *BALL, "-o", str(written)]), 0)
        self.assertTrue(written.exists())

    def test_a_ball_has_the_pressures_of_hertz(self):
        code, out, told = called("solve", self.npy, *BALL, "--units", "mm", "N")
        self.assertEqual((code, told), (0, ""))
        values = dict(re.match(r"(.{24})(.*)", line).groups() for line in out.splitlines())
        values = {name.strip(): value for name, value in values.items()}
        self.assertEqual((values["status"], values["elements"], values["force"]), ("solved", "56 x 40", "1000 N"))
        e_star = MODULUS / (1 - RATIO)
        largest = (6 * FORCE * e_star**2 / (np.pi**3 * RADIUS**2)) ** (1 / 3)
        approach = (9 * FORCE**2 / (16 * RADIUS * e_star**2)) ** (1 / 3)
        # The contact has some 14 elements per radius, so that errors are of the order of (1/14)^2.
        self.assertAlmostEqual(float(values["largest pressure"].removesuffix(" MPa")) / largest, 1.0, delta=1 / 14**2)
        self.assertAlmostEqual(float(values["approach"].removesuffix(" mm")) / approach, 1.0, delta=1 / 14**2)

    def test_surfaces_are_read_the_right_way_round(self):
        gap = HEIGHTS.max() - HEIGHTS
        for name, save in (
            ("a.txt", lambda path, z: np.savetxt(path, z, header="heights, mm")),
            ("a.csv", lambda path, z: np.savetxt(path, z, delimiter=",")),
            ("a.npz", lambda path, z: np.savez(path, heights=z)),
        ):
            save(self.folder / name, HEIGHTS)
            found = self.solved(self.folder / name, *BALL)
            self.assertEqual((found["dx"], found["dy"], found["pressure"].shape), (DX, DY, (MY, MX)))
            h = self.undeformed(found)
            # The round-off of displacements of some .01 and distances of .1 is far below 1e-12.
            np.testing.assert_allclose(h - h.min(), gap, atol=1e-12)
        np.save(self.npy, gap)
        h = self.undeformed(self.solved(self.npy, *BALL, "--gap"))
        np.testing.assert_allclose(h - h.min(), gap, atol=1e-12)
        # The file of a gap that the package writes has the element sizes.
        Gap(gap, DX, DY).write(self.folder / "gap.txt")
        h = self.undeformed(self.solved(self.folder / "gap.txt", *BALL[4:], "--gap"))
        np.testing.assert_allclose(h - h.min(), gap, atol=1e-12)

    def test_tilt_and_spikes_are_removed(self):
        plain = self.solved(self.npy, *BALL)
        spoiled = HEIGHTS + 0.1 * X[None, :] - 0.2 * Y[:, None]
        spoiled[3, 50] += 5.0
        np.save(self.npy, spoiled)
        self.assertLess(self.solved(self.npy, *BALL)["contact"].sum(), 9)  # the spike carries the ball
        code, _, told = called("solve", self.npy, *BALL, "--faults", "--level", "plane", "-o", self.folder / "level.npz")
        self.assertEqual((code, "spike" in told), (0, True), told)
        level = np.load(self.folder / "level.npz")
        # A ball off the middle has a mean slope, so that levelling moves its top. Its contact area does not change.
        self.assertFalse(level["contact"][3, 50])
        self.assertAlmostEqual(level["pressure"].max() / plain["pressure"].max(), 1.0, delta=1e-2)

    def test_a_tilted_period_is_levelled_first(self):
        wave = np.cos(2 * np.pi * np.arange(32) / 32)[None, :] + np.zeros((16, 1))
        scene = ("--dx", "1", "--force", "10", "--e-star", "100", "--period", "xy")
        np.save(self.npy, wave)
        plain = self.solved(self.npy, *scene, "--level", "plane")
        np.save(self.npy, wave + 0.3 * np.arange(16)[:, None])
        np.testing.assert_allclose(self.solved(self.npy, *scene, "--level", "plane")["pressure"], plain["pressure"], atol=1e-5)

    def test_arrays_of_instruments(self):
        turned = HEIGHTS + 1e-3 * X[None, :] + 2e-3 * Y[:, None]
        np.save(self.npy, turned)
        plain = self.solved(self.npy, *BALL)["pressure"]
        np.save(self.npy, turned[::-1].T)
        # In this file the first index is that of x, and y decreases along the second one.
        np.testing.assert_array_equal(self.solved(self.npy, *BALL, "--axes", "xy", "--top-first")["pressure"], plain)

    def test_negative_numbers_may_have_exponents(self):
        np.save(self.npy, np.where(np.arange(MX) == 0, -3.5e38, HEIGHTS))
        for value in ("-3.5e38", "-3.5e+38"):
            self.assertEqual(called("solve", self.npy, *BALL, "--hole", value)[0], 0)
        code, _, told = called("solve", self.npy, *BALL, "--hole", "-9999e-3")
        self.assertEqual((code, "contact-normal: no element has the value -9.999" in told), (0, True), told)

    def test_lists_of_negative_numbers(self):
        code, out, told = called("creep-table", "--xi", "0,1", "--eta", "-1,0,1", "--elements", "9")
        self.assertEqual((code, len(out.splitlines())), (0, 7), told)
        code, _, told = called("creep-table", "--xi", "-1:1:3")
        self.assertEqual((code, "xi begins with -1.0" in told), (3, True), told)
        code, _, told = called("creep-table", "--workers", "-1")
        self.assertEqual((code, "--workers is -1" in told), (3, True), told)

    def test_nothing_is_lost_or_left_out_without_a_word(self):
        code, _, told = called("solve", self.npy, *BALL, "-o", self.npy.with_suffix(".npz"))
        self.assertEqual(code, 0, told)
        np.savez(self.folder / "two.npz", z=HEIGHTS)
        before = (self.folder / "two.npz").read_bytes()
        code, _, told = called("solve", self.folder / "two.npz", *BALL, "-o", self.folder / "two.npz")
        self.assertEqual((code, "would be lost" in told), (3, True), told)
        self.assertEqual((self.folder / "two.npz").read_bytes(), before)
        picture = self.folder / "heights.png"
        shutil.copy(self.npy, picture)
        code, _, told = called("bill", picture, *BALL, "--plot", picture)
        self.assertEqual((code, "would be lost" in told), (3, True), told)
        Gap(HEIGHTS.max() - HEIGHTS, DX, DY).write(self.folder / "gap.txt")
        for option in (("--dx", "5"), ("--level", "plane"), ("--faults",), ("--hole", "3"), ("--axes", "xy"), ("--top-first",), ("--variable", "z")):
            code, _, told = called("solve", self.folder / "gap.txt", "--gap", *option, "--force", FORCE, *STEEL)
            self.assertEqual((code, f"{option[0]} does not go with it" in told), (3, True), told)

    def test_one_size_of_an_element_is_not_enough(self):
        code, _, told = called("solve", self.npy, "--dy", DY, "--force", FORCE, *STEEL)
        self.assertEqual((code, "--dy goes with --dx" in told), (3, True), told)

    def test_holes_have_no_surface(self):
        inside = np.zeros((MY, MX), dtype=bool)
        inside[17, 30] = True  # the top of the ball
        for hole, options in ((np.nan, ()), (-9999.0, ("--hole", "-9999"))):
            np.save(self.npy, np.where(inside, hole, HEIGHTS))
            found = self.solved(self.npy, *BALL, *options)
            self.assertEqual((found["contact"][17, 30], found["contact"][17, 31]), (False, True))
        # A fill value that is not given by --hole is a pit in the heights, which does not change the contact.
        self.assertEqual(called("solve", self.npy, *BALL)[0], 0)
        np.save(self.npy, np.full((4, 4), np.nan))
        code, _, told = called("solve", self.npy, *BALL)
        self.assertEqual((code, "has no element with a surface" in told), (3, True))

    def test_bodies_and_effects_reach_the_library(self):
        pair = self.solved(self.npy, *BALL[:6], "--young-modulus", "210000", "70000", "--poisson-ratio", "0.28", "0.33")
        e_star = 1 / ((1 - 0.28**2) / 210000 + (1 - 0.33**2) / 70000)
        same = self.solved(self.npy, *BALL[:6], "--e-star", e_star)
        # Both solves have a residual of 1e-6. Errors of pressures are up to a hundred times larger.
        np.testing.assert_allclose(pair["pressure"], same["pressure"], atol=1e-4 * same["pressure"].max())
        self.assertGreater(same["pressure"].max(), 600.0)
        self.assertEqual(self.solved(self.npy, *BALL, "--pressure-limit", "600")["pressure"].max(), 600.0)
        self.assertLess(self.solved(self.npy, *BALL, "--layer", "1e-4")["pressure"].max(), 0.5 * same["pressure"].max())
        mean = self.solved(self.npy, *BALL[:4], "--mean-pressure", "50", *STEEL, "--period", "xy")
        self.assertAlmostEqual(mean["pressure"].mean(), 50.0, delta=1e-9)

    def test_exit_codes(self):
        cut = ("--tolerance", "1e-30")
        for code, arguments, words in (
            (1, ("solve", self.npy, *BALL, *cut), ""),
            (1, ("creep-table", "--xi", "0.1", "--elements", "9", *cut), ""),
            (2, ("solve", self.npy, "--dx", "0.1", *STEEL), "one of the arguments --force --approach --mean-pressure is required"),
            (2, ("solve", self.npy, *BALL, "--approach", "1"), "not allowed with argument"),
            (2, ("turn",), "invalid choice: 'turn'"),
            (3, ("solve", self.npy, "--dx", "-1", *BALL[2:]), "element sizes are -1.0 and 0.05; they must be positive and finite"),
            (3, ("solve", self.npy, *BALL, "--tolerance", "2"), "(status -2: an invalid argument)"),
            (3, ("solve", self.npy, "--force", "1", *STEEL), "give --dx, and --dy if it differs"),
            (3, ("solve", self.npy, *BALL, "-o", "p.xlsx"), "p.xlsx must end in one of .nc, .npz, .vtk, .vtu"),
            (3, ("solve", self.npy, *BALL, "--plot", "p.gif"), "p.gif must end in one of .png, .svg, .pdf"),
            (3, ("solve", self.npy, *BALL[:6], "--e-star", "1", "--poisson-ratio", "1", "2", "3"), "--poisson-ratio has 3 values"),
            (3, ("creep-table", "--xi", "0:1"), "--xi is 0:1; it must be numbers as 0,0.5,1 or first:last:count"),
            (3, ("creep-table", "--xi", "0.1,1e300", "--elements", "9"), "1 of 2 entries were refused"),
            (3, ("creep-table", "t.txt"), "t.txt must end in .nc"),
            (4, ("creep-table", "nowhere/t.nc"), "there is no folder nowhere"),
            (4, ("solve", self.folder / "none.npy", *BALL), "No such file or directory"),
            (4, ("solve", self.npy, *BALL, "-o", self.folder / "no" / "p.npz"), "there is no folder"),
        ):
            found, _, told = called(*arguments)
            self.assertEqual(found, code, arguments)
            self.assertIn(words, told)
        np.save(self.npy, HEIGHTS[None])
        self.assertEqual(called("solve", self.npy, *BALL)[::2], (3, "contact-normal: values has shape (1, 40, 56); heights have two indices\n"))
        with mock.patch("contact_normal._command_solve.solve", side_effect=KeyboardInterrupt):
            np.save(self.npy, HEIGHTS)
            self.assertEqual(called("solve", self.npy, *BALL)[::2], (130, "contact-normal: interrupted\n"))

    def test_what_is_missing_is_named(self):
        (self.folder / "a.x3p").touch()
        for package, arguments, extra in (
            ("SurfaceTopography", ("solve", self.folder / "a.x3p", *BALL), "contact-normal[surface]"),
            ("meshio", ("solve", self.npy, *BALL, "-o", "p.vtu"), "contact-normal[vtk]"),
            ("xarray", ("solve", self.npy, *BALL, "-o", "p.nc"), "contact-normal[tables]"),
        ):
            with without(package):
                code, _, told = called(*arguments)
            self.assertEqual((code, extra in told), (4, True), told)

    def test_several_grids_in_a_file_are_named(self):
        np.savez(self.folder / "two.npz", a=HEIGHTS, b=2 * HEIGHTS)
        code, _, told = called("solve", self.folder / "two.npz", *BALL)
        self.assertEqual((code, "has a, b; give variable, one of them" in told), (3, True))
        h = self.undeformed(self.solved(self.folder / "two.npz", *BALL, "--variable", "b"))
        np.testing.assert_allclose(h - h.min(), 2 * (HEIGHTS.max() - HEIGHTS), atol=1e-12)

    def test_pictures_and_progress(self):
        # Instruments write a picture of this name beside their heights. It must not be overwritten.
        photo = self.npy.with_suffix(".png")
        photo.write_bytes(b"a photo")
        code, _, told = called("solve", self.npy, *BALL, "--plot", "--progress")
        self.assertEqual((code, "56 x 40, cycle" in told), (0, True))
        self.assertEqual(photo.read_bytes(), b"a photo")
        self.assertEqual(self.npy.with_suffix(".contact.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        code, _, _ = called("solve", self.npy, *BALL, "--plot", self.folder / "p.svg")
        self.assertIn("<svg", (self.folder / "p.svg").read_text())

    def test_prices(self):
        code, out, _ = called("prices", self.npy, *BALL, "--targets", "1e-2", "1e-15")
        rows = [line.split() for line in out.splitlines()]
        self.assertEqual((code, rows[0][:2], rows[1][0], rows[2][0]), (0, ["relative", "error"], "1.0e-02", "1.0e-15"))
        # Eight elements suffice for this error of the force (docs/accuracy.md).
        self.assertGreaterEqual(int(rows[1][1]), 8)
        self.assertTrue(out.rstrip().endswith("below round-off"), out)
        # Effects reach the library, which refuses a negative compliance.
        code, out, told = called("prices", self.npy, *BALL, "--layer", "-1e-12")
        self.assertNotEqual(code, 0)
        self.assertIn("compliance", told)

    def test_bills(self):
        code, out, told = called("bill", self.npy, *BALL, "--layer", "1e-12", "--pressure-limit", "300", "--plot", self.folder / "bill.svg")
        self.assertEqual((code, told), (0, ""))
        # The largest pressure of the ball is 1000, above the limit of 300.
        self.assertEqual(out.splitlines()[-1], "needed: pressure_limit; negligible: layer")
        self.assertGreater((self.folder / "bill.svg").stat().st_size, 1000)
        code, out, _ = called("bill", self.npy, *BALL)
        self.assertEqual((code, out), (0, "the scene names no effect: there is nothing to leave out\n"))

    def test_creep_tables(self):
        code, out, _ = called("creep-table", "--xi", "0:0.02:3", "--eta", "0", "--phi", "0", "--elements", "35")
        rows = [dict(zip(out.splitlines()[0].split(), map(float, line.split()))) for line in out.splitlines()[1:]]
        self.assertEqual((code, [row["xi"] for row in rows], rows[0]["force_x"]), (0, [0.0, 0.01, 0.02], 0.0))
        # Kalker's linear theory: C11 of a circle is 4.12 to 4.27 for Poisson ratios of .25 to .3. Saturation changes the force by 1.4 %, and elements
        # of 1/35 of the contact by a few per cent.
        self.assertLess(abs(rows[1]["force_x"] / (-0.01 * 4.2) - 1), 0.1)

    @unittest.skipIf(os.name == "nt", "its program is a shell script")
    def test_a_replay_returns_what_the_program_does(self):
        with mock.patch.dict(os.environ, {"PATH": ""}):
            with mock.patch("contact_normal._command_replay.candidates", return_value=[str(self.folder / "lib" / "x.so")]):
                code, _, told = called("replay", "failed.dump")
                self.assertEqual((code, "contact-normal-replay is not beside the library" in told), (4, True))
                (self.folder / "bin").mkdir()
                program = self.folder / "bin" / "contact-normal-replay"
                program.write_text(f'#!/bin/sh\necho "$@" > {self.folder}/asked\nexit 2\n')
                program.chmod(program.stat().st_mode | stat.S_IEXEC)
                self.assertEqual(called("replay", "failed.dump")[0], 2)
        self.assertEqual((self.folder / "asked").read_text(), "failed.dump\n")

    def test_the_module_is_a_program(self):
        printed = subprocess.run([sys.executable, "-m", "contact_normal", "--version"], capture_output=True, text=True, check=True)
        self.assertEqual(printed.stdout, f"contact-normal {cn.VERSION}\n")


if __name__ == "__main__":
    unittest.main()
