//! The ears of a polygon: corners that can be cut off, the first of them in order, kept up to date while others go.

use glam::DVec2;
use std::collections::BTreeSet;

/// Corners in a part of the plane that is not divided further.
const LEAF: usize = 8;

/// A polygon of which ears are cut.
#[derive(Debug)]
pub(super) struct Ears<'a> {
    points: &'a [DVec2],
    /// Neighbours of each corner among those that are left.
    before: Vec<usize>,
    after: Vec<usize>,
    left: usize,
    ears: BTreeSet<usize>,
    /// Corners that would be ears but for this one.
    waiting: Vec<Vec<usize>>,
    places: Places,
}

impl<'a> Ears<'a> {
    /// For corners counter-clockwise.
    pub(super) fn of(points: &'a [DVec2]) -> Ears<'a> {
        let n = points.len();
        let mut ears = Ears {
            points,
            before: (0..n).map(|k| (k + n - 1) % n).collect(),
            after: (0..n).map(|k| (k + 1) % n).collect(),
            left: n,
            ears: BTreeSet::new(),
            waiting: vec![Vec::new(); n],
            places: Places::of(points),
        };
        (0..n).for_each(|k| ears.look(k));
        ears
    }

    /// Cuts the first ear while more than three corners are left and there is one: its neighbours about it.
    pub(super) fn cut(&mut self) -> Option<[usize; 3]> {
        if self.left <= 3 {
            return None;
        }
        // Self-crossing outlines may have none.
        let ear = self.ears.pop_first()?;
        let (before, after) = (self.before[ear], self.after[ear]);
        (self.after[before], self.before[after]) = (after, before);
        self.left -= 1;
        self.places.remove(ear);
        let waiting = std::mem::take(&mut self.waiting[ear]);
        // Marked as gone: a corner is its own neighbour only then.
        (self.before[ear], self.after[ear]) = (ear, ear);
        for corner in [before, after].into_iter().chain(waiting) {
            self.look(corner);
        }
        Some([before, ear, after])
    }

    /// What is left, in order.
    pub(super) fn rest(&self) -> Vec<usize> {
        (0..self.points.len()).filter(|&k| self.after[k] != k).collect()
    }

    /// Looks whether a corner is an ear: convex, and no other corner in its triangle.
    fn look(&mut self, corner: usize) {
        let (before, after) = (self.before[corner], self.after[corner]);
        if before == corner {
            return;
        }
        self.ears.remove(&corner);
        let [a, b, c] = [before, corner, after].map(|k| self.points[k]);
        // Not a number beside a corner that is not finite, which is no ear.
        let is_convex = area(a, b, c) > 0.0;
        if !is_convex {
            return;
        }
        match self.places.inside(self.points, [before, corner, after]) {
            Some(other) => self.waiting[other].push(corner),
            None => {
                self.ears.insert(corner);
            }
        }
    }
}

/// Twice the signed area of a triangle.
pub(super) fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Corners by where they lie: a tree of halves.
#[derive(Debug)]
struct Places {
    /// Corners so that those of each part are neighbours.
    order: Vec<usize>,
    /// Of each corner its place in `order`.
    place: Vec<usize>,
    gone: Vec<bool>,
    /// Per part, children of part k at 2k + 1 and 2k + 2: its bounds and how many corners are left in it.
    parts: Vec<Part>,
}

#[derive(Clone, Copy, Debug)]
struct Part {
    lower: DVec2,
    upper: DVec2,
    left: usize,
}

impl Places {
    fn of(points: &[DVec2]) -> Places {
        let nothing = Part { lower: DVec2::INFINITY, upper: DVec2::NEG_INFINITY, left: 0 };
        let n = points.len();
        let mut order: Vec<usize> = (0..n).collect();
        let mut parts = Vec::new();
        let mut open = vec![(0, 0..n)];
        while let Some((part, range)) = open.pop() {
            if parts.len() <= part {
                parts.resize(part + 1, nothing);
            }
            let own = &mut order[range.clone()];
            let lower = own.iter().fold(DVec2::INFINITY, |least, &k| least.min(points[k]));
            let upper = own.iter().fold(DVec2::NEG_INFINITY, |most, &k| most.max(points[k]));
            parts[part] = Part { lower, upper, left: own.len() };
            if own.len() <= LEAF {
                continue;
            }
            let across = upper.x - lower.x < upper.y - lower.y;
            let along = |k: &usize| points[*k][usize::from(across)];
            let half = own.len() / 2;
            own.select_nth_unstable_by(half, |a, b| along(a).total_cmp(&along(b)));
            let middle = range.start + half;
            open.extend([(2 * part + 1, range.start..middle), (2 * part + 2, middle..range.end)]);
        }
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(at, &k)| place[k] = at);
        Places { order, place, gone: vec![false; n], parts }
    }

    fn remove(&mut self, corner: usize) {
        self.gone[corner] = true;
        let (mut part, mut range) = (0, 0..self.order.len());
        loop {
            self.parts[part].left -= 1;
            if range.len() <= LEAF {
                return;
            }
            let middle = range.start + range.len() / 2;
            (part, range) = if self.place[corner] < middle {
                (2 * part + 1, range.start..middle)
            } else {
                (2 * part + 2, middle..range.end)
            };
        }
    }

    /// Some corner that is left inside a triangle of three corners or on its edge. Corners that touch its own, as where a hole
    /// is joined by a slit, do not count.
    fn inside(&self, points: &[DVec2], corners: [usize; 3]) -> Option<usize> {
        let [a, b, c] = corners.map(|k| points[k]);
        let (lower, upper) = (a.min(b).min(c), a.max(b).max(c));
        let holds = |p: DVec2| area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
        let counts = |&k: &usize| {
            let p = points[k];
            !self.gone[k] && !corners.contains(&k) && p != a && p != b && p != c && holds(p)
        };
        let mut open = vec![(0, 0..self.order.len())];
        while let Some((index, range)) = open.pop() {
            let part = &self.parts[index];
            if part.left == 0 || part.upper.cmplt(lower).any() || part.lower.cmpgt(upper).any() {
                continue;
            }
            if range.len() <= LEAF {
                if let Some(&found) = self.order[range].iter().find(|k| counts(k)) {
                    return Some(found);
                }
                continue;
            }
            if [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| part.is_right_of(from, to)) {
                continue;
            }
            let middle = range.start + range.len() / 2;
            open.extend([(2 * index + 1, range.start..middle), (2 * index + 2, middle..range.end)]);
        }
        None
    }
}

impl Part {
    /// Whether all of it lies to the right of a line: its corner farthest to the left does, and rounding is monotonous.
    fn is_right_of(&self, from: DVec2, to: DVec2) -> bool {
        let along = to - from;
        let x = if along.y > 0.0 { self.lower.x } else { self.upper.x };
        let y = if along.x > 0.0 { self.upper.y } else { self.lower.y };
        area(from, to, DVec2::new(x, y)) < 0.0
    }
}
