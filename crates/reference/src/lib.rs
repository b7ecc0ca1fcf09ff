//! An independent path tracer: the ground truth.
