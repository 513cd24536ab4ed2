"""Contents of results: values, coordinates, units; other kinds of moduli and loads; stresses and tangential problems."""

import io
import unittest
from contextlib import redirect_stderr
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal import _solved
from contact_normal._bar import SolveBar
from contact_normal._structs import Report, names

G, NU = 82000.0, 0.28
STEEL = {"shear_modulus": G, "poisson_ratio": NU}
MY, MX, DX, DY = 20, 26, 0.1, 0.12
X = (np.arange(MX) - 0.5 * (MX - 1)) * DX
Y = (np.arange(MY) - 0.5 * (MY - 1)) * DY
# The lowest place is off the middle.
H = 0.02 * ((X[None, :] - 0.3) ** 2 + 2 * (Y[:, None] + 0.2) ** 2)


def solve(**given):
    return cn.solve(H, DX, DY, **{"force": 100.0, **(STEEL if not {"young_modulus", "e_star"} & set(given) else {}), **given})


class Numbers(unittest.TestCase):
    def test_numbers_and_coordinates(self):
        found = solve(friction={"coefficient": 0.3, "force": (10.0, -5.0)})
        np.testing.assert_allclose(found.x, X, atol=1e-14)
        np.testing.assert_allclose(found.y, Y, atol=1e-14)
        self.assertEqual(found.max_pressure, found.pressure.max())
        self.assertAlmostEqual(found.contact_area, found.contact.sum() * DX * DY, places=12)
        self.assertAlmostEqual(found.contact_area, found.report["contact_area"], places=12)
        self.assertAlmostEqual(found.mean_pressure, found.pressure.mean(), places=9)
        np.testing.assert_allclose(found.tangential_force, found.traction.sum(axis=(1, 2)) * DX * DY, atol=1e-9)
        np.testing.assert_allclose(found.tangential_force, (10.0, -5.0), atol=1e-4)
        moment = ((X * found.traction[1]).sum() - (Y[:, None] * found.traction[0]).sum()) * DX * DY
        self.assertAlmostEqual(found.report["tangential_moment"], moment, delta=1e-9 * np.abs(found.traction).sum())
        self.assertEqual(solve().tangential_force, (0.0, 0.0))

    def test_each_number_of_a_report_has_a_key_of_its_own(self):
        groups = [(group, name) for group in _solved._GROUPS for name in names(dict(Report._fields_)[group]) if not name.startswith("reserved")]
        keys = ["ledger_rows", "warnings", *(_solved.report_key(group, name) for group, name in groups)]
        self.assertEqual(sorted(keys), sorted(set(keys)))
        found = solve(method="MULTIGRID", friction={"coefficient": 0.3, "force": (10.0, -5.0)})
        self.assertEqual(sorted(found.report), sorted(keys))
        # `update` is that of the pressures, not that of the tractions, and is not 0 because there are no pressures.
        self.assertEqual(found.report["update"], found._report.normal.update)
        self.assertEqual(found.report["tangential_update"], found._report.tangential.update)
        self.assertGreater(solve(method="MULTIGRID").report["update"], 0.0)

    def test_coordinates_of_a_callable_surface(self):
        def ball(x, y):
            return 0.02 * ((x - 7.0) ** 2 + (y + 3.0) ** 2)

        found = cn.solve_to_accuracy(ball, 0.2, 0.2, shape=(32, 32), corner=(3.8, -6.2), force=100.0, target=0.05, **STEEL)
        iy, ix = np.unravel_index(found.pressure.argmax(), found.pressure.shape)
        self.assertLess(max(abs(found.x[ix] - 7.0), abs(found.y[iy] + 3.0)), found.dx)
        self.assertAlmostEqual(found.x[0] - 0.5 * found.dx, 3.8)
        # The stresses are those below the last grid, not below the first one.
        stress = found.subsurface([0.05, 0.1, 0.2])
        self.assertEqual(stress.zz.shape[1:], found.pressure.shape)
        self.assertLess(max(abs(stress.largest_shear["x"] - 7.0), abs(stress.largest_shear["y"] + 3.0)), 2 * found.dx)
        at = found.stress_at_points([(found.x[ix], found.y[iy], 0.1)])
        self.assertAlmostEqual(at[0, 2], stress.zz[1, iy, ix], delta=1e-9 * found.max_pressure)

    def test_repr(self):
        found = solve(units=("mm", "N"), friction={"coefficient": 0.3, "force": (10.0, 0.0)})
        self.assertRegex(repr(found), r"^<Result: solved; 26 x 20 elements, force 100 N, approach 0\.\d+ mm, max_pressure \d+\.?\d* MPa, "
                                      r"contact_area 0\.\d+ mm2 \(\d+\.\d+ % of the grid\), tangential_force \(10, .*\) N, residual \S+>$")
        stopped = solve(method="NORM", max_cycles=1, tolerance=1e-12)
        self.assertIn(f"; {stopped.message}>", repr(stopped))
        accurate = cn.solve_to_accuracy(H, DX, DY, force=100.0, target=0.1, **STEEL)
        self.assertRegex(repr(accurate), r"^<AccurateResult: .*; reached \d\.\de-\d\d>$")
        with cn.Solver(MY, MX, DX, DY, **STEEL) as solver:
            self.assertEqual(repr(solver), "<Solver: 26 x 20 elements>")
            refused = solver.solve_batch([H], force=-1.0)[0]
        self.assertEqual(repr(solver), "<Solver: 26 x 20 elements, closed>")
        self.assertRegex(repr(refused), "^<Result: an invalid argument; 26 x 20 elements; force is -1")
        self.assertRegex(repr(found.subsurface([0.1, 0.2])),
                         r"^<SubsurfaceStress: 26 x 20 elements, 2 depths; largest von_mises \d+\.?\d* at \(.*\), ")
        batch = cn.friction_batch(H, DX, DY, [(1e-4, 0.0, 0.0)], force=100.0, friction={"coefficient": 0.3}, **STEEL)
        self.assertRegex(repr(batch), r"^<FrictionBatch: 1 of 1 entries solved, largest residual ")

    def test_a_creepage_without_a_motion_is_a_length(self):
        friction = {"coefficient": 0.3, "creepage": (1e-4, 0.0)}
        self.assertRegex(solve(friction=friction).message, "it is a SHIFT, whose creepage is a length")
        self.assertRegex(solve(friction={"coefficient": 0.3, "spin": 1e-4}).message, "whose spin an angle")
        for clear in ({**friction, "motion": "SHIFT"}, {**friction, "motion": 0}, {"coefficient": 0.3, "force": (1.0, 0.0)}):
            self.assertEqual(solve(friction=clear).message, "")

    def test_numbers_of_friction_that_may_be_meant_otherwise(self):
        rolling = {"coefficient": 0.3, "motion": "STEADY_ROLLING"}
        for given, text in (({"creepage": (0.0, -0.1)}, r"^a creepage of 0.1 is this part of the rolling speed: 0.1 % is 1e-3$"),
                            ({"spin": 0.16}, r"^a spin of 0.16 makes a creepage of \S+ at the ends of the grid: .* 0.16 per m is 1.6e-4 per mm$"),
                            ({"coefficient": 30.0, "creepage": (1e-3, 0.0)}, "^a coefficient of 30 is a ratio of forces: 30 % is 0.3$"),
                            ({"creepage": (0.01, 0.0), "spin": 1e-4}, "^$")):
            self.assertRegex(solve(friction={**rolling, **given}).message, text)


