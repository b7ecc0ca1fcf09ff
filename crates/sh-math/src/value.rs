//! The numbers that the evaluators run on: f32, f64, and blocks of directions side by side.

use std::ops::{Add, Div, Mul, Sub};

/// `f32` or `f64`.
pub trait Real: Root + Default + sealed::Sealed {
    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
    /// The same number in f64.
    fn to_f64(self) -> f64;
}

/// What an evaluator needs of a number; implemented by [`Real`] and by blocks of them.
pub trait Value: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// A constant, rounded once.
    fn of(value: f64) -> Self;
}

/// A [`Value`] that can be divided and has square roots, both exactly rounded: what the hemispherical bases need beside.
pub trait Root: Value + Div<Output = Self> {
    /// The square root.
    fn sqrt(self) -> Self;
    /// The larger of the number and 0.
    fn at_least_zero(self) -> Self;
}

mod sealed {
    /// Keeps [`super::Real`] to the two types whose error bounds are tested.
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

impl Real for f32 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
}

impl Root for f32 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn at_least_zero(self) -> Self {
        self.max(0.0)
    }
}

impl Value for f32 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }
}

impl Root for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn at_least_zero(self) -> Self {
        self.max(0.0)
    }
}

impl Value for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
}

/// Directions per block: two SSE registers or one AVX register of f32.
pub(crate) const LANES: usize = 8;

/// One component of [`LANES`] directions; each operation is done lane by lane, so results equal the scalar ones bit for bit.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Block<T>(pub(crate) [T; LANES]);

impl<T: Real> Value for Block<T> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self([T::from_f64(value); LANES])
    }
}

impl<T: Real> Add for Block<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] + other.0[lane]))
    }
}

impl<T: Real> Sub for Block<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] - other.0[lane]))
    }
}

impl<T: Real> Mul for Block<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] * other.0[lane]))
    }
}
