//! The wide registers of x86-64: the same operations as `lanes`, one instruction each, none of them fused.

#![expect(
    unsafe_code,
    reason = "a measured kernel: each function maps to one instruction that `level` has found the processor to have"
)]

use crate::lanes::{Lanes, Path};
use std::arch::x86_64::*;

/// Implements the operations for one width of register before AVX-512.
macro_rules! lanes {
    ($row:ident, $register:ty, $n:expr, $splat:ident, $load:ident, $store:ident, $add:ident, $sub:ident, $mul:ident,
     $div:ident, $min:ident, $max:ident, $andnot:ident, $above:expr, $bits:ident, $blend:ident, $mask:ident, $lowest:ident, $highest:ident) => {
        /// A register of numbers.
        #[derive(Clone, Copy)]
        pub(crate) struct $row($register);

        impl Lanes for $row {
            const N: usize = $n;

            #[inline(always)]
            fn splat(value: f32) -> Self {
                unsafe { $row($splat(value)) }
            }

            #[inline(always)]
            fn load(from: &[f32]) -> Self {
                let from = &from[..$n];
                unsafe { $row($load(from.as_ptr())) }
            }

            #[inline(always)]
            fn store(self, to: &mut [f32]) {
                let to = &mut to[..$n];
                unsafe { $store(to.as_mut_ptr(), self.0) }
            }

            #[inline(always)]
            fn add(self, other: Self) -> Self {
                unsafe { $row($add(self.0, other.0)) }
            }

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                unsafe { $row($sub(self.0, other.0)) }
            }

            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                unsafe { $row($mul(self.0, other.0)) }
            }

            #[inline(always)]
            fn div(self, other: Self) -> Self {
                unsafe { $row($div(self.0, other.0)) }
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                unsafe { $row($min(self.0, other.0)) }
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                unsafe { $row($max(self.0, other.0)) }
            }

            #[inline(always)]
            fn abs(self) -> Self {
                unsafe { $row($andnot($splat(-0.0), self.0)) }
            }

            #[inline(always)]
            fn lowest(self) -> f32 {
                unsafe { $lowest(self.0) }
            }

            #[inline(always)]
            fn highest(self) -> f32 {
                unsafe { $highest(self.0) }
            }

            #[inline(always)]
            fn above(self, other: Self) -> u32 {
                unsafe { $bits($above(self.0, other.0)) as u32 }
            }

            #[inline(always)]
            fn where_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
                unsafe { $row($blend(no.0, yes.0, $above(b.0, a.0))) }
            }

            #[inline(always)]
            fn choose(bits: u32, yes: Self, no: Self) -> Self {
                unsafe { $row($blend(no.0, yes.0, $mask(bits))) }
            }
        }
    };
}

lanes!(
    Row4,
    __m128,
    4,
    _mm_set1_ps,
    _mm_loadu_ps,
    _mm_storeu_ps,
    _mm_add_ps,
    _mm_sub_ps,
    _mm_mul_ps,
    _mm_div_ps,
    _mm_min_ps,
    _mm_max_ps,
    _mm_andnot_ps,
    _mm_cmp_ps::<_CMP_GT_OQ>,
    _mm_movemask_ps,
    _mm_blendv_ps,
    mask_of_4,
    lowest_of_4,
    highest_of_4
);

lanes!(
    Row8,
    __m256,
    8,
    _mm256_set1_ps,
    _mm256_loadu_ps,
    _mm256_storeu_ps,
    _mm256_add_ps,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_div_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    _mm256_andnot_ps,
    _mm256_cmp_ps::<_CMP_GT_OQ>,
    _mm256_movemask_ps,
    _mm256_blendv_ps,
    mask_of_8,
    lowest_of_8,
    highest_of_8
);

/// Folds a register onto itself until one number is left.
macro_rules! fold {
    ($four:ident, $eight:ident, $op:ident) => {
        #[inline(always)]
        unsafe fn $four(row: __m128) -> f32 {
            unsafe {
                let two = $op(row, _mm_movehl_ps(row, row));
                _mm_cvtss_f32($op(two, _mm_shuffle_ps::<1>(two, two)))
            }
        }

        #[inline(always)]
        unsafe fn $eight(row: __m256) -> f32 {
            unsafe { $four($op(_mm256_castps256_ps128(row), _mm256_extractf128_ps::<1>(row))) }
        }
    };
}

fold!(lowest_of_4, lowest_of_8, _mm_min_ps);
fold!(highest_of_4, highest_of_8, _mm_max_ps);

/// A register whose lanes have all bits set where the lane's bit is set.
#[inline(always)]
unsafe fn mask_of_4(bits: u32) -> __m128 {
    unsafe {
        let each = _mm_setr_epi32(1, 2, 4, 8);
        _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(bits as i32), each), each))
    }
}

/// The same for eight lanes.
#[inline(always)]
unsafe fn mask_of_8(bits: u32) -> __m256 {
    unsafe {
        let each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(bits as i32), each), each))
    }
}

/// Sixteen numbers.
#[derive(Clone, Copy)]
pub(crate) struct Row16(__m512);

impl Lanes for Row16 {
    const N: usize = 16;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        unsafe { Row16(_mm512_set1_ps(value)) }
    }

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from = &from[..16];
        unsafe { Row16(_mm512_loadu_ps(from.as_ptr())) }
    }

    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..16];
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        unsafe { Row16(_mm512_add_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        unsafe { Row16(_mm512_sub_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        unsafe { Row16(_mm512_mul_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        unsafe { Row16(_mm512_div_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        unsafe { Row16(_mm512_min_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        unsafe { Row16(_mm512_max_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { Row16(_mm512_abs_ps(self.0)) }
    }

    #[inline(always)]
    fn lowest(self) -> f32 {
        unsafe { _mm512_reduce_min_ps(self.0) }
    }

    #[inline(always)]
    fn highest(self) -> f32 {
        unsafe { _mm512_reduce_max_ps(self.0) }
    }

    #[inline(always)]
    fn above(self, other: Self) -> u32 {
        unsafe { u32::from(_mm512_cmp_ps_mask::<_CMP_GT_OQ>(self.0, other.0)) }
    }

    #[inline(always)]
    fn where_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        unsafe { Row16(_mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(a.0, b.0), no.0, yes.0)) }
    }

    #[inline(always)]
    fn choose(bits: u32, yes: Self, no: Self) -> Self {
        unsafe { Row16(_mm512_mask_blend_ps(bits as u16, no.0, yes.0)) }
    }
}

/// Processors with AVX2.
pub(crate) struct Avx2;

impl Path for Avx2 {
    type Four = Row4;
    type Eight = Row8;
    type Rays = crate::lanes::Pair<Row8>;

    #[inline(always)]
    fn fetch(place: *const u8) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(place.cast()) }
    }
}

/// Processors with AVX-512.
pub(crate) struct Avx512;

impl Path for Avx512 {
    type Four = Row4;
    type Eight = Row8;
    type Rays = Row16;

    #[inline(always)]
    fn fetch(place: *const u8) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(place.cast()) }
    }
}
