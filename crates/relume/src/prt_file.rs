//! Baked files, with the name of the file in every error.

use crate::Error;
use coeff_io::Prt;
use std::path::Path;

/// Reads and checks a `.prt` file.
///
/// # Errors
/// [`Error::ReadPrt`] where the file is missing, damaged or of an unknown version.
pub fn load_prt(path: impl AsRef<Path>) -> Result<Prt, Error> {
    let path = path.as_ref();
    Prt::read(path).map_err(|source| Error::ReadPrt { path: path.to_owned(), source })
}

/// Writes a `.prt` file, whole or not at all.
///
/// # Errors
/// [`Error::WritePrt`] where the operating system refuses or the data contradict the format.
pub fn save_prt(prt: &Prt, path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    prt.write(path).map_err(|source| Error::WritePrt { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_names_the_file() {
        let text = load_prt("missing.prt").expect_err("no file").to_string();
        assert!(text.contains("missing.prt"), "{text}");
    }
}
