//! Baked transfer times light against the path tracer, under the same band-limited light.

mod support;