class Bodies(unittest.TestCase):
    def test_moduli(self):
        unlike, nus = (82000.0, 1000.0), (0.28, 0.45)
        young = tuple(2 * g * (1 + nu) for g, nu in zip(unlike, nus))
        star = 1.0 / sum((1 - nu**2) / e for e, nu in zip(young, nus))
        expected = cn.solve(H, DX, DY, force=100.0, shear_modulus=unlike, poisson_ratio=nus, tolerance=1e-10)
        for given in ({"young_modulus": young, "poisson_ratio": nus}, {"e_star": star}, {"e_star": star, "poisson_ratio": 0.4},
                      {"e_star": star, "poisson_ratio": nus}):
            found = solve(**given, tolerance=1e-10)
            np.testing.assert_allclose(found.pressure, expected.pressure, atol=1e-8 * expected.max_pressure)
            self.assertAlmostEqual(found.approach, expected.approach, delta=1e-9)
        steel = {"young_modulus": 2 * G * (1 + NU), "poisson_ratio": NU}
        rigid = solve(young_modulus=(steel["young_modulus"], np.inf), poisson_ratio=NU)
        by_shear = cn.solve(H, DX, DY, force=100.0, shear_modulus=(G, np.inf), poisson_ratio=NU)
        np.testing.assert_allclose(rigid.pressure, by_shear.pressure, rtol=1e-9)
        for one, other in (
            (cn.hertz(0.01, 0.02, force=1.0, **steel), cn.hertz(0.01, 0.02, force=1.0, **STEEL)),
            (cn.influence_half_space(4, 4, DX, DY, **steel), cn.influence_half_space(4, 4, DX, DY, **STEEL)),
            *[[cn.to_accuracy(H, DX, DY, force=100.0, target=0.1, **bodies).pressure for bodies in (steel, STEEL)]],
            (cn.Solver(MY, MX, DX, DY, **steel).solve(H, force=100.0).pressure, solve().pressure),
            (cn.friction_batch(H, DX, DY, [(1e-4, 0, 0)], force=100.0, friction={"coefficient": 0.3}, **steel).force,
             cn.friction_batch(H, DX, DY, [(1e-4, 0, 0)], force=100.0, friction={"coefficient": 0.3}, **STEEL).force),
        ):
            np.testing.assert_allclose(one, other, rtol=1e-5)
        self.assertEqual(cn.cost_of_accuracy(H, DX, DY, force=100.0, **steel)[0].shape, cn.cost_of_accuracy(H, DX, DY, force=100.0, **STEEL)[0].shape)

    def test_moduli_that_are_refused(self):
        for given, words in (
            ({"shear_modulus": None, "poisson_ratio": NU}, "give one of shear_modulus, young_modulus and e_star"),
            ({"shear_modulus": G, "young_modulus": G, "poisson_ratio": NU}, "give one of"),
            ({"shear_modulus": G, "poisson_ratio": None}, "give poisson_ratio"),
            ({"young_modulus": -1.0, "poisson_ratio": NU}, "young_modulus is -1.0; it must be positive"),
            ({"young_modulus": (1.0, np.nan), "poisson_ratio": NU}, "young_modulus is nan"),
            ({"e_star": 0.0}, "e_star is 0.0; it must be positive"),
            ({"e_star": 1.0, "friction": {"coefficient": 0.3}}, "poisson_ratio is needed with e_star: friction depends on it"),
            ({"e_star": 1.0, "coating": ((0.1, 1.0, 0.3), None)}, "poisson_ratio is needed with e_star: coating"),
        ):
            with self.assertRaisesRegex((TypeError, ValueError), words):
                cn.solve(H, DX, DY, force=1.0, **given)
        for nu in (-1.0, 1.0):
            for modulus in ("young_modulus", "e_star"):
                with self.assertRaisesRegex(cn.ContactNormalError, r"poisson_ratio\[0\]"):
                    cn.solve(H, DX, DY, force=1.0, poisson_ratio=nu, **{modulus: 1.0})
        h, by = np.add.outer(np.arange(-7.5, 8.0) ** 2, np.arange(-7.5, 8.0) ** 2) / 50.0, {"approach": 0.1, "e_star": 1.0}
        for call in (
            lambda: cn.quantities(h, 1.0, 1.0, names=["force", "max_shear"], **by),
            lambda: cn.cost_of_accuracy(h, 1.0, 1.0, targets=(0.1,), quantity="max_von_mises", **by),
            lambda: cn.solve_to_accuracy(h, 1.0, 1.0, target=0.1, targets={"von_mises_depth": 0.1}, **by),
            lambda: cn.what_matters(h, 1.0, 1.0, quantities=["max_shear"], period="x", **by),
        ):
            with self.assertRaisesRegex(TypeError, "poisson_ratio is needed with e_star: (max_shear|max_von_mises|von_mises_depth) depends on it"):
                call()
        with self.assertRaisesRegex(TypeError, "poisson_ratio is needed with e_star: a stress"):
            solve(e_star=G).subsurface([0.1])

    def test_mean_pressures(self):
        expected = solve()
        mean = 100.0 / (MY * MX * DX * DY)
        with cn.Solver(MY, MX, DX, DY, **STEEL) as solver:
            batch = solver.solve_batch([H, H], mean_pressure=[mean, 2 * mean])
            again = solver.solve(H, mean_pressure=mean)
        for found in (solve(force=None, mean_pressure=mean), again, batch[0]):
            np.testing.assert_allclose(found.pressure, expected.pressure, rtol=1e-9)
            self.assertAlmostEqual(found.mean_pressure, mean, places=9)
        self.assertAlmostEqual(batch[1].force, 200.0, places=6)
        accurate = cn.to_accuracy(H, DX, DY, mean_pressure=mean, target=0.1, **STEEL)
        self.assertAlmostEqual(accurate.force, 100.0, places=6)
        for load in ({"force": 1.0, "mean_pressure": 1.0}, {"approach": 1.0, "mean_pressure": 1.0}):
            with self.assertRaisesRegex(TypeError, "give either approach or force, or mean_pressure"):
                cn.solve(H, DX, DY, **load, **STEEL)


