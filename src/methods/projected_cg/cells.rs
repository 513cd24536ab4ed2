//! Cells of S x S elements, which have a box of the extension in common: the larger the pieces of C, the larger they are.

use std::ops::{Add, Range};

use super::boxes::CHUNK;

/// Elements of the largest cell in each direction.
pub(super) const LARGEST_SIDE: usize = 16;
/// Pieces of C have at least this mean length, in cells. Measured (tolerance 1e-6, iterations on the finest grid with boxes of 9, 17, 33 elements):
/// rough surface 2048, 32 elements in a piece, 11, 9, 9. Boxes that are large beside the pieces of C harm: rough surface 1024 with 7.7 in a
/// piece 24, 49, 87.
const LEAST_LENGTH: f64 = 6.0;

/// Elements of a cell in each direction that suits C: a power of two. The mean length of pieces of C in a row or a column counts, whichever
/// is shorter. Cells have one element where there are no more pieces than rows or columns of the grid: then there is little rim, and larger
/// cells save nothing (ellipse 512: 3 iterations with any).
pub(super) fn suitable_side(contact: &[bool], mx: usize) -> usize {
    let Pieces { elements, in_rows, in_columns } = pulp::Arch::new().dispatch(CountPieces { contact, mx });
    let (my, pieces) = (contact.len() / mx, in_rows.max(in_columns));
    let mut side = 1;
    if in_rows > my && in_columns > mx {
        while side < LARGEST_SIDE && (2 * side) as f64 * LEAST_LENGTH * pieces as f64 <= elements as f64 {
            side *= 2;
        }
    }
    side
}

/// Elements of C, and in how many pieces they are.
struct Pieces {
    elements: usize,
    in_rows: usize,
    in_columns: usize,
}

/// Counts them: a piece is counted where it ends.
struct CountPieces<'a> {
    contact: &'a [bool],
    mx: usize,
}

impl pulp::NullaryFnOnce for CountPieces<'_> {
    type Output = Pieces;

    #[inline(always)]
    fn call(self) -> Pieces {
        let mut pieces = Pieces { elements: 0, in_rows: 0, in_columns: 0 };
        let mut before: &[bool] = &[];
        for row in self.contact.chunks_exact(self.mx) {
            pieces.elements += row.iter().map(|inside| u32::from(*inside)).sum::<u32>() as usize;
            pieces.in_rows += ends(row, &row[1..]) + usize::from(row[self.mx - 1]);
            pieces.in_columns += ends(before, row);
            before = row;
        }
        pieces.in_columns += before.iter().filter(|&&inside| inside).count();
        pieces
    }
}

/// How often an element of C in `a` has none beside it in `b`.
#[inline(always)]
fn ends(a: &[bool], b: &[bool]) -> usize {
    a.iter().zip(b).map(|(a, b)| u32::from(*a & !*b)).sum::<u32>() as usize
}

/// Sums over the elements of each cell of a row of cells, of `value(element, whether it is in C)`.
pub(super) struct CellSums<'a, A, B, F, const S: usize> {
    pub(super) elements: &'a [A],
    pub(super) contact: &'a [bool],
    pub(super) mx: usize,
    pub(super) value: F,
    pub(super) sums: &'a mut [B],
}

impl<A, B, F, const S: usize> pulp::NullaryFnOnce for CellSums<'_, A, B, F, S>
where
    A: Copy,
    B: Copy + Default + Add<Output = B>,
    F: Fn(A, bool) -> B,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let CellSums { elements, contact, mx, value, sums } = self;
        for (k, sums) in sums.chunks_mut(CHUNK).enumerate() {
            let all = sums_of_cells::<_, _, S>((elements, contact, mx), k, &value);
            sums.copy_from_slice(&all[..sums.len()]);
        }
    }
}

/// The same of one chunk; sums beyond the row have no meaning.
#[inline(always)]
pub(super) fn sums_of_cells<A: Copy, B: Copy + Default + Add<Output = B>, const S: usize>(
    (elements, contact, mx): (&[A], &[bool], usize),
    k: usize,
    value: impl Fn(A, bool) -> B,
) -> [B; CHUNK] {
    let mut columns = [[B::default(); S]; CHUNK];
    let here = k * CHUNK * S..mx.min((k + 1) * CHUNK * S);
    for (row, contact) in elements.chunks_exact(mx).zip(contact.chunks_exact(mx)) {
        let columns = columns.as_flattened_mut().iter_mut();
        for ((sum, element), inside) in columns.zip(&row[here.clone()]).zip(&contact[here.clone()]) {
            *sum = *sum + value(*element, *inside);
        }
    }
    let mut sums = [B::default(); CHUNK];
    for (sum, columns) in sums.iter_mut().zip(&columns) {
        *sum = columns.iter().fold(B::default(), |sum, column| sum + *column);
    }
    sums
}

/// Calls `work(elements, values)` for each row of elements of a chunk of cells, with the value of each element's cell; the elements are of `length`
/// that begin with the cells' row 0, `mx` in a row.
#[inline(always)]
pub(super) fn for_its_elements<B: Copy + Default, const S: usize>(
    cells: &[B; CHUNK],
    (row, k): (usize, usize),
    (length, mx): (usize, usize),
    mut work: impl FnMut(Range<usize>, &[B]),
) {
    if S == 1 {
        let elements = row * mx + k * CHUNK..row * mx + mx.min((k + 1) * CHUNK);
        return work(elements, cells);
    }
    let mut each = [[B::default(); S]; CHUNK];
    each.iter_mut().zip(cells).for_each(|(each, cell)| *each = [*cell; S]);
    for y in row * S..(length / mx).min((row + 1) * S) {
        work(y * mx + k * CHUNK * S..y * mx + mx.min((k + 1) * CHUNK * S), each.as_flattened());
    }
}
