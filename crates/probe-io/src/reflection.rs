//! The light as rough surfaces mirror it: panoramas blurred by the GGX lobe, one per roughness.
//!
//! Level k holds perceptual roughness `k / (levels - 1)`, with GGX's width `alpha = roughness^2` (B. Walter et al.,
//! "Microfacet Models for Refraction", 2007). The lobe is taken head-on (normal = view = mirror direction), as in
//! B. Karis, "Real Shading in Unreal Engine 4", 2013: light from an angle t off the mirror direction counts as
//! `D(t/2) cos t`, normalised. Sums run over all texels, so no sample noise and no lost suns.

use crate::{Environment, Layout, Probe, equirect};
use glam::Vec3;
use std::collections::BTreeMap;

/// Blurred panoramas of one size, sharpest first.
#[derive(Debug, Clone)]
pub struct Reflection {
    /// Columns of every level.
    pub width: usize,
    /// Rows of every level.
    pub height: usize,
    /// Linear RGB radiance per level, row by row from the top; level k is roughness `k / (levels - 1)`.
    pub levels: Vec<Vec<[f32; 3]>>,
}

/// Rows of the finest picture that is blurred; sharper lobes than its texels are left to the texels.
const MAX_ROWS: usize = 128;
/// Rows of the picture that is blurred where a lobe is wide or far from its middle.
const FAR_ROWS: usize = 64;
/// Rows per radian of the lobe's width: the lobe's core spans about this many texels.
const ROWS_PER_WIDTH: f64 = 10.0;
/// Cosines of 0.2 and 0.4 radian: between them a narrow lobe passes from the fine to the coarse picture.
const NEAR_COS: f64 = 0.980_07;
const FAR_COS: f64 = 0.921_06;

impl Reflection {
    /// Blurs an environment into `levels` panoramas of `width` by `width / 2` pixels (at least 1 and 2 by 1).
    pub fn build(environment: &Environment, levels: usize, width: usize) -> Reflection {
        let height = (width / 2).max(1);
        let levels = levels.max(1);
        let sharp = flatten(environment, height);
        let mut sources = BTreeMap::new();
        let blurred = (0..levels).map(|k| {
            let roughness = k as f64 / (levels - 1).max(1) as f64;
            let alpha = roughness * roughness;
            if alpha == 0.0 {
                return sharp.pixels.clone();
            }
            let rows = libm::ceil(ROWS_PER_WIDTH / alpha).min(MAX_ROWS as f64) as usize;
            let rows = rows.next_power_of_two().clamp(FAR_ROWS, MAX_ROWS);
            let mut source = |rows: usize| {
                let flat = sources.entry(rows).or_insert_with(|| flatten(environment, rows));
                flat.clone()
            };
            if rows <= FAR_ROWS {
                return blur(&source(rows), alpha, Part::All).mean(height);
            }
            let near = blur(&source(rows), alpha, Part::Near);
            near.plus(blur(&source(FAR_ROWS), alpha, Part::Far)).mean(height)
        });
        Reflection { width: 2 * height, height, levels: blurred.collect() }
    }

    /// Radiance mirrored from a unit direction at a perceptual roughness in [0, 1].
    pub fn sample(&self, direction: Vec3, roughness: f32) -> [f32; 3] {
        let last = self.levels.len() - 1;
        let place = roughness.clamp(0.0, 1.0) * last as f32;
        let low = (place as usize).min(last);
        let high = (low + 1).min(last);
        let blend = place - low as f32;
        let mut sum = [0.0f32; 3];
        for (pixel, weight) in equirect::taps(self.width, self.height, direction.as_dvec3()) {
            let (a, b) = (self.levels[low][pixel], self.levels[high][pixel]);
            for c in 0..3 {
                sum[c] += weight * (a[c] + blend * (b[c] - a[c]));
            }
        }
        sum
    }
}

