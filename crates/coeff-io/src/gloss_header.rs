//! What the header chunk says of gloss, transfer textures and codebooks: all but their bytes.

use crate::{
    Arriving, Bounced, Codebook, Codebooks, Error, Form, Gloss, Prt, Table, TransferLevel, TransferSheet,
    TransferTextures, VertexGloss,
};
use serde::{Deserialize, Serialize};
use std::vec::IntoIter;

/// [`Table`] without its bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TableHeader {
    /// Number of receivers.
    pub rows: u32,
    /// Numbers per receiver.
    pub columns: u32,
    /// How the numbers are held.
    pub form: Form,
}

/// [`Codebook`] without its bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CodebookHeader {
    /// Numbers per vector.
    pub columns: u32,
    /// Number of clusters.
    pub clusters: u32,
    /// Vectors of each cluster beside its mean.
    pub rank: u32,
    /// Vectors that all clusters share.
    pub shared: u32,
}

/// [`Arriving`] without bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArrivingHeader {
    /// Of visibility.
    pub visibility: TableHeader,
    /// Of bounces.
    pub bounces: Vec<TableHeader>,
}

/// [`Gloss`] without bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GlossHeader {
    /// Number of bands.
    pub bands: u32,
    /// What bounces hold.
    pub bounced: Option<Bounced>,
    /// Of each mesh the row of its first vertex, and the rows; none where texels hold all.
    pub vertices: Option<(Vec<Option<u32>>, ArrivingHeader)>,
}

/// [`TransferLevel`] without bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TransferLevelHeader {
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// Diffuse transfer.
    pub diffuse: TableHeader,
    /// For mirrored light.
    pub arriving: Option<ArrivingHeader>,
}

/// [`TransferTextures`] without bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TransferTexturesHeader {
    /// Channels of the diffuse transfer.
    pub channels: u32,
    /// Whether normal maps are in it.
    pub bent: bool,
    /// The levels of each sheet.
    pub sheets: Vec<Vec<TransferLevelHeader>>,
    /// Of each mesh its sheet.
    pub sheet_of_mesh: Vec<Option<u32>>,
}

/// All of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct SurfacesHeader {
    /// Codebooks of diffuse transfer, visibility and bounces.
    pub codebooks: [Option<CodebookHeader>; 3],
    /// The transfer of the vertices, where it is clustered.
    pub compressed: Option<TableHeader>,
    /// What shines.
    pub gloss: Option<GlossHeader>,
    /// Transfer at texels.
    pub transfer_textures: Option<TransferTexturesHeader>,
}

impl TableHeader {
    fn of(table: &Table) -> Self {
        Self { rows: table.rows, columns: table.columns, form: table.form }
    }
}

impl ArrivingHeader {
    fn of(arriving: &Arriving) -> Self {
        Self {
            visibility: TableHeader::of(&arriving.visibility),
            bounces: arriving.bounces.iter().map(TableHeader::of).collect(),
        }
    }
}

impl SurfacesHeader {
    pub(crate) fn of(prt: &Prt) -> Self {
        let Codebooks { diffuse, visibility, bounce } = &prt.codebooks;
        let book = |book: &Codebook| CodebookHeader {
            columns: book.columns,
            clusters: book.clusters,
            rank: book.rank,
            shared: book.shared,
        };
        let level = |level: &TransferLevel| TransferLevelHeader {
            width: level.width,
            height: level.height,
            diffuse: TableHeader::of(&level.diffuse),
            arriving: level.arriving.as_ref().map(ArrivingHeader::of),
        };
        Self {
            codebooks: [diffuse, visibility, bounce].map(|one| one.as_ref().map(book)),
            compressed: prt.compressed.as_ref().map(TableHeader::of),
            gloss: prt.gloss.as_ref().map(|gloss| GlossHeader {
                bands: gloss.bands,
                bounced: gloss.bounced.clone(),
                vertices: gloss.vertices.as_ref().map(|v| (v.first_row.clone(), ArrivingHeader::of(&v.arriving))),
            }),
            transfer_textures: prt.transfer_textures.as_ref().map(|textures| TransferTexturesHeader {
                channels: textures.channels,
                bent: textures.bent,
                sheets: textures.sheets.iter().map(|sheet| sheet.levels.iter().map(level).collect()).collect(),
                sheet_of_mesh: textures.sheet_of_mesh.clone(),
            }),
        }
    }
}

/// Every table of a file with its codebook, in the order of the file.
pub(crate) fn tables(prt: &Prt) -> impl Iterator<Item = (&Table, Option<&Codebook>)> {
    let books = &prt.codebooks;
    let vertices = prt.gloss.iter().flat_map(|gloss| &gloss.vertices).map(|vertices| &vertices.arriving);
    let compressed = prt.compressed.iter().map(|table| (table, books.diffuse.as_ref()));
    compressed
        .chain(vertices.flat_map(move |arriving| of_arriving(arriving, books)))
        .chain(levels(prt).flat_map(move |level| of_level(level, books)))
}

fn of_level<'a>(
    level: &'a TransferLevel,
    books: &'a Codebooks,
) -> impl Iterator<Item = (&'a Table, Option<&'a Codebook>)> {
    let arriving = level.arriving.iter().flat_map(move |arriving| of_arriving(arriving, books));
    std::iter::once((&level.diffuse, books.diffuse.as_ref())).chain(arriving)
}

