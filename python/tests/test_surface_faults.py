"""Spikes are found. Elements of a sound surface and neighbours of a spike do not count as spikes."""

import unittest
import warnings

import numpy as np

from contact_normal import surface


def rough(shape, period="xy", seed=1):
    """A self-affine surface with the grid as its period, and an rms of 1."""
    rng = np.random.default_rng(seed)
    k = np.hypot(*np.meshgrid(*(np.fft.fftfreq(n) * max(shape) for n in shape), indexing="ij"))
    amplitudes = np.where((k >= 2) & (k <= max(shape) / 8), np.maximum(k, 1.0) ** -1.8, 0.0)
    z = np.fft.ifft2(np.fft.fft2(rng.normal(size=shape)) * amplitudes).real
    return z / z.std()


def turned(n, dx, feed=0.1, nose=0.8):
    """The profile of a turned face: arcs of the tool's nose."""
    u = ((np.arange(n) + 0.3) * dx + 0.5 * feed) % feed - 0.5 * feed
    return nose - np.sqrt(nose * nose - u * u)


def spikes(z, period=None):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of slopes
        made = surface.heights(z, 1.0, 1.0, period=period)
    return np.argwhere(surface.faults(made).spikes).tolist()


class Lays(unittest.TestCase):
    def test_crests_along_a_lay_are_no_spikes(self):
        n, dust = 256, [[0, 7], [20, 20], [20, 21], [21, 20], [21, 21], [50, 50], [50, 51], [100, 100]]
        for noise in (0.0, 1e-6, 2e-6, 5e-6):
            z = np.tile(turned(n, 1.11e-3), (n, 1)) + noise * np.random.default_rng(1).standard_normal((n, n))
            for measured in (z, z.T):
                self.assertEqual(spikes(measured), [], noise)
            for place in dust:
                z[tuple(place)] += 1e-3
            self.assertEqual(spikes(z), dust, noise)

    def test_extruded_profiles_have_none(self):
        for seed in range(4):
            profile = np.cumsum(np.random.default_rng(seed).standard_normal(128))
            for period in (None, "x", "y", "xy"):
                self.assertEqual(spikes(np.tile(profile, (64, 1)), period), [], (seed, period))

    def test_dust_is_found_ring_by_ring(self):
        z = rough((128, 128))
        z[5, 5] += 50.0
        z[9:12, 9:12] += 50.0
        measured, counts = surface.heights(z, 1e3, 1e3), []
        for _ in range(4):
            found = surface.faults(measured)
            counts.append(int(found.spikes.sum()))
            measured = found.removed
        self.assertEqual(counts, [5, 4, 1, 0], "the spike and four corners, four edges, the middle")
        # A measured element among holes is no spike.
        z = rough((64, 64))
        for iy, ix in ((20, 30), (0, 0), (63, 12)):
            around = np.maximum(*np.abs(np.mgrid[-iy : 64 - iy, -ix : 64 - ix])) == 1
            z[around] = np.nan
        self.assertEqual(spikes(z), [])


    def test_pairs_at_borders_and_beside_holes_are_found(self):
        z = rough((96, 96), seed=4)
        z[40:50, 40:50] = np.nan
        for places in ([[0, 5], [0, 6]], [[0, 0], [0, 1]], [[0, 0], [1, 0]], [[30, 95], [31, 95]], [[39, 44], [39, 45], [49, 50], [50, 50]], [[0, 0], [0, 95]]):
            measured = z.copy()
            measured[tuple(np.transpose(places))] += 50.0
            for period in (None, "x", "y", "xy"):
                self.assertEqual(spikes(measured, period), places, period)


class Lines(unittest.TestCase):
    def test_a_spike_takes_no_neighbours_with_it(self):
        for seed in range(4):
            walk = np.cumsum(np.random.default_rng(seed).standard_normal(200))
            for places in ([100], [100, 101], [1], [0], [198], [0, 199]):
                z = walk.copy()
                z[places] += 200.0
                for period in (None, "y") if {0, 1, 198} & set(places) else (None, "x", "y", "xy"):
                    self.assertEqual(spikes(z[None], period), [[0, k] for k in places], (seed, places, period))
                turned_over = {None: None, "x": "y", "y": "x", "xy": "xy"}
                self.assertEqual(spikes(z[:, None], turned_over["y"]), [[k, 0] for k in places], (seed, places))

    def test_a_period_across_changes_nothing(self):
        for seed in range(16):
            walk = np.cumsum(np.random.default_rng(seed).standard_normal(400))
            smooth = rough((1, 128), seed=seed)
            for line in (walk[None], smooth):
                for period in (None, "y"):
                    self.assertEqual(spikes(line, period), [], (seed, period))
            self.assertEqual(spikes(smooth, "xy"), [], seed)

    def test_the_ends_of_a_slope_are_no_spikes(self):
        z = 3.0 * np.arange(60.0) + np.sin(0.1 * np.arange(60.0))
        z[20:23] = np.nan
        self.assertEqual(spikes(z[None]), [])
        z[40] += 30.0
        self.assertEqual(spikes(z[None]), [[0, 40]])

    def test_steps_cusps_and_wide_dust_take_nothing_else(self):
        noise = 1e-3 * np.random.default_rng(5).standard_normal(400)
        step, cusps = np.where(np.arange(400) > 200, 3.0, 0.0), 30.0 * turned(400, 2.6e-3, nose=0.1)
        for line in (step + noise, cusps + noise):
            self.assertEqual(spikes(line[None]), [])
        for wide, rest in ((2, []), (3, [[0, 101]])):
            z = step + noise
            z[100 : 100 + wide] += 5.0
            measured, found = surface.heights(z[None], 1.0, 1.0), []
            for _ in range(3):
                found.append(np.argwhere(surface.faults(measured).spikes).tolist())
                measured = surface.faults(measured).removed
            self.assertEqual(found, [[[0, 100], [0, 99 + wide]], rest, []])


class Plateaus(unittest.TestCase):
    def test_what_is_not_clipped_is_no_spike(self):
        for dtype in (np.float64, np.float32):
            z = rough((64, 64)).astype(dtype)
            clipped = np.maximum(z, np.quantile(z, 0.6))
            self.assertEqual(spikes(clipped), [], dtype)
            clipped[50, 10] += 30.0
            self.assertEqual(spikes(clipped), [[50, 10]], dtype)

    def test_spikes_on_a_coarsely_quantised_flat(self):
        z = np.round(0.3 * np.random.default_rng(1).standard_normal((96, 96)))
        self.assertEqual(spikes(z), [])
        z[40, 40], z[60, 60:62], z[20, 20] = 50.0, 60.0, -70.0
        self.assertEqual(spikes(z), [[20, 20], [40, 40], [60, 60], [60, 61]])

    def test_spikes_on_an_exact_plane(self):
        z = np.zeros((32, 32))
        self.assertEqual(spikes(z), [])
        z[3, 4], z[0, 31] = 1e-3, -2.0
        self.assertEqual(spikes(z), [[0, 31], [3, 4]])
        # Two levels are a pattern: islands of one or several elements.
        z = np.zeros((32, 32))
        z[::4, ::4] = 1.0
        self.assertEqual(spikes(z), [])
        z[8:12, 8:12] = 1.0
        self.assertEqual(spikes(z), [])

    def test_a_bump_on_a_flat_has_none(self):
        x = np.arange(64.0)
        bump = np.maximum(0.0, 30.0 - (x[None] - 31.3) ** 2 - (x[:, None] - 29.9) ** 2)
        self.assertEqual(spikes(bump), [])


if __name__ == "__main__":
    unittest.main()
