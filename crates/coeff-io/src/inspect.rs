//! A look at a file without reading its arrays into memory.

use crate::read::{Front, open, read_front};
use crate::{Chunk, Error, Header, Supplement};
use serde::Serialize;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// What a file says about itself.
#[derive(Debug, Clone, Serialize)]
pub struct Inspection {
    /// Version of the format.
    pub version: u32,
    /// Bytes.
    pub file_length: u64,
    /// The chunks in file order.
    pub chunks: Vec<Chunk>,
    /// Every small record.
    pub header: Header,
    /// Records of the header that came after version 4.
    pub supplement: Supplement,
}

/// Reads the table and the header of a file, not its arrays.
///
/// # Errors
/// As [`crate::Prt::read`] for what is read.
pub fn inspect(path: &Path) -> Result<Inspection, Error> {
    let (file, file_length) = open(path)?;
    let Front { version, chunks, header } = read_front(&mut BufReader::new(file), file_length)?;
    let supplement = Supplement::from_header(&header);
    Ok(Inspection { version, file_length, chunks, header, supplement })
}

/// Computes the CRC-32 of every chunk anew, in file order, with a small buffer; compare with [`Chunk::crc32`].
///
/// # Errors
/// `Io`.
pub fn check(path: &Path, chunks: &[Chunk]) -> Result<Vec<u32>, Error> {
    let (mut file, _) = open(path)?;
    let mut buffer = vec![0; 1 << 16];
    let mut sums = Vec::with_capacity(chunks.len());
    for chunk in chunks {
        file.seek(SeekFrom::Start(chunk.offset))?;
        let mut hasher = crc32fast::Hasher::new();
        let mut left = chunk.length;
        while left > 0 {
            let part = &mut buffer[..left.min(1 << 16) as usize];
            file.read_exact(part)?;
            hasher.update(part);
            left -= part.len() as u64;
        }
        sums.push(hasher.finalize());
    }
    Ok(sums)
}
