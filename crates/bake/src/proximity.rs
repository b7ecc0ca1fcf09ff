//! Which triangles and edges lie near small objects, and how long edges may be there.

use crate::small::{Cube, Object};
use glam::Vec3;

/// Distance up to which an object calls for shorter edges, in its sizes: farther off it covers little of the sky.
const REACH: f32 = 1.5;
/// Longest edge beside an object, in its sizes.
const BESIDE: f32 = 0.5;
/// Longest edge at a distance from an object, in that distance.
const GRADE: f32 = 0.5;
/// Cubes of a leaf.
const LEAF: usize = 4;

/// The cubes of small objects in a tree of boxes.
#[derive(Debug, Default)]
pub(crate) struct Proximity {
    cubes: Vec<Cube>,
    nodes: Vec<Node>,
}

/// A box around the zones of some cubes; its children are the next node and `second`.
#[derive(Debug)]
struct Node {
    min: Vec3,
    max: Vec3,
    smallest: f32,
    first: usize,
    count: usize,
    second: usize,
}

impl Proximity {
    /// Of the given cubes.
    pub(crate) fn new(mut cubes: Vec<Cube>) -> Self {
        let mut nodes = Vec::new();
        let count = cubes.len();
        if count > 0 {
            build(&mut cubes, 0..count, &mut nodes);
        }
        Self { cubes, nodes }
    }

    /// Whether there are no small objects.
    pub(crate) fn is_empty(&self) -> bool {
        self.cubes.is_empty()
    }

    /// Size of the smallest object.
    pub(crate) fn smallest(&self) -> f32 {
        self.nodes.first().map_or(f32::INFINITY, |node| node.smallest)
    }

    /// Without the objects below a size.
    pub(crate) fn above(&self, size: f32) -> Self {
        Self::new(self.cubes.iter().copied().filter(|cube| cube.size >= size).collect())
    }

    /// Whether a triangle with edges up to `longest` is too large for what stands near it: before it, or on either side. The object that it
    /// belongs to does not count.
    pub(crate) fn calls_for_split(&self, triangle: [Vec3; 3], longest: f32, two_sided: bool, own: Object) -> bool {
        let [a, b, c] = triangle;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let mut called = false;
        self.visit([a.min(b).min(c), a.max(b).max(c)], longest / BESIDE, &mut |cube| {
            let is_before = two_sided || normal.dot(cube.centre - a) > -0.5 * cube.radius();
            let distance = closest_point(triangle, cube.centre).distance(cube.centre) - cube.radius();
            called |= is_before && cube.object != own && longest > allowed(cube, distance, BESIDE);
            called
        });
        called
    }

    /// Whether an edge may be halved: it is longer than a part of the objects near its middle.
    pub(crate) fn may_halve(&self, middle: Vec3, length: f32, part: f32) -> bool {
        let mut may = false;
        self.visit([middle, middle], length / part, &mut |cube| {
            let distance = middle.distance(cube.centre) - cube.radius();
            may |= length > allowed(cube, distance, part);
            may
        });
        may
    }

    /// Visits cubes smaller than `size` whose zones a box meets, until `visit` says that it has seen enough.
    fn visit(&self, [min, max]: [Vec3; 2], size: f32, visit: &mut dyn FnMut(&Cube) -> bool) {
        let mut stack = Vec::from_iter((!self.nodes.is_empty()).then_some(0));
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index];
            if node.smallest >= size || max.cmplt(node.min).any() || min.cmpgt(node.max).any() {
                continue;
            }
            if node.second == 0 {
                if self.cubes[node.first..node.first + node.count].iter().any(&mut *visit) {
                    return;
                }
            } else {
                stack.extend([node.second, index + 1]);
            }
        }
    }
}

/// Longest edge at a distance from a cube; no bound beyond its reach.
fn allowed(cube: &Cube, distance: f32, part: f32) -> f32 {
    if distance > REACH * cube.size { f32::INFINITY } else { f32::max(part * cube.size, GRADE * distance) }
}

/// Appends the node of a range of cubes and those below it.
fn build(cubes: &mut [Cube], range: std::ops::Range<usize>, nodes: &mut Vec<Node>) {
    let own = &mut cubes[range.clone()];
    let zone = |cube: &Cube| cube.radius() + REACH * cube.size;
    let min = own.iter().map(|cube| cube.centre - zone(cube)).fold(Vec3::INFINITY, Vec3::min);
    let max = own.iter().map(|cube| cube.centre + zone(cube)).fold(Vec3::NEG_INFINITY, Vec3::max);
    let smallest = own.iter().map(|cube| cube.size).fold(f32::INFINITY, f32::min);
    let index = nodes.len();
    nodes.push(Node { min, max, smallest, first: range.start, count: range.len(), second: 0 });
    if range.len() <= LEAF {
        return;
    }
    let extent = (max - min).to_array();
    let axis = (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
    own.sort_by(|a, b| a.centre[axis].total_cmp(&b.centre[axis]));
    let middle = range.start + range.len() / 2;
    build(cubes, range.start..middle, nodes);
    nodes[index].second = nodes.len();
    build(cubes, middle..range.end, nodes);
}

/// The point of a triangle that is nearest to a point (C. Ericson, *Real-Time Collision Detection*, section 5.1.5).
fn closest_point([a, b, c]: [Vec3; 3], p: Vec3) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    a + (vb * ab + vc * ac) / (va + vb + vc)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Vec<Cube> {
        (0..30).map(|k| Cube { centre: Vec3::new(k as f32, 0.1, 0.0), size: 0.2, object: [k, 0] }).collect()
    }

    /// Through the tree as by going through all cubes.
    #[test]
    fn the_tree_finds_what_a_search_of_all_finds() {
        let (cubes, tree) = (row(), Proximity::new(row()));
        let (mut near, mut far) = (0, 0);
        for k in 0..400 {
            let (x, z) = ((k % 40) as f32 * 0.8, (k / 40) as f32 * 0.1);
            let middle = Vec3::new(x, 0.0, z);
            let all = cubes.iter().any(|cube| {
                let distance = middle.distance(cube.centre) - cube.radius();
                distance <= REACH * 0.2 && 0.15 > f32::max(0.5 * 0.2, GRADE * distance)
            });
            assert_eq!(tree.may_halve(middle, 0.15, 0.5), all, "at {middle}");
            *if all { &mut near } else { &mut far } += 1;
        }
        assert!(near > 20 && far > 20, "both happen: {near}, {far}");
    }

    /// A triangle is called for by what stands on its inside, far from its edges; not by what it belongs to, nor by what is behind it.
    #[test]
    fn a_large_triangle_is_called_for_from_its_inside() {
        let triangle = [Vec3::new(-40.0, 0.0, -40.0), Vec3::new(0.0, 0.0, 90.0), Vec3::new(80.0, 0.0, -40.0)];
        let with = |height: f32, object| {
            let cube = Cube { centre: Vec3::new(3.0, height, 4.0), size: 0.5, object };
            Proximity::new(vec![cube]).calls_for_split(triangle, 100.0, false, [7, 7])
        };
        assert!(with(0.1, [1, 0]), "it stands there");
        assert!(!with(0.1, [7, 7]), "it is its own");
        assert!(!with(-0.6, [1, 0]), "it is behind");
        assert!(!with(3.0, [1, 0]), "it is far above");
    }
}
