"""Tables of creep forces: entries, errors, symmetries, interpolation, surfaces, processes."""

import concurrent.futures
import io
import multiprocessing
import unittest
import warnings
from contextlib import redirect_stderr
from unittest import mock

import numpy as np

import contact_normal as cn
from contact_normal import _creep_force_plane, _creep_force_table
from contact_normal._creep_force_plane import halved

XI, ETA, PHI = [0.0, 0.1, 0.3, 0.8], [-0.15, 0.0, 0.15], [0.0, 0.5]
TABLE = cn.creep_force_table(xi=XI, eta=ETA, phi=PHI, axis_ratio=[0.5, 1.0, 2.0], poisson_ratio=[0.25, 0.28], elements=17)


def direct(axis_ratio, nu, entries, elements=17):
    """Forces and moments over mu N and mu N c, with G = mu N = 1 and pressures at the centres of elements of an ellipse."""
    a, b = np.sqrt(axis_ratio), 1.0 / np.sqrt(axis_ratio)
    x = (np.arange(elements * 4) + 0.5) * 2.0 / (elements * 4) - 1.0
    p = np.sqrt(np.maximum(0.0, 1.0 - x[None, :] ** 2 - x[:, None] ** 2)).reshape(elements, 4, elements, 4).mean(axis=(1, 3))
    dx, dy = 2.0 * a / elements, 2.0 * b / elements
    found = cn.friction_batch(None, dx, dy, entries, pressure=p / (p.sum() * dx * dy), shear_modulus=1.0, poisson_ratio=nu,
                              friction={"coefficient": 1.0, "motion": "STEADY_ROLLING"}, tolerance=1e-6)
    assert not found.status.any(), found.message
    return np.column_stack([found.force, found.moment])


class Entries(unittest.TestCase):
    def test_entries_are_what_direct_solves_find(self):
        self.assertEqual(TABLE.force_x.shape, (3, 2, 2, 3, 4))
        self.assertFalse(TABLE.status.any())
        self.assertLessEqual(TABLE.residual.max(), 1e-4)
        for r, n, p in ((0, 0, 0), (1, 1, 1), (2, 0, 1)):
            entries = [(xi, eta, PHI[p]) for eta in ETA for xi in XI]
            found = direct(TABLE.axis_ratio[r], TABLE.poisson_ratio[n], entries).reshape(3, 4, 3)
            table = np.stack([values[r, n, p] for values in (TABLE.force_x, TABLE.force_y, TABLE.moment)], axis=-1)
            # A residual of 1e-4 leaves an error of some 1e-5 of mu N (docs/friction.md).
            np.testing.assert_allclose(table, found, atol=1e-4)

    def test_small_creepages_follow_kalkers_coefficients(self):
        # A circle with nu = .25 has C11 = 4.12, C22 = 3.67, C23 = 1.47 (Kalker 1990, appendix E). The error of forces is of first order in the
        # elements, so that they are extrapolated from two grids.
        small, slopes = 0.002, []
        for elements in (40, 80):
            table = cn.creep_force_table(xi=[0.0, small], eta=[0.0, small], phi=[0.0, small], poisson_ratio=0.25, elements=elements)
            x, y, moment = (values[0, 0] / small for values in (table.force_x, table.force_y, table.moment))
            slopes.append(np.array([-x[0, 0, 1], -y[0, 1, 0], -y[1, 0, 0], moment[0, 1, 0]]))
        # C23 appears twice: in the force by spin, and in the moment by lateral creepage. Kalker's values are accurate to some 1 %.
        np.testing.assert_allclose(2.0 * slopes[1] - slopes[0], [4.12, 3.67, 1.47, 1.47], rtol=0.015)

    def test_the_estimated_error_bounds_that_to_a_finer_grid(self):
        axes = {"xi": XI, "eta": ETA, "phi": PHI, "axis_ratio": [0.5, 2.0]}
        coarse, fine = (cn.creep_force_table(elements=elements, **axes) for elements in (17, 68))
        radius = 1.0  # c, the radius of a circle of the area of the contact
        off = np.sqrt((coarse.force_x - fine.force_x) ** 2 + (coarse.force_y - fine.force_y) ** 2 + ((coarse.moment - fine.moment) / radius) ** 2)
        # The finer grid is the reference. It has a quarter of the error.
        self.assertLess((off / coarse.error).max(), 1.0)
        # The estimate is not much too large.
        self.assertLess(np.median(coarse.error), 4.0 * np.median(off))


