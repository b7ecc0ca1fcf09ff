//! Whether a result can be written, asked before long work begins: it must replace neither an input nor another's file.

use crate::usage::Usage;
use anyhow::{Context, Result, bail};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A kind of file that a command writes, told by its ending and by its first bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Prt,
    Png,
    Exr,
    Npy,
    Json,
    Ktx2,
    Dds,
    /// Tables, drawings and pages.
    Text,
}

impl Format {
    /// All that are told by their first bytes.
    const ALL: [(Self, &'static str, &'static [u8]); 6] = [
        (Self::Prt, "prt", &coeff_io::MAGIC),
        (Self::Png, "png", b"\x89PNG\r\n\x1a\n"),
        (Self::Exr, "exr", b"\x76\x2f\x31\x01"),
        (Self::Npy, "npy", b"\x93NUMPY"),
        (Self::Ktx2, "ktx2", b"\xabKTX 20\xbb\r\n\x1a\n"),
        (Self::Dds, "dds", b"DDS "),
    ];

    /// The format that a file of this name should have.
    fn of_name(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "json" => Some(Self::Json),
            "csv" | "svg" | "html" | "md" | "txt" => Some(Self::Text),
            other => Self::ALL.iter().find(|(_, ending, _)| *ending == other).map(|(format, _, _)| *format),
        }
    }

    /// Whether a file that begins with these bytes is of this format; an empty one is of every format.
    fn fits(self, head: &[u8]) -> bool {
        let text = || !head.contains(&0) && !Self::ALL.iter().any(|(_, _, magic)| head.starts_with(magic));
        let first = head.iter().find(|byte| !byte.is_ascii_whitespace());
        head.is_empty()
            || match self {
                Self::Json => matches!(first, Some(b'{' | b'[')) && !is_scene(head),
                Self::Text => text(),
                other => Self::ALL.iter().any(|(format, _, magic)| *format == other && head.starts_with(magic)),
            }
    }
}

/// Whether JSON begins as a glTF scene does, as far as that shows.
fn is_scene(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    text.contains("\"asset\"") && text.contains("\"version\"")
}

/// Parses the name of a baked file.
pub(crate) fn prt(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if Format::of_name(&path) == Some(Format::Prt) { Ok(path) } else { Err("give a file that ends in .prt".into()) }
}

/// Makes a folder, and fails where one of the files of those names cannot be made in it.
pub(crate) fn check_all(folder: &Path, names: &[&str], inputs: &[PathBuf]) -> Result<()> {
    make_folder(folder)?;
    names.iter().try_for_each(|name| check(&folder.join(name), inputs))
}

/// Fails where a file in a folder has the ending, but not the bytes, of what is written there.
pub(crate) fn check_folder(folder: &Path, inputs: &[PathBuf]) -> Result<()> {
    if !folder.exists() {
        return Ok(());
    }
    check_is_folder(folder)?;
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read the folder {}", folder.display()))?;
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_file() && Format::of_name(&path).is_some() && !inputs.iter().any(|input| same(input, &path)) {
            check_bytes(&path)?;
        }
    }
    tempfile::tempfile_in(folder)
        .map(drop)
        .with_context(|| format!("cannot write into {}: choose another folder", folder.display()))
}

fn check_is_folder(folder: &Path) -> Result<()> {
    if folder.is_file() {
        bail!("{} is a file: name a folder to write into", folder.display());
    }
    Ok(())
}

fn make_folder(folder: &Path) -> Result<()> {
    check_is_folder(folder)?;
    coeff_io::make_folder(folder)
        .with_context(|| format!("cannot make the folder {}: choose another, or make room for it", folder.display()))
}

/// Fails where no file can be made at `path`, or where it would replace an input or a file of another format.
pub(crate) fn check(path: &Path, inputs: &[PathBuf]) -> Result<()> {
    if path.is_dir() {
        bail!("cannot write {}: it is a folder; name a file", path.display());
    }
    if let Some(input) = inputs.iter().find(|input| same(input, path)) {
        let (output, input) = (path.display(), input.display());
        return Err(Usage(format!("{output} would replace the input {input}: give the output another name")).into());
    }
    check_bytes(path)?;
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    tempfile::tempfile_in(folder)
        .with_context(|| format!("cannot write {}: make the folder or choose another", path.display()))?;
    Ok(())
}

/// Whether both names mean one file that exists, be it by links.
fn same(a: &Path, b: &Path) -> bool {
    same_file::is_same_file(a, b).unwrap_or(false)
}

/// Fails where a file stands at `path` that has not the format that its ending says.
fn check_bytes(path: &Path) -> Result<()> {
    let Some(format) = Format::of_name(path) else { return Ok(()) };
    // What cannot be read is for the attempt to write it.
    let Ok(file) = File::open(path) else { return Ok(()) };
    if !file.metadata().is_ok_and(|metadata| metadata.is_file()) {
        return Ok(());
    }
    let mut head = Vec::new();
    let read = file.take(4096).read_to_end(&mut head);
    if read.is_ok() && !format.fits(&head) {
        let ending = path.extension().unwrap_or_default().display();
        return Err(Usage(format!(
            "{} exists and is no .{ending} file: give the output another name, or move that file away",
            path.display()
        ))
        .into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_told_by_their_bytes() {
        let head = |path: &str, bytes: &[u8]| Format::of_name(Path::new(path)).unwrap().fits(bytes);
        assert!(
            head("a.prt", &coeff_io::MAGIC) && head("a.PNG", b"\x89PNG\r\n\x1a\n...") && head("a.json", b" {\"a\":1}")
        );
        assert!(head("a.csv", b"a,b\n") && head("a.npy", b""));
        assert!(!head("a.prt", b"glTF") && !head("a.npy", b"#?RADIANCE") && !head("a.exr", b"\x89PNG\r\n\x1a\n"));
        assert!(!head("a.json", b"{\"asset\":{\"version\":\"2.0\"}}") && !head("a.csv", b"\x93NUMPY\x01\0"));
        assert_eq!(Format::of_name(Path::new("a")), None);
        assert!(prt("a.prt").is_ok() && prt("a.glb").is_err() && prt("a").is_err());
    }

    #[test]
    fn inputs_and_strangers_stay() {
        let folder = tempfile::tempdir().unwrap();
        let [scene, stranger, mine, new] =
            ["scene.prt", "stranger.png", "mine.png", "new.png"].map(|name| folder.path().join(name));
        fs::write(&scene, coeff_io::MAGIC).unwrap();
        fs::write(&stranger, "my diary").unwrap();
        fs::write(&mine, b"\x89PNG\r\n\x1a\n").unwrap();
        let said = |path: &Path| check(path, std::slice::from_ref(&scene)).map_err(|error| error.to_string());
        assert!(said(&scene).unwrap_err().contains("replace the input"));
        assert!(said(&stranger).unwrap_err().contains("no .png file"));
        assert_eq!((said(&mine), said(&new)), (Ok(()), Ok(())));
        let round = folder.path().join("..").join(folder.path().file_name().unwrap()).join("scene.prt");
        assert!(said(&round).unwrap_err().contains("replace the input"), "by another name");
        assert!(check(&scene, &[]).is_ok(), "a file of the same format that is no input is replaced");
        assert!(check_folder(folder.path(), &[]).unwrap_err().to_string().contains("stranger.png"));
    }
}
