//! Seeds in; directions, densities and honest error estimates out.
//!
//! Everything here is a pure function of its arguments and bit-identical on every machine: integers, the four
//! operations, square roots, and `libm` for the rest. Densities are per solid angle (steradian) unless their name or
//! doc says otherwise. Local frames have `z` up; squares are `[0, 1)²`.

pub mod discrete;
pub mod estimate;
pub mod frame;
pub mod rng;
pub mod sequence;
pub mod warp;
