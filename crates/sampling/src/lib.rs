//! Seeded sequences, warps with densities, discrete sampling, error estimates.
