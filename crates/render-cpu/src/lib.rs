//! Evaluates a .prt file on the CPU.
