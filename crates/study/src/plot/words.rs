//! Where the words of a plot find room: beside their points, clear of marks and of each other.

use super::chart::{LEGEND, SIZE};

/// Letters of labels, in pixels: size, and the mean width of one.
pub(super) const LETTER: (i32, i32) = (15, 7);

/// Frames of words beside a point, the best first: left, right, top, bottom.
pub(super) fn places((x, y): (i32, i32), width: i32) -> Vec<[i32; 4]> {
    let high = LETTER.0 / 2 + 1;
    let mut frames = Vec::new();
    for away in [15, 28] {
        for up in [-away, away] {
            for left in [x + 8, x - 8 - width, x - width / 2] {
                frames.push([left, left + width, y + up - high, y + up + high]);
            }
        }
    }
    frames.push([x + 14, x + 14 + width, y - high, y + high]);
    frames.push([x - 14 - width, x - 14, y - high, y + high]);
    frames
}

/// Whether a frame lies within the plot.
pub(super) fn is_inside([left, right, top, bottom]: [i32; 4]) -> bool {
    left > 80 && right < (SIZE.0 - LEGEND) as i32 - 6 && top > 8 && bottom < SIZE.1 as i32 - 60
}

/// Whether a frame keeps clear of others.
pub(super) fn is_free(frame: [i32; 4], taken: &[[i32; 4]]) -> bool {
    let apart = |b: &[i32; 4]| frame[1] < b[0] || b[1] < frame[0] || frame[3] < b[2] || b[3] < frame[2];
    taken.iter().all(apart)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No word of the plot lies on a point or on another word, and the legend keeps out of the plot.
    #[test]
    fn words_keep_clear_of_points() {
        let taken = [[100, 112, 100, 112], [100, 112, 130, 142]];
        let free =
            places((106, 106), 70).into_iter().find(|frame| is_inside(*frame) && is_free(*frame, &taken)).unwrap();
        assert!(is_free(free, &taken));
        assert!(!is_free([90, 160, 98, 114], &taken), "can fail: words upon the point");
        assert!(!is_inside([600, 700, 100, 116]), "can fail: words upon the legend");
    }
}
