//! Pieces of a picture on the sphere.

use glam::DVec3;

/// A piece of the sphere: where it is and how large.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch {
    /// Unit direction of its centre.
    pub(crate) direction: DVec3,
    /// Steradians.
    pub(crate) solid_angle: f64,
}

/// A rectangle of a picture, in pixels from the top left corner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rect {
    /// Left.
    pub(crate) x0: f64,
    /// Top.
    pub(crate) y0: f64,
    /// Right.
    pub(crate) x1: f64,
    /// Bottom.
    pub(crate) y1: f64,
}

impl Rect {
    /// The whole pixel `(x, y)`.
    pub(crate) fn pixel(x: usize, y: usize) -> Rect {
        let (x, y) = (x as f64, y as f64);
        Rect { x0: x, y0: y, x1: x + 1.0, y1: y + 1.0 }
    }

    /// Cell `(i, j)` of this rectangle cut into `split * split` equal cells.
    pub(crate) fn cell(&self, split: usize, i: usize, j: usize) -> Rect {
        let at = |a: f64, b: f64, k: usize| a + (b - a) * (k as f64 / split as f64);
        Rect {
            x0: at(self.x0, self.x1, i),
            y0: at(self.y0, self.y1, j),
            x1: at(self.x0, self.x1, i + 1),
            y1: at(self.y0, self.y1, j + 1),
        }
    }

    /// The point in the middle.
    pub(crate) fn centre(&self) -> (f64, f64) {
        (0.5 * (self.x0 + self.x1), 0.5 * (self.y0 + self.y1))
    }
}
