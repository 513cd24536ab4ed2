//! SIMD vectors whose lanes hold values of several columns or rows, and complex numbers of such vectors.
//!
//! Multiplications and additions are not fused, so the bits of each lane are those of a scalar computation.

use std::marker::PhantomData;

use pulp::{bytemuck::Pod, Simd};

use rustfft::num_complex::Complex;

/// A real number that can be a lane of a vector.
pub trait Lanes: Copy {
    /// A vector of such numbers, for the instruction set `S`.
    type Vector<S: Simd>: Pod;

    /// A slice as vectors. Its length is a multiple of the number of lanes.
    fn vectors<S: Simd>(values: &[Self]) -> &[Self::Vector<S>];
    /// A mutable slice as vectors. Its length is a multiple of the number of lanes.
    fn vectors_mut<S: Simd>(values: &mut [Self]) -> &mut [Self::Vector<S>];
    /// A vector with the same value in all lanes.
    fn splat<S: Simd>(simd: S, value: Self) -> Self::Vector<S>;
    /// a + b.
    fn add<S: Simd>(simd: S, a: Self::Vector<S>, b: Self::Vector<S>) -> Self::Vector<S>;
    /// a - b.
    fn sub<S: Simd>(simd: S, a: Self::Vector<S>, b: Self::Vector<S>) -> Self::Vector<S>;
    /// a b, lane by lane.
    fn mul<S: Simd>(simd: S, a: Self::Vector<S>, b: Self::Vector<S>) -> Self::Vector<S>;
    /// Transposes four vectors. They hold four consecutive values of each row, row after row. Vector k of the result holds value k of each row. The
    /// machine determines which lane belongs to which row.
    fn from_rows<S: Simd>(simd: S, rows: [Self::Vector<S>; 4]) -> [Self::Vector<S>; 4];
    /// The reverse of [`Lanes::from_rows`].
    fn to_rows<S: Simd>(simd: S, vectors: [Self::Vector<S>; 4]) -> [Self::Vector<S>; 4];
}

macro_rules! lanes {
    ($t:ident: $v:ident $as:ident $as_mut:ident $splat:ident $add:ident $sub:ident $mul:ident $from_rows:ident $to_rows:ident) => {
        impl Lanes for $t {
            type Vector<S: Simd> = S::$v;

            #[inline(always)]
            fn vectors<S: Simd>(values: &[Self]) -> &[S::$v] {
                S::$as(values).0
            }
            #[inline(always)]
            fn vectors_mut<S: Simd>(values: &mut [Self]) -> &mut [S::$v] {
                S::$as_mut(values).0
            }
            #[inline(always)]
            fn splat<S: Simd>(simd: S, value: Self) -> S::$v {
                simd.$splat(value)
            }
            #[inline(always)]
            fn add<S: Simd>(simd: S, a: S::$v, b: S::$v) -> S::$v {
                simd.$add(a, b)
            }
            #[inline(always)]
            fn sub<S: Simd>(simd: S, a: S::$v, b: S::$v) -> S::$v {
                simd.$sub(a, b)
            }
            #[inline(always)]
            fn mul<S: Simd>(simd: S, a: S::$v, b: S::$v) -> S::$v {
                simd.$mul(a, b)
            }
            #[inline(always)]
            fn from_rows<S: Simd>(simd: S, rows: [S::$v; 4]) -> [S::$v; 4] {
                simd.$from_rows(rows)
            }
            #[inline(always)]
            fn to_rows<S: Simd>(simd: S, vectors: [S::$v; 4]) -> [S::$v; 4] {
                simd.$to_rows(vectors)
            }
        }
    };
}
lanes! { f32: f32s as_simd_f32s as_mut_simd_f32s splat_f32s add_f32s sub_f32s mul_f32s deinterleave_shfl_f32s interleave_shfl_f32s }
lanes! { f64: f64s as_simd_f64s as_mut_simd_f64s splat_f64s add_f64s sub_f64s mul_f64s deinterleave_shfl_f64s interleave_shfl_f64s }