/// A panorama that holds the picture and the lamps: every texel or lamp sample gives its flux to the pixel it
/// falls into.
fn flatten(environment: &Environment, rows: usize) -> Probe {
    let (width, height) = (2 * rows, rows);
    let mut probe = area_mean(&environment.image, rows);
    for lamp in &environment.lamps {
        for (d, flux) in lamp.samples() {
            for (pixel, share) in equirect::taps(width, height, d) {
                let area = equirect::row_solid_angle(width, height, pixel / width);
                for (value, f) in probe.pixels[pixel].iter_mut().zip(flux) {
                    *value += (f64::from(share) * f / area) as f32;
                }
            }
        }
    }
    probe
}

/// The picture's mean over each pixel of a panorama: exact sums of small cells when shrinking, bilinear when not.
fn area_mean(image: &Probe, rows: usize) -> Probe {
    let source = image.equivalent_rows();
    if source <= rows {
        return image.to_equirect(rows);
    }
    let (width, height) = (2 * rows, rows);
    let mut sums = vec![[0.0f64; 4]; width * height];
    // Cells of a quarter of a target pixel or less keep the grid of the source from showing.
    let split = (4 * rows).div_ceil(source);
    for texel in image.cells(split) {
        let (x, y) = equirect::locate(width, height, texel.direction);
        let pixel = (y as usize).min(height - 1) * width + (x as usize).min(width - 1);
        let weighted = texel.radiance.map(|v| f64::from(v) * texel.solid_angle);
        let [r, g, b, area] = sums[pixel];
        let [dr, dg, db] = weighted;
        sums[pixel] = [r + dr, g + dg, b + db, area + texel.solid_angle];
    }
    let pixels = sums.iter().map(|s| std::array::from_fn(|c| (s[c] / s[3]) as f32));
    Probe { layout: Layout::Equirect, width, height, pixels: pixels.collect() }
}

/// Which part of a lobe is summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    Near,
    Far,
}

impl Part {
    /// Share of this part at the cosine of an angle from the lobe's middle.
    fn share(self, cos: f64) -> f64 {
        let t = ((cos - FAR_COS) / (NEAR_COS - FAR_COS)).clamp(0.0, 1.0);
        let near = t * t * (3.0 - 2.0 * t);
        match self {
            Part::All => 1.0,
            Part::Near => near,
            Part::Far => 1.0 - near,
        }
    }

    /// Whether nothing of this part lies further off than an angle of this cosine.
    fn ends_before(self, cos: f64) -> bool {
        cos <= 0.0 || (self == Part::Near && cos <= FAR_COS)
    }
}

/// Weighted sums of radiance around each pixel of a panorama, and the sum of the weights per row.
#[derive(Debug)]
struct Blurred {
    sums: Probe,
    totals: Vec<f64>,
}

impl Blurred {
    /// Adds the part of a lobe that was summed over a coarser picture.
    fn plus(mut self, coarse: Blurred) -> Blurred {
        let rows = self.sums.height;
        let added = coarse.sums.to_equirect(rows).pixels;
        for (sum, more) in self.sums.pixels.iter_mut().zip(added) {
            *sum = std::array::from_fn(|c| sum[c] + more[c]);
        }
        for (y, total) in self.totals.iter_mut().enumerate() {
            *total += coarse.totals[y * coarse.totals.len() / rows];
        }
        self
    }

    /// The means as a panorama of another number of rows.
    fn mean(mut self, rows: usize) -> Vec<[f32; 3]> {
        let width = self.sums.width;
        for (line, total) in self.sums.pixels.chunks_exact_mut(width).zip(&self.totals) {
            for pixel in line {
                *pixel = pixel.map(|sum| (f64::from(sum) / total) as f32);
            }
        }
        if self.sums.height == rows { self.sums.pixels } else { self.sums.to_equirect(rows).pixels }
    }
}

