//! The first bytes of a `.prt` file: magic, version and the table of chunks.

use crate::Error;
use serde::Serialize;
use std::fmt;
use std::io::{self, Read, Write};

/// First bytes of every `.prt`: one outside ASCII, both line ends and an end-of-text mark, so that a file that was
/// sent as text is recognised as damaged.
pub const MAGIC: [u8; 8] = *b"\x89PRT\r\n\x1a\n";

/// Version of the format, apart from the version of the program.
pub const VERSION: u32 = 5;

/// The oldest version that is still read.
const OLDEST: u32 = 4;

/// Every chunk begins at a multiple of so many bytes, so that a mapped file can be used without copying.
pub const ALIGNMENT: u64 = 16;

/// Bytes before the table: magic, version, chunk count, file length, zero, checksum.
const PRELUDE: usize = 32;

/// Bytes of one row of the table: kind, index, offset, length, checksum, zero.
const ROW: usize = 32;

/// What a chunk holds. The order of the kinds is their order in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub enum Kind {
    /// The small records, in bincode.
    Header,
    /// Small records that came after version 4, in JSON.
    Supplement,
    /// `[vertex][3]` f32.
    Positions,
    /// `[vertex][3]` f32.
    Normals,
    /// `[vertex][4]` f32.
    Tangents,
    /// `[vertex][2]` f32.
    Uv0,
    /// `[vertex][2]` f32.
    Uv1,
    /// `[vertex][4]` f32.
    Colors,
    /// `[triangle][3]` u32.
    Triangles,
    /// `[vertex][coefficient][channel]` f32.
    Transfer,
    /// `[vertex][3]` f32.
    Albedo,
    /// `[vertex]` f32.
    Openness,
    /// `[row][column][4]` u8, one per texture.
    Picture,
    /// The bytes of `Layers`, one per sheet of a light map.
    Sheet,
    /// `[node][8]` u32: the cells of an irradiance volume.
    VolumeNodes,
    /// `[probe][function of 9][depth][channel]` f32.
    VolumeValues,
    /// `[probe][3]` f32.
    VolumePositions,
    /// `[probe]` f32.
    VolumeValidity,
    /// `[probe][row][column][2]` f32.
    VolumeDistances,
    /// The bytes of a `Codebook`.
    Codebook,
    /// `[texel]` u32: where the rows of a level of a transfer texture lie.
    Places,
    /// The bytes of a `Table`.
    Table,
}

impl Kind {
    /// Every kind with its tag, in file order.
    const TAGS: [(Self, [u8; 4]); 22] = [
        (Self::Header, *b"HEAD"),
        (Self::Supplement, *b"MORE"),
        (Self::Positions, *b"POSN"),
        (Self::Normals, *b"NORM"),
        (Self::Tangents, *b"TANG"),
        (Self::Uv0, *b"TEX0"),
        (Self::Uv1, *b"TEX1"),
        (Self::Colors, *b"COLR"),
        (Self::Triangles, *b"TRIS"),
        (Self::Transfer, *b"TRAN"),
        (Self::Albedo, *b"ALBD"),
        (Self::Openness, *b"OPEN"),
        (Self::Picture, *b"PICT"),
        (Self::Sheet, *b"MAPS"),
        (Self::VolumeNodes, *b"VNOD"),
        (Self::VolumeValues, *b"VVAL"),
        (Self::VolumePositions, *b"VPOS"),
        (Self::VolumeValidity, *b"VOKS"),
        (Self::VolumeDistances, *b"VDIS"),
        (Self::Codebook, *b"BOOK"),
        (Self::Places, *b"PLAC"),
        (Self::Table, *b"ROWS"),
    ];

    /// Whether a file may hold several, counted by [`Chunk::index`].
    #[must_use]
    pub fn repeats(self) -> bool {
        matches!(self, Self::Picture | Self::Sheet | Self::Codebook | Self::Places | Self::Table)
    }

