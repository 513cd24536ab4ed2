"""Pictures show places correctly, the right way up, and with the given units."""

import copy
import unittest

import matplotlib
import numpy as np

import contact_normal as cn

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
MY, MX, D = 30, 40, 0.1
X, Y = ((np.arange(m) - 0.5 * (m - 1)) * D for m in (MX, MY))
# The contact is at the upper right, so that mirrored pictures fail.
CENTRE = (1.0, 0.5)
H = 0.01 * ((X[None, :] - CENTRE[0]) ** 2 + 4.0 * (Y[:, None] - CENTRE[1]) ** 2)


def colour_at(axes, x, y):
    """The colour at a place of the axes."""
    axes.figure.canvas.draw()
    pixels = np.asarray(axes.figure.canvas.buffer_rgba())[..., :3].astype(int)
    column, row = axes.transData.transform((x, y))
    # Rows of pixels are counted from the top.
    return pixels[pixels.shape[0] - 1 - int(row), int(column)]


def brightness(axes, x, y):
    return colour_at(axes, x, y).sum()


class Plots(unittest.TestCase):
    def setUp(self):
        friction = {"coefficient": 0.3, "force": (60.0, None)}
        self.found = cn.solve(H, D, D, force=900.0, friction=friction, units=("mm", "N"), **STEEL)
        iy, ix = np.unravel_index(self.found.pressure.argmax(), H.shape)
        self.assertLess(max(abs(X[ix] - CENTRE[0]), abs(Y[iy] - CENTRE[1])), D)
        self.mirrored = [(-CENTRE[0], CENTRE[1]), (CENTRE[0], -CENTRE[1]), (-CENTRE[0], -CENTRE[1])]
        # The contact is an ellipse with its long axis along x.
        self.out_along_y = (CENTRE[0], CENTRE[1] + 0.45 * np.ptp(np.nonzero(self.found.contact)[1]) * D)

    def tearDown(self):
        pyplot.close("all")

    def assert_outline(self, axes, contact):
        """Asserts that the border is that of the contact area, by the middles of its segments."""
        drawn = {tuple(np.round(segment.mean(axis=0) / D, 2)) for lines in axes.collections if hasattr(lines, "get_segments")
                 for segment in lines.get_segments()}
        border = set()
        for iy, ix in zip(*np.nonzero(contact)):
            for ny, nx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
                inside = 0 <= iy + ny < MY and 0 <= ix + nx < MX and contact[iy + ny, ix + nx]
                if not inside:
                    border.add(tuple(np.round((X[ix] / D + 0.5 * nx, Y[iy] / D + 0.5 * ny), 2)))
        self.assertLessEqual(border, drawn)
        return drawn - border

    def test_pressures(self):
        axes = self.found.plot()
        background = colour_at(axes, *self.mirrored[0])
        self.assertGreater(abs(colour_at(axes, *CENTRE) - background).sum(), 100)
        for place in (*self.mirrored, self.out_along_y):
            np.testing.assert_array_equal(colour_at(axes, *place), background, err_msg=str(place))
        self.assertEqual(self.assert_outline(axes, self.found.contact), set())
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel(), axes.figure.axes[1].get_ylabel()), ("x [mm]", "y [mm]", "pressure [MPa]"))
        self.assertRegex(axes.get_title(), r"^force 900 N, approach 0\.\d+ mm, 40 × 30 elements$")
        self.found.units = None
        plain = self.found.plot()
        self.assertEqual((plain.get_xlabel(), plain.get_ylabel(), plain.figure.axes[1].get_ylabel()), ("x", "y", "pressure"))

    def test_tractions(self):
        for largest in (99.99999999999999, 0.09999999999999999, 1e23):
            scaled = copy.copy(self.found)
            scaled.traction = self.found.traction * (largest / np.hypot(*self.found.traction).max())
            scaled.plot_traction()
        axes = self.found.plot_traction()
        for place in self.mirrored:
            np.testing.assert_allclose(colour_at(axes, *place), [240] * 3, atol=1)
        arrows = axes.collections[0]
        for (x, y), qx, qy in zip(arrows.get_offsets(), arrows.U, arrows.V):
            iy, ix = int(round((y - Y[0]) / D)), int(round((x - X[0]) / D))
            self.assertEqual((qx, qy), tuple(self.found.traction[:, iy, ix]))
        self.assertGreater(len(arrows.U), 20)
        self.assert_outline(axes, self.found.contact)
        self.assert_outline(axes, self.found.stick_slip == 1)
        blue, orange = (np.array(colour) * 255 for colour in ((0.78, 0.87, 0.96), (0.99, 0.85, 0.74)))
        shown = axes.images[0].get_array()
        for side, colour in ((1, blue), (2, orange)):
            inside = self.found.stick_slip == side
            np.testing.assert_allclose(shown[inside] * 255, np.broadcast_to(colour, (inside.sum(), 3)))
        self.assertEqual(axes.images[0].origin, "lower")
        self.assertEqual(axes.get_xlabel(), "x [mm]")
        self.assertRegex(axes.get_title(), r"force \(60, .*\) N;")

    def test_sections(self):
        stress = self.found.subsurface([1.5, 0.0, 0.4, 0.2, 0.8])
        for given, across in (({"y": CENTRE[1]}, CENTRE[0]), ({"x": CENTRE[0]}, CENTRE[1])):
            axes = stress.plot_section(of="von_mises", **given)
            # The body is below its surface, and the largest stress near the surface.
            below, above = axes.transData.transform((across, 1.4))[1], axes.transData.transform((across, 0.0))[1]
            self.assertLess(below, above)
            self.assertGreater(brightness(axes, across, 0.3), brightness(axes, across, 1.4) + 100)
            self.assertGreater(brightness(axes, across, 0.3), brightness(axes, -across, 0.3) + 100)
            name = "x" if "y" in given else "y"
            self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), (f"{name} [mm]", "depth z [mm]"))
            self.assertEqual(axes.figure.axes[1].get_ylabel(), "von Mises [MPa]")
        axes = stress.plot_depth(*CENTRE)
        self.assertGreater(*axes.get_ylim())
        lines = {line.get_label(): line for line in axes.get_lines()}
        depths = np.argsort(stress.depths)
        iy, ix = np.argmin(abs(Y - CENTRE[1])), np.argmin(abs(X - CENTRE[0]))
        np.testing.assert_array_equal(lines["von Mises"].get_ydata(), stress.depths[depths])
        self.assertTrue(any(np.array_equal(lines["von Mises"].get_xdata(), stress.von_mises[depths, y, x])
                            for y in (iy - 1, iy, iy + 1) for x in (ix - 1, ix, ix + 1)))
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("stress [MPa]", "depth z [mm]"))
        some = self.found.subsurface([0.0, 0.2], components=["zz"])
        self.assertEqual(len(some.plot_depth().get_lines()), 2)
        with self.assertRaisesRegex(ValueError, "von_mises is not there to be drawn"):
            some.plot_section()
        with self.assertRaisesRegex(ValueError, "units is not there to be drawn"):
            some.plot_section(of="units")

        borders = next(line for line in stress.plot_section(y=CENTRE[1]).get_lines() if line.get_label() == "edge of the contact")
        inside = X[self.found.contact[np.argmin(abs(Y - CENTRE[1]))]]
        np.testing.assert_allclose(borders.get_xdata(), [inside[0] - 0.5 * D, inside[-1] + 0.5 * D], atol=1e-12)
        own = cn.subsurface_stress(None, D, D, [0.2, 0.4], traction=(H, H), poisson_ratio=0.3).plot_section()
        self.assertEqual([len(line.get_xdata()) for line in own.get_lines()], [1, 1, 0])

    def test_sections_of_the_surface(self):
        for given, across in (({"y": Y[20]}, self.found.contact[20]), ({"x": X[30]}, self.found.contact[:, 30])):
            axes = self.found.plot_section(**given)
            curve, *lines = axes.get_lines()
            row = self.found.pressure[20] if "y" in given else self.found.pressure[:, 30]
            np.testing.assert_array_equal(curve.get_ydata(), row)
            places = X if "y" in given else Y
            inside = places[across]
            np.testing.assert_allclose([line.get_xdata()[0] for line in lines], [inside[0] - 0.5 * D, inside[-1] + 0.5 * D], atol=1e-12)
            self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x [mm]" if "y" in given else "y [mm]", "pressure [MPa]"))
        with self.assertRaisesRegex(TypeError, "either x or y"):
            self.found.plot_section(x=0.0, y=0.0)
        with self.assertRaisesRegex(ValueError, "y is 9.0; it must lie within the grid"):
            self.found.plot_section(y=9.0)

    def test_pressures_by_their_size(self):
        axes = self.found.plot_histogram(bins=7)
        inside = self.found.pressure[self.found.contact]
        edges = np.linspace(inside.min(), inside.max(), 8)
        shares = [100.0 * np.mean((inside >= low) & ((inside < high) | (high == edges[-1]))) for low, high in zip(edges, edges[1:])]
        np.testing.assert_allclose([bar.get_height() for bar in axes.patches], shares, atol=1e-9)
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("pressure [MPa]", "share of the contact area [%]"))
        with cn.Solver(MY, MX, D, D, **STEEL) as solver:
            self.assertEqual(len(solver.solve(H + 1.0, approach=0.5).plot_histogram().patches), 40)  # no contact

    def test_a_histogram_of_equal_pressures_has_one_bar(self):
        flat = cn.solve(np.zeros((MY, MX)), D, D, force=1000.0, period="xy", **STEEL)
        ball = cn.solve(H, D, D, force=1e-3, **STEEL)
        limited = cn.solve(H, D, D, force=900.0, pressure_limit=100.0, **STEEL)
        for found in (flat, ball):
            self.assertLess(np.ptp(found.pressure[found.contact]), 1e-6 * found.max_pressure)
        for found, share in ((flat, 100.0), (ball, 100.0), (limited, None)):
            for bins in (40, 7, 1, np.int64(8)):
                axes = found.plot_histogram(bins=bins)
                bars = [(bar.get_x(), bar.get_width(), bar.get_height()) for bar in axes.patches if bar.get_height() > 0.0]
                self.assertAlmostEqual(sum(height for *_, height in bars), 100.0, places=9)
                axes.figure.canvas.draw()
                low, high = axes.get_xlim()
                self.assertTrue(all(width > 1e-3 * (high - low) for _, width, _ in bars))
                if share:
                    ((left, width, height),) = bars
                    self.assertAlmostEqual(height, share, places=9)
                    self.assertTrue(left < found.max_pressure < left + width, (bins, left, width))

    def test_areas_over_forces(self):
        found = [cn.solve(H, D, D, force=force, units=("mm", "N"), **STEEL) for force in (400.0, 100.0, 900.0)]
        axes = cn.plot_contact_area(found)
        x, y = axes.get_lines()[0].get_data()
        np.testing.assert_allclose(x, [100.0, 400.0, 900.0])
        np.testing.assert_allclose(y, [found[k].contact.sum() * D * D for k in (1, 0, 2)])
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("normal force [N]", "contact area [mm²]"))
        with self.assertRaisesRegex(ValueError, "results is empty"):
            cn.plot_contact_area([])

    def test_creep_curves(self):
        table = cn.creep_force_table(xi=[0.0, 0.5, 1.0], eta=[0.0], phi=[0.0, 0.5], elements=9)
        axes = table.plot()
        for k, line in enumerate(axes.get_lines()):
            xi, force = line.get_data()
            self.assertEqual((xi[0], xi[-1], line.get_label()), (-1.0, 1.0, f"$\\phi$ = {(0.0, 0.5)[k]:g}"))
            self.assertEqual(force[-1], table.force_x[0, 0, k, 0, -1])
            self.assertAlmostEqual(force[0], -force[-1])
        self.assertIn("F_x", axes.get_ylabel())
        self.assertIn("M_z", table.plot("moment").get_ylabel())
        with self.assertRaisesRegex(ValueError, "of is 'error'"):
            table.plot("error")

    def test_the_scale_of_tractions(self):
        axes = self.found.plot_traction()
        key = next(artist for artist in axes.get_children() if type(artist).__name__ == "QuiverKey")
        largest = np.hypot(*self.found.traction).max()
        self.assertEqual(key.label, f"{key.U:g} MPa")
        self.assertTrue(0.3 * largest < key.U <= largest, (key.U, largest))

    def test_the_outline_does_not_cover_a_rough_contact(self):
        generator = np.random.default_rng(1)
        rough = cn.solve(generator.random((128, 128)), 1.0, 1.0, force=1e4, **STEEL)
        axes = rough.plot()
        axes.figure.canvas.draw()
        outline = next(lines for lines in axes.collections if hasattr(lines, "get_segments"))
        points = 72.0 / axes.figure.dpi * axes.get_window_extent().width / 128
        # Half of the line is on either side of the edge, so that at least half of the element remains visible.
        self.assertLessEqual(outline.get_linewidths()[0], 0.5 * points)
        self.assertTrue(outline.get_rasterized() or len(outline.get_segments()) <= 4000)

    def test_dark_pages(self):
        from contact_normal._style import matplotlib_style
        with matplotlib_style(dark=True):
            axes = self.found.plot_traction()
            self.assertLess(sum(matplotlib.colors.to_rgb(axes.figure.get_facecolor())), 0.5)
            # The exterior area is dark, too, but text is not.
            self.assertLess(axes.images[0].get_array()[0, 0].sum(), 1.5)
            self.assertGreater(sum(matplotlib.colors.to_rgb(axes.xaxis.label.get_color())), 2.0)

    def test_a_grid_that_lies_elsewhere(self):
        found = cn.solve_to_accuracy(lambda x, y: 0.1 * ((x - 11.0) ** 2 + (y - 21.0) ** 2), 0.2, 0.2, shape=(16, 16), corner=(10.0, 20.0),
                                     force=100.0, target=0.1, **STEEL)
        axes = found.plot()
        self.assertEqual(tuple(np.round(axes.images[0].get_extent(), 9)), (10.0, 13.2, 20.0, 23.2))
        self.assertGreater(abs(colour_at(axes, 11.0, 21.0) - colour_at(axes, 12.5, 22.5)).sum(), 100)
        stress = found.subsurface([0.0, 0.3, 1.0])
        axes = stress.plot_section(y=21.0)
        self.assertGreater(brightness(axes, 11.0, 0.3), brightness(axes, 13.0, 0.3) + 100)
        self.assertEqual(len(stress.plot_depth().get_lines()), 6)

    def test_units(self):
        for units, pressure in ((("m", "N"), "Pa"), (("mm", "N"), "MPa"), (("in", "lbf"), "lbf in⁻²"), (["um", "mN"], "GPa"),
                                (("\u00b5m", "mN"), "GPa"), (("\u03bcm", "\u00b5N"), "MPa"), (["um", "kN"], "kN um⁻²")):
            self.found.units = units
            self.assertEqual(self.found.plot().figure.axes[1].get_ylabel(), f"pressure [{pressure}]")
        for bad, words in (("mm", "units is 'mm'"), (("mm",), "units has 1 parts"), (("mm", 3), "units are"), (("mm", ""), "units are")):
            with self.assertRaisesRegex((TypeError, ValueError), words):
                self.found.units = bad
            with self.assertRaisesRegex((TypeError, ValueError), words):
                cn.solve(H, D, D, force=1.0, units=bad, **STEEL)
            with self.assertRaisesRegex((TypeError, ValueError), words):
                cn.Solver(MY, MX, D, D, units=bad, **STEEL)
        with cn.Solver(MY, MX, D, D, units=("m", "N"), **STEEL) as solver:
            self.assertEqual(solver.solve(H, force=1.0).units, ("m", "N"))
            self.assertEqual(solver.solve_batch([H], force=1.0)[0].units, ("m", "N"))
        accurate = cn.to_accuracy(H, D, D, force=100.0, target=0.1, units=("mm", "N"), **STEEL)
        self.assertEqual((accurate.units, accurate.subsurface([0.1]).units), (("mm", "N"), ("mm", "N")))


if __name__ == "__main__":
    unittest.main()
