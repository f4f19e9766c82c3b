//! Vector instructions for neighbouring cells of a row.
//!
//! A [`Machine`] provides packs of [`LANES`] numbers. All machines perform the same operations on the same lanes in the
//! same order, and no machine fuses multiplication and addition, so results are identical bit by bit.

use std::ops::{Add, Mul, Sub};

/// Number of numbers in a pack. Rows are padded to a multiple of this, so that loops over whole rows have no remainder.
pub(super) const LANES: usize = 8;

/// A pack of numbers.
pub(super) trait Pack<T>: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    fn store(self, to: &mut [T], at: usize);
    fn lanes(self) -> [T; LANES];
}

/// Operations of a processor.
pub(super) trait Machine: Copy {
    type Single: Pack<f32>;
    type Double: Pack<f64>;

    /// Runs a kernel with the instructions of this machine. The kernel, and all functions called in its loops, must be marked as
    /// always inlined. Otherwise each instruction becomes a call.
    fn run<R>(self, kernel: impl FnOnce() -> R) -> R;
    fn pack(self, from: &[f32; LANES]) -> Self::Single;
    fn pack_double(self, from: &[f64; LANES]) -> Self::Double;

    #[inline(always)]
    fn load(self, from: &[f32], at: usize) -> Self::Single {
        let mut pack = [0.0; LANES];
        pack.copy_from_slice(&from[at..at + LANES]);
        self.pack(&pack)
    }

    /// Returns a pack with the same number in all lanes.
    fn all(self, x: f32) -> Self::Single;
    fn all_double(self, x: f64) -> Self::Double;
    /// Returns the reciprocal of each positive number, and 0 for others.
    fn inverse(self, x: Self::Single) -> Self::Single;
    /// Returns `x` with 0 in those lanes whose magnitude is below `negligible`.
    fn significant(self, x: Self::Single, negligible: f32) -> Self::Single;
    fn double(self, x: Self::Single) -> Self::Double;
    fn single(self, x: Self::Double) -> Self::Single;
    fn abs(self, x: Self::Single) -> Self::Single;
    fn abs_double(self, x: Self::Double) -> Self::Double;
    fn greater(self, a: Self::Single, b: Self::Single) -> Self::Single;
    fn greater_double(self, a: Self::Double, b: Self::Double) -> Self::Double;
}

/// Returns `count` packs from index `at` on. Loops over several such slices of equal length need no bounds checks.
#[inline(always)]
pub(super) fn packs<T>(from: &[T], at: usize, count: usize) -> &[[T; LANES]] {
    &from[at..].as_chunks().0[..count]
}

/// Does the same as [`packs`] for writing.
#[inline(always)]
pub(super) fn packs_mut<T>(from: &mut [T], at: usize, count: usize) -> &mut [[T; LANES]] {
    &mut from[at..].as_chunks_mut().0[..count]
}

/// The portable machine: loops of constant length, compiled for any processor.
#[derive(Debug, Clone, Copy)]
pub(super) struct Portable;

/// The packs of [`Portable`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Plain<T>([T; LANES]);

impl<T: Copy> Plain<T> {
    #[inline(always)]
    fn map<U>(self, f: impl Fn(T) -> U) -> Plain<U> {
        Plain(self.0.map(f))
    }

    #[inline(always)]
    fn with(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for k in 0..LANES {
            self.0[k] = f(self.0[k], other.0[k]);
        }
        self
    }
}

impl<T: Copy + Add<Output = T>> Add for Plain<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl<T: Copy + Sub<Output = T>> Sub for Plain<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl<T: Copy + Mul<Output = T>> Mul for Plain<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Pack<T> for Plain<T> {
    #[inline(always)]
    fn store(self, to: &mut [T], at: usize) {
        to[at..at + LANES].copy_from_slice(&self.0);
    }

    #[inline(always)]
    fn lanes(self) -> [T; LANES] {
        self.0
    }
}

impl Machine for Portable {
    type Single = Plain<f32>;
    type Double = Plain<f64>;

    #[inline(always)]
    fn run<R>(self, kernel: impl FnOnce() -> R) -> R {
        kernel()
    }

    #[inline(always)]
    fn pack(self, from: &[f32; LANES]) -> Plain<f32> {
        Plain(*from)
    }

    #[inline(always)]
    fn pack_double(self, from: &[f64; LANES]) -> Plain<f64> {
        Plain(*from)
    }

    #[inline(always)]
    fn all(self, x: f32) -> Plain<f32> {
        Plain([x; LANES])
    }

    #[inline(always)]
    fn all_double(self, x: f64) -> Plain<f64> {
        Plain([x; LANES])
    }

    #[inline(always)]
    fn inverse(self, x: Plain<f32>) -> Plain<f32> {
        x.map(|x| if x > 0.0 { 1.0 / x } else { 0.0 })
    }

    #[inline(always)]
    fn significant(self, x: Plain<f32>, negligible: f32) -> Plain<f32> {
        x.map(|x| if x.abs() < negligible { 0.0 } else { x })
    }

    #[inline(always)]
    fn double(self, x: Plain<f32>) -> Plain<f64> {
        x.map(f64::from)
    }

    #[inline(always)]
    fn single(self, x: Plain<f64>) -> Plain<f32> {
        x.map(|x| x as f32)
    }

    #[inline(always)]
    fn abs(self, x: Plain<f32>) -> Plain<f32> {
        x.map(f32::abs)
    }

    #[inline(always)]
    fn abs_double(self, x: Plain<f64>) -> Plain<f64> {
        x.map(f64::abs)
    }

    #[inline(always)]
    fn greater(self, a: Plain<f32>, b: Plain<f32>) -> Plain<f32> {
        a.with(b, |a, b| if b > a { b } else { a })
    }

    #[inline(always)]
    fn greater_double(self, a: Plain<f64>, b: Plain<f64>) -> Plain<f64> {
        a.with(b, |a, b| if b > a { b } else { a })
    }
}