class Stresses(unittest.TestCase):
    def test_of_pressures_of_ones_own(self):
        found = solve(friction={"coefficient": 0.3, "force": (10.0, 0.0)})
        depths = [0.05, 0.2]
        for body, sign in ((1, 1.0), (2, -1.0)):
            all_of_it = found.subsurface(depths, body=body)
            traction = tuple(sign * found.traction)
            own = cn.subsurface_stress(found.pressure, DX, DY, depths, poisson_ratio=NU, traction=traction, body=body, components=("zz", "von_mises"))
            np.testing.assert_array_equal(own.zz, all_of_it.zz)
            np.testing.assert_array_equal(own.von_mises, all_of_it.von_mises)
            self.assertEqual(own.largest_von_mises, all_of_it.largest_von_mises)
            self.assertTrue(own.xx is None and own.maximum_shear is None and own.largest_shear == {} and own.principal is None)
            # Stresses at points are the same. Their x and y are coordinates of the result.
            points = [(x, y, z) for z in depths for y in found.y[5:8] for x in found.x[4:9]]
            at = cn.stress_at_points(found.pressure, DX, DY, points, poisson_ratio=NU, traction=traction, body=body)
            tensor = np.stack([getattr(all_of_it, name)[:, 5:8, 4:9].ravel() for name in ("xx", "yy", "zz", "xy", "xz", "yz")], axis=1)
            np.testing.assert_allclose(at, tensor, atol=1e-10 * found.max_pressure)
            np.testing.assert_array_equal(found.stress_at_points(points, body=body), at)
        sideways = cn.subsurface_stress(None, DX, DY, [0.0], poisson_ratio=NU, traction=tuple(found.traction), components="xz")
        np.testing.assert_allclose(sideways.xz[0], -found.traction[0], atol=1e-12 * found.traction.max())
        only = found.subsurface([0.1], components=[], principal=True)
        np.testing.assert_allclose(only.principal.sum(axis=0), sum(getattr(found.subsurface([0.1]), name) for name in ("xx", "yy", "zz")), atol=1e-9)

    def test_what_is_refused(self):
        p = np.ones((4, 5))
        for call, words in (
            (lambda: cn.subsurface_stress(p, DX, DY, [0.1], poisson_ratio=NU, components=("zz", "zx")), "components has 'zx'; there are: xx"),
            (lambda: cn.subsurface_stress(None, DX, DY, [0.1], poisson_ratio=NU), "give pressure, or traction"),
            (lambda: cn.subsurface_stress(p, DX, DY, [0.1], poisson_ratio=NU, traction=(p, p[1:])), r"traction\[1\] has shape"),
            (lambda: cn.subsurface_stress(p, DX, DY, [0.1], poisson_ratio=NU, traction=p), "traction has 4 parts"),
            (lambda: cn.stress_at_points(p, DX, DY, [(0.0, 0.0)], poisson_ratio=NU), r"points has shape \(1, 2\); it must be \(n, 3\)"),
        ):
            with self.assertRaisesRegex((TypeError, ValueError), words):
                call()
        with self.assertRaises(cn.ContactNormalError):
            cn.stress_at_points(p, DX, DY, [(0.0, 0.0, 0.0)], poisson_ratio=NU, body=3)
        self.assertEqual(cn.stress_at_points(p, DX, DY, np.zeros((0, 3)), poisson_ratio=NU).shape, (0, 6))

    def test_coating_compliance(self):
        # A coating of the body's own material has no effect: (1 - nu)/(G k).
        waves = np.array([[0.1, 1.0], [10.0, 1e4]])
        np.testing.assert_allclose(cn.coating_compliance(0.2, G, NU, waves, below=(G, NU)), (1 - NU) / (G * waves), rtol=1e-12)
        # Short waves see the coating only, long ones the substrate only.
        found = cn.coating_compliance(0.2, 4 * G, NU, [1e-5, 1e5], below=(G, NU)) * [1e-5, 1e5]
        np.testing.assert_allclose(found, [(1 - NU) / G, (1 - NU) / (4 * G)], rtol=1e-4)
        self.assertEqual(cn.coating_compliance(0.2, G, NU, 1.0, below=(G, NU)).shape, ())
        with self.assertRaises(cn.ContactNormalError):
            cn.coating_compliance(0.2, G, NU, -1.0, below=(G, NU))