class Work(unittest.TestCase):
    AXES = {"xi": [0.0, 0.3], "eta": [0.0], "phi": [0.0, 0.5], "axis_ratio": [0.5, 1.0], "elements": 9}

    def test_what_the_coarse_grid_says_is_told(self):
        solved = _creep_force_plane.friction_batch

        def unsolved_on(elements, status):
            def batch(*given, pressure, **named):
                found = solved(*given, pressure=pressure, **named)
                if len(pressure) == elements:
                    found.status[1] = status
                return found

            return batch

        for elements in (9, 5):
            for status in (cn.ITERATION_LIMIT, cn.STAGNATED):
                with mock.patch.object(_creep_force_plane, "friction_batch", unsolved_on(elements, status)):
                    table = cn.creep_force_table(**self.AXES)
                # Only the second entry of each plane has the status.
                np.testing.assert_array_equal(table.status[..., 0, 1], status)
                np.testing.assert_array_equal(table.status[..., 0, 0], cn.OK)
        # The status of the fine grid takes precedence.
        both = lambda *given, **named: mark(solved(*given, **named))  # noqa: E731

        def mark(found):
            found.status[:] = cn.STAGNATED if found.products.size and len(marked) % 2 else cn.ITERATION_LIMIT
            marked.append(found)
            return found

        marked = []
        with mock.patch.object(_creep_force_plane, "friction_batch", both):
            np.testing.assert_array_equal(cn.creep_force_table(**self.AXES).status, cn.ITERATION_LIMIT)

    def test_a_bar_of_what_was_done_before_is_full(self):
        plan = _creep_force_table._plan(surface=None, poisson_ratio=0.28, tolerance=1e-4, **self.AXES)
        done = {index: _creep_force_plane.plane(plan, index) for index in range(plan.planes)}
        with redirect_stderr(io.StringIO()) as err, mock.patch.dict("sys.modules", {"tqdm": None}):
            self.assertEqual(_creep_force_table._planes(plan, mock.Mock(done=lambda: done), 1, None, True), done)
        self.assertIn("[" + 30 * "#" + "]", err.getvalue())

    def test_processes_end_with_the_table(self):
        alone = cn.creep_force_table(**self.AXES)
        parallel = cn.creep_force_table(workers=2, **self.AXES)
        np.testing.assert_array_equal(alone.force_x, parallel.force_x)
        self.assertEqual(multiprocessing.active_children(), [])
        for bad, words in (({"poisson_ratio": 0.7}, "poisson_ratio"), ({"progress": self.fail_at_once}, "enough")):
            with self.assertRaisesRegex((cn.ContactNormalError, RuntimeError), words):
                cn.creep_force_table(workers=2, **{**self.AXES, **bad})
            self.assertEqual(multiprocessing.active_children(), [])

    @staticmethod
    def fail_at_once(done, entries):
        raise RuntimeError("enough")

    def test_a_clusters_executor_is_left_and_not_waited_for(self):
        class Executor(concurrent.futures.ThreadPoolExecutor):
            ended = ()

            def shutdown(self, *given, **named):
                self.ended = (*self.ended, (given, named))
                super().shutdown(*given, **named)

        executor = Executor(1)
        client = mock.Mock()
        client.get_executor.return_value = executor
        table = cn.creep_force_table(client=client, **self.AXES)
        np.testing.assert_array_equal(table.force_x, cn.creep_force_table(**self.AXES).force_x)
        self.assertEqual(executor.ended, (((), {"wait": False}),))


