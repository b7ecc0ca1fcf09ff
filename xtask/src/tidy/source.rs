//! The shape of a source file: its first line, its length, its name, the words that it may use.

/// Folders that never see files, clocks, logs or threads.
const MATHS: &[&str] = &["crates/sh-math/src/", "crates/sampling/src/", "crates/raytrace/src/"];
/// What may not be named there.
const FORBIDDEN_IN_MATHS: &[&str] =
    &["std::fs", "std::io", "std::env", "Instant", "SystemTime", "println!", "std::thread", "rayon::"];
/// Folders that never read or write bytes: that is for `scene`, `probe-io` and `coeff-io`.
const SILENT: &[&str] =
    &["crates/bake/src/", "crates/reference/src/", "crates/render-cpu/src/", "crates/render-wgpu/src/"];
/// What may not be named there; tests at the end of a file may.
const FORBIDDEN_IN_SILENT: &[&str] = &["std::fs", "std::io", "File::"];
/// Lines above which a file asks for a reason.
const MAX_LINES: usize = 400;
/// A file written by a program says so in its head and may be longer.
const GENERATED: &str = "//! Written by `";
/// Names that say nothing.
const NO_NOUNS: &[&str] = &["util", "utils", "common", "helpers", "misc"];

/// What is wrong with the source `text` at `path`, relative to the root.
pub(super) fn faults(path: &str, text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let mut fault = |what: String| faults.push(format!("{path}: {what}"));
    if !text.starts_with("//! ") {
        fault("the first line must be '//! ' and say what the file is".to_owned());
    }
    let lines = text.lines().count();
    let generated = text.lines().take_while(|line| line.starts_with("//!")).any(|line| line.starts_with(GENERATED));
    if lines > MAX_LINES && !generated {
        fault(format!("{lines} lines; split it at a noun ({MAX_LINES} at most)"));
    }
    let mut names = path.split('/').map(|part| part.strip_suffix(".rs").unwrap_or(part));
    if names.any(|name| NO_NOUNS.contains(&name)) {
        fault("name the noun that this file holds".to_owned());
    }
    if begins(path, MATHS) {
        words(FORBIDDEN_IN_MATHS, body(text)).for_each(|word| fault(format!("the maths crates may not use {word}")));
    }
    if begins(path, SILENT) {
        words(FORBIDDEN_IN_SILENT, body(text))
            .for_each(|word| fault(format!("{word} is for scene, probe-io and coeff-io")));
    }
    faults
}

fn begins(path: &str, folders: &[&str]) -> bool {
    folders.iter().any(|folder| path.starts_with(folder))
}

fn words<'a>(forbidden: &'a [&'a str], body: &'a str) -> impl Iterator<Item = &'a str> {
    forbidden.iter().copied().filter(move |word| body.contains(word))
}

/// The text before its tests.
fn body(text: &str) -> &str {
    text.split("#[cfg(test)]").next().unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOUND: &str = "//! A noun.\n\nfn main() {}\n";

    #[test]
    fn sound_file_has_no_faults() {
        assert!(faults("crates/bake/src/plan.rs", SOUND).is_empty());
        let generated = format!("//! A table.\n//!\n//! Written by `tests/table.rs`.\n{}", "\n".repeat(500));
        assert!(faults("crates/sh-math/src/table.rs", &generated).is_empty());
        let tested = format!("{SOUND}#[cfg(test)]\nmod tests {{ use std::fs; }}\n");
        assert!(faults("crates/render-wgpu/src/shaders.rs", &tested).is_empty());
    }

    #[test]
    fn every_check_can_fail() {
        let cases = [
            ("crates/bake/src/plan.rs", "fn main() {}".to_owned(), "first line"),
            ("crates/bake/src/plan.rs", format!("{SOUND}{}", "\n".repeat(400)), "lines"),
            ("crates/bake/tests/common/mod.rs", SOUND.to_owned(), "noun"),
            ("crates/scene/src/utils.rs", SOUND.to_owned(), "noun"),
            ("crates/sh-math/src/bands.rs", format!("{SOUND}use std::time::Instant;"), "Instant"),
            ("crates/raytrace/src/walk.rs", format!("{SOUND}use rayon::prelude::*;"), "rayon"),
            ("crates/bake/src/bake.rs", format!("{SOUND}use std::fs;"), "std::fs"),
        ];
        for (path, text, reason) in cases {
            let found = faults(path, &text);
            assert!(found.len() == 1 && found[0].contains(path) && found[0].contains(reason), "{path}: {found:?}");
        }
    }
}
