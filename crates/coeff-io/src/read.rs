//! Bytes become a [`Prt`].

use crate::gloss_header::{Joined, SurfaceBytes};
use crate::supplement::Supplement;
use crate::table::{self, Chunk, Kind};
use crate::volume_header::VolumeArrays;
use crate::{Codebook, Error, Geometry, Header, Prt, Table, Texture, Transfer, array, validate};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

impl Prt {
    /// Reads a file and checks all of it: checksums, lengths, indices, numbers.
    ///
    /// Memory is bounded by a small multiple of the length of the file, whatever the file says.
    ///
    /// # Errors
    /// `Unsupported` for another version or convention, `Invalid` for damage or contradiction, `Io`.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let (file, length) = open(path)?;
        read_from(BufReader::new(file), length)
    }

    /// Reads a file that is in memory.
    ///
    /// # Errors
    /// As [`Prt::read`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        read_from(bytes, bytes.len() as u64)
    }
}

/// Opens a regular file and tells its length: lengths inside the file are measured against it.
pub(crate) fn open(path: &Path) -> Result<(File, u64), Error> {
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    if !metadata.is_file() {
        return Err(Error::Unsupported("this is no regular file, so its length is not known beforehand".into()));
    }
    Ok((file, metadata.len()))
}

/// What stands before the arrays of a file.
pub(crate) struct Front {
    pub(crate) version: u32,
    pub(crate) chunks: Vec<Chunk>,
    pub(crate) header: Header,
}

impl Front {
    /// Number of chunks that are part of the header.
    fn chunks_read(&self) -> usize {
        1 + usize::from(self.chunks.get(1).is_some_and(|chunk| chunk.kind == Kind::Supplement))
    }
}

/// Reads prelude, table, header and supplement.
pub(crate) fn read_front(from: &mut impl Read, file_length: u64) -> Result<Front, Error> {
    let (version, chunks) = table::read(from, file_length)?;
    let header = array::read::<u8>(&chunks[0], from)?;
    let mut header = Header::decode(&header, chunks[0].offset)?;
    if header.convention != sh_math::CONVENTION {
        let (theirs, ours) = (&header.convention, sh_math::CONVENTION);
        return Err(Error::Unsupported(format!("the coefficients follow the convention '{theirs}', not '{ours}'")));
    }
    if let Some(chunk) = chunks.get(1).filter(|chunk| chunk.kind == Kind::Supplement) {
        array::read_padding(chunks[0].end(), chunk, from)?;
        Supplement::decode_into(&mut header, &array::read::<u8>(chunk, from)?, chunk.offset)?;
    }
    Ok(Front { version, chunks, header })
}

fn read_from(mut from: impl Read, file_length: u64) -> Result<Prt, Error> {
    let front = read_front(&mut from, file_length)?;
    let first = front.chunks_read() - 1;
    let Front { chunks, header, .. } = front;
    let mut arrays = Arrays::default();
    for pair in chunks[first..].windows(2) {
        array::read_padding(pair[0].end(), &pair[1], &mut from)?;
        arrays.read(&pair[1], &mut from)?;
    }
    let prt = arrays.join(header, &chunks)?;
    validate::validate(&prt, &chunks)?;
    Ok(prt)
}

/// The arrays of the file, as far as they are read.
#[derive(Default)]
struct Arrays {
    geometry: Geometry,
    transfer: Transfer,
    pictures: Vec<Vec<[u8; 4]>>,
    sheets: Vec<Vec<u8>>,
    volume: VolumeArrays,
    surfaces: SurfaceBytes,
}

