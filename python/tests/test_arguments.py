"""Mistaken arguments are refused by name: integers do not wrap, masks are not lost, numbers are not truncated."""

import unittest
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal import _adhesion, _arguments, _calls, _constants, _visco

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
X = np.arange(12) - 5.5
H = 0.01 * (X[None, :] ** 2 + X[:10, None] ** 2)


def solve(h=H, **given):
    return cn.solve(h, 0.2, 0.2, approach=0.1, **given, **STEEL)


class Arguments(unittest.TestCase):
    def test_integers_do_not_wrap(self):
        # Without a check, 10^12 would wrap to a negative number of 32 bits, and 2^32 + 5 to 5.
        for name, value in (("max_cycles", 10**12), ("max_cycles", 2**32 + 5), ("threads", 2**32 + 1), ("coarsest", -(2**31) - 1)):
            with self.assertRaisesRegex(ValueError, f"{name} is {value}; it must fit into 32 bits"):
                solve(**{name: value})
        with self.assertRaisesRegex(ValueError, "mx is 4294967304"):
            cn.Solver(10, 2**32 + 8, 0.2, 0.2, **STEEL)
        with self.assertRaisesRegex(ValueError, "cx is 4294967304"):
            cn.influence_half_space(2**32 + 8, 8, 0.2, 0.2, **STEEL)
        for name in ("max_bytes", "max_elements"):
            with self.assertRaisesRegex(ValueError, f"{name} is {2**64 + 1}; it must fit into 64 bits"):
                cn.solve_to_accuracy(H, 0.2, 0.2, approach=0.1, **{name: 2**64 + 1}, **STEEL)

    def test_integers_are_not_cut_off(self):
        with self.assertRaisesRegex(TypeError, "max_cycles is 2.5; it must be an integer"):
            solve(max_cycles=2.5)

    def test_other_masked_arrays_are_refused(self):
        masked = np.ma.masked_where(H > 0.2, H)
        with self.assertRaisesRegex(TypeError, "layer is a masked array"):
            solve(layer=np.ma.masked_where(H > 0.2, 1e-6 * H))
        with self.assertRaisesRegex(TypeError, "pressure is a masked array"):
            solve(pressure=masked)
        # A handle copies its effects before they are checked, and must not lose the masks.
        effects = {"layer": np.ma.masked_where(H > 0.2, 1e-6 * H), "shear_modulus": np.ma.array([1e3, 9e9], mask=[False, True]),
                   "patches": (np.ma.masked_where(H > 0.2, (H > 0.1).astype(int)), np.eye(2))}
        for name, value in effects.items():
            with self.assertRaisesRegex(TypeError, f"{name}.* is a masked array"):
                cn.Solver(*H.shape, 0.5, 0.5, **{"shear_modulus": 82000.0, "poisson_ratio": 0.28, name: value})
            with self.assertRaisesRegex(TypeError, f"{name}.* is a masked array"):
                cn.solve(H, 0.5, 0.5, force=1.0, **{"shear_modulus": 82000.0, "poisson_ratio": 0.28, name: value})

    def test_integer_arrays_hold_integers(self):
        factors = np.eye(2)
        with self.assertRaisesRegex(TypeError, r"patches\[0\] has dtype float64; it must hold integers or booleans"):
            solve(patches=(np.where(X < 0, 0.0, 0.7) + 0 * H, factors))
        with self.assertRaisesRegex(TypeError, "contact has dtype float64"):
            solve(contact=np.full(H.shape, 0.5), active_set="FIXED")
        with self.assertRaisesRegex(ValueError, r"an element of patches\[0\] is 4294967296; it must fit into 32 bits"):
            solve(patches=(np.full(H.shape, 2**32), factors))
        whole = solve(patches=((X > 0).astype(np.int64) + np.zeros(H.shape, dtype=np.int8), factors))
        self.assertEqual(whole.status, cn.OK)

    def test_effects_of_wrong_shapes(self):
        for name, value, message in (
            ("patches", (np.zeros(H.shape, int),), "patches has 1 parts"),
            ("patches", (np.zeros(H.shape, int), np.ones((1, 2))), "must be square"),
            ("influence", np.ones((3, 4)), r"influence has shape \(3, 4\)"),
            ("row_tables", np.ones((10, 9, 24)), r"row_tables has shape \(10, 9, 24\)"),
            ("period", "yx", "period is 'yx'"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                solve(**{name: value})
        with self.assertRaisesRegex(ValueError, r"shear_modulus has shape \(3,\)"):
            cn.solve(H, 0.2, 0.2, approach=0.1, shear_modulus=[1.0, 1.0, 1.0], poisson_ratio=0.0)
        for load in ({}, {"approach": 0.1, "force": 1.0}):
            with self.assertRaisesRegex(TypeError, "give either approach or force"):
                cn.solve(H, 0.2, 0.2, **load, **STEEL)

    def test_names_stand_for_constants(self):
        for method in ("AUTO", "auto", "NORM", "FULL_MULTIGRID", "PROJECTED_CG"):
            by_name = solve(method=method)
            by_number = solve(method=getattr(cn, f"METHOD_{method.upper()}"))
            self.assertEqual(by_name.status, cn.OK)
            self.assertTrue(np.array_equal(by_name.pressure, by_number.pressure), method)
            self.assertEqual(by_name.report["cycles"], by_number.report["cycles"])
        with self.assertRaisesRegex(ValueError, "method is 'FASTEST'; it must be one of AUTO, NORM, MULTIGRID, FULL_"):
            solve(method="FASTEST")
        with self.assertRaisesRegex(ValueError, "tolerance is '1e-3'; it must be a number"):
            solve(tolerance="1e-3")
        with self.assertRaisesRegex(TypeError, r"no argument and no option tolerence \(is tolerance meant\?\); options are: active_set, coarsest"):
            solve(tolerence=1e-3)

    def test_arrays_at_odd_addresses(self):
        def odd(array):
            return np.frombuffer(b"." + array.tobytes(), array.dtype, offset=1).reshape(array.shape)

        self.assertFalse(odd(H).flags.aligned)
        patches = (X > 0).astype(np.int32) + np.zeros(H.shape, dtype=np.int32)
        for one, other in ((_arguments.doubles("h", odd(H)), H), (_arguments.integers("patches", odd(patches), H.shape), patches)):
            self.assertTrue(one.flags.aligned)
            np.testing.assert_array_equal(one, other)
        np.testing.assert_array_equal(solve(odd(H)).pressure, solve().pressure)

    def test_numbers_stand_for_constants_of_effects(self):
        given = {"work": 1.0, "range": 5.0}
        for law, start in (("EXPONENTIAL", "FROM_CONTACT"), ("DUGDALE", "FROM_APART")):
            numbers = {"law": _constants.value_of("law", law), "start": _constants.value_of("start", start)}
            found = [_adhesion.adhesion({**given, **names}, H.shape)[0] for names in ({"law": law, "start": start}, numbers)]
            self.assertEqual(*[(one.law, one.start) for one in found])
        found = [_visco.visco({"form": form})[0].form for form in ("CREEP", _constants.value_of("form", "CREEP"))]
        self.assertEqual(*found)
        with self.assertRaisesRegex(TypeError, r"visco\['form'\] is 1.5; it must be an integer"):
            _visco.visco({"form": 1.5})

    def test_units_are_checked_before_the_solve(self):
        pressure = np.ones((4, 4))
        calls = (lambda **units: solve(**units),
                 lambda **units: cn.pull_off(H, 0.2, 0.2, adhesion={"work": 1.0, "range": 5.0}, **units, **STEEL),
                 lambda **units: cn.solve_tangential(pressure, 0.2, 0.2, friction={"coefficient": 0.3}, **units, **STEEL),
                 lambda **units: cn.subsurface_stress(pressure, 0.2, 0.2, [0.1], poisson_ratio=0.3, **units))
        for call in calls:
            with mock.patch.object(_calls, "_told", side_effect=AssertionError("the library was called")):
                with self.assertRaisesRegex(ValueError, "units are"):
                    call(units=("N", "mm"))

    def test_messages_name_what_the_call_takes(self):
        pressure = np.ones((4, 4))
        with self.assertRaisesRegex(TypeError, "^give either approach or force, and only one of them$"):
            cn.hertz(0.1, 0.1, **STEEL)
        for call in (lambda **given: cn.solve_tangential(pressure, 0.2, 0.2, friction={"coefficient": 0.3}, **given),
                     lambda **given: cn.friction_batch(None, 0.2, 0.2, [(0.0, 0.0, 0.0)], pressure=pressure, friction={"coefficient": 0.3}, **given)):
            for given in ({}, {"shear_modulus": 1.0, "young_modulus": 1.0}):
                with self.assertRaisesRegex(TypeError, "give either shear_modulus or young_modulus,"):
                    call(poisson_ratio=0.3, **given)
        self.assertEqual(cn.solve(H, 0.2, 0.2, approach=0.1, shear_modulus=10**20, poisson_ratio=0.3).status, cn.OK)
        with self.assertRaisesRegex(ValueError, "shear_modulus is 1.*; it must fit into a double"):
            cn.solve(H, 0.2, 0.2, approach=0.1, shear_modulus=10**400, poisson_ratio=0.3)
        for name in ("influence", "row_tables"):
            with self.assertRaisesRegex(TypeError, rf"friction\['{name}'\] is 5; it must be \(xx, yy, xy\)"):
                solve(friction={"coefficient": 0.3, name: 5})
        # Old versions of numpy make object arrays of such lists.
        with self.assertRaisesRegex((ValueError, TypeError), "h has (parts of different shapes|dtype object)"):
            solve([[0.0, 1.0], [2.0]])
        with self.assertRaisesRegex((ValueError, TypeError), "influence has (parts of different shapes|dtype object)"):
            solve(influence=[np.ones((20, 24)), 2])

    def test_a_creepage_beside_the_force_is_refused(self):
        friction = {"coefficient": 0.3, "force": (1.0, None), "motion": "STEADY_ROLLING"}
        with self.assertRaisesRegex(ValueError, r"friction\['creepage'\]\[0\] is 0.005 and friction\['force'\]\[0\] is 1.0; give one of them"):
            solve(friction={**friction, "creepage": (5e-3, 0.0)})
        for creepage in ((0.0, 1e-4), (None, 1e-4)):
            self.assertEqual(solve(friction={**friction, "creepage": creepage}).status, cn.OK)

    def test_limits_that_are_whole(self):
        given = {"approach": 0.1, "target": 0.1, **STEEL}
        found = cn.solve_to_accuracy(H, 0.2, 0.2, max_bytes=2e9, max_elements=1e6, **given)
        self.assertEqual(found.status, cn.OK)
        with self.assertRaisesRegex(TypeError, "max_bytes is 1.5; it must be an integer"):
            cn.solve_to_accuracy(H, 0.2, 0.2, max_bytes=1.5, **given)

    def test_arrays_with_x_first(self):
        class Transposed(np.ndarray):
            dims = ("x", "y")

        square = np.ones((8, 8))
        for call, name in ((lambda one: cn.solve(square, 0.1, 0.1, approach=1.1, layer=one, **STEEL), "layer"),
                           (lambda one: cn.solve(square, 0.1, 0.1, approach=1.1, contact=one > 0, **STEEL), "contact"),
                           (lambda one: cn.subsurface_stress(one, 0.1, 0.1, [0.1], poisson_ratio=0.3), "pressure"),
                           (lambda one: cn.solve(one, 0.1, 0.1, approach=1.1, **STEEL), "h")):
            with self.assertRaisesRegex(ValueError, rf"^{name} has the dimensions \('x', 'y'\); x must be the last one"):
                call(square.view(Transposed))


if __name__ == "__main__":
    unittest.main()
