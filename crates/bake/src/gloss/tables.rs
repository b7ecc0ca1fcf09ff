//! Rows become the tables of the file, in clusters where that is asked for.

use super::row::{Bouncing, Layout, RowMaker};
use super::sheets::{BakedSheet, SheetPlan};
use super::{Job, Vertices};
use crate::compress::{Aim, compress, compress_sketched};
use crate::maps::plate::Plate;
use coeff_io::{
    Arriving, Bounced, Codebook, Gloss, GlossRecord, Prt, Table, TransferLevel, TransferSheet, TransferTextures,
    VertexGloss,
};
use std::ops::Range;

/// Most clusters and vectors.
const MOST_CLUSTERS: u32 = 128;
const MOST_RANK: u32 = 64;

/// All that was found.
pub(super) struct Found {
    pub(super) plans: Vec<SheetPlan>,
    pub(super) baked: Vec<BakedSheet>,
    pub(super) vertices: Vertices,
    /// `[vertex][number]`.
    pub(super) rows: Vec<f32>,
    pub(super) bounced: Option<Bounced>,
    /// Relative error of the sketch of bounces, over all receivers.
    pub(super) sketched: f32,
    /// Share of bounces of all that arrives, root mean square.
    pub(super) bounced_share: f32,
}

/// Rows of several tables that share a codebook.
struct Rows {
    columns: usize,
    /// `[table]`, each `[row][column]`.
    sets: Vec<Vec<f32>>,
}

/// Tables with their codebook and the relative error that clusters added.
struct Coded {
    book: Option<Codebook>,
    tables: std::vec::IntoIter<Table>,
    error: f32,
}

pub(super) fn write(job: &Job<'_>, maker: &RowMaker<'_>, found: Found, mut record: GlossRecord, prt: &mut Prt) {
    let aim = job.extras.compression.rows;
    let levels: Vec<Level<'_>> =
        found.baked.iter().flat_map(|sheet| sheet.levels.iter().map(|plate| Level::of(plate, sheet.layout))).collect();
    let at_vertices = maker.layout(false, true);
    let vertex_rows = |range: Range<usize>| columns_of(&found.rows, at_vertices.len(), range);
    let has_vertices = !found.vertices.ids.is_empty();

    let mut diffuse = Rows { columns: job.light.coefficients() * maker.channels, sets: Vec::new() };
    let with_vertices = aim.is_some() && maker.channels == prt.transfer.channels as usize;
    if with_vertices {
        diffuse.sets.push(prt.transfer.values.clone());
    }
    diffuse.sets.extend(levels.iter().map(|level| level.rows(0..level.layout.diffuse)));
    let mut visibility = Rows { columns: job.gloss.coefficients(), sets: Vec::new() };
    let mut bounces = Rows { columns: at_vertices.bounce, sets: Vec::new() };
    if has_vertices {
        visibility.sets.push(vertex_rows(at_vertices.visibility()));
        bounces.sets.extend((0..at_vertices.tables).map(|t| vertex_rows(at_vertices.bounces(t))));
    }
    for level in levels.iter().filter(|level| level.layout.visibility > 0) {
        visibility.sets.push(level.rows(level.layout.visibility()));
        bounces.sets.extend((0..level.layout.tables).map(|t| level.rows(level.layout.bounces(t))));
    }
    record.bytes[0] = 4 * (diffuse.numbers() + visibility.numbers()) as u64 + long_bytes(maker, &bounces);

    let mut diffuse = diffuse.coded(aim);
    let mut visibility = visibility.coded(aim);
    let mut bounces = match &maker.bouncing {
        Bouncing::Sketched(sketch) => {
            let share = found.bounced_share;
            let coded = bounces.coded_sketched(sketch, job.extras.compression.bounces / share, found.sketched);
            Coded { error: share * coded.error, ..coded }
        }
        _ => bounces.coded(None),
    };
    record.compression = [diffuse.error, visibility.error, bounces.error];
    let books = [&diffuse.book, &visibility.book, &bounces.book];
    let tables = [&diffuse.tables, &visibility.tables, &bounces.tables];
    record.bytes[1] = books.into_iter().flatten().map(|book| book.bytes.len() as u64).sum::<u64>()
        + tables.iter().flat_map(|tables| tables.as_slice()).map(|table| table.bytes.len() as u64).sum::<u64>();

    if with_vertices {
        let table = diffuse.next();
        if diffuse.book.is_some() {
            prt.transfer.values = table.decode(diffuse.book.as_ref());
            prt.compressed = Some(table);
        }
    }
    let tables_of_bounces = found.bounced.as_ref().map_or(0, Bounced::tables);
    let mut arriving = || Arriving {
        visibility: visibility.next(),
        bounces: (0..tables_of_bounces).map(|_| bounces.next()).collect(),
    };
    let vertices = has_vertices.then(|| VertexGloss { first_row: found.vertices.first_row, arriving: arriving() });
    let mut sheets = Vec::new();
    let mut remaining = levels.iter();
    for sheet in &found.baked {
        let own = remaining.by_ref().take(sheet.levels.len());
        let level = |level: &Level<'_>| TransferLevel {
            width: level.plate.width as u32,
            height: level.plate.height as u32,
            places: level.places(),
            diffuse: diffuse.next(),
            arriving: (level.layout.visibility > 0).then(&mut arriving),
        };
        sheets.push(TransferSheet { levels: own.map(level).collect() });
    }
    prt.codebooks.diffuse = diffuse.book;
    prt.codebooks.visibility = visibility.book;
    prt.codebooks.bounce = bounces.book;
    if job.glossy && (vertices.is_some() || sheets.iter().any(|sheet| sheet.levels[0].arriving.is_some())) {
        prt.gloss = Some(Gloss { bands: job.gloss.count() as u32, bounced: found.bounced, vertices });
    }
    if let (Some(settings), false) = (&job.extras.textures, sheets.is_empty()) {
        let mut sheet_of_mesh = vec![None; prt.meshes.len()];
        for (index, plan) in (0..).zip(&found.plans) {
            plan.settings.meshes.iter().for_each(|&mesh| sheet_of_mesh[mesh] = Some(index));
        }
        let (channels, bent) = (maker.channels as u32, settings.bent);
        prt.transfer_textures = Some(TransferTextures { channels, bent, sheets, sheet_of_mesh });
    }
    let mark = prt.materials_mark();
    if let Some(Bounced::Fixed { materials, .. }) = prt.gloss.as_mut().and_then(|gloss| gloss.bounced.as_mut()) {
        *materials = mark;
    }
    prt.achieved.visibility_rays += record.rays[0];
    prt.achieved.bounce_rays += record.rays[1];
    prt.achieved.gloss = Some(record);
}