/// The number of lanes of a vector of T.
#[inline(always)]
pub fn lane_count<T: Lanes, S: Simd>() -> usize {
    size_of::<T::Vector<S>>() / size_of::<T>()
}

/// A vector of complex numbers: the vector of real parts, and that of imaginary parts.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Parts<V> {
    pub re: V,
    pub im: V,
}

/// The arithmetic of complex vectors of T, with the instruction set `simd`.
#[derive(Clone, Copy)]
pub struct Arithmetic<T, S> {
    pub simd: S,
    of: PhantomData<T>,
}

impl<T: Lanes, S: Simd> Arithmetic<T, S> {
    #[inline(always)]
    pub fn new(simd: S) -> Arithmetic<T, S> {
        Arithmetic { simd, of: PhantomData }
    }

    #[inline(always)]
    pub fn add(self, a: C<T, S>, b: C<T, S>) -> C<T, S> {
        Parts { re: T::add(self.simd, a.re, b.re), im: T::add(self.simd, a.im, b.im) }
    }

    #[inline(always)]
    pub fn sub(self, a: C<T, S>, b: C<T, S>) -> C<T, S> {
        Parts { re: T::sub(self.simd, a.re, b.re), im: T::sub(self.simd, a.im, b.im) }
    }

    /// a - i b.
    #[inline(always)]
    pub fn sub_i(self, a: C<T, S>, b: C<T, S>) -> C<T, S> {
        Parts { re: T::add(self.simd, a.re, b.im), im: T::sub(self.simd, a.im, b.re) }
    }

    /// a + i b.
    #[inline(always)]
    pub fn add_i(self, a: C<T, S>, b: C<T, S>) -> C<T, S> {
        Parts { re: T::sub(self.simd, a.re, b.im), im: T::add(self.simd, a.im, b.re) }
    }

    /// a b, lane by lane.
    #[inline(always)]
    pub fn mul(self, a: C<T, S>, b: C<T, S>) -> C<T, S> {
        let product = |x, y| T::mul(self.simd, x, y);
        Parts {
            re: T::sub(self.simd, product(a.re, b.re), product(a.im, b.im)),
            im: T::add(self.simd, product(a.re, b.im), product(a.im, b.re)),
        }
    }

    /// a times real numbers, lane by lane.
    #[inline(always)]
    pub fn scale(self, a: C<T, S>, by: T::Vector<S>) -> C<T, S> {
        Parts { re: T::mul(self.simd, a.re, by), im: T::mul(self.simd, a.im, by) }
    }

    /// a times the complex number w, which is the same for all lanes.
    #[inline(always)]
    pub fn twiddle(self, a: C<T, S>, w: Complex<T>) -> C<T, S> {
        let (re, im) = (T::splat(self.simd, w.re), T::splat(self.simd, w.im));
        let product = |x, y| T::mul(self.simd, x, y);
        Parts {
            re: T::sub(self.simd, product(a.re, re), product(a.im, im)),
            im: T::add(self.simd, product(a.re, im), product(a.im, re)),
        }
    }

    /// a + b of vectors of real numbers.
    #[inline(always)]
    pub fn add_real(self, a: T::Vector<S>, b: T::Vector<S>) -> T::Vector<S> {
        T::add(self.simd, a, b)
    }

    /// a - b of vectors of real numbers.
    #[inline(always)]
    pub fn sub_real(self, a: T::Vector<S>, b: T::Vector<S>) -> T::Vector<S> {
        T::sub(self.simd, a, b)
    }

    /// A vector with the same real number in all lanes.
    #[inline(always)]
    pub fn splat(self, value: T) -> T::Vector<S> {
        T::splat(self.simd, value)
    }
}

/// A vector of complex numbers whose parts are of type `T`.
pub type C<T, S> = Parts<<T as Lanes>::Vector<S>>;
