//! Lengths of fast transforms.

/// The largest radix of a stage.
pub(crate) const LONGEST: usize = 5;

/// Work of a transform of length `2^a 3^b 5^c` by rustfft relative to one of `2^a 3^b` with many twos: measured in single precision, where it
/// differs more. Lengths with few twos are vectorised badly, and so are fives, except a single five beside many twos and no threes.
fn relative_work(twos: u32, threes: u32, fives: u32) -> f64 {
    let of_twos = [3.0, 1.5, 1.25, 1.1].get(twos as usize).copied().unwrap_or(1.0);
    let of_fives = match (threes > 0, fives) {
        (_, 0) => 1.0,
        (false, 1) if twos >= 5 => 1.0,
        (_, 1) => 1.12,
        (_, 2) => 1.3,
        _ => 1.6,
    };
    of_twos * of_fives
}

/// The even `2^a 3^b 5^c >= n` with the fastest transform by rustfft: lengths with a large prime factor cost six times as much.
pub fn good_length(n: usize) -> usize {
    length_of_least_work(n, relative_work)
}

/// The length for stages of this crate: the even `2^a 3^b 5^c >= n` with the fastest products. Measured: a stage of 3 takes as long as two of
/// 2, one of 5 as three of 2, and the transfer between memory and vectors as ten.
pub fn length_for_stages(n: usize) -> usize {
    length_of_least_work(n, |twos, threes, fives| f64::from(10 + twos + 2 * threes + 3 * fives))
}

/// The even `2^a 3^b 5^c >= n` of which `length * relative_work(a, b, c)` is least.
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

/// Whether products of these periods use stages of this crate in both directions, on a machine with vectors.
pub fn have_stages((px, py): (usize, usize)) -> bool {
    px % 2 == 0 && has_stages(px / 2) && has_stages(py)
}

/// Whether there are stages for a length. There are none up to the largest radix, where one stage suffices.
fn has_stages(length: usize) -> bool {
    let mut rest = length;
    for prime in [2, 3, 5] {
        divide(&mut rest, prime);
    }
    length > LONGEST && rest == 1
}

/// Divides by a factor as often as it can. Returns how often.
fn divide(rest: &mut usize, factor: usize) -> usize {
    let mut count = 0;
    while *rest > 0 && *rest % factor == 0 {
        (*rest, count) = (*rest / factor, count + 1);
    }
    count
}

/// Factors of a length: a four first, the other fours last, the other factors between.
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
