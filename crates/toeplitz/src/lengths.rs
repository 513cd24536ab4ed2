//! Chooses the lengths of fast transforms.

/// The largest radix of a stage.
pub(crate) const LONGEST: usize = 5;

/// The time per value of a transform of length `2^twos 3^threes 5^fives` by rustfft, relative to that of a length with at least four twos and no
/// fives. It was measured in single precision, where lengths differ more. rustfft vectorises lengths with few twos badly. The same holds for fives,
/// except for one five with many twos and no threes.
fn relative_work(twos: u32, threes: u32, fives: u32) -> f64 {
    let factor_of_twos = [3.0, 1.5, 1.25, 1.1].get(twos as usize).copied().unwrap_or(1.0);
    let factor_of_fives = match (threes > 0, fives) {
        (_, 0) => 1.0,
        (false, 1) if twos >= 5 => 1.0,
        (_, 1) => 1.12,
        (_, 2) => 1.3,
        _ => 1.6,
    };
    factor_of_twos * factor_of_fives
}

/// The even length `2^a 3^b 5^c >= n` with the fastest transform by rustfft. Lengths with a large prime factor would take six times as long.
pub fn good_length(n: usize) -> usize {
    length_of_least_work(n, relative_work)
}

/// The even length `2^a 3^b 5^c >= n` with the fastest products by stages of this crate. In measurements, a stage of 3 takes as long as two stages of
/// 2, a stage of 5 as long as three stages of 2, and the transfer between memory and vectors as long as ten stages of 2.
pub fn length_for_stages(n: usize) -> usize {
    length_of_least_work(n, |twos, threes, fives| f64::from(10 + twos + 2 * threes + 3 * fives))
}

/// The even length `2^a 3^b 5^c >= n` for which `length * relative_work(a, b, c)` is smallest.
fn length_of_least_work(n: usize, relative_work: impl Fn(u32, u32, u32) -> f64) -> usize {
    let longest = n.max(2).next_power_of_two();
    let (mut best, mut least) = (longest, f64::INFINITY);
    let (mut fives, mut power_of_five) = (0, 1);
    while power_of_five < longest {
        let (mut threes, mut odd) = (0, power_of_five);
        while odd < longest {
            let even = n.div_ceil(odd).max(2).next_power_of_two();
            let work = (odd * even) as f64 * relative_work(even.trailing_zeros(), threes, fives);
            if work < least {
                (best, least) = (odd * even, work);
            }
            (threes, odd) = (threes + 1, 3 * odd);
        }
        (fives, power_of_five) = (fives + 1, 5 * power_of_five);
    }
    best
}

/// Whether both periods have stages of this crate. A product of even coefficients uses them on a machine with SIMD vectors. Rows are transformed as
/// px/2 complex numbers.
pub fn have_stages((px, py): (usize, usize)) -> bool {
    px % 2 == 0 && has_stages(px / 2) && has_stages(py)
}

/// Whether a length has stages of this crate. Lengths up to the largest radix have none, because a transform needs at least two stages.
fn has_stages(length: usize) -> bool {
    let mut rest = length;
    for prime in [2, 3, 5] {
        divide(&mut rest, prime);
    }
    length > LONGEST && rest == 1
}

/// Divides `rest` by a factor as often as possible. Returns the number of divisions.
fn divide(rest: &mut usize, factor: usize) -> usize {
    let mut count = 0;
    while *rest > 0 && *rest % factor == 0 {
        (*rest, count) = (*rest / factor, count + 1);
    }
    count
}

/// The radices of the stages of a length: one 4 first, the other fours last, and 5, 3 and 2 between. None if the length has other prime factors, or
/// needs fewer than two stages.
pub(crate) fn radices(length: usize) -> Option<Vec<usize>> {
    let mut rest = length;
    let fours = divide(&mut rest, 4);
    let others = [5, 3, 2].map(|radix| vec![radix; divide(&mut rest, radix)]).concat();
    let first = fours.min(1);
    let radices = [vec![4; first], others, vec![4; fours - first]].concat();
    (rest == 1 && radices.len() > 1).then_some(radices)
}

#[cfg(test)]
#[path = "../tests/unit/lengths.rs"]
mod tests;
