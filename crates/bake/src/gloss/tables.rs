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
    /// `[table][row][column]`.
    values: Vec<f32>,
    /// Where each table ends in the values.
    ends: Vec<usize>,
}

/// Tables with their codebook and the relative error that clusters added.
struct Coded {
    book: Option<Codebook>,
    tables: std::vec::IntoIter<Table>,
    error: f32,
}

pub(super) fn write(job: &Job<'_>, maker: &RowMaker<'_>, mut found: Found, mut record: GlossRecord, prt: &mut Prt) {
    let aim = job.extras.compression.rows;
    let with_vertices = aim.is_some() && maker.channels == prt.transfer.channels as usize;
    let of_vertices = with_vertices.then_some(&prt.transfer.values[..]);
    let [diffuse, visibility, bounces] = take_rows(job, maker, &mut found, of_vertices);
    let has_vertices = !found.vertices.ids.is_empty();
    record.bytes[0] = 4 * (diffuse.values.len() + visibility.values.len()) as u64 + long_bytes(maker, &bounces);

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
    let levels = levels(&found.baked);
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

/// The rows of vertices that shine and of all levels by what they tell of: light for normals, visibility, bounces. The first begins with those
/// of `vertices` that share its clusters. Rows leave their sheets, lest they are there twice while clusters are made.
fn take_rows(job: &Job<'_>, maker: &RowMaker<'_>, found: &mut Found, vertices: Option<&[f32]>) -> [Rows; 3] {
    let at_vertices = maker.layout(false, true);
    let columns = [job.light.coefficients() * maker.channels, job.gloss.coefficients(), at_vertices.bounce];
    let mut all = columns.map(|columns| Rows { columns, values: Vec::new(), ends: Vec::new() });
    let [diffuse, visibility, bounces] = &mut all;
    if let Some(rows) = vertices {
        diffuse.add(rows.iter());
    }
    if !found.vertices.ids.is_empty() {
        let rows = |range| columns_of(&found.rows, at_vertices.len(), range);
        visibility.add(rows(at_vertices.visibility()));
        (0..at_vertices.tables).for_each(|t| bounces.add(rows(at_vertices.bounces(t))));
    }
    found.rows = Vec::new();
    for sheet in &mut found.baked {
        for plate in &mut sheet.levels {
            let level = Level::of(plate, sheet.layout);
            diffuse.add(level.rows(0..level.layout.diffuse));
            if level.layout.visibility > 0 {
                visibility.add(level.rows(level.layout.visibility()));
                (0..level.layout.tables).for_each(|t| bounces.add(level.rows(level.layout.bounces(t))));
            }
            plate.values = Vec::new();
        }
    }
    all
}

/// The levels of all sheets.
fn levels(baked: &[BakedSheet]) -> Vec<Level<'_>> {
    baked.iter().flat_map(|sheet| sheet.levels.iter().map(|plate| Level::of(plate, sheet.layout))).collect()
}

/// Bytes of the bounces as f32 in full.
fn long_bytes(maker: &RowMaker<'_>, bounces: &Rows) -> u64 {
    let rows = bounces.values.len() / bounces.columns.max(1);
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

    fn rows(&self, range: Range<usize>) -> impl Iterator<Item = &f32> {
        self.order.iter().flat_map(move |&slot| &self.plate.values[slot as usize * self.plate.row_len..][range.clone()])
    }
}

fn columns_of(rows: &[f32], row_len: usize, range: Range<usize>) -> impl Iterator<Item = &f32> {
    rows.chunks_exact(row_len.max(1)).flat_map(move |row| &row[range.clone()])
}

impl Rows {
    /// Adds the rows of one table.
    fn add<'a>(&mut self, rows: impl Iterator<Item = &'a f32>) {
        self.values.extend(rows);
        self.ends.push(self.values.len());
    }

    /// Of each table where it begins and ends in the values.
    fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        self.ends.iter().scan(0, |start, &end| Some(std::mem::replace(start, end)..end))
    }

    /// Tables in clusters to within a relative error, or in halves where none is given or clusters would take more.
    fn coded(self, error: Option<f32>) -> Coded {
        let all = error.filter(|_| !self.values.is_empty()).and_then(|error| {
            let aim = Aim { error, most_clusters: MOST_CLUSTERS, most_rank: MOST_RANK };
            compress(&self.values, self.columns, &aim)
        });
        match all {
            Some(all) => {
                let tables = self.split(&all.book, &all.clusters, &all.weights);
                Coded { book: Some(all.book), tables: tables.into_iter(), error: all.error }
            }
            None => {
                let half = |range| Table::half(self.columns as u32, &self.values[range]);
                Coded { book: None, tables: self.ranges().map(half).collect::<Vec<_>>().into_iter(), error: 0.0 }
            }
        }
    }

    /// Rows that are kept by the vectors of a sketch: always by a codebook, in the worst case that of the sketch itself.
    fn coded_sketched(self, sketch: &crate::compress::Sketch, error: f32, sketched: f32) -> Coded {
        if self.ends.is_empty() {
            return Coded { book: None, tables: Vec::new().into_iter(), error: 0.0 };
        }
        let aim = Aim { error, most_clusters: MOST_CLUSTERS, most_rank: MOST_RANK };
        let all = compress_sketched(&self.values, sketch, &aim);
        let tables = self.split(&all.book, &all.clusters, &all.weights);
        let error = (all.error * all.error + sketched * sketched).sqrt();
        Coded { book: Some(all.book), tables: tables.into_iter(), error }
    }

    fn split(&self, book: &Codebook, clusters: &[u16], weights: &[f32]) -> Vec<Table> {
        let rank = book.rank as usize;
        let table = |range: Range<usize>| {
            let [start, end] = [range.start, range.end].map(|at| at / self.columns);
            Table::clustered(book, &clusters[start..end], &weights[start * rank..end * rank])
        };
        self.ranges().map(table).collect()
    }
}

impl Coded {
    fn next(&mut self) -> Table {
        self.tables.next().expect("a table for each set of rows")
    }
}
