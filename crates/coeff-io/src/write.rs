//! A [`Prt`] becomes bytes.

use crate::gloss_header::{levels, tables};
use crate::supplement::Supplement;
use crate::table::{self, Kind};
use crate::volume_header::nodes_to_words;
use crate::{Error, Header, Prt, Volume, array, replace, validate};
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

impl Prt {
    /// Writes the file beside `path`, then renames it: there is never half a file.
    ///
    /// # Errors
    /// `Invalid` where the data contradicts itself (see `docs/format.md`), `Io` where the system refuses.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let image = Image::of(self)?;
        Ok(replace(path, |file| image.write(file))?)
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// `Invalid` where the data contradicts itself.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        let mut bytes = Vec::new();
        Image::of(self)?.write(&mut bytes)?;
        Ok(bytes)
    }
}

/// The file before it is written: the table and what each chunk holds.
struct Image<'a> {
    chunks: Vec<table::Chunk>,
    payloads: Vec<Cow<'a, [u8]>>,
}

impl<'a> Image<'a> {
    fn of(prt: &'a Prt) -> Result<Self, Error> {
        let header = Header::of(prt);
        let small = [(Kind::Header, header.encode()?), (Kind::Supplement, Supplement::encode(&header)?)];
        let small = small.into_iter().map(|(kind, bytes)| (kind, 0, Cow::<[u8]>::Owned(bytes)));
        let mut parts: Vec<_> = small.filter(|(_, _, bytes)| !bytes.is_empty()).collect();
        parts.extend(arrays(prt).filter(|(_, _, bytes)| !bytes.is_empty()));
        let row =
            |(kind, index, bytes): &(Kind, u32, Cow<[u8]>)| (*kind, *index, bytes.len() as u64, crc32fast::hash(bytes));
        let chunks = table::lay_out(parts.iter().map(row));
        validate::validate(prt, &chunks)?;
        Ok(Self { chunks, payloads: parts.into_iter().map(|(_, _, bytes)| bytes).collect() })
    }

    fn write(&self, to: &mut impl Write) -> io::Result<()> {
        table::write(&self.chunks, to)?;
        let mut position = self.chunks[0].offset;
        for (chunk, payload) in self.chunks.iter().zip(&self.payloads) {
            // Less than ALIGNMENT zeros, from the end of the chunk before.
            to.write_all(&[0; table::ALIGNMENT as usize][..(chunk.offset - position) as usize])?;
            to.write_all(payload)?;
            position = chunk.end();
        }
        Ok(())
    }
}

/// Every array of `prt` in file order, the empty ones too.
fn arrays(prt: &Prt) -> impl Iterator<Item = (Kind, u32, Cow<'_, [u8]>)> {
    let (geometry, transfer) = (&prt.geometry, &prt.transfer);
    let single = [
        (Kind::Positions, array::bytes(&geometry.positions)),
        (Kind::Normals, array::bytes(&geometry.normals)),
        (Kind::Tangents, array::bytes(&geometry.tangents)),
        (Kind::Uv0, array::bytes(&geometry.uv0)),
        (Kind::Uv1, array::bytes(&geometry.uv1)),
        (Kind::Colors, array::bytes(&geometry.colors)),
        (Kind::Triangles, array::bytes(&geometry.triangles)),
        (Kind::Transfer, if prt.compressed.is_some() { Cow::Borrowed(&[]) } else { array::bytes(&transfer.values) }),
        (Kind::Albedo, array::bytes(&transfer.albedo)),
        (Kind::Openness, array::bytes(&transfer.openness)),
    ];
    let pictures = prt.textures.iter().enumerate();
    let pictures = pictures.map(|(i, texture)| (Kind::Picture, i as u32, array::bytes(&texture.rgba)));
    let sheets = prt.maps.iter().flat_map(|maps| &maps.sheets).enumerate();
    let sheets = sheets.map(|(i, sheet)| (Kind::Sheet, i as u32, Cow::Borrowed(sheet.layers.bytes.as_slice())));
    let single = single.into_iter().map(|(kind, bytes)| (kind, 0, bytes));
    let base = single.chain(pictures).chain(sheets).chain(prt.volume.iter().flat_map(volume_arrays));
    base.chain(surface_arrays(prt))
}

fn surface_arrays(prt: &Prt) -> impl Iterator<Item = (Kind, u32, Cow<'_, [u8]>)> {
    let books = prt.codebooks.all().map(|book| (Kind::Codebook, Cow::Borrowed(book.bytes.as_slice())));
    let places = levels(prt).map(|level| (Kind::Places, array::bytes(&level.places)));
    let tables = tables(prt).map(|(table, _)| (Kind::Table, Cow::Borrowed(table.bytes.as_slice())));
    let number = |(index, (kind, bytes))| (kind, index, bytes);
    (0..).zip(books).map(number).chain((0..).zip(places).map(number)).chain((0..).zip(tables).map(number))
}

fn volume_arrays(volume: &Volume) -> [(Kind, u32, Cow<'_, [u8]>); 5] {
    let nodes = nodes_to_words(&volume.nodes);
    [
        (Kind::VolumeNodes, 0, Cow::Owned(array::bytes(&nodes).into_owned())),
        (Kind::VolumeValues, 0, array::bytes(&volume.values)),
        (Kind::VolumePositions, 0, array::bytes(&volume.positions)),
        (Kind::VolumeValidity, 0, array::bytes(&volume.validity)),
        (Kind::VolumeDistances, 0, array::bytes(&volume.distances)),
    ]
}
