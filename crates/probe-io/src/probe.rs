//! Pixels with a layout: radiance by direction.

use crate::patch::{Patch, Rect};
use crate::{Layout, angular, cube, equirect};
use glam::{DVec3, Vec3};

/// A picture of the radiance that arrives from every direction.
#[derive(Debug, Clone)]
pub struct Probe {
    /// How the pixels lie on the sphere.
    pub layout: Layout,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear RGB radiance, row by row from the top; finite and not negative.
    pub pixels: Vec<[f32; 3]>,
}

/// A pixel as a piece of the sphere.
#[derive(Debug, Clone, Copy)]
pub struct Texel {
    /// Unit direction of its centre, world axes.
    pub direction: DVec3,
    /// Steradians, exact; all texels of a probe sum to 4 pi.
    pub solid_angle: f64,
    /// Linear RGB radiance.
    pub radiance: [f32; 3],
}

impl Probe {
    /// Radiance from a unit direction, bilinear between pixels.
    pub fn radiance(&self, direction: Vec3) -> [f32; 3] {
        let d = direction.as_dvec3();
        let taps = match self.layout {
            Layout::Equirect => equirect::taps(self.width, self.height, d),
            Layout::Angular => angular::taps(self.width, d),
            layout => cube::taps(layout, self.width, d),
        };
        let mut sum = [0.0f32; 3];
        for (pixel, weight) in taps {
            for (total, value) in sum.iter_mut().zip(self.pixels[pixel]) {
                *total += weight * value;
            }
        }
        sum
    }

    /// Radiance of the pixel that holds a unit direction: constant over each texel.
    pub fn texel_radiance(&self, direction: Vec3) -> [f32; 3] {
        self.pixels[self.texel_index(direction)]
    }

    /// Index of the pixel that holds a unit direction.
    pub fn texel_index(&self, direction: Vec3) -> usize {
        let d = direction.as_dvec3();
        match self.layout {
            Layout::Equirect => {
                let (x, y) = equirect::locate(self.width, self.height, d);
                let column = (x as usize).min(self.width - 1);
                (y as usize).min(self.height - 1) * self.width + column
            }
            Layout::Angular => angular::nearest(self.width, d),
            layout => cube::nearest(layout, self.width, d),
        }
    }

    /// Every pixel that lies on the sphere; empty tiles and corners are left out.
    pub fn texels(&self) -> impl Iterator<Item = Texel> + '_ {
        self.cells(1)
    }

    /// Every pixel cut into `split * split` cells of its own colour, with exact solid angles.
    pub(crate) fn cells(&self, split: usize) -> impl Iterator<Item = Texel> + '_ {
        let rows = (0..self.height).flat_map(move |y| (0..self.width).map(move |x| (x, y)));
        rows.flat_map(move |(x, y)| {
            let radiance = self.pixels[self.stand_in(x, y)];
            let cells = (0..split * split).map(move |k| (split, k % split, k / split));
            cells.filter_map(move |cell| {
                let patch = self.patch((x, y), cell)?;
                Some(Texel { direction: patch.direction, solid_angle: patch.solid_angle, radiance })
            })
        })
    }

    /// Rows of a panorama with pixels of about the same size.
    pub fn equivalent_rows(&self) -> usize {
        match (self.layout, self.layout.tiles()) {
            (Layout::Angular, _) | (_, None) => self.height,
            (_, Some((columns, _))) => 2 * (self.width / columns),
        }
    }

    /// The same light as a panorama of `2 rows` by `rows` pixels; each is the mean of four bilinear lookups.
    pub fn to_equirect(&self, rows: usize) -> Probe {
        let (width, height) = (2 * rows.max(1), rows.max(1));
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0.0f32; 3];
                for (dx, dy) in [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)] {
                    let d = equirect::direction(width, height, x as f64 + dx, y as f64 + dy);
                    let value = self.radiance(d.as_vec3());
                    sum = std::array::from_fn(|c| sum[c] + 0.25 * value[c]);
                }
                pixels.push(sum);
            }
        }
        Probe { layout: Layout::Equirect, width, height, pixels }
    }

    /// Whether any of a pixel lies on the sphere, in a picture of this layout and width.
    pub(crate) fn covers(layout: Layout, width: usize, x: usize, y: usize) -> bool {
        match layout {
            Layout::Equirect => true,
            Layout::Angular => angular::touches(width, x, y),
            layout => cube::covers(layout, width, x, y),
        }
    }

    /// A cell of a pixel on the sphere.
    fn patch(&self, (x, y): (usize, usize), (split, i, j): (usize, usize, usize)) -> Option<Patch> {
        let rect = || Rect::pixel(x, y).cell(split, i, j);
        match self.layout {
            Layout::Equirect => Some(equirect::patch(self.width, self.height, &rect())),
            Layout::Angular => angular::patch(self.width, &rect()),
            layout => cube::patch(layout, self.width, (x, y), (split, i, j)),
        }
    }

    /// The pixel whose colour stands for this one: only the rim of an angular map borrows.
    fn stand_in(&self, x: usize, y: usize) -> usize {
        match self.layout {
            Layout::Angular => angular::stand_in(self.width, x, y),
            _ => y * self.width + x,
        }
    }
}