fn of_arriving<'a>(
    arriving: &'a Arriving,
    books: &'a Codebooks,
) -> impl Iterator<Item = (&'a Table, Option<&'a Codebook>)> {
    let bounces = arriving.bounces.iter().map(|table| (table, books.bounce.as_ref()));
    std::iter::once((&arriving.visibility, books.visibility.as_ref())).chain(bounces)
}

/// Every level of every transfer texture.
pub(crate) fn levels(prt: &Prt) -> impl Iterator<Item = &TransferLevel> {
    prt.transfer_textures.iter().flat_map(|textures| &textures.sheets).flat_map(|sheet| &sheet.levels)
}

/// The bytes of books, places and tables as they lie in the file.
#[derive(Default)]
pub(crate) struct SurfaceBytes {
    pub(crate) books: Vec<Vec<u8>>,
    pub(crate) places: Vec<Vec<u32>>,
    pub(crate) tables: Vec<Vec<u8>>,
}

/// What the header and the bytes say together.
#[derive(Default)]
pub(crate) struct Joined {
    pub(crate) codebooks: Codebooks,
    pub(crate) compressed: Option<Table>,
    pub(crate) gloss: Option<Gloss>,
    pub(crate) transfer_textures: Option<TransferTextures>,
}

/// Hands out bytes in order.
struct Bytes {
    books: IntoIter<Vec<u8>>,
    places: IntoIter<Vec<u32>>,
    tables: IntoIter<Vec<u8>>,
    /// Where the header lies.
    at: u64,
}

impl Bytes {
    fn missing(&self, what: &str) -> Error {
        Error::invalid(self.at, format!("the header names more {what} than the file holds"))
    }

    fn table(&mut self, header: TableHeader) -> Result<Table, Error> {
        let bytes = self.tables.next().ok_or_else(|| self.missing("tables"))?;
        Ok(Table { rows: header.rows, columns: header.columns, form: header.form, bytes })
    }

    fn book(&mut self, header: Option<CodebookHeader>) -> Result<Option<Codebook>, Error> {
        let Some(CodebookHeader { columns, clusters, rank, shared }) = header else { return Ok(None) };
        let bytes = self.books.next().ok_or_else(|| self.missing("codebooks"))?;
        Ok(Some(Codebook { columns, clusters, rank, shared, bytes }))
    }

    fn arriving(&mut self, header: ArrivingHeader) -> Result<Arriving, Error> {
        let visibility = self.table(header.visibility)?;
        let bounces = header.bounces.into_iter().map(|bounce| self.table(bounce)).collect::<Result<_, _>>()?;
        Ok(Arriving { visibility, bounces })
    }

    fn level(&mut self, header: TransferLevelHeader) -> Result<TransferLevel, Error> {
        let places = self.places.next().ok_or_else(|| self.missing("levels"))?;
        let diffuse = self.table(header.diffuse)?;
        let arriving = header.arriving.map(|arriving| self.arriving(arriving)).transpose()?;
        Ok(TransferLevel { width: header.width, height: header.height, places, diffuse, arriving })
    }
}

impl SurfacesHeader {
    /// What header and bytes say together; `at` is where the header lies.
    ///
    /// # Errors
    /// `Invalid` where the header names more or fewer parts than there are bytes of.
    pub(crate) fn join(self, bytes: SurfaceBytes, at: u64) -> Result<Joined, Error> {
        let mut bytes = Bytes {
            books: bytes.books.into_iter(),
            places: bytes.places.into_iter(),
            tables: bytes.tables.into_iter(),
            at,
        };
        let [diffuse, visibility, bounce] = self.codebooks;
        let codebooks = Codebooks {
            diffuse: bytes.book(diffuse)?,
            visibility: bytes.book(visibility)?,
            bounce: bytes.book(bounce)?,
        };
        let compressed = self.compressed.map(|table| bytes.table(table)).transpose()?;
        let gloss = match self.gloss {
            Some(GlossHeader { bands, bounced, vertices }) => {
                let vertices = match vertices {
                    Some((first_row, arriving)) => Some(VertexGloss { first_row, arriving: bytes.arriving(arriving)? }),
                    None => None,
                };
                Some(Gloss { bands, bounced, vertices })
            }
            None => None,
        };
        let transfer_textures = match self.transfer_textures {
            Some(TransferTexturesHeader { channels, bent, sheets, sheet_of_mesh }) => {
                let mut joined = Vec::new();
                for levels in sheets {
                    let levels = levels.into_iter().map(|level| bytes.level(level)).collect::<Result<_, _>>()?;
                    joined.push(TransferSheet { levels });
                }
                Some(TransferTextures { channels, bent, sheets: joined, sheet_of_mesh })
            }
            None => None,
        };
        let left = bytes.books.len() + bytes.places.len() + bytes.tables.len();
        if left > 0 {
            return Err(Error::invalid(at, format!("the file holds {left} codebooks, levels or tables too many")));
        }
        Ok(Joined { codebooks, compressed, gloss, transfer_textures })
    }
}