class Interpolation(unittest.TestCase):
    def test_signs_that_are_not_in_the_table(self):
        points = np.array([(0.3 * a, 0.15 * b, 0.5 * c) for a in (1, -1) for b in (1, -1) for c in (1, -1)])
        force_x, force_y, moment, error = TABLE.forces(*points.T, axis_ratio=2.0, poisson_ratio=0.28)
        np.testing.assert_allclose(np.column_stack([force_x, force_y, moment]), direct(2.0, 0.28, points), atol=1e-4)
        self.assertTrue((error > 0).all())

    def test_between_entries_and_beyond_them(self):
        at = {"axis_ratio": 2.0, "poisson_ratio": 0.25}
        low, high = (TABLE.force_x[2, 0, 0, 1, k] for k in (1, 2))
        np.testing.assert_allclose(TABLE.forces(0.15, 0.0, 0.0, **at)[0], 0.75 * low + 0.25 * high, rtol=1e-12)
        # Interpolation is linear in the logarithm of a/b: half way between 1 and 2 is sqrt(2).
        middle = TABLE.forces(0.1, 0.0, 0.0, axis_ratio=np.sqrt(2.0), poisson_ratio=0.25)[0]
        np.testing.assert_allclose(middle, 0.5 * (TABLE.force_x[1, 0, 0, 1, 1] + TABLE.force_x[2, 0, 0, 1, 1]), rtol=1e-12)
        self.assertEqual(TABLE.forces(np.zeros((2, 1)), np.zeros(3), 0.0, **at)[0].shape, (2, 3))
        for axis, point in (("xi", (0.9, 0.0, 0.0)), ("eta", (0.1, 0.2, 0.0)), ("phi", (0.1, 0.0, 0.6))):
            with self.assertRaisesRegex(ValueError, f"^{axis} has values outside"):
                TABLE.forces(*point, **at)
        np.testing.assert_array_equal(TABLE.forces(0.9, 0.0, 0.0, hold=True, **at), TABLE.forces(0.8, 0.0, 0.0, **at))
        with self.assertRaisesRegex(TypeError, "poisson_ratio is needed"):
            TABLE.forces(0.1, 0.0, 0.0)

    def test_units_of_a_wheel_on_a_rail(self):
        # A steel wheel with an ellipse of 6 x 3 mm has the forces of friction_batch in mm and N.
        a, b, force, mu, shear = 6.0, 3.0, 80e3, 0.3, 82000.0
        creepage, spin, n = (0.25 * mu * force / (shear * a * b), 0.0), 0.0, 17
        x = (np.arange(n * 4) + 0.5) * 2.0 / (n * 4) - 1.0
        p = np.sqrt(np.maximum(0.0, 1.0 - x[None, :] ** 2 - x[:, None] ** 2)).reshape(n, 4, n, 4).mean(axis=(1, 3))
        dx, dy = 2 * a / n, 2 * b / n
        p *= force / (p.sum() * dx * dy)
        found = cn.friction_batch(None, dx, dy, [(*creepage, spin)], pressure=p, friction={"coefficient": mu, "motion": "STEADY_ROLLING"},
                                  shear_modulus=shear, poisson_ratio=0.28, tolerance=1e-6)
        table = cn.creep_force_table(xi=[0.25, 0.3], eta=[0.0], phi=[0.0], axis_ratio=2.0, elements=n)
        from_table = table.wheel_rail(creepage, spin, semi_axes=(a, b), normal_force=force, coefficient=mu, shear_modulus=shear)
        np.testing.assert_allclose(np.ravel(from_table)[:2], found.force[0], atol=1e-4 * mu * force)