/// Bytes of the bounces as f32 in full.
fn long_bytes(maker: &RowMaker<'_>, bounces: &Rows) -> u64 {
    let rows = bounces.numbers() / bounces.columns.max(1);
    let long = if matches!(maker.bouncing, Bouncing::Sketched(_)) { maker.long() } else { bounces.columns };
    4 * rows as u64 * long as u64
}

/// One level of a sheet.
struct Level<'a> {
    plate: &'a Plate,
    layout: Layout,
    /// Slots in the order of their texels.
    order: Vec<u32>,
}

impl<'a> Level<'a> {
    fn of(plate: &'a Plate, layout: Layout) -> Self {
        let mut order: Vec<u32> = (0..plate.slots() as u32).collect();
        order.sort_unstable_by_key(|&slot| plate.texel_of[slot as usize]);
        Self { plate, layout, order }
    }

    fn places(&self) -> Vec<u32> {
        self.order.iter().map(|&slot| self.plate.texel_of[slot as usize]).collect()
    }

    fn rows(&self, range: Range<usize>) -> Vec<f32> {
        let row = |&slot: &u32| &self.plate.values[slot as usize * self.plate.row_len..][range.clone()];
        self.order.iter().flat_map(row).copied().collect()
    }
}

fn columns_of(rows: &[f32], row_len: usize, range: Range<usize>) -> Vec<f32> {
    rows.chunks_exact(row_len.max(1)).flat_map(|row| &row[range.clone()]).copied().collect()
}

impl Rows {
    fn numbers(&self) -> usize {
        self.sets.iter().map(Vec::len).sum()
    }

    /// Tables in clusters to within a relative error, or in halves where none is given or clusters would take more.
    fn coded(self, error: Option<f32>) -> Coded {
        let all = error.filter(|_| self.numbers() > 0).and_then(|error| {
            let aim = Aim { error, most_clusters: MOST_CLUSTERS, most_rank: MOST_RANK };
            compress(&self.sets.concat(), self.columns, &aim)
        });
        match all {
            Some(all) => {
                let tables = self.split(&all.book, &all.clusters, &all.weights);
                Coded { book: Some(all.book), tables: tables.into_iter(), error: all.error }
            }
            None => {
                let half = |rows: &Vec<f32>| Table::half(self.columns as u32, rows);
                Coded { book: None, tables: self.sets.iter().map(half).collect::<Vec<_>>().into_iter(), error: 0.0 }
            }
        }
    }

    /// Rows that are kept by the vectors of a sketch: always by a codebook, in the worst case that of the sketch itself.
    fn coded_sketched(self, sketch: &crate::compress::Sketch, error: f32, sketched: f32) -> Coded {
        if self.sets.is_empty() {
            return Coded { book: None, tables: Vec::new().into_iter(), error: 0.0 };
        }
        let aim = Aim { error, most_clusters: MOST_CLUSTERS, most_rank: MOST_RANK };
        let all = compress_sketched(&self.sets.concat(), sketch, &aim);
        let tables = self.split(&all.book, &all.clusters, &all.weights);
        let error = (all.error * all.error + sketched * sketched).sqrt();
        Coded { book: Some(all.book), tables: tables.into_iter(), error }
    }

    fn split(&self, book: &Codebook, clusters: &[u16], weights: &[f32]) -> Vec<Table> {
        let (mut row, rank) = (0, book.rank as usize);
        let table = |set: &Vec<f32>| {
            let rows = set.len() / self.columns;
            let range = row..row + rows;
            row += rows;
            Table::clustered(book, &clusters[range.clone()], &weights[range.start * rank..range.end * rank])
        };
        self.sets.iter().map(table).collect()
    }
}

impl Coded {
    fn next(&mut self) -> Table {
        self.tables.next().expect("a table for each set of rows")
    }
}
