//! Precomputes how a scene carries light.
