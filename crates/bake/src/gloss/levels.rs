//! Lower levels of detail: each texel averages those of one chart, so no chart bleeds into another (\[T\] section 7 asks for mip-maps).

use crate::maps::plate::{NONE, Plate};

/// Fewest texels along the longer side of a level.
const SMALLEST: usize = 4;
/// Share of the finest texels that may lie in a texel of another chart: beyond it a level is not made.
const MOST_STRANGERS: f64 = 0.02;

/// The levels below the finest, which is not among them, with rings of `dilation` texels around charts.
pub(crate) fn below(finest: &Plate, dilation: u32) -> Vec<Plate> {
    let mut levels: Vec<Plate> = Vec::new();
    // Of each texel of the finest level that a surface touches its chart.
    loop {
        let above = levels.last().unwrap_or(finest);
        // Renderers' own levels are exact halves.
        let odd = !above.width.is_multiple_of(2) || !above.height.is_multiple_of(2);
        if odd || above.width.max(above.height) <= SMALLEST {
            return levels;
        }
        let mut next = halved(above);
        let step = levels.len() + 1;
        if strangers(finest, &next, step) > MOST_STRANGERS {
            return levels;
        }
        (0..dilation.min(1)).for_each(|_| next.dilate());
        levels.push(next);
    }
}

/// Half the columns and rows, rounded up. Of the charts in a texel the one with most texels above counts, of as many the first.
fn halved(above: &Plate) -> Plate {
    let [width, height] = [above.width.div_ceil(2), above.height.div_ceil(2)];
    let mut plate = Plate::empty([width, height], above.row_len);
    for texel in 0..width * height {
        let (x, y) = (texel % width, texel / width);
        let quad = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| (2 * x + dx, 2 * y + dy));
        let inside = quad.into_iter().filter(|&(x, y)| x < above.width && y < above.height);
        let slots: Vec<u32> =
            inside.map(|(x, y)| above.slot_of[y * above.width + x]).filter(|&slot| slot != NONE).collect();
        let Some(chart) = most(slots.iter().map(|&slot| above.chart_of[slot as usize])) else { continue };
        let own: Vec<u32> = slots.into_iter().filter(|&slot| above.chart_of[slot as usize] == chart).collect();
        plate.add_slot(texel, chart);
        let share = 1.0 / own.len() as f32;
        let start = plate.values.len();
        plate.values.resize(start + above.row_len, 0.0);
        for slot in own {
            let row = &above.values[slot as usize * above.row_len..][..above.row_len];
            plate.values[start..].iter_mut().zip(row).for_each(|(sum, value)| *sum += share * value);
        }
    }
    plate
}

/// The most frequent number, of several the smallest.
fn most(numbers: impl Iterator<Item = u32>) -> Option<u32> {
    let mut sorted: Vec<u32> = numbers.collect();
    sorted.sort_unstable();
    let groups = sorted.chunk_by(|a, b| a == b);
    groups.max_by_key(|group| (group.len(), std::cmp::Reverse(group[0]))).map(|group| group[0])
}

/// Share of the finest texels on surfaces that lie in a texel of another chart `step` levels below.
fn strangers(finest: &Plate, level: &Plate, step: usize) -> f64 {
    let (mut all, mut lost) = (0u64, 0u64);
    for slot in 0..finest.slots() {
        // Rings that were filled are no surface.
        if finest.model_of[slot] as usize != slot {
            continue;
        }
        let texel = finest.texel_of[slot] as usize;
        let (x, y) = ((texel % finest.width) >> step, (texel / finest.width) >> step);
        let below = level.slot_of[y.min(level.height - 1) * level.width + x.min(level.width - 1)];
        all += 1;
        lost += u64::from(below == NONE || level.chart_of[below as usize] != finest.chart_of[slot]);
    }
    if all == 0 { 0.0 } else { lost as f64 / all as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two charts side by side, `gap` empty columns apart; a chart's texels hold its number.
    fn two(side: usize, gap: usize) -> Plate {
        let mut plate = Plate::empty([2 * side + gap, side], 1);
        for row in 0..side {
            for column in (0..side).chain(side + gap..2 * side + gap) {
                let chart = u32::from(column >= side);
                plate.add_slot(row * (2 * side + gap) + column, chart);
                plate.values.push(chart as f32);
            }
        }
        plate
    }

    #[test]
    fn no_texel_of_any_level_mixes_charts() {
        let finest = two(16, 4);
        let levels = below(&finest, 1);
        assert!(levels.len() >= 2, "{}", levels.len());
        for level in &levels {
            for slot in 0..level.slots() {
                assert_eq!(level.values[slot], level.chart_of[slot] as f32);
            }
        }
        assert_eq!([levels[0].width, levels[0].height], [18, 8]);
        // Averaged without regard to charts a texel would hold a mixture.
        let blind = (finest.values.iter().sum::<f32>()) / finest.values.len() as f32;
        assert!(blind > 0.4 && blind < 0.6, "can fail: {blind}");
    }

    #[test]
    fn levels_end_where_charts_would_be_lost() {
        // Charts of one column each: one of two is lost at once.
        let mut thin = Plate::empty([16, 16], 1);
        for row in 0..16 {
            for column in 0..16 {
                thin.add_slot(row * 16 + column, column as u32);
                thin.values.push(1.0);
            }
        }
        assert!(below(&thin, 1).is_empty());
        assert_eq!(below(&two(16, 16), 1).len(), 4, "can fail: wide charts have levels down to a few texels");
    }

    #[test]
    fn a_level_keeps_the_mean() {
        let mut plate = Plate::empty([4, 2], 1);
        for texel in 0..8 {
            plate.add_slot(texel, 0);
            plate.values.push(texel as f32);
        }
        assert_eq!(halved(&plate).values, [2.5, 4.5]);
    }
}