/// Blurs a panorama by a part of the lobe of width alpha.
///
/// The lobe's weight depends on the two rows and the difference of columns only, so each pair of rows is one
/// circular convolution.
fn blur(source: &Probe, alpha: f64, part: Part) -> Blurred {
    let (width, height) = (source.width, source.height);
    let rows: Vec<Row> = (0..height).map(|y| Row::new(width, height, y)).collect();
    let columns: Vec<f64> =
        (0..=width / 2).map(|x| libm::cos(std::f64::consts::TAU * x as f64 / width as f64)).collect();
    let lines: Vec<[Ring; 3]> =
        source.pixels.chunks_exact(width).map(|line| std::array::from_fn(|c| Ring::new(line, c))).collect();
    let mut pixels = Vec::with_capacity(width * height);
    let mut totals = Vec::with_capacity(height);
    let mut kernel = Vec::with_capacity(columns.len());
    for target in &rows {
        let mut sums = [vec![0.0f32; width], vec![0.0f32; width], vec![0.0f32; width]];
        let mut total = 0.0f64;
        for (from, line) in rows.iter().zip(&lines) {
            total += target.kernel(from, &columns, (alpha, part), &mut kernel);
            for (sum, channel) in sums.iter_mut().zip(line) {
                channel.convolve(&kernel, sum);
            }
        }
        totals.push(total);
        pixels.extend((0..width).map(|x| -> [f32; 3] { std::array::from_fn(|c| sums[c][x]) }));
    }
    let sums = Probe { layout: Layout::Equirect, width, height, pixels };
    Blurred { sums, totals }
}

/// Where a row of a panorama stands.
#[derive(Debug)]
struct Row {
    cos: f64,
    sin: f64,
    /// Of one pixel.
    solid_angle: f64,
}

impl Row {
    fn new(width: usize, height: usize, y: usize) -> Row {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * (y as f64 + 0.5) / height as f64);
        let solid_angle = equirect::row_solid_angle(width, height, y);
        Row { cos, sin, solid_angle }
    }

    /// Fills the weights of another row's pixels by difference of columns, up to half a turn or the lobe's end,
    /// and gives their sum over the whole row.
    fn kernel(&self, from: &Row, columns: &[f64], (alpha, part): (f64, Part), kernel: &mut Vec<f32>) -> f64 {
        kernel.clear();
        let mut total = 0.0;
        for (x, cos) in columns.iter().enumerate() {
            let mirror = self.cos * from.cos + self.sin * from.sin * cos;
            if part.ends_before(mirror) {
                break; // further columns are further away
            }
            let weight = lobe(mirror, alpha) * part.share(mirror) * from.solid_angle;
            // Straight ahead and straight behind stand once in a row, all others twice.
            let once = x == 0 || x + 1 == columns.len();
            total += if once { weight } else { 2.0 * weight };
            kernel.push(if x + 1 == columns.len() { 0.5 * weight } else { weight } as f32);
        }
        total
    }
}

/// GGX's `D(t/2) cos t` without its constant, by the cosine of the angle t from the mirror direction.
fn lobe(cos: f64, alpha: f64) -> f64 {
    if cos <= 0.0 {
        return 0.0;
    }
    let half = 0.5 * (1.0 + cos); // cos^2 (t/2)
    let base = half * (alpha * alpha - 1.0) + 1.0;
    cos / (base * base)
}

/// One channel of a row, with the row again before and after it, so that shifts need no wrapping.
#[derive(Debug)]
struct Ring {
    width: usize,
    values: Vec<f32>,
}

impl Ring {
    fn new(line: &[[f32; 3]], channel: usize) -> Ring {
        let values = line.iter().chain(line).chain(line).map(|pixel| pixel[channel]).collect();
        Ring { width: line.len(), values }
    }

    /// Adds the row, weighted by a symmetric kernel of column differences, to the sums.
    fn convolve(&self, kernel: &[f32], sums: &mut [f32]) {
        for (shift, weight) in kernel.iter().enumerate() {
            let before = &self.values[self.width - shift..][..self.width];
            let after = &self.values[self.width + shift..][..self.width];
            let weight = if shift == 0 { 0.5 * weight } else { *weight };
            for ((sum, a), b) in sums.iter_mut().zip(before).zip(after) {
                *sum += weight * (a + b);
            }
        }
    }
}
