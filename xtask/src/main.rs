//! Runs commands in order.
fn main() {}
