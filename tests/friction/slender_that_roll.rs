//! Coefficients of slender elements for bodies that relax and roll, to all digits.
//!
//! The numbers below are sums over panels by mpmath 1.3 with 30 digits, each between two of the offsets `+-1/2 +- 2^k` and `kx + 2 k L`:
//!
//! ```text
//! def corners(f, x, y, dy): h, v = mpf(1)/2, mpf(dy)/2; return f(x+h, y+v) - f(x+h, y-v) - f(x-h, y+v) + f(x-h, y-v)
//! def A(a, b): return a*asinh(b/abs(a)) if a else mpf(0)
//! def at(x, y, dy, nu):                                           # of a body with G = 1 (Love 1929; Kalker 1990, appendix B)
//!     a, b = corners(A, x, y, dy), corners(lambda p, q: A(q, p), x, y, dy)
//!     c = -corners(lambda p, q: sqrt(p*p + q*q), x, y, dy)
//!     return [(1-nu)*(a+b)/pi, ((1-nu)*a+b)/pi, (a+(1-nu)*b)/pi, nu*c/pi]
//! value = at(kx, ky*dy) + 19/L*sum(quad(lambda x: exp(-(x-kx)/L)*at(x, ky*dy), [p, q]) for p, q in panels)     # up to kx + 80 L, L = 2
//! ```
//!
//! Two bodies with G = 1 and nu = .3. A part of .95 of the modulus relaxes in a time of .1 at a speed of 1: the final compliance is 20 times the
//! instantaneous one, with creep over 2 elements.

use contact_normal::friction::rolling_tables;
use contact_normal::visco::{rolling_table, RollingBody, Series};

/// The width of elements whose length is 1, the offset in elements, and the coefficients: of pressures, and xx, yy and xy of tractions.
const KNOWN: [(f64, (i32, i32), [f64; 4]); 20] = [
    (0.001, (0, 0), [0.022_071_804_347_162_86, 0.030_537_490_574_038_935, 0.023_065_462_840_499_446, 0.0]),
    (
        0.001,
        (0, 1),
        [0.018_251_047_781_534_264, 0.025_079_269_719_555_05, 0.019_244_703_464_171_023, 9.24390933347931e-06],
    ),
    (
        0.001,
        (-1, 1),
        [0.020_831_975_968_673_973, 0.028_647_997_251_922_346, 0.021_943_944_386_285_878, -3.4932840028776467e-06],
    ),
    (
        0.001,
        (2, -1),
        [0.001_389_621_820_454_595_5, 0.001_985_173_934_935_817_4, 0.001_389_621_914_739_629, -2.1549112987330963e-07],
    ),
    (0.01, (0, 0), [0.167_332_003_937_921_97, 0.229_109_335_095_671_6, 0.177_268_388_753_567_43, 0.0]),
    (
        0.01,
        (0, 1),
        [0.129_126_939_589_128_83, 0.174_532_668_889_587_63, 0.139_061_327_255_439_5, 0.000_599_045_652_041_264_5],
    ),
    (
        0.01,
        (-1, 1),
        [0.148_576_810_171_470_3, 0.201_132_748_643_605_53, 0.159_696_647_487_108_07, -0.000_221_313_682_066_305_1],
    ),
    (
        0.01,
        (2, -1),
        [0.013_896_109_307_643_645, 0.019_851_490_444_174_03, 0.013_896_203_588_674_825, -2.1548404681508035e-05],
    ),
    (0.1, (0, 0), [1.139_629_251_463_890_4, 1.528_810_832_889_440_5, 1.238_860_206_380_007_4, 0.0]),
    (0.1, (0, 1), [0.759_132_486_632_042_9, 0.986_414_454_502_713, 0.857_193_013_032_248_4, 0.027_557_398_045_049_128]),
    (
        0.1,
        (-1, 1),
        [0.888_472_515_056_776_8, 1.158_231_968_021_891_8, 0.999_486_997_115_994_8, -0.009_391_825_276_148_576],
    ),
    (
        0.1,
        (2, -1),
        [0.138_852_428_839_522_06, 0.198_266_729_816_258_73, 0.138_946_311_651_152, -0.002_147_788_022_855_163],
    ),
    (10.0, (0, 0), [20.547_561_115_190_337, 24.039_255_096_702_41, 25.861_964_754_474_123, 0.0]),
    (10.0, (0, 1), [4.688_209_050_682_374, 4.823_454_628_628_67, 6.562_195_923_028_524, 0.341_614_844_847_014_3]),
    (10.0, (-1, 1), [4.761_197_762_968_035, 4.850_547_813_564_021, 6.712_361_039_358_35, 0.144_490_675_908_319_88]),
    (10.0, (2, -1), [4.392_773_089_545_526, 4.709_703_956_176_918, 5.958_459_261_290_786, -0.622_001_687_457_800_7]),
    (1_000.0, (0, 0), [61.105_675_190_279_09, 64.925_335_136_586_16, 83.474_161_754_091_61, 0.0]),
    (1_000.0, (0, 1), [4.895_757_703_216_933, 4.895_783_786_310_34, 6.993_913_492_930_783, 0.004_837_971_403_564_43]),
    (1_000.0, (-1, 1), [4.895_768_793_592_37, 4.895_785_371_468_646, 6.993_938_841_541_394, 0.002_291_627_272_689_109]),
    (
        1_000.0,
        (2, -1),
        [4.895_711_757_573_276_5, 4.895_777_219_084_953, 6.993_808_477_878_719, -0.009_930_364_012_372_583],
    ),
];

#[test]
fn coefficients_of_slender_elements_are_right_to_all_digits() {
    let (reach, cx) = ((3, 3), 3);
    let bodies = |compliance: f64| {
        [(); 2].map(|()| RollingBody { compliance, series: Series::new(1.0, &[0.95], &[0.1]).expect("a series") })
    };
    let mut worst = 0.0f64;
    for (dy, (kx, ky), known) in KNOWN {
        let k = ((ky + cx) * 2 * cx + kx + cx) as usize;
        let normal = rolling_table(reach, (1.0, dy), &bodies(0.35), 1.0).unwrap();
        let [xx, yy, xy] = rolling_tables(reach, (1.0, dy), (&bodies(0.5), [0.3; 2]), 1.0).unwrap();
        for (found, known) in [normal[k], xx[k], yy[k], xy[k]].into_iter().zip(known) {
            worst = worst.max((found - known).abs() / known.abs().max(f64::MIN_POSITIVE));
            // Coefficients are differences of terms that are up to some ten times as large, each with some units of round-off.
            assert!((found - known).abs() <= 1e-13 * known.abs(), "{dy} ({kx}, {ky}): {found} {known}");
        }
    }
    println!("{worst:e}");
}
