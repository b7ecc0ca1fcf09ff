//! Accuracy against time, measured by calling the public crates as any user would: sweeps over settings, Pareto fronts, tables and plots.

pub mod bases;
pub mod cost;
mod front;
pub mod paper;
pub mod plot;
