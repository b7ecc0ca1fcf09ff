//! Which pieces touch which tile of the picture.

use crate::raster::{Piece, Window};

/// Samples along each side of a tile: its depth and colours stay in the processor's nearest caches.
pub(crate) const TILE: u32 = 64;

/// The tiles of a picture, of `TILE` samples or of whole pixels, whichever is less.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tiles {
    /// Samples along the side of a tile; a whole number of pixels.
    side: u32,
    columns: u32,
    rows: u32,
    samples: [u32; 2],
}

impl Tiles {
    /// Cuts `samples` (columns, rows) of which `supersample` squared make a pixel.
    pub(crate) fn new(samples: [u32; 2], supersample: u32) -> Self {
        let side = TILE / supersample * supersample;
        Self { side, columns: samples[0].div_ceil(side), rows: samples[1].div_ceil(side), samples }
    }

    /// Number of tiles.
    pub(crate) fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// The samples of one tile; tiles are counted row by row.
    pub(crate) fn window(&self, tile: usize) -> Window {
        let range = |index: u32, end: u32| [index * self.side, ((index + 1) * self.side).min(end)];
        let (column, row) = (tile as u32 % self.columns, tile as u32 / self.columns);
        Window { columns: range(column, self.samples[0]), rows: range(row, self.samples[1]) }
    }

    fn touched_by(&self, piece: &Piece) -> impl Iterator<Item = usize> + use<> {
        let columns = piece.columns.map(|c| (c / self.side) as usize);
        let rows = piece.rows.map(|r| (r / self.side) as usize);
        let stride = self.columns as usize;
        (rows[0]..=rows[1]).flat_map(move |row| (columns[0]..=columns[1]).map(move |column| row * stride + column))
    }
}

/// Indices of pieces per tile, in the order of the pieces.
#[derive(Debug)]
pub(crate) struct Bins {
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Bins {
    /// Sorts pieces into the tiles that their boxes touch.
    pub(crate) fn new(tiles: &Tiles, pieces: &[Piece]) -> Self {
        let mut starts = vec![0_u32; tiles.count() + 1];
        for tile in pieces.iter().flat_map(|piece| tiles.touched_by(piece)) {
            starts[tile + 1] += 1;
        }
        for tile in 0..tiles.count() {
            starts[tile + 1] += starts[tile];
        }
        let mut items = vec![0; starts[tiles.count()] as usize];
        let mut next = starts.clone();
        for (index, piece) in pieces.iter().enumerate() {
            for tile in tiles.touched_by(piece) {
                items[next[tile] as usize] = index as u32;
                next[tile] += 1;
            }
        }
        Self { starts, items }
    }

    /// The pieces of one tile.
    pub(crate) fn of(&self, tile: usize) -> &[u32] {
        &self.items[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }
}
