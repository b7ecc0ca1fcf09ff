//! Where the test data lies, and how a test says that it was skipped.

use std::io::Write;
use std::path::{Path, PathBuf};

/// Folder of the test data, if there is one: `RELUME_TEST_DATA`, else `shared/data` beside the checkout.
#[must_use]
pub fn data_dir() -> Option<PathBuf> {
    let folder = match std::env::var_os("RELUME_TEST_DATA") {
        Some(named) => PathBuf::from(named),
        None => checkout_root()?.parent()?.join("shared").join("data"),
    };
    folder.is_dir().then_some(folder)
}

/// Says that a test was skipped because the data is not there.
pub fn skip(what: &str) {
    say_skipped(&format!("{what} (no test data; set RELUME_TEST_DATA to its folder)"));
}

/// Says that something was skipped, where a test log shows it even though the test passes.
pub fn say_skipped(what: &str) {
    // Straight to the stream: what the macros print is kept from the log of a test that passes.
    let _ = writeln!(std::io::stderr(), "skipped: {what}");
}

fn checkout_root() -> Option<&'static Path> {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().find(|folder| folder.join("Cargo.lock").is_file())
}

#[cfg(test)]
mod tests {
    #[test]
    fn checkout_root_holds_this_crate() {
        let root = super::checkout_root().expect("tests run inside the checkout");
        assert!(root.join("crates/testkit/src/data.rs").is_file(), "{} is not the checkout", root.display());
    }
}
