//! `relume bases`: the table of errors, its files, and what it refuses.

mod command;

use command::{complaint, relume};
use std::fs;
use std::path::Path;

/// The rows of bases.csv after `arguments`, without the columns of this machine's time.
fn errors(folder: &Path, arguments: &[&str]) -> Vec<Vec<String>> {
    let output = relume(folder, &[&["bases", "-q"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    assert!(complaint(&output).is_empty(), "-q must be quiet: {}", complaint(&output));
    let out = arguments.last().unwrap();
    let csv = fs::read_to_string(folder.join(out).join("bases.csv")).unwrap();
    csv.lines().map(|line| line.split(',').take(8).map(str::to_owned).collect()).collect()
}

#[test]
fn the_table_and_its_files_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let output = relume(folder, &["bases", "-o", "new/folder"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        text.contains("10000 signals") && text.contains("modified H 6") && text.contains("11 of 11 hold"),
        "{text}"
    );
    assert!(complaint(&output).contains("bases.png"), "{}", complaint(&output));
    let folder = folder.join("new/folder");
    let svg = fs::read_to_string(folder.join("bases.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("Makhotkin 9"), "{}", &svg[..200]);
    let picture = image::open(folder.join("bases.png")).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (1200, 620));
    assert!(fs::metadata(folder.join("bases.png")).unwrap().len() < 100 * 1024);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 3, "nothing else is left there");
}

#[test]
fn errors_depend_on_the_seed_alone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let few = |seed, out| errors(folder, &["--signals", "50", "--seed", seed, "-o", out]);
    let first = few("3", "a");
    assert_eq!(first, few("3", "b"));
    assert_ne!(first, few("4", "c"), "another seed draws other signals");
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (arguments, reason) in [
        (&["bases"][..], "--output"),
        (&["bases", "-o", "out", "--signals", "1"], "from 2 to 10000000"),
        (&["bases", "-o", "out", "--seed", "x"], "--seed"),
    ] {
        let output = relume(folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", complaint(&output));
        assert!(complaint(&output).contains(reason), "{arguments:?}: {}", complaint(&output));
    }
    fs::write(folder.join("taken"), "mine").unwrap();
    let output = relume(folder, &["bases", "--signals", "2", "-o", "taken"]);
    let text = complaint(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.starts_with("error: ") && text.contains("taken") && text.lines().count() == 1, "{text}");
    assert_eq!(fs::read(folder.join("taken")).unwrap(), b"mine", "what stood there still stands");
}
