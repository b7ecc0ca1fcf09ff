//! Names beside points, moved until none covers another.

/// A box in pixels: left, top, right, bottom.
pub(super) type Area = [i32; 4];

/// Pixels between a point and its label.
const GAP: i32 = 7;

/// Where the label of each point goes: the left upper corner of a box of its size.
///
/// Takes the first place around the point that is inside `frame` and free of other labels, of all points and of the line
/// through the corners `line`; where there is none, the first place.
pub(super) fn place(points: &[(i32, i32)], sizes: &[(i32, i32)], line: &[(i32, i32)], frame: Area) -> Vec<(i32, i32)> {
    let marks = points.iter().map(|(x, y)| [x - 5, y - 5, x + 5, y + 5]);
    let mut taken: Vec<Area> = marks.collect();
    // level and upright pieces only, so that the box of a piece is the piece
    taken.extend(line.windows(2).map(|ends| {
        let [(a, b), (c, d)] = [ends[0], ends[1]];
        [a.min(c) - 2, b.min(d) - 2, a.max(c) + 2, b.max(d) + 2]
    }));
    let mut corners = Vec::with_capacity(points.len());
    for (point, size) in points.iter().zip(sizes) {
        let area = |(x, y): (i32, i32)| [x, y, x + size.0, y + size.1];
        let free =
            |corner: &(i32, i32)| inside(area(*corner), frame) && !taken.iter().any(|t| overlap(area(*corner), *t));
        let corner = candidates(*point, *size).find(free).unwrap_or((point.0 + GAP, point.1 - size.1 / 2));
        taken.push(area(corner));
        corners.push(corner);
    }
    corners
}

/// Places around a point: right, left, above, below, and the same further off.
fn candidates((x, y): (i32, i32), (width, height): (i32, i32)) -> impl Iterator<Item = (i32, i32)> {
    let ring = move |step: i32| {
        let (up, down) = (y - height / 2 - step, y - height / 2 + step);
        let (right, left) = (x + GAP, x - GAP - width);
        [(right, up), (left, up), (right, down), (left, down), (x - width / 2, up - GAP), (x - width / 2, down + GAP)]
    };
    (0..8).flat_map(move |n| ring(n * height / 2))
}

fn inside(a: Area, frame: Area) -> bool {
    a[0] >= frame[0] && a[1] >= frame[1] && a[2] <= frame[2] && a[3] <= frame[3]
}

fn overlap(a: Area, b: Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Area = [0, 0, 400, 300];
    const SIZE: (i32, i32) = (60, 14);

    fn areas(corners: &[(i32, i32)]) -> Vec<Area> {
        corners.iter().map(|(x, y)| [*x, *y, x + SIZE.0, y + SIZE.1]).collect()
    }

    #[test]
    fn labels_of_a_crowd_keep_apart() {
        let points = [(100, 100), (104, 101), (108, 99), (390, 150), (200, 290)];
        let placed = areas(&place(&points, &[SIZE; 5], &[(100, 100), (300, 100)], FRAME));
        for (i, a) in placed.iter().enumerate() {
            assert!(inside(*a, FRAME), "label {i} leaves the frame: {a:?}");
            assert!(!overlap(*a, [100, 99, 300, 101]), "label {i} lies on the line: {a:?}");
            assert!(placed[..i].iter().all(|b| !overlap(*a, *b)), "label {i} covers another: {placed:?}");
        }
    }

    /// Without moving them two of the labels lie upon each other and the line, and one leaves the frame.
    #[test]
    fn labels_left_where_they_are_can_fail() {
        let [a, b] = [(107, 93), (111, 94)].map(|(x, y)| [x, y, x + SIZE.0, y + SIZE.1]);
        assert!(overlap(a, b) && overlap(a, [100, 99, 300, 101]));
        assert!(!inside([397, 143, 457, 157], FRAME));
    }
}
