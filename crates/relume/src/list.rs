//! `relume list`: the built-in scenes and light probes.

use crate::console::Console;
use anyhow::Result;
use std::fmt::Write;

pub(crate) fn run(console: &Console) -> Result<()> {
    let mut text = String::new();
    for (title, entries) in [
        ("Scenes", scene::BUILTINS),
        ("Scenes for measuring", scene::PAPER_SCENES),
        ("Light probes", probe_io::BUILTINS),
    ] {
        writeln!(text, "{title}:")?;
        for (name, what) in entries {
            writeln!(text, "  {:<28} {what}", format!("builtin:{name}"))?;
        }
    }
    console.print(&text)
}
