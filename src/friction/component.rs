//! Products of one component alone, where a traction in one direction displaces in that direction only: by real transforms, half of the work.

use super::spectrum::Spectrum;
use super::toeplitz::{rows_with_traction, Toeplitz};
use super::workspace::Workspace;
use crate::operator::columns::for_each_block;
use crate::operator::fft::{Complex, Real};

impl<T: Real> Toeplitz<T> {
    /// The same of one component alone, where it displaces in its own direction only.
    pub(super) fn apply_one<S: Real>(
        &self,
        component: usize,
        q: &[[S; 2]],
        scales: (f64, f64),
        u: &mut [[S; 2]],
        workspace: &mut Workspace<T>,
    ) {
        let (nb, length, mx) = (self.real_rows.bins(), self.columns.length(), self.mx);
        let Workspace { bins, pieces } = workspace;
        let bins = &mut bins[..self.my * nb];
        let loaded = rows_with_traction(q, mx);
        let (first, scale) = (loaded.start, scales.0);
        self.threads.for_each_row(&mut bins[first * nb..loaded.end * nb], nb, pieces, |i, to, piece| {
            let q = &q[(first + i) * mx..(first + i + 1) * mx];
            piece.row.iter_mut().zip(q).for_each(|(to, q)| *to = T::of(scale * q[component].to_double()));
            piece.row[mx..].fill(T::zero());
            self.real_rows.forward(&piece.row, to, &mut piece.scratch);
        });
        for_each_block(bins, nb, &self.threads, pieces, |block, piece| {
            let columns = &mut piece.columns[..block.columns() * length];
            block.gather(loaded.clone(), length, columns);
            self.columns.forward(columns, &mut piece.scratch);
            let each = columns.chunks_exact_mut(length).enumerate();
            each.for_each(|(c, column)| self.multiply_one(component, block.first() + c, column));
            self.columns.inverse(columns, &mut piece.scratch);
            block.scatter(0..self.my, length, columns);
        });
        self.threads.for_each_row_pair_with((u, mx), (bins, nb), pieces, |_, u, row, piece| {
            self.real_rows.inverse(row, &mut piece.row, &mut piece.scratch);
            for (u, value) in u.iter_mut().zip(&piece.row) {
                *u = [S::zero(); 2];
                u[component] = S::of(scales.1 * value.to_double());
            }
        });
    }

    /// Multiplies the waves of x bin `kx` by Sxx, or by Syy.
    fn multiply_one(&self, component: usize, kx: usize, column: &mut [Complex<T>]) {
        let (py, sign) = (column.len(), if component == 0 { T::one() } else { -T::one() });
        match &self.spectrum {
            Spectrum::Even(spectrum) => {
                let waves = &spectrum[kx * (py / 2 + 1)..(kx + 1) * (py / 2 + 1)];
                let (low, high) = column.split_at_mut(py / 2 + 1);
                let factor = |[alpha, beta, _]: [T; 3]| alpha + sign * beta;
                low.iter_mut().zip(waves).for_each(|(value, wave)| *value = *value * factor(*wave));
                high.iter_mut().rev().zip(&waves[1..]).for_each(|(value, wave)| *value = *value * factor(*wave));
            }
            Spectrum::General(spectrum) => {
                for (value, [alpha, delta, _]) in column.iter_mut().zip(&spectrum[kx * py..(kx + 1) * py]) {
                    *value = *value * (*alpha + *delta * sign);
                }
            }
        }
    }
}
