//! Bytes and numbers: chunks as they lie in the file, little-endian, with their checksums.

use crate::Error;
use crate::table::Chunk;
use bytemuck::Pod;
use std::borrow::Cow;
use std::io::Read;

/// The bytes that numbers have in the file. Every array is of 4-byte words, or of single bytes where `T` is.
pub(crate) fn bytes<T: Pod>(values: &[T]) -> Cow<'_, [u8]> {
    let bytes = bytemuck::cast_slice(values);
    if cfg!(target_endian = "little") || align_of::<T>() == 1 {
        return Cow::Borrowed(bytes);
    }
    let mut swapped = bytes.to_vec();
    swap_words(&mut swapped);
    Cow::Owned(swapped)
}

fn swap_words(bytes: &mut [u8]) {
    bytes.chunks_exact_mut(4).for_each(<[u8]>::reverse);
}

/// Reads a chunk whose length the table has checked against the file, and compares its checksum.
///
/// # Errors
/// `Invalid` where the length is no whole number of elements or the checksum differs; `Io`.
pub(crate) fn read<T: Pod>(chunk: &Chunk, from: &mut impl Read) -> Result<Vec<T>, Error> {
    let size = size_of::<T>() as u64;
    if !chunk.length.is_multiple_of(size) {
        return Err(Error::invalid(
            chunk.offset,
            format!("chunk {} has {} bytes, which is no multiple of {size}", chunk.kind, chunk.length),
        ));
    }
    let count = usize::try_from(chunk.length / size)
        .map_err(|_| Error::Unsupported(format!("chunk {} is too large for this machine", chunk.kind)))?;
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| {
        Error::Unsupported(format!("chunk {} of {} bytes does not fit into memory", chunk.kind, chunk.length))
    })?;
    values.resize(count, T::zeroed());
    let bytes = bytemuck::cast_slice_mut(&mut values);
    from.read_exact(bytes)?;
    if crc32fast::hash(bytes) != chunk.crc32 {
        return Err(damaged(chunk));
    }
    if cfg!(target_endian = "big") && align_of::<T>() > 1 {
        swap_words(bytes);
    }
    Ok(values)
}

/// The error of a chunk with a wrong checksum.
pub(crate) fn damaged(chunk: &Chunk) -> Error {
    Error::invalid(chunk.offset, format!("the checksum of chunk {} is wrong: the file is damaged", chunk.kind))
}

/// Reads the zeros between `position` and the start of `chunk`; anything else there is damage.
pub(crate) fn read_padding(position: u64, chunk: &Chunk, from: &mut impl Read) -> Result<(), Error> {
    let mut padding = [0; crate::ALIGNMENT as usize];
    let padding = &mut padding[..(chunk.offset - position) as usize];
    from.read_exact(padding)?;
    match padding.iter().position(|byte| *byte != 0) {
        Some(i) => {
            Err(Error::invalid(position + i as u64, "the padding between two chunks is not zero: the file is damaged"))
        }
        None => Ok(()),
    }
}
