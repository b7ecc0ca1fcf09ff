//! Real spherical harmonics: evaluation, projection, rotation, windows.