class Surfaces(unittest.TestCase):
    def test_a_hertzian_surface_has_the_forces_of_its_ellipse(self):
        n, d = 41, 0.06
        x = (np.arange(n) - 0.5 * (n - 1)) * d
        h = 0.01 * x[None, :] ** 2 + 0.02 * x[:, None] ** 2
        bodies = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
        exact = cn.hertz(0.01, 0.02, force=1000.0, **bodies)
        a, b, mu = exact.semi_axis_x, exact.semi_axis_y, 0.3
        c, bound = np.sqrt(a * b), mu * 1000.0
        unit = 82000.0 * c * c / bound
        surface = {"h": h, "dx": d, "dy": d, "force": 1000.0, "coefficient": mu, **bodies}
        table = cn.creep_force_table(xi=np.array([-0.3, 0.0, 0.3]) / unit, eta=np.array([0.0, 0.15]) / unit,
                                     phi=np.array([0.0, 0.5]) / (unit * c), surface=surface)
        ellipse = cn.creep_force_table(xi=[0.0, 0.3], eta=[0.0, 0.15], phi=[0.0, 0.5], axis_ratio=a / b, elements=35)
        self.assertTrue(table.of_surface)
        for k, xi in ((0, -0.3), (2, 0.3)):
            scaled = ellipse.forces(xi, 0.0, 0.5, axis_ratio=a / b)
            off = np.hypot(table.force_x[0, 0, 1, 0, k] / bound - scaled[0], table.force_y[0, 0, 1, 0, k] / bound - scaled[1])
            self.assertLess(off, table.error[0, 0, 1, 0, k] + scaled[3])
            # If both creepages and the spin change their signs, so do the forces and the moment.
            there = table.forces(-xi / unit, -0.15 / unit, -0.5 / (unit * c))
            np.testing.assert_array_equal(there[0], -table.force_x[0, 0, 1, 1, k])
            np.testing.assert_array_equal(there[2], -table.moment[0, 0, 1, 1, k])
        for bad, words in (({"force": None}, "it must have"), ({"approach": 1.0}, "either force or approach"), ({"dq": 1.0}, "it must have")):
            given = {name: value for name, value in {**surface, **bad}.items() if value is not None}
            with self.assertRaisesRegex(ValueError, words):
                cn.creep_force_table(xi=[0.0], eta=[0.0], phi=[0.0], surface=given)

    def test_unlike_bodies_have_no_symmetry(self):
        x = (np.arange(16) - 7.5) * 0.15
        surface = {"h": 0.01 * (x[None, :] ** 2 + x[:, None] ** 2), "dx": 0.15, "dy": 0.15, "force": 1000.0, "coefficient": 0.3,
                   "shear_modulus": 82000.0}
        axes = {"xi": [-1e-3, 1e-3], "eta": [0.0], "phi": [0.0, 1e-4]}
        alike, unlike = (cn.creep_force_table(surface={**surface, "poisson_ratio": nu}, **axes) for nu in (0.28, (0.1, 0.45)))
        self.assertEqual(alike.forces(1e-3, 0.0, -1e-4)[0], -alike.force_x[0, 0, 1, 0, 0])
        with self.assertRaisesRegex(ValueError, "phi has values outside"):
            unlike.forces(1e-3, 0.0, -1e-4)
        self.assertGreater(abs(unlike.force_x + unlike.force_x[..., ::-1])[0, 0, 0].max(), 0.01 * 300)

    def test_a_surface_on_elements_twice_as_large(self):
        h = np.array([[1.0, 3.0, np.inf], [5.0, np.inf, np.inf], [2.0, 4.0, 7.0]])
        np.testing.assert_array_equal(halved(h), [[3.0, np.inf], [3.0, 7.0]])


