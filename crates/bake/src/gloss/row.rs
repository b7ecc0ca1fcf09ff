//! The numbers that are kept of a receiver, in one row while texels are filled, stitched and averaged: all of it is linear.

use super::fixed::FixedBounces;
use crate::arrival::Arrival;
use crate::compress::Sketch;
use crate::maps::Part;
use glam::Vec3;
use sh_math::{Bands, zonal};

/// What a row holds, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Layout {
    /// Numbers of diffuse transfer, `[coefficient][channel]`.
    pub(crate) diffuse: usize,
    /// Numbers of visibility.
    pub(crate) visibility: usize,
    /// Numbers that are kept of each table of bounces.
    pub(crate) bounce: usize,
    /// Tables of bounces.
    pub(crate) tables: usize,
}

impl Layout {
    pub(crate) fn len(self) -> usize {
        self.diffuse + self.visibility + self.bounce * self.tables
    }

    pub(crate) fn visibility(self) -> std::ops::Range<usize> {
        self.diffuse..self.diffuse + self.visibility
    }

    pub(crate) fn bounces(self, table: usize) -> std::ops::Range<usize> {
        let start = self.diffuse + self.visibility + table * self.bounce;
        start..start + self.bounce
    }
}

/// How bounces are kept.
pub(crate) enum Bouncing<'a> {
    /// No surface sends light.
    None,
    /// In full: `[coefficient][coefficient of the light][channel]`.
    Whole,
    /// The same by a few vectors.
    Sketched(&'a Sketch),
    /// Under one light.
    Fixed(&'a FixedBounces<'a>),
}

/// Turns what arrives at receivers into rows.
pub(crate) struct RowMaker<'a> {
    /// Bands over directions of what arrives.
    pub(crate) functions: Bands,
    /// Bands of gloss, no more.
    pub(crate) gloss: Bands,
    /// Bands of the light.
    pub(crate) light: Bands,
    pub(crate) channels: usize,
    pub(crate) bouncing: Bouncing<'a>,
}

impl RowMaker<'_> {
    /// The layout of rows with or without diffuse transfer, and with or without gloss.
    pub(crate) fn layout(&self, diffuse: bool, gloss: bool) -> Layout {
        let (bounce, tables) = match &self.bouncing {
            Bouncing::None => (0, 0),
            Bouncing::Whole => (self.long(), 1),
            Bouncing::Sketched(sketch) => (sketch.rank(), 1),
            Bouncing::Fixed(fixed) => (3 * self.gloss.coefficients(), fixed.tables()),
        };
        Layout {
            diffuse: if diffuse { self.light.coefficients() * self.channels } else { 0 },
            visibility: if gloss { self.gloss.coefficients() } else { 0 },
            bounce: if gloss { bounce } else { 0 },
            tables: if gloss { tables } else { 0 },
        }
    }

    /// The parts of a row of a layout whose first numbers are means over all directions.
    pub(crate) fn parts(&self, layout: Layout) -> Vec<Part> {
        let means = match &self.bouncing {
            // The vectors of a sketch have signs of their own.
            Bouncing::None | Bouncing::Sketched(_) => 0,
            Bouncing::Whole => self.channels,
            Bouncing::Fixed(_) => 3,
        };
        let mut parts = vec![
            Part { numbers: 0..layout.diffuse, means: self.channels },
            Part { numbers: layout.visibility(), means: 1 },
        ];
        parts.extend((0..layout.tables).map(|table| Part { numbers: layout.bounces(table), means }));
        parts.retain(|part| part.means > 0 && !part.numbers.is_empty());
        parts
    }

    /// Numbers of a row of bounces in full.
    pub(crate) fn long(&self) -> usize {
        self.gloss.coefficients() * self.light.coefficients() * self.channels
    }

    /// Sums of squares of an arrival's bounces: what a sketch leaves out, and all of it.
    pub(crate) fn lost(&self, layout: Layout, arrival: &Arrival, row: &[f32]) -> [f64; 2] {
        let Bouncing::Sketched(_) = self.bouncing else { return [0.0; 2] };
        if layout.tables == 0 {
            return [0.0; 2];
        }
        let square = |values: &[f32]| values.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>();
        let (all, kept) = (square(&arrival.bounced[..self.long()]), square(&row[layout.bounces(0)]));
        [(all - kept).max(0.0), all]
    }

    /// What of an arrival a row of `layout` keeps; diffuse transfer is about a unit normal.
    pub(crate) fn make(&self, layout: Layout, arrival: &Arrival, normal: Vec3) -> Vec<f32> {
        let mut row = Vec::with_capacity(layout.len());
        if layout.diffuse > 0 {
            row.extend(self.diffuse(arrival, normal));
        }
        if layout.visibility > 0 {
            // Of a receiver that sees all of its hemisphere only the first bands may be there.
            row.extend_from_slice(&arrival.visibility[..layout.visibility]);
            match &self.bouncing {
                Bouncing::None => {}
                Bouncing::Whole => row.extend_from_slice(&arrival.bounced[..self.long()]),
                Bouncing::Sketched(sketch) => row.extend(sketch.project(&arrival.bounced[..self.long()])),
                Bouncing::Fixed(fixed) => fixed.append(&arrival.found, &mut row),
            }
        }
        row
    }

    /// The radiance of a white surface for every coefficient of the light: what arrives, convolved with the clamped cosine and read at the
    /// normal.
    fn diffuse(&self, arrival: &Arrival, normal: Vec3) -> Vec<f32> {
        let numbers = self.light.coefficients() * self.channels;
        let mut cosine = vec![0.0; self.functions.coefficients()];
        zonal::cosine_transfer(self.functions, normal, &mut cosine);
        let mut out = vec![0.0f32; numbers];
        for (factor, values) in cosine.iter().zip(arrival.values.chunks_exact(numbers)) {
            out.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
        }
        out
    }
}
