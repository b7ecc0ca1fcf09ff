//! Point sets in the unit square that cover it more evenly than chance.

use crate::rng::{GOLDEN, Rng, hash};

/// The ways to fill the unit square.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sequence {
    /// Owen-scrambled Sobol points: any prefix is valid, powers of two are best. For runs that grow until good enough.
    OwenSobol,
    /// Fibonacci lattice with a random shift along both axes: least error for a count that is known beforehand.
    Fibonacci,
    /// One random point per cell of a grid of equal cells; the paper's sampler.
    Stratified,
}

/// Points of one Sobol block: the direction numbers of `sobol_burley` end at 16 bits.
const SOBOL_BLOCK: u32 = 1 << 16;

/// Point `index` of a set of `count` points; `index < count`.
///
/// [`Sequence::OwenSobol`] does not depend on `count`. Beyond 65,536 points it goes on with independent blocks of that size.
#[must_use]
pub fn point(sequence: Sequence, index: u32, count: u32, seed: u64) -> [f32; 2] {
    debug_assert!(index < count, "point {index} of {count}");
    match sequence {
        Sequence::OwenSobol => sobol(index, sobol_seed(seed, index / SOBOL_BLOCK)),
        Sequence::Fibonacci => fibonacci(index, count, shift(seed)),
        Sequence::Stratified => jittered(index, count, (f64::from(count).sqrt() as u32).max(1), seed),
    }
}

/// Replaces `points` by the whole set, equal to [`point`] of each index.
pub fn fill(sequence: Sequence, count: u32, seed: u64, points: &mut Vec<[f32; 2]>) {
    points.clear();
    match sequence {
        Sequence::OwenSobol => {
            points.extend((0..count).map(|i| sobol(i, sobol_seed(seed, i / SOBOL_BLOCK))));
        }
        Sequence::Fibonacci => {
            let shift = shift(seed);
            points.extend((0..count).map(|i| fibonacci(i, count, shift)));
        }
        Sequence::Stratified => {
            let rows = (f64::from(count).sqrt() as u32).max(1);
            points.extend((0..count).map(|i| jittered(i, count, rows, seed)));
        }
    }
}

/// The first two dimensions, with the scramble of one seed.
#[inline]
fn sobol(index: u32, seed: u32) -> [f32; 2] {
    let [x, y, _, _] = sobol_burley::sample_4d(index % SOBOL_BLOCK, 0, seed);
    [x, y]
}

#[inline]
fn sobol_seed(seed: u64, block: u32) -> u32 {
    (hash(seed, u64::from(block), 0x0536) >> 32) as u32
}

/// Random start of both axes, as fractions of 2^64.
fn shift(seed: u64) -> [u64; 2] {
    let mut rng = Rng::new(seed, 0xF1B0);
    [rng.next_u64(), rng.next_u64()]
}

/// `((i + 1/2) / count, i / golden ratio)` plus the shift, modulo 1, in 64-bit fractions: exact for any count.
#[inline]
fn fibonacci(index: u32, count: u32, shift: [u64; 2]) -> [f32; 2] {
    let position = ((u128::from(2 * u64::from(index) + 1) << 64) / u128::from(2 * u64::from(count))) as u64;
    let turn = u64::from(index).wrapping_mul(GOLDEN);
    [unit(position.wrapping_add(shift[0])), unit(turn.wrapping_add(shift[1]))]
}

/// The leading 24 bits of a fraction of 2^64.
#[inline]
fn unit(fraction: u64) -> f32 {
    (fraction >> 40) as f32 * (1.0 / (1_u64 << 24) as f32)
}

/// A random point of cell `index` of `count` equal cells in `rows` rows.
///
/// A count that is no square spreads its cells over the rows as evenly as it goes; each row is as high as it has
/// cells, so that every cell has area `1 / count`.
#[inline]
fn jittered(index: u32, count: u32, rows: u32, seed: u64) -> [f32; 2] {
    let [index, count, rows] = [index, count, rows].map(u64::from);
    // First cell of each row is floor(row * count / rows); this inverts it.
    let row = ((index + 1) * rows - 1) / count;
    let (first, next) = (row * count / rows, (row + 1) * count / rows);
    let mut rng = Rng::new(seed, index);
    let columns = (next - first) as f64;
    let x = (first as f64 + rng.next_f64() * columns) / count as f64;
    let y = ((index - first) as f64 + rng.next_f64()) / columns;
    [below_one(x), below_one(y)]
}

/// Rounds to f32 without reaching 1.
#[inline]
fn below_one(value: f64) -> f32 {
    (value as f32).min(1.0 - f32::EPSILON / 2.0)
}
