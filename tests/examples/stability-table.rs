//! Prints the table of `docs/stability.md`: every hard case with its bound, our worst value, and the naive method's.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

#[path = "../tests/stability/cases/mod.rs"]
mod cases;

macro_rules! rows {
    ($($theme:ident { $($case:ident),+ $(,)? })+) => {
        $($(println!("{}", cases::$theme::$case().row());)+)+
    };
}

fn main() {
    println!("| case | bound and why | at most | ours | the naive method | its value |");
    println!("|---|---|---|---|---|---|");
    cases::hard_cases!(rows);
}
