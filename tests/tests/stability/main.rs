//! Hard cases: each must hold within a number that is stated with its reason, and the naive method must be seen to break.
//!
//! `cargo test --release -p end-to-end --test stability`; one case is a module with the tests `holds` and `naive_can_fail`.
//! The example `stability-table` prints the same cases as the table of `docs/stability.md`.

mod cases;

macro_rules! tests {
    ($($theme:ident { $($case:ident),+ $(,)? })+) => {
        $(mod $theme {
            $(mod $case {
                #[test]
                fn holds() {
                    crate::cases::$theme::$case().holds();
                }

                #[test]
                fn naive_can_fail() {
                    crate::cases::$theme::$case().naive_fails();
                }
            })+
        })+
    };
}
cases::hard_cases!(tests);

macro_rules! lead_cells {
    ($($theme:ident { $($case:ident),+ $(,)? })+) => {
        [$($(crate::cases::$theme::$case().lead_cells()),+),+]
    };
}

/// The table in the documents has a row for each case, with the bound and the naive method that stand here.
#[test]
fn table_names_every_case() {
    let document = include_str!("../../../docs/stability.md");
    let rows: Vec<&str> = document.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    let cells = cases::hard_cases!(lead_cells);
    assert_eq!(
        rows.len(),
        cells.len(),
        "docs/stability.md: one row per case; print them with the example stability-table"
    );
    for (row, [start, naive]) in rows.iter().zip(&cells) {
        assert!(
            row.starts_with(start) && row.contains(naive),
            "docs/stability.md: '{row}' is not of '{start}', '{naive}'"
        );
    }
}
