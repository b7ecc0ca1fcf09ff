//! `relume list`: the built-in scenes and light probes.

use crate::columns::entry;
use crate::console::Console;
use anyhow::Result;
use std::fmt::Write;

/// Characters of the column of names: the longest stand above what is said of them.
const NAMES: usize = 31;

pub(crate) fn run(console: &Console) -> Result<()> {
    let mut text = String::new();
    for (title, entries) in [
        ("Scenes", scene::BUILTINS),
        ("Scenes for measuring", scene::PAPER_SCENES),
        ("Light probes", probe_io::BUILTINS),
    ] {
        writeln!(text, "{title}:")?;
        for (name, what) in entries {
            text.push_str(&entry(&format!("  builtin:{name}"), NAMES, what));
        }
    }
    console.print(&text)
}
