//! Glow of bright places: a pyramid of blurred pictures mixed into the picture.

use rayon::prelude::*;

/// Most levels of the pyramid.
const MAX_LEVELS: u32 = 8;

/// A linear picture, row by row.
#[derive(Debug, Clone)]
struct Plane {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

/// Mixes `strength` of the blurred picture into the picture; a constant picture stays as it is.
pub(crate) fn apply(width: usize, height: usize, pixels: &mut [[f32; 3]], strength: f32) {
    let levels = (width.min(height).max(1).ilog2()).saturating_sub(3).clamp(1, MAX_LEVELS);
    let mut pyramid = vec![halved(width, height, pixels)];
    for _ in 1..levels {
        let last = &pyramid[pyramid.len() - 1];
        pyramid.push(halved(last.width, last.height, &last.pixels));
    }
    while pyramid.len() > 1 {
        let (Some(coarse), Some(fine)) = (pyramid.pop(), pyramid.last_mut()) else {
            break;
        };
        let (width, height) = (fine.width, fine.height);
        add_doubled(&coarse, width, height, &mut fine.pixels, |here, glow| here + glow);
    }
    let share = 1.0 / levels as f32;
    add_doubled(&pyramid[0], width, height, pixels, |here, glow| (1.0 - strength) * here + strength * (share * glow));
}

/// Half the columns and rows, rounded up, through the kernel (1, 3, 3, 1)/8 along each axis.
fn halved(width: usize, height: usize, pixels: &[[f32; 3]]) -> Plane {
    let (half_width, half_height) = (width.div_ceil(2), height.div_ceil(2));
    let mut out = vec![[0.0; 3]; half_width * half_height];
    out.par_chunks_mut(half_width).enumerate().for_each_init(
        || vec![[0.0; 3]; width],
        |column_sums, (y, row)| {
            let lines = taps(y, height).map(|j| &pixels[j * width..(j + 1) * width]);
            for (x, sum) in column_sums.iter_mut().enumerate() {
                *sum = weighted(lines.map(|line| line[x]));
            }
            for (x, out) in row.iter_mut().enumerate() {
                *out = weighted(taps(x, width).map(|i| column_sums[i]));
            }
        },
    );
    Plane { width: half_width, height: half_height, pixels: out }
}

/// The four fine samples that make coarse sample `x`.
fn taps(x: usize, size: usize) -> [usize; 4] {
    [(2 * x).saturating_sub(1), 2 * x, 2 * x + 1, 2 * x + 2].map(|i| i.min(size - 1))
}

fn weighted([a, b, c, d]: [[f32; 3]; 4]) -> [f32; 3] {
    std::array::from_fn(|k| 0.125 * (a[k] + d[k]) + 0.375 * (b[k] + c[k]))
}

/// Enlarges `coarse` twofold between its texels and combines each value with the pixel that stands there.
fn add_doubled(
    coarse: &Plane,
    width: usize,
    height: usize,
    pixels: &mut [[f32; 3]],
    combine: impl Fn(f32, f32) -> f32 + Sync,
) {
    debug_assert_eq!(pixels.len(), width * height, "the picture has the size that is given");
    pixels.par_chunks_mut(width).enumerate().for_each_init(
        || vec![[0.0; 3]; coarse.width],
        |line, (y, row)| {
            let [near, far] = parents(y, coarse.height).map(|j| &coarse.pixels[j * coarse.width..][..coarse.width]);
            for (x, out) in line.iter_mut().enumerate() {
                *out = mixed(near[x], far[x]);
            }
            for (x, pixel) in row.iter_mut().enumerate() {
                let [near, far] = parents(x, coarse.width);
                let glow = mixed(line[near], line[far]);
                *pixel = std::array::from_fn(|k| combine(pixel[k], glow[k]));
            }
        },
    );
}

/// The coarse samples of fine sample `x`: the one that holds it, then the next nearest.
fn parents(x: usize, coarse: usize) -> [usize; 2] {
    let near = x / 2;
    let far = if x.is_multiple_of(2) { near.saturating_sub(1) } else { near + 1 };
    [near, far.min(coarse - 1)]
}

fn mixed(near: [f32; 3], far: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|k| 0.75 * near[k] + 0.25 * far[k])
}
