//! Evaluates a .prt file on the GPU.
