//! Which cells of a grid a triangle touches.

use glam::DVec2;

/// Calls `visit` with column and row of every cell of a `size` grid that shares more than an edge with a triangle, given in units
/// of cells; cells outside the grid are left out. A triangle on a line still visits the cells that it runs through.
pub(crate) fn cover(triangle: [DVec2; 3], size: [u32; 2], visit: &mut dyn FnMut(u32, u32)) {
    if !triangle.iter().all(|p| p.is_finite()) {
        return;
    }
    let ys = triangle.map(|p| p.y);
    let (low, high) = extremes(ys.into_iter());
    for row in cells(low, high, size[1]) {
        let band = [f64::from(row), f64::from(row) + 1.0];
        let (left, right) = extremes(within(triangle, band).into_iter().flatten());
        if left <= right {
            cells(left, right, size[0]).for_each(|column| visit(column, row));
        }
    }
}

/// Cells from the one that `low` lies in to the one that ends at `high` or after it.
fn cells(low: f64, high: f64, count: u32) -> std::ops::Range<u32> {
    let first = low.floor().max(0.0);
    let end = high.ceil().max(low.floor() + 1.0).min(f64::from(count));
    // Negative and beyond the grid saturate.
    first.min(f64::from(count)) as u32..end.max(0.0) as u32
}

/// Abscissas of the corners within a band of rows, and of where edges cross its two borders.
fn within(triangle: [DVec2; 3], band: [f64; 2]) -> [Option<f64>; 9] {
    let mut found = [None; 9];
    for k in 0..3 {
        let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
        if (band[0]..=band[1]).contains(&a.y) {
            found[3 * k] = Some(a.x);
        }
        for (i, border) in band.into_iter().enumerate() {
            if (a.y < border) != (b.y < border) {
                // Between the ends even where rounding would leave them.
                let x = a.x + (b.x - a.x) * ((border - a.y) / (b.y - a.y));
                found[3 * k + 1 + i] = Some(x.clamp(a.x.min(b.x), a.x.max(b.x)));
            }
        }
    }
    found
}

fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

#[cfg(test)]
mod tests {
    use super::cover;
    use glam::DVec2;
    use std::collections::BTreeSet;

    fn covered(triangle: [DVec2; 3], size: [u32; 2]) -> BTreeSet<(u32, u32)> {
        let mut cells = BTreeSet::new();
        cover(triangle, size, &mut |x, y| assert!(cells.insert((x, y)), "cell {x}, {y} twice"));
        cells
    }

    /// Numbers that repeat: a multiplicative congruence.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1u64 << 31) as f64
        }
    }

    /// Against a fine raster of points of the triangle: each lies in a visited cell, and nearly every visited cell holds one.
    #[test]
    fn visits_every_cell_that_the_triangle_enters() {
        let mut next = numbers(1);
        for _ in 0..200 {
            let triangle = [(); 3].map(|()| DVec2::new(12.0 * next() - 2.0, 12.0 * next() - 2.0));
            let cells = covered(triangle, [8, 8]);
            let mut seen = BTreeSet::new();
            let [a, b, c] = triangle;
            for i in 0..=400 {
                for j in 0..=400 - i {
                    let p = a + (b - a) * (f64::from(i) / 400.0) + (c - a) * (f64::from(j) / 400.0);
                    let inside = p.x > 0.0 && p.y > 0.0 && p.x < 8.0 && p.y < 8.0;
                    if inside && p.fract().min_element() > 1e-9 {
                        seen.insert((p.x as u32, p.y as u32));
                    }
                }
            }
            assert!(seen.is_subset(&cells), "{triangle:?}: {:?} missed", seen.difference(&cells).next());
            assert!(cells.len() - seen.len() <= 4, "{triangle:?}: {:?}", cells.difference(&seen));
        }
    }

    #[test]
    fn whole_cells_have_no_neighbours() {
        let square = [DVec2::new(1.0, 1.0), DVec2::new(3.0, 1.0), DVec2::new(1.0, 3.0)];
        let expected = BTreeSet::from([(1, 1), (2, 1), (1, 2)]);
        assert!(expected.is_subset(&covered(square, [8, 8])));
        assert!(covered(square, [8, 8]).iter().all(|&(x, y)| (1..3).contains(&x) && (1..3).contains(&y)));
    }

    #[test]
    fn odd_triangles_are_taken_as_they_are() {
        let point = DVec2::new(2.5, 3.5);
        assert_eq!(covered([point; 3], [8, 8]), BTreeSet::from([(2, 3)]));
        let line = [DVec2::new(0.5, 0.5), DVec2::new(6.5, 0.5), DVec2::new(3.5, 0.5)];
        assert_eq!(covered(line, [8, 8]).len(), 7);
        assert!(covered([DVec2::new(-5.0, -5.0); 3], [8, 8]).is_empty());
        assert!(covered([DVec2::new(9.0, 1.0), DVec2::new(1e30, 2.0), DVec2::new(9.0, 2.0)], [8, 8]).is_empty());
        assert!(covered([DVec2::new(f64::NAN, 1.0); 3], [8, 8]).is_empty());
        let huge = [DVec2::new(-1e9, -1e9), DVec2::new(1e9, -1e9), DVec2::new(0.0, 1e9)];
        assert_eq!(covered(huge, [8, 8]).len(), 64);
    }
}