    fn tag(self) -> [u8; 4] {
        Self::TAGS[self as usize].1
    }

    fn from_tag(tag: [u8; 4]) -> Option<Self> {
        Self::TAGS.iter().find(|(_, known)| *known == tag).map(|(kind, _)| *kind)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(std::str::from_utf8(&self.tag()).unwrap_or("????"))
    }
}

/// One row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Chunk {
    /// What it holds.
    pub kind: Kind,
    /// Which picture, sheet, codebook or table; 0 for kinds that do not repeat.
    pub index: u32,
    /// Where it begins, bytes from the start of the file.
    pub offset: u64,
    /// Its length in bytes, never 0.
    pub length: u64,
    /// CRC-32 (IEEE, reflected, as in zip) of its bytes.
    pub crc32: u32,
}

impl Chunk {
    /// First byte after it.
    pub(crate) fn end(&self) -> u64 {
        self.offset.saturating_add(self.length)
    }
}

/// The next multiple of [`ALIGNMENT`].
fn align(offset: u64) -> u64 {
    offset.saturating_add(ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT
}

/// Places chunks of `(kind, index, length, crc32)` one after the other behind a table of their number.
pub(crate) fn lay_out(chunks: impl ExactSizeIterator<Item = (Kind, u32, u64, u32)>) -> Vec<Chunk> {
    let mut end = (PRELUDE + ROW * chunks.len()) as u64;
    let mut place = |(kind, index, length, crc32)| {
        let offset = align(end);
        end = offset + length;
        Chunk { kind, index, offset, length, crc32 }
    };
    chunks.map(&mut place).collect()
}

/// Writes prelude and table.
pub(crate) fn write(chunks: &[Chunk], to: &mut impl Write) -> io::Result<()> {
    let file_length = chunks.last().map_or(PRELUDE as u64, Chunk::end);
    let mut bytes = Vec::with_capacity(PRELUDE + ROW * chunks.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((chunks.len() as u32).to_le_bytes());
    bytes.extend(file_length.to_le_bytes());
    bytes.extend([0; 8]);
    for chunk in chunks {
        bytes.extend(chunk.kind.tag());
        bytes.extend(chunk.index.to_le_bytes());
        bytes.extend(chunk.offset.to_le_bytes());
        bytes.extend(chunk.length.to_le_bytes());
        bytes.extend(chunk.crc32.to_le_bytes());
        bytes.extend([0; 4]);
    }
    // The checksum counts itself as zero.
    let crc32 = crc32fast::hash(&bytes);
    bytes[28..32].copy_from_slice(&crc32.to_le_bytes());
    to.write_all(&bytes)
}

/// Reads prelude and table of a file of `file_length` bytes and checks that they describe exactly this file: its version
/// and its chunks.
///
/// # Errors
/// `Unsupported` for another version or an unknown kind, `Invalid` for everything else that is wrong.
pub(crate) fn read(from: &mut impl Read, file_length: u64) -> Result<(u32, Vec<Chunk>), Error> {
    let mut prelude = [0; PRELUDE];
    if file_length < PRELUDE as u64 {
        return Err(Error::invalid(
            file_length,
            format!("the file ends within its first {PRELUDE} bytes: no .prt file"),
        ));
    }
    from.read_exact(&mut prelude)?;
    let count = check_prelude(&prelude, file_length)?;
    let mut rows = vec![0; ROW * count];
    from.read_exact(&mut rows)?;
    check_sum(&mut prelude, &rows)?;
    let chunks = rows.chunks_exact(ROW).enumerate().map(|(i, row)| parse_row(i, row));
    let chunks = chunks.collect::<Result<Vec<_>, _>>()?;
    check_layout(&chunks, file_length)?;
    let version = u32_at(&prelude, 8);
    if version < 5 && chunks.iter().any(|chunk| chunk.kind == Kind::Supplement) {
        return Err(Error::invalid(PRELUDE as u64, format!("a file of version {version} has no chunk MORE")));
    }
    Ok((version, chunks))
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

/// Number of chunks, after a check of all but the checksum.
fn check_prelude(prelude: &[u8; PRELUDE], file_length: u64) -> Result<usize, Error> {
    if prelude[..8] != MAGIC {
        return Err(Error::invalid(0, "the file does not begin as a .prt file does"));
    }
    let version = u32_at(prelude, 8);
    if !(OLDEST..=VERSION).contains(&version) {
        return Err(Error::Unsupported(format!(
            "the file is of format version {version}, but this program reads versions {OLDEST} to {VERSION}: bake the scene again or use the program that wrote it"
        )));
    }
    let stated = u64_at(prelude, 16);
    if stated != file_length {
        return Err(Error::invalid(
            16,
            format!("the file should be {stated} bytes long but is {file_length}: it was cut off or changed"),
        ));
    }
    if u32_at(prelude, 24) != 0 {
        return Err(Error::invalid(24, "a reserved field is not zero"));
    }
    let count = u32_at(prelude, 12);
    let table_end = PRELUDE as u64 + ROW as u64 * u64::from(count);
    if table_end > file_length {
        return Err(Error::invalid(12, format!("a table of {count} chunks does not fit into {file_length} bytes")));
    }
    Ok(count as usize)
}

fn check_sum(prelude: &mut [u8; PRELUDE], rows: &[u8]) -> Result<(), Error> {
    let stated = u32_at(prelude, 28);
    prelude[28..].fill(0);
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(prelude);
    hasher.update(rows);
    if hasher.finalize() == stated {
        Ok(())
    } else {
        Err(Error::invalid(28, "the checksum of the chunk table is wrong: the file is damaged"))
    }
}

fn parse_row(number: usize, row: &[u8]) -> Result<Chunk, Error> {
    let at = (PRELUDE + ROW * number) as u64;
    let tag = std::array::from_fn(|i| row[i]);
    let kind = Kind::from_tag(tag)
        .ok_or_else(|| Error::Unsupported(format!("chunk {number} is of the unknown kind '{}'", tag.escape_ascii())))?;
    if u32_at(row, 28) != 0 {
        return Err(Error::invalid(at + 28, "a reserved field is not zero"));
    }
    Ok(Chunk { kind, index: u32_at(row, 4), offset: u64_at(row, 8), length: u64_at(row, 16), crc32: u32_at(row, 24) })
}

/// Chunks must lie as [`lay_out`] places them: a file has one form, and no length exceeds the file.
fn check_layout(chunks: &[Chunk], file_length: u64) -> Result<(), Error> {
    if chunks.first().map(|c| c.kind) != Some(Kind::Header) {
        return Err(Error::invalid(PRELUDE as u64, "the first chunk is not the header"));
    }
    let mut end = (PRELUDE + ROW * chunks.len()) as u64;
    for (number, chunk) in chunks.iter().enumerate() {
        let at = (PRELUDE + ROW * number) as u64;
        let expected = match number.checked_sub(1).map(|before| &chunks[before]) {
            Some(before) if before.kind == chunk.kind => before.index.checked_add(1),
            _ => Some(0),
        };
        let in_order = number == 0 || {
            let before = chunks[number - 1].kind;
            chunk.kind > before || (chunk.kind == before && chunk.kind.repeats())
        };
        if !in_order || Some(chunk.index) != expected {
            return Err(Error::invalid(at, format!("chunk {number} ({} {}) is out of order", chunk.kind, chunk.index)));
        }
        if chunk.offset != align(end) || chunk.length == 0 || chunk.end() > file_length {
            return Err(Error::invalid(at + 8, format!("chunk {number} ({}) does not lie where it must", chunk.kind)));
        }
        end = chunk.end();
    }
    if end == file_length { Ok(()) } else { Err(Error::invalid(end, "the file goes on after its last chunk")) }
}
