"""What callers pass by mistake is refused by name: it does not wrap, lose its mask, or get truncated."""

import unittest

import numpy as np

import contact_normal as cn

STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
X = np.arange(12) - 5.5
H = 0.01 * (X[None, :] ** 2 + X[:10, None] ** 2)


def solve(h=H, **given):
    return cn.solve(h, 0.2, 0.2, approach=0.1, **given, **STEEL)


class Arguments(unittest.TestCase):
    def test_integers_do_not_wrap(self):
        # 10^12 modulo 2^32 is negative; 2^32 + 5 would be 5.
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


if __name__ == "__main__":
    unittest.main()