class Runs(unittest.TestCase):
    AXES = {"xi": [0.0, 0.3], "eta": [0.0], "phi": [0.0, 0.2, 0.4], "elements": 9}

    def test_processes_give_the_same_bits(self):
        one, two = (cn.creep_force_table(workers=workers, **self.AXES) for workers in (1, 2))
        for name in ("force_x", "force_y", "moment", "error", "products", "status"):
            np.testing.assert_array_equal(getattr(one, name), getattr(two, name))

    def test_progress_is_told_and_may_end_the_call(self):
        told = []
        cn.creep_force_table(progress=lambda done, total: told.append((done, total)), **self.AXES)
        self.assertEqual(told, [(2, 6), (4, 6), (6, 6)])

        def fail(done, total):
            raise KeyError("mine")

        for workers in (1, 2):
            with self.assertRaisesRegex(KeyError, "mine"):
                cn.creep_force_table(progress=fail, workers=workers, **self.AXES)

    def test_axes_are_checked(self):
        for bad, words in (({"xi": [0.3, 0.1]}, "xi is"), ({"xi": [-0.1, 0.1]}, "symmetry"), ({"phi": [-1.0]}, "symmetry"),
                           ({"eta": [np.nan]}, "eta is"), ({"axis_ratio": 0.0}, "must be positive"), ({"elements": 3}, "elements is 3")):
            with self.assertRaisesRegex(ValueError, words):
                cn.creep_force_table(**{**self.AXES, **bad})


class OneSided(unittest.TestCase):
    def test_axes_that_begin_with_0(self):
        axis = [0.0, 0.5, 1.0]
        table = cn.creep_force_table(xi=axis, eta=axis, phi=[0.0], elements=11)
        x, y, _, error = table.forces(0.5, 0.5, 0.0)
        self.assertLess(max(x, y), -0.5)
        for xi, eta in ((-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)):
            for spin in (0.0, -0.3, 0.3):
                found = table.forces(xi, eta, spin, hold=True)
                np.testing.assert_array_equal(found[:2], (np.sign(xi) * x, np.sign(eta) * y))
            np.testing.assert_array_equal(table.forces(xi, eta, 0.0), (np.sign(xi) * x, np.sign(eta) * y, found[2], error))
        with self.assertRaisesRegex(ValueError, "eta has values outside the table"):
            table.forces(0.5, -1.5, 0.0)

    def test_a_surface(self):
        x = (np.arange(16) - 7.5) * 0.1
        surface = {"h": 0.1 * (x[None, :] ** 2 + x[:, None] ** 2), "dx": 0.1, "dy": 0.1, "force": 0.05, "coefficient": 0.3, "shear_modulus": 1.0,
                   "poisson_ratio": 0.3}
        axis = [0.0, 1e-2, 2e-2]
        table = cn.creep_force_table(xi=axis, eta=axis, phi=[0.0], surface=surface)
        for sign in (1.0, -1.0):
            found = table.forces(sign * 1e-2, sign * 2e-2, 0.0)
            np.testing.assert_array_equal(found[:2], (sign * table.force_x[0, 0, 0, 2, 1], sign * table.force_y[0, 0, 0, 2, 1]))

    def test_loads_and_coefficients_in_lists(self):
        given = {"semi_axes": (1.0, 1.0), "shear_modulus": 1.0, "poisson_ratio": 0.28, "hold": True}
        found = TABLE.wheel_rail((1e-3, 0.0), 0.0, normal_force=2, coefficient=[0.3, 0.2], **given)
        expected = TABLE.wheel_rail((1e-3, 0.0), 0.0, normal_force=2.0, coefficient=np.array([0.3, 0.2]), **given)
        np.testing.assert_array_equal(found, expected)

    def test_a_surface_without_friction(self):
        surface = {"h": 0.1 * np.ones((8, 8)), "dx": 0.1, "dy": 0.1, "approach": 0.11, "coefficient": 0.0, "shear_modulus": 1.0, "poisson_ratio": 0.3}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = cn.creep_force_table(xi=[0.0, 1e-3], eta=[0.0], phi=[0.0], surface=surface)
            self.assertIn("2 entries", repr(table))
        self.assertFalse(table.force_x.any())
        np.testing.assert_array_equal(table.error, 0.0)


if __name__ == "__main__":
    unittest.main()