class Tangential(unittest.TestCase):
    def test_pressures_of_ones_own(self):
        friction = {"coefficient": 0.3, "force": (10.0, -5.0)}
        both = solve(friction=friction, tolerance=1e-8)
        pressure = np.where(both.contact, both.pressure, -1.0)
        found = cn.solve_tangential(pressure, DX, DY, friction=friction, tolerance=1e-8, units=("mm", "N"), **STEEL)
        self.assertEqual((type(found), found.status, found.message), (cn.TangentialResult, cn.OK, ""))
        np.testing.assert_allclose(found.traction, both.traction, atol=1e-5 * both.max_pressure)
        np.testing.assert_array_equal(found.stick_slip, both.stick_slip)
        np.testing.assert_array_equal(found.pressure, both.pressure)
        np.testing.assert_array_equal(found.contact, both.contact)
        self.assertEqual((found.max_pressure, found.contact_area), (both.max_pressure, both.contact_area))
        np.testing.assert_allclose(found.tangential_force, (10.0, -5.0), atol=1e-6)
        np.testing.assert_allclose(found.subsurface([0.1]).xz, both.subsurface([0.1]).xz, atol=1e-5 * both.max_pressure)
        self.assertRegex(repr(found), r"^<TangentialResult: solved; 26 x 20 elements, force 100 N, max_pressure .* tangential_force \(10, -5\) N>$")
        self.assertFalse(hasattr(found, "deformed_distance"))
        with self.assertRaises(cn.ContactNormalError):
            cn.solve_tangential(pressure, DX, DY, friction={"coefficient": -1.0}, **STEEL)


