//! Pixels that are infinite or not a number: refused, or replaced by choice.

use crate::error::Fault;
use crate::picture::Picture;

/// What to do with pixels that are infinite or not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NonFinite {
    /// The file is refused.
    Refuse,
    /// Infinite values become the largest finite one of the picture, at least 65,504, the largest of half floats, in
    /// which suns overflow; negative infinity becomes 0. NaN becomes the mean of its finite neighbours. A warning
    /// counts them.
    Clamp,
}

/// The largest half float.
const LARGEST_HALF: f32 = 65_504.0;

/// Most rounds in which a hole of NaN is filled from its rim; what is left then becomes 0.
const ROUNDS: usize = 256;

/// Refuses or replaces what is not finite; the string is a warning.
pub(crate) fn settle(picture: &mut Picture, choice: NonFinite) -> Result<Option<String>, Fault> {
    let is_broken = |pixel: &[f32; 3]| pixel.iter().any(|v| !v.is_finite());
    let broken: Vec<usize> = (0..picture.pixels.len()).filter(|&i| is_broken(&picture.pixels[i])).collect();
    let Some(&first) = broken.first() else { return Ok(None) };
    let value = picture.pixels[first].into_iter().find(|v| !v.is_finite()).unwrap_or(f32::NAN);
    let place = format!("pixel ({}, {})", first % picture.width, first / picture.width);
    let others = match broken.len() {
        1 => String::new(),
        count => format!(" and {} other pixels are not finite", count - 1),
    };
    if choice == NonFinite::Refuse {
        return Err(Fault::NotFinite(format!(
            "{place} has radiance {value}{others}; have them clamped (to the largest finite value, or the mean of \
             neighbours for NaN), or mend the file"
        )));
    }
    let finite = picture.pixels.iter().flatten().filter(|v| v.is_finite());
    let largest = finite.fold(LARGEST_HALF, |a, b| a.max(*b));
    let count = |value: f32| broken.iter().filter(|&&i| picture.pixels[i].contains(&value)).count();
    let (infinite, negative) = (count(f32::INFINITY), count(f32::NEG_INFINITY));
    let nan: Vec<usize> = broken.iter().copied().filter(|&i| picture.pixels[i].iter().any(|v| v.is_nan())).collect();
    // Before infinite values are replaced: they are no finite neighbours.
    fill(picture, nan.clone());
    for &i in &broken {
        picture.pixels[i] = picture.pixels[i].map(|v| match v {
            f32::INFINITY => largest,
            f32::NEG_INFINITY => 0.0,
            v => v,
        });
    }
    let below = if negative > 0 { format!(", {negative} of minus infinity 0") } else { String::new() };
    Ok(Some(format!(
        "{} pixels were not finite, the first {place}: {infinite} infinite ones became {largest}{below}, {} NaN ones the mean of \
         their neighbours",
        broken.len(),
        nan.len()
    )))
}

/// Gives NaN channels the mean of the finite ones among the eight pixels around, holes from their rim inwards.
fn fill(picture: &mut Picture, mut holes: Vec<usize>) {
    let (width, height) = (picture.width as isize, picture.height as isize);
    for _ in 0..ROUNDS {
        let filled: Vec<(usize, [f32; 3])> = holes.iter().map(|&i| (i, filled(picture, width, height, i))).collect();
        for (i, pixel) in filled {
            picture.pixels[i] = pixel;
        }
        holes.retain(|&i| picture.pixels[i].iter().any(|v| v.is_nan()));
        if holes.is_empty() {
            return;
        }
    }
    for i in holes {
        picture.pixels[i] = picture.pixels[i].map(|v| if v.is_nan() { 0.0 } else { v });
    }
}

/// The pixel with what can be said of its NaN channels.
fn filled(picture: &Picture, width: isize, height: isize, i: usize) -> [f32; 3] {
    let (x, y) = (i as isize % width, i as isize / width);
    std::array::from_fn(|c| {
        let value = picture.pixels[i][c];
        if !value.is_nan() {
            return value;
        }
        let (mut sum, mut count) = (0.0f64, 0);
        for (dx, dy) in (0..9).map(|k| (k % 3 - 1, k / 3 - 1)) {
            let (x, y) = (x + dx, y + dy);
            if (0..width).contains(&x) && (0..height).contains(&y) {
                let near = picture.pixels[(y * width + x) as usize][c];
                if near.is_finite() {
                    sum += f64::from(near);
                    count += 1;
                }
            }
        }
        if count == 0 { f32::NAN } else { (sum / f64::from(count)) as f32 }
    })
}
