//! Packs of numbers in 256-bit vectors, for x86-64 processors with AVX2.

use super::machine::{LANES, Machine, Pack};
use pulp::x86::V3;
use pulp::{Simd, f32x8, f64x4};
use std::ops::{Add, Mul, Sub};

/// Eight numbers in single precision, with a token as proof that the processor has AVX2.
#[derive(Debug, Clone, Copy)]
pub(super) struct Singles(V3, f32x8);

/// Eight numbers in double precision in two vectors, with the same kind of token.
#[derive(Debug, Clone, Copy)]
pub(super) struct Doubles(V3, [f64x4; 2]);

macro_rules! operator {
    ($trait:ident, $name:ident, $single:ident, $double:ident) => {
        impl $trait for Singles {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0, self.0.$single(self.1, other.1))
            }
        }
        impl $trait for Doubles {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0, [self.0.$double(self.1[0], other.1[0]), self.0.$double(self.1[1], other.1[1])])
            }
        }
    };
}
operator!(Add, add, add_f32s, add_f64s);
operator!(Sub, sub, sub_f32s, sub_f64s);
operator!(Mul, mul, mul_f32s, mul_f64s);

impl Pack<f32> for Singles {
    #[inline(always)]
    fn store(self, to: &mut [f32], at: usize) {
        V3::as_mut_simd_f32s(&mut to[at..at + LANES]).0[0] = self.1;
    }

    #[inline(always)]
    fn lanes(self) -> [f32; LANES] {
        let mut lanes = [0.0; LANES];
        self.store(&mut lanes, 0);
        lanes
    }
}

impl Pack<f64> for Doubles {
    #[inline(always)]
    fn store(self, to: &mut [f64], at: usize) {
        let to = V3::as_mut_simd_f64s(&mut to[at..at + LANES]).0;
        to[0] = self.1[0];
        to[1] = self.1[1];
    }

    #[inline(always)]
    fn lanes(self) -> [f64; LANES] {
        let mut lanes = [0.0; LANES];
        self.store(&mut lanes, 0);
        lanes
    }
}

impl Machine for V3 {
    type Single = Singles;
    type Double = Doubles;

    #[inline(always)]
    fn run<R>(self, kernel: impl FnOnce() -> R) -> R {
        self.vectorize(kernel)
    }

    #[inline(always)]
    fn pack(self, from: &[f32; LANES]) -> Singles {
        Singles(self, V3::as_simd_f32s(from).0[0])
    }

    #[inline(always)]
    fn pack_double(self, from: &[f64; LANES]) -> Doubles {
        let from = V3::as_simd_f64s(from).0;
        Doubles(self, [from[0], from[1]])
    }

    #[inline(always)]
    fn all(self, x: f32) -> Singles {
        Singles(self, self.splat_f32s(x))
    }

    #[inline(always)]
    fn all_double(self, x: f64) -> Doubles {
        Doubles(self, [self.splat_f64s(x); 2])
    }

    #[inline(always)]
    fn inverse(self, x: Singles) -> Singles {
        let zero = self.splat_f32s(0.0);
        let inverse = self.div_f32s(self.splat_f32s(1.0), x.1);
        Singles(self, self.select_f32s(self.greater_than_f32s(x.1, zero), inverse, zero))
    }

    #[inline(always)]
    fn significant(self, x: Singles, negligible: f32) -> Singles {
        let small = self.less_than_f32s(self.abs_f32s(x.1), self.splat_f32s(negligible));
        Singles(self, self.select_f32s(small, self.splat_f32s(0.0), x.1))
    }

    #[inline(always)]
    fn double(self, x: Singles) -> Doubles {
        let halves: [pulp::f32x4; 2] = pulp::bytemuck::cast(x.1);
        Doubles(self, halves.map(|half| self.convert_f32x4_to_f64x4(half)))
    }

    #[inline(always)]
    fn single(self, x: Doubles) -> Singles {
        Singles(self, pulp::bytemuck::cast(x.1.map(|half| self.convert_f64x4_to_f32x4(half))))
    }

    #[inline(always)]
    fn abs(self, x: Singles) -> Singles {
        Singles(self, self.abs_f32s(x.1))
    }

    #[inline(always)]
    fn abs_double(self, x: Doubles) -> Doubles {
        Doubles(self, x.1.map(|half| self.abs_f64s(half)))
    }

    #[inline(always)]
    fn greater(self, a: Singles, b: Singles) -> Singles {
        Singles(self, self.max_f32s(a.1, b.1))
    }

    #[inline(always)]
    fn greater_double(self, a: Doubles, b: Doubles) -> Doubles {
        Doubles(self, [self.max_f64s(a.1[0], b.1[0]), self.max_f64s(a.1[1], b.1[1])])
    }
}