class Limits(unittest.TestCase):
    def test_seconds(self):
        found = cn.solve_to_accuracy(H, DX, DY, force=100.0, target=1e-6, max_seconds=1e-9, **STEEL)
        self.assertEqual(found.status, cn.ITERATION_LIMIT)
        self.assertIn("max_seconds", found.message)
        rows = cn.cost_of_accuracy(lambda x, y: 0.02 * (x * x + y * y), DX, DY, shape=(32, 32), force=100.0, max_seconds=1e-9, **STEEL)
        self.assertEqual(rows[-1].obstacle, "too long")

    def test_bytes_and_elements(self):
        for name, obstacle in (("max_bytes", "too much memory"), ("max_elements", "too many elements")):
            found = cn.solve_to_accuracy(H, DX, DY, force=100.0, target=1e-6, **{name: 1000}, **STEEL)
            self.assertIn(name, found.message)
            rows = cn.cost_of_accuracy(lambda x, y: 0.02 * (x * x + y * y), DX, DY, shape=(32, 32), force=100.0, **{name: 1000}, **STEEL)
            self.assertEqual(rows[-1].obstacle, obstacle)
        # The docstrings say what no limit means: 4096 x 4096 elements.
        for function in (cn.solve_to_accuracy, cn.cost_of_accuracy):
            self.assertRegex(function.__doc__, r"max_elements : int\n.*0: 4096 x 4096\.")

    def test_targets(self):
        for name in ("max_pressure_target", "contact_area_target"):
            # A relative error of 7 % is written 0.07.
            with self.assertRaisesRegex(ValueError, f"{name} is 7; .* 1 % is 0.01"):
                cn.solve_to_accuracy(H, DX, DY, force=100.0, **{name: 7.0}, **STEEL)
            with self.assertRaisesRegex(cn.ContactNormalError, name):
                cn.solve_to_accuracy(H, DX, DY, force=100.0, **{name: -7.0}, **STEEL)

    def test_what_was_reached_is_not_always_known(self):
        cancelled = cn.solve_to_accuracy(H, DX, DY, approach=0.05, progress=lambda told: True, **STEEL)
        self.assertEqual((cancelled.status, cancelled.reached), (cn.CANCELLED, None))
        self.assertIn("reached not known", repr(cancelled))