impl Arrays {
    fn read(&mut self, chunk: &Chunk, from: &mut impl Read) -> Result<(), Error> {
        let (geometry, transfer, volume) = (&mut self.geometry, &mut self.transfer, &mut self.volume);
        match chunk.kind {
            // The table allows one header and one supplement, and they were read before.
            Kind::Header | Kind::Supplement => {}
            Kind::Positions => geometry.positions = array::read(chunk, from)?,
            Kind::Normals => geometry.normals = array::read(chunk, from)?,
            Kind::Tangents => geometry.tangents = array::read(chunk, from)?,
            Kind::Uv0 => geometry.uv0 = array::read(chunk, from)?,
            Kind::Uv1 => geometry.uv1 = array::read(chunk, from)?,
            Kind::Colors => geometry.colors = array::read(chunk, from)?,
            Kind::Triangles => geometry.triangles = array::read(chunk, from)?,
            Kind::Transfer => transfer.values = array::read(chunk, from)?,
            Kind::Albedo => transfer.albedo = array::read(chunk, from)?,
            Kind::Openness => transfer.openness = array::read(chunk, from)?,
            Kind::Picture => self.pictures.push(array::read(chunk, from)?),
            Kind::Sheet => self.sheets.push(array::read(chunk, from)?),
            Kind::VolumeNodes => volume.nodes = array::read(chunk, from)?,
            Kind::VolumeValues => volume.values = array::read(chunk, from)?,
            Kind::VolumePositions => volume.positions = array::read(chunk, from)?,
            Kind::VolumeValidity => volume.validity = array::read(chunk, from)?,
            Kind::VolumeDistances => volume.distances = array::read(chunk, from)?,
            Kind::Codebook => self.surfaces.books.push(array::read(chunk, from)?),
            Kind::Places => self.surfaces.places.push(array::read(chunk, from)?),
            Kind::Table => self.surfaces.tables.push(array::read(chunk, from)?),
        }
        Ok(())
    }

    fn join(mut self, header: Header, chunks: &[Chunk]) -> Result<Prt, Error> {
        if header.textures.len() != self.pictures.len() {
            let (stated, found) = (header.textures.len(), self.pictures.len());
            return Err(Error::invalid(
                chunks[0].offset,
                format!("the header names {stated} textures, the file holds {found}"),
            ));
        }
        let at = chunks[0].offset;
        let maps = match header.maps {
            Some(maps) => Some(maps.join(self.sheets, at)?),
            None if self.sheets.is_empty() => None,
            None => {
                return Err(Error::invalid(at, "the file holds sheets of light maps that the header does not name"));
            }
        };
        let volume = match header.volume {
            Some(volume) => Some(volume.join(self.volume)),
            None => self.volume.check_absent(at).map(|()| None)?,
        };
        let Joined { codebooks, compressed, gloss, transfer_textures } = header.surfaces.join(self.surfaces, at)?;
        if let Some(table) = &compressed {
            if !self.transfer.values.is_empty() {
                return Err(Error::invalid(at, "the transfer of the vertices stands twice in the file"));
            }
            let length = chunks.last().map_or(0, Chunk::end);
            self.transfer.values = decoded(table, codebooks.diffuse.as_ref(), length)
                .ok_or_else(|| Error::invalid(at, "the clustered transfer is not what its sizes demand"))?;
        }
        let pictures = header.textures.into_iter().zip(self.pictures);
        let texture = |(t, rgba): (crate::TextureHeader, _)| Texture {
            name: t.name,
            width: t.width,
            height: t.height,
            rgba,
            wrap: t.wrap,
        };
        Ok(Prt {
            generator: header.generator,
            convention: header.convention,
            scene: header.scene,
            origin: header.origin,
            settings: header.settings,
            plan: header.plan,
            achieved: header.achieved,
            meshes: header.meshes,
            materials: header.materials,
            cameras: header.cameras,
            geometry: self.geometry,
            transfer: Transfer { bands: header.bands, channels: header.channels, ..self.transfer },
            textures: pictures.map(texture).collect(),
            maps,
            volume,
            gloss,
            transfer_textures,
            codebooks,
            compressed,
        })
    }
}

/// Most bytes of decoded transfer per byte of its file: far more than a clustered file saves.
const MOST_GROWTH: u64 = 64;

/// A clustered transfer of a file of `length` bytes in numbers; none where it is unsound or too large for its file.
fn decoded(table: &Table, book: Option<&Codebook>, length: u64) -> Option<Vec<f32>> {
    let bytes = u64::from(table.rows).checked_mul(u64::from(table.columns))?.checked_mul(4)?;
    let sound = book.is_none_or(|book| book.fault().is_none()) && table.fault(book).is_none();
    (sound && bytes <= MOST_GROWTH.saturating_mul(length)).then(|| table.decode(book))
}
