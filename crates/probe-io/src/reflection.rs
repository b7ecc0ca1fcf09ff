//! The light as rough surfaces mirror it: panoramas blurred by the GGX lobe, one per roughness.
//!
//! Level k holds perceptual roughness `k / (levels - 1)`, with GGX's width `alpha = roughness^2` (B. Walter et al.,
//! "Microfacet Models for Refraction", 2007). The lobe is taken head-on (normal = view = mirror direction), as in
//! B. Karis, "Real Shading in Unreal Engine 4", 2013: light from an angle t off the mirror direction counts as
//! `D(t/2) cos t`, normalised. Sums run over all texels, so no sample noise and no lost suns.

use crate::{Environment, Layout, Probe, equirect};
use glam::Vec3;

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
/// Rows of the coarsest picture that is blurred.
const MIN_ROWS: usize = 32;
/// Rows per radian of the lobe's width: the lobe's core spans about this many texels.
const ROWS_PER_WIDTH: f64 = 12.0;

impl Reflection {
    /// Blurs an environment into `levels` panoramas of `width` by `width / 2` pixels (at least 1 and 2 by 1).
    pub fn build(environment: &Environment, levels: usize, width: usize) -> Reflection {
        let height = (width / 2).max(1);
        let levels = levels.max(1);
        let sharp = flatten(environment, height);
        let blurred = (0..levels).map(|k| {
            let roughness = k as f64 / (levels - 1).max(1) as f64;
            let alpha = roughness * roughness;
            if alpha == 0.0 {
                return sharp.pixels.clone();
            }
            let rows = libm::ceil(ROWS_PER_WIDTH / alpha).min(MAX_ROWS as f64) as usize;
            let rows = rows.next_power_of_two().clamp(MIN_ROWS, MAX_ROWS.min(height.max(MIN_ROWS)));
            let source = flatten(environment, rows);
            let level = blur(&source, alpha);
            resample(&level, height)
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

/// Blurs a panorama by the lobe of width alpha.
///
/// The lobe's weight depends on the two rows and the difference of columns only, so each pair of rows is one
/// circular convolution.
fn blur(source: &Probe, alpha: f64) -> Probe {
    let (width, height) = (source.width, source.height);
    let rows: Vec<Row> = (0..height).map(|y| Row::new(width, height, y)).collect();
    let columns: Vec<f64> = (0..width).map(|x| libm::cos(std::f64::consts::TAU * x as f64 / width as f64)).collect();
    let mut pixels = vec![[0.0f32; 3]; width * height];
    let mut kernel = vec![0.0f32; width];
    for (y, target) in rows.iter().enumerate() {
        let mut sums = vec![[0.0f32; 3]; width];
        let mut total = 0.0f64;
        for (k, from) in rows.iter().enumerate() {
            let mut reach = 0;
            for (x, cos) in columns.iter().enumerate().take(width / 2 + 1) {
                let mirror = target.cos * from.cos + target.sin * from.sin * cos;
                let weight = lobe(mirror, alpha) * from.solid_angle;
                kernel[x] = weight as f32;
                if weight > 0.0 {
                    reach = x + 1;
                    let both = if x == 0 || 2 * x == width { 1.0 } else { 2.0 };
                    total += both * weight;
                }
            }
            let line = &source.pixels[k * width..(k + 1) * width];
            convolve(line, &kernel[..reach], &mut sums);
        }
        for (pixel, sum) in pixels[y * width..].iter_mut().zip(&sums) {
            *pixel = sum.map(|s| (f64::from(s) / total) as f32);
        }
    }
    Probe { layout: Layout::Equirect, width, height, pixels }
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

/// Adds a line, weighted by a symmetric kernel of column differences, to the sums.
fn convolve(line: &[[f32; 3]], kernel: &[f32], sums: &mut [[f32; 3]]) {
    let width = line.len();
    for (shift, weight) in kernel.iter().enumerate() {
        let left = (width - shift) % width;
        for start in if shift == left { vec![shift] } else { vec![shift, left] } {
            let (tail, head) = line.split_at(start);
            for (sum, value) in sums.iter_mut().zip(head.iter().chain(tail)) {
                for c in 0..3 {
                    sum[c] += weight * value[c];
                }
            }
        }
    }
}

/// A blurred panorama at another number of rows.
fn resample(level: &Probe, rows: usize) -> Vec<[f32; 3]> {
    if level.height == rows {
        return level.pixels.clone();
    }
    level.to_equirect(rows).pixels
}
