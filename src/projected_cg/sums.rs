//! Sums in a fixed order: lanes that the compiler can keep in vector registers, added up at the end.

const LANES: usize = 8;

/// `sum over i < n of term(i)`, of K quantities at once.
#[inline(always)]
pub fn sums<const K: usize>(n: usize, mut term: impl FnMut(usize) -> [f64; K]) -> [f64; K] {
    let mut lanes = [[0.0; LANES]; K];
    let whole = n - n % LANES;
    for base in (0..whole).step_by(LANES) {
        for lane in 0..LANES {
            let terms = term(base + lane);
            for k in 0..K {
                lanes[k][lane] += terms[k];
            }
        }
    }
    let mut total = [0.0; K];
    for k in 0..K {
        total[k] = lanes[k].iter().sum();
    }
    for i in whole..n {
        let terms = term(i);
        for k in 0..K {
            total[k] += terms[k];
        }
    }
    total
}