class Bars(unittest.TestCase):
    def drawn(self, call):
        with redirect_stderr(io.StringIO()) as err, mock.patch.dict("sys.modules", {"tqdm": None}):
            found = call()
        bars = [line.count("#") for line in err.getvalue().split("\r") if "[" in line]
        self.assertEqual(bars, sorted(bars))
        return found, bars[-1]

    def test_what_is_solved_ends_at_all(self):
        rough = H + 1e-3 * np.random.default_rng(2).standard_normal(H.shape)
        for call in (
            lambda: solve(progress=True),
            lambda: cn.solve(rough, DX, DY, approach=0.05, progress=True, method="NORM", **STEEL),
            lambda: cn.solve(H + 1.0, DX, DY, approach=0.0, progress=True, **STEEL),
            lambda: cn.to_accuracy(H, DX, DY, force=100.0, target=0.01, progress=True, **STEEL),
        ):
            found, filled = self.drawn(call)
            self.assertEqual((found.status, filled), (cn.OK, 30))
        entries = np.zeros((40, 3)) + 1e-5
        shift = {"coefficient": 0.3, "motion": "SHIFT"}
        batch, filled = self.drawn(lambda: cn.friction_batch(H, DX, DY, entries, force=100.0, friction=shift, progress=True, **STEEL))
        self.assertEqual((batch.message, filled), ("", 30))
        _, filled = self.drawn(lambda: cn.creep_force_table(xi=[0.0, 0.5], eta=[0.0], phi=[0.0, 0.5], elements=9, progress=True))
        self.assertEqual(filled, 30)

    def test_what_is_not_does_not(self):
        for call in (lambda: solve(progress=True, method="NORM", max_cycles=1, tolerance=1e-14),
                     lambda: cn.to_accuracy(H, DX, DY, force=100.0, target=1e-6, max_elements=1000, progress=True, **STEEL)):
            found, filled = self.drawn(call)
            self.assertEqual(found.status, cn.ITERATION_LIMIT)
            self.assertLess(filled, 30)

    def test_it_never_goes_back(self):
        def told(m, residual, cycles=1):
            return cn.Progress(m, m, cycles, 0, 1.0, 1.0, 0.0, residual)

        # Three bars: for one grid, for grids that are not known beforehand, and for entries.
        for bar, steps in ((SolveBar(64 * 64, 1e-6), [(32, 1e-5), (64, 1e-3), (64, 1e-2), (64, 1e-5), (64, np.nan)]),
                           (SolveBar(None, 1e-6), [(16, 1e-3), (16, 1e-7), (32, 0.5), (32, 1e-3), (16, 1e-1), (64, 0.9), (64, 1e-6)]),
                           (SolveBar(64 * 64, 1e-6, 10), [(64, 1e-9, 3), (64, 1e-9, 1), (64, 1e-9, 7)])):
            parts = []
            with mock.patch.object(bar._bar, "draw", lambda part, text, parts=parts: parts.append(part)):
                for step in steps:
                    bar._due = 0.0
                    bar.tell(told(*step))
                bar.close(False)
                bar.close(True)
            self.assertEqual(parts, sorted(parts))
            self.assertLess(parts[-2], 1.0)
            self.assertEqual(parts[-1], 1.0)
            self.assertGreater(len(set(parts)), 2)

    def test_with_tqdm(self):
        tqdm = mock.MagicMock()
        with mock.patch.dict("sys.modules", {"tqdm": tqdm}):
            solve(progress=True)
        self.assertEqual(tqdm.tqdm.return_value.n, 100)


if __name__ == "__main__":
    unittest.main()
