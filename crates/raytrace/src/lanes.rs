//! Numbers side by side: what the kernels ask of a processor, and the portable form of it.

/// A row of single-precision numbers on which every operation acts lane by lane.
///
/// Each operation rounds as IEEE 754 says and none fuses two, so that all implementations give the same bits.
pub(crate) trait Lanes: Copy {
    const N: usize;
    fn splat(value: f32) -> Self;
    /// The first `N` numbers of a slice.
    fn load(from: &[f32]) -> Self;
    /// Into the first `N` numbers of a slice.
    fn store(self, to: &mut [f32]);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// The smaller; `other` where either is not a number.
    fn min(self, other: Self) -> Self;
    /// The larger; `other` where either is not a number.
    fn max(self, other: Self) -> Self;
    fn abs(self) -> Self;
    /// The smallest of the row, which holds numbers only.
    fn lowest(self) -> f32;
    /// The largest of the row, which holds numbers only.
    fn highest(self) -> f32;
    /// One bit per lane: self > other; clear where either is not a number.
    fn above(self, other: Self) -> u32;
    /// `yes` where a < b, else `no`.
    fn where_less(a: Self, b: Self, yes: Self, no: Self) -> Self;
    /// `yes` where the lane's bit is set, else `no`.
    fn choose(bits: u32, yes: Self, no: Self) -> Self;
}

/// What a path provides: rows of four for triangles, of eight for boxes, and as wide as pays for rays.
pub(crate) trait Path {
    type Four: Lanes;
    type Eight: Lanes;
    type Rays: Lanes;

    /// Asks for the memory at a place, which need not exist, to be brought near.
    fn fetch(place: *const u8);
}

/// Plain arrays, which any processor can do.
#[derive(Clone, Copy)]
#[repr(align(16))]
pub(crate) struct Row<const N: usize>([f32; N]);

impl<const N: usize> Row<N> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Row(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl<const N: usize> Lanes for Row<N> {
    const N: usize = N;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Row([value; N])
    }

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        Row(std::array::from_fn(|i| from[i]))
    }

    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..N].copy_from_slice(&self.0);
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Row(self.0.map(f32::abs))
    }

    #[inline(always)]
    fn lowest(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, f32::min)
    }

    #[inline(always)]
    fn highest(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }

    #[inline(always)]
    fn above(self, other: Self) -> u32 {
        (0..N).fold(0, |mask, i| mask | u32::from(self.0[i] > other.0[i]) << i)
    }

    #[inline(always)]
    fn where_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        Row(std::array::from_fn(|i| if a.0[i] < b.0[i] { yes.0[i] } else { no.0[i] }))
    }

    #[inline(always)]
    fn choose(bits: u32, yes: Self, no: Self) -> Self {
        Row(std::array::from_fn(|i| if bits >> i & 1 == 1 { yes.0[i] } else { no.0[i] }))
    }
}

/// Two rows in one.
#[derive(Clone, Copy)]
pub(crate) struct Pair<L>(L, L);

impl<L: Lanes> Lanes for Pair<L> {
    const N: usize = 2 * L::N;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Pair(L::splat(value), L::splat(value))
    }

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        Pair(L::load(from), L::load(&from[L::N..]))
    }

    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        self.0.store(to);
        self.1.store(&mut to[L::N..]);
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Pair(self.0.add(other.0), self.1.add(other.1))
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Pair(self.0.sub(other.0), self.1.sub(other.1))
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Pair(self.0.mul(other.0), self.1.mul(other.1))
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Pair(self.0.div(other.0), self.1.div(other.1))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Pair(self.0.min(other.0), self.1.min(other.1))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Pair(self.0.max(other.0), self.1.max(other.1))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Pair(self.0.abs(), self.1.abs())
    }

    #[inline(always)]
    fn lowest(self) -> f32 {
        self.0.min(self.1).lowest()
    }

    #[inline(always)]
    fn highest(self) -> f32 {
        self.0.max(self.1).highest()
    }

    #[inline(always)]
    fn above(self, other: Self) -> u32 {
        self.0.above(other.0) | self.1.above(other.1) << L::N
    }

    #[inline(always)]
    fn where_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        Pair(L::where_less(a.0, b.0, yes.0, no.0), L::where_less(a.1, b.1, yes.1, no.1))
    }

    #[inline(always)]
    fn choose(bits: u32, yes: Self, no: Self) -> Self {
        Pair(L::choose(bits, yes.0, no.0), L::choose(bits >> L::N, yes.1, no.1))
    }
}

/// The path of processors without wide registers.
pub(crate) struct Portable;

impl Path for Portable {
    type Four = Row<4>;
    type Eight = Row<8>;
    type Rays = Row<8>;

    #[inline(always)]
    fn fetch(_place: *const u8) {}
}
