"""Arguments that are easily mistaken: masks, complex numbers, booleans, words, contact areas, NaN."""

import unittest
import warnings
from fractions import Fraction

import numpy as np

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
M, D = 16, 0.1
X = (np.arange(M) - 0.5 * (M - 1)) * D
H = X[None, :] ** 2 + X[:, None] ** 2
MASK = (X[None, :] > 0) & (X[:, None] > -9)
MASKED = np.ma.masked_array(H, MASK)


def solve(h=H, **given):
    return cn.solve(h, **{"dx": D, "dy": D, "approach": 0.3, **STEEL, **given})


class Masks(unittest.TestCase):
    def setUp(self):
        self.expected = solve(np.where(MASK, np.inf, H)).pressure
        self.assertFalse(np.array_equal(self.expected, solve().pressure))

    def test_what_is_masked_has_no_surface(self):
        class Holds:
            def __array__(self, *_args, **_kwargs):
                return MASKED

        rows = [[np.ma.masked if hidden else value for value, hidden in zip(*row)] for row in zip(H.tolist(), MASK)]
        under_the_mask = [np.ma.masked_array(np.where(MASK, hidden, H), MASK) for hidden in (np.nan, np.inf, -1e300)]
        for h in (MASKED, list(MASKED), tuple(MASKED), rows, Holds(), *under_the_mask):
            np.testing.assert_array_equal(solve(h).pressure, self.expected)
        np.testing.assert_array_equal(solve(np.ma.masked_array(H)).pressure, solve().pressure)
        # Integers that are masked may have any value.
        whole = np.ma.masked_array(np.where(MASK, 10**18, np.round(H)).astype(np.int64), MASK)
        np.testing.assert_array_equal(solve(whole).pressure, solve(np.where(MASK, np.inf, np.round(H))).pressure)

    def test_solvers_and_tables(self):
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            np.testing.assert_array_equal(solver.solve(list(MASKED), approach=0.3).pressure, self.expected)
            for batch in ([MASKED, H], np.ma.stack([MASKED, H])):
                np.testing.assert_array_equal(solver.solve_batch(batch, approach=0.3)[0].pressure, self.expected)
        surface = {"dx": D, "dy": D, "approach": 0.3, "coefficient": 0.3, **STEEL}
        tables = [cn.creep_force_table(xi=[0.0, 1e-3], eta=[0.0], phi=[0.0], surface={**surface, "h": h})
                  for h in (MASKED, np.where(MASK, np.inf, H), H)]
        np.testing.assert_array_equal(tables[0].force_x, tables[1].force_x)
        self.assertFalse(np.array_equal(tables[0].force_x, tables[2].force_x))

    def test_accuracies(self):
        given = {"shape": (M, M), "target": 0.5, "approach": 0.3, **STEEL}

        def half(x, y):
            return np.where((x > 0) & (y > -9), np.inf, x * x + y * y)

        expected = cn.solve_to_accuracy(half, D, D, **given)
        for surface in (lambda x, y: np.ma.masked_where((x > 0) & (y > -9), x * x + y * y),
                        lambda x, y: list(np.ma.masked_where((x > 0) & (y > -9), x * x + y * y))):
            np.testing.assert_array_equal(cn.solve_to_accuracy(surface, D, D, **given).pressure, expected.pressure)
        self.assertFalse(expected.pressure[:, expected.pressure.shape[1] // 2 :].any())

    def test_masks_elsewhere_are_refused(self):
        masked = [np.ma.masked_array([0.3, 0.2], [False, True]), [np.ma.masked, 1.0]]
        for values in masked:
            for call in (lambda v=values: solve(shear_modulus=v), lambda v=values: solve(friction={"coefficient": 0.3, "creepage": v}),
                         lambda v=values: cn.Solver(M, M, D, D, **STEEL).solve_batch([H, H], approach=v),
                         lambda v=values: cn.cost_of_accuracy(H, D, D, approach=0.3, targets=v, **STEEL),
                         lambda v=values: solve().subsurface(v)):
                with self.assertRaises(TypeError):
                    call()
        for name in ("layer", "pressure_limit"):
            for value in (MASKED, list(MASKED), np.ma.masked):
                with self.assertRaises(TypeError):
                    solve(**{name: value})
        with self.assertRaises(TypeError):
            solve(approach=np.ma.masked)


class Numbers(unittest.TestCase):
    def assert_refused(self, words, call):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaisesRegex((TypeError, ValueError), words):
                call()

    def test_numbers(self):
        for name in ("dx", "dy", "approach", "layer", "pressure_limit", "tolerance", "relaxation"):
            for bad in (True, np.True_, 1j, np.complex128(1 + 1j), np.array([0.3, 0.4]), b"1", [0.3], 10**400):
                if name in ("layer", "pressure_limit") and np.ndim(bad):
                    continue
                with self.subTest(name=name, bad=bad):
                    self.assert_refused(f"^{name} is ", lambda: solve(**{name: bad}))
        for bad in ("0.1", "a"):
            self.assert_refused("^dx is '", lambda: solve(dx=bad))
        for good in (np.float32(0.5), np.array(0.5), Fraction(1, 2), np.longdouble(0.5)):
            self.assertEqual(solve(approach=good).approach, 0.5)
        self.assertEqual(solve(approach=1).approach, 1.0)
        self.assert_refused("max_cycles is True", lambda: solve(max_cycles=True))
        self.assert_refused("max_seconds is '5'", lambda: cn.solve_to_accuracy(H, D, D, approach=0.3, max_seconds="5", **STEEL))
        self.assert_refused("curvature_x is True", lambda: cn.hertz(True, 1.0, force=1.0, **STEEL))

    def test_arrays(self):
        self.assert_refused("^h has dtype bool", lambda: solve(H > 0.1))
        self.assert_refused("^h has dtype complex", lambda: solve(H + 0j))
        self.assert_refused("^h holds 9007199254740993; it must be at most 2", lambda: solve(np.full((M, M), 2**53 + 1)))
        huge = H.astype(np.longdouble)
        # On Windows longdouble is double.
        if np.finfo(np.longdouble).max > np.finfo(float).max:
            huge[3, 4] = np.longdouble(10) ** 400
            self.assert_refused("^h holds a number that does not fit", lambda: solve(huge))
        huge[3, 4] = np.inf
        self.assertEqual(solve(huge).pressure[3, 4], 0.0)
        for same in (H.astype(">f8"), H.astype(np.longdouble), np.asfortranarray(H), H.tolist()):
            np.testing.assert_array_equal(solve(same).pressure, solve().pressure)
        for bad in (lambda x, y: (x * x + y * y) * (1 + 5j), lambda x, y: x * x + y * y > 0.1, lambda x, y: "0", lambda x, y: None):
            self.assert_refused("what h.x, y. returns (is|has)", lambda: cn.to_accuracy(bad, D, D, shape=(M, M), approach=0.3, **STEEL))
        self.assert_refused("what h.x, y. returns has shape", lambda: cn.to_accuracy(lambda x, y: H[:3], D, D, shape=(M, M), approach=0.3, **STEEL))
        for flat in (lambda x, y: 0.0, lambda x, y: 0.0 * x, lambda x, y: [[0.0]]):
            self.assertTrue(cn.to_accuracy(flat, D, D, shape=(M, M), approach=0.3, target=0.5, **STEEL).contact.all())

    def test_batches(self):
        with cn.Solver(M, M, D, D, **STEEL) as solver:
            for bad, words in (([1.0, 2.0, 3.0], r"force has shape \(3,\); it must be one value, or 2"),
                               ([1.0], "one value, or 2"), ([[1.0], [2.0]], "one value"), ([True, False], "dtype bool"), ([1j, 2.0], "dtype complex"), (["1", "2"], "dtype")):
                self.assert_refused(words, lambda: solver.solve_batch([H, H], force=bad))
            for name in ("pressure", "contact"):
                for count in (1, 3):
                    given = {name: [1.0 * (H > 0)] * count}
                    self.assert_refused(f"{name} has {count} parts; it must have 2", lambda: solver.solve_batch([H, H], force=1.0, **given))

    def test_friction(self):
        for bad, words in (
            (0.3, "friction is 0.3; it must be a mapping of coefficient, motion"),
            ({1: 2, None: 3}, "friction has 1, None; it may have coefficient"),
            ({"motion": 2.0}, r"friction\['motion'\] is 2.0; it must be an integer"),
            ({"continues": "no"}, r"friction\['continues'\] is 'no'; it must be True or False"),
            ({"sensitivities": np.zeros(2)}, r"friction\['sensitivities'\] is"),
            ({"creepage": 1e-3}, r"friction\['creepage'\] is 0.001; it must be two numbers"),
            ({"creepage": (1e-3, 0.0, 0.0)}, r"friction\['creepage'\] has 3 parts"),
            ({"spin": "1"}, r"friction\['spin'\] is '1'"),
            ({"coefficient": True}, r"friction\['coefficient'\] is True"),
            ({"force": 5.0}, r"friction\['force'\] is 5.0; it must be a pair, None where"),
            ({"force": (1j, None)}, r"friction\['force'\]\[0\] is 1j"),
            ({"previous_traction": [0 * H] * 3}, r"friction\['previous_traction'\] has 3 parts; it must be a pair"),
            ({"previous_traction": [0 * H]}, r"friction\['previous_traction'\] has 1 parts"),
            ({"rigid_slip": 0 * H}, r"friction\['rigid_slip'\] has 16 parts"),
            ({"influence": [np.ones((32, 32))] * 3, "influence_cross": [np.ones((32, 32))] * 3}, r"friction\['influence_cross'\] has 3 parts"),
        ):
            with self.subTest(bad=str(bad)[:60]):
                self.assert_refused(words, lambda: solve(friction={"coefficient": 0.3, **bad} if isinstance(bad, dict) else bad))

    def test_others(self):
        for bad in (5, "bar", 1.0):
            self.assert_refused(f"progress is {bad!r}; it must be a callable, or True", lambda: solve(progress=bad))
        self.assert_refused("coating has 3 parts", lambda: solve(coating=(0.1, 8e4, 0.3)))
        self.assert_refused(r"coating\[0\] is 0.1; it must be \(thickness", lambda: solve(coating=(0.1, None)))
        self.assert_refused("principal is 'no'", lambda: solve().subsurface([0.1], principal="no"))
        self.assert_refused("shape is for a surface that is a callable", lambda: cn.solve_to_accuracy(H, D, D, shape=(8, 8), approach=0.3, **STEEL))
        self.assert_refused("corner is 3", lambda: cn.solve_to_accuracy(lambda x, y: x, D, D, shape=(8, 8), corner=3, approach=0.3, **STEEL))


class Guesses(unittest.TestCase):
    def test_a_contact_area_is_a_guess(self):
        rough = H + 0.1 * np.random.default_rng(5).standard_normal((M, M))
        for load in ({"approach": 0.3}, {"approach": None, "force": 2000.0}, {"approach": None, "mean_pressure": 800.0}):
            alone = solve(rough, method="NORM", **load)
            found = solve(rough, method="NORM", contact=alone.contact, **load)
            self.assertEqual(found.status, cn.OK)
            np.testing.assert_allclose(found.pressure, alone.pressure, atol=1e-4 * alone.max_pressure)
            # With the right area as a guess the solve need not search for it.
            self.assertLess(found.report["cycles"], alone.report["cycles"])
        with cn.Solver(M, M, D, D, method="NORM", **STEEL) as solver:
            one = solver.solve(rough, approach=0.3, contact=solve(rough).contact)
            batch = solver.solve_batch([rough], approach=0.3, contact=[solve(rough).contact])
            self.assertLess(one.report["cycles"], solver.solve(rough, approach=0.3).report["cycles"])
            np.testing.assert_array_equal(one.pressure, batch[0].pressure)

    def test_a_wrong_one_does_no_harm(self):
        for wrong in (H < 0, H < np.inf, H > 0.3, np.eye(M, dtype=bool)):
            for load in ({"approach": 0.3}, {"approach": None, "force": 2000.0}):
                found = solve(contact=wrong, **load)
                self.assertEqual(found.status, cn.OK)
                np.testing.assert_allclose(found.pressure, solve(**load).pressure, atol=1e-4 * found.max_pressure)

    def test_a_fixed_area_is_no_guess(self):
        area = H < 0.1
        fixed = solve(contact=area, active_set="FIXED")
        np.testing.assert_array_equal(fixed.contact, area)


class Tables(unittest.TestCase):
    def test_nan_has_no_force(self):
        table = cn.creep_force_table(xi=[0.0, 0.5, 1.0], eta=[0.0, 0.3], phi=[0.0, 0.5], axis_ratio=[1.0, 2.0], poisson_ratio=[0.2, 0.3], elements=9)
        one = cn.creep_force_table(xi=[0.0, 0.5, 1.0], eta=[0.0], phi=[0.0], elements=9)
        names = ("xi", "eta", "phi", "axis_ratio", "poisson_ratio")
        for filled in (table, one):
            right = dict(zip(names, (0.2, 0.0, 0.0, 1.0, 0.28)))
            for name in names:
                keys = {**right, name: np.array([np.nan, right[name]])}
                for values in filled.forces(**keys, hold=True):
                    self.assertTrue(np.isnan(values[0]))
                    self.assertTrue(np.isfinite(values[1]))
                with self.assertRaisesRegex(ValueError, f"^{name} has values outside the table"):
                    filled.forces(**keys)
        for bad in (np.ma.masked_array([0.2, 0.3], [True, False]), [np.ma.masked, 0.2], None, "0.2", 0.2 + 0j, True):
            with self.assertRaisesRegex(TypeError, "^xi "):
                one.forces(bad, 0.0, 0.0)
            with self.assertRaisesRegex(TypeError, "^xi "):
                cn.creep_force_table(xi=bad, eta=[0.0], phi=[0.0], elements=9)
            with self.assertRaisesRegex(TypeError, "^creepage.1. "):
                one.wheel_rail((0.0, bad), 0.0, semi_axes=(1.0, 1.0), normal_force=1.0, coefficient=0.3, shear_modulus=1.0)
        with self.assertRaisesRegex(TypeError, "hold is 'no'"):
            one.forces(0.2, 0.0, 0.0, hold="no")
        rail = {"semi_axes": (1.0, 1.0), "normal_force": 1.0, "coefficient": 0.3, "shear_modulus": 1.0, "hold": True}
        for creepage, spin in (((np.nan, 0.0), 0.0), ((0.0, np.nan), 0.0), ((0.0, 0.0), np.nan)):
            self.assertTrue(np.isnan(one.wheel_rail(creepage, spin, **rail)).all())
        for name in ("normal_force", "coefficient", "shear_modulus"):
            self.assertTrue(np.isnan(one.wheel_rail((0.1, 0.0), 0.0, **{**rail, name: np.nan})).all())
        # Wheels that are lifted, entirely or nearly, have no force. The loaded wheel has the force that a call for it alone gives.
        lifted = {**rail, "semi_axes": (np.array([1.0, 1.0, 1.0]), np.array([0.0, 1.0, 1.0])), "normal_force": np.array([0.0, 1.0, 1e-320])}
        for hold in (True, False):
            forces = np.array(one.wheel_rail((1e-4, 0.0), 0.0, **{**lifted, "hold": hold}))
            np.testing.assert_array_equal(forces[:, [0, 2]], 0.0)
            np.testing.assert_array_equal(forces[:, 1], one.wheel_rail((1e-4, 0.0), 0.0, **rail))
        self.assertEqual(one.wheel_rail((0.0, 0.0), 0.0, **{**rail, "semi_axes": (np.ones(3), 1.0), "normal_force": 0.0})[0].shape, (3,))


if __name__ == "__main__":
    unittest.main()
