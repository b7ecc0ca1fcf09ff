//! The order of commands: `cargo xtask pipeline | ci | tidy | golden | compare | bench`. Runs commands; holds no algorithm.

mod bench;
mod ci;
mod compare;
mod golden;
mod pipeline;
mod run;
mod tidy;

use clap::{Parser, Subcommand};

/// Runs the project's own tasks.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Bakes a scene, relights it and draws it: .prt and pictures into a folder.
    Pipeline(pipeline::Options),
    /// Runs everything that CI checks, in CI's order.
    Ci(ci::Options),
    /// Checks the arrows between crates and the shape of the sources.
    Tidy,
    /// Compares golden pictures with what is drawn today, or accepts it by name.
    #[command(subcommand)]
    Golden(golden::Act),
    /// Compares the numbers of ten bakes by an older program with today's.
    Compare(compare::Options),
    /// Runs the benchmarks; --record writes a dated record to docs/bench.
    Bench(bench::Options),
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().task {
        Task::Pipeline(options) => pipeline::run(&options),
        Task::Ci(options) => ci::run(&options),
        Task::Tidy => tidy::run(),
        Task::Golden(act) => golden::run(&act),
        Task::Compare(options) => compare::run(&options),
        Task::Bench(options) => bench::run(&options),
    }
}
