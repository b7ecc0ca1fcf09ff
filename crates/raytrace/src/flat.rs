//! How flat the parts of a tree are: a slab about a plane of their own, and a cone of the directions that their triangles face.
//!
//! A box about a tilted plane reaches far above it; a slab does not. So a question about that plane is answered in a few steps.

use crate::above::{Half, facing};
use crate::tree::{Child, Tree};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// Bound on the rounding of heights that are reckoned by way of a slab, over the largest coordinate in play.
const ROUNDING: f64 = 1e-12;

/// Rounding of coordinates by which corners may lie off a plane that they were meant for, over the largest coordinate.
const STEP: f64 = 1.0 / 2_097_152.0;

/// Bound on the rounding of a corner translated to an origin in single precision, over its distance along each axis.
const TRANSLATION: f64 = 1.01 / 16_777_216.0;

/// Rounding and length of normals in the comparison of a cone with a direction.
const CONE_SLACK: f64 = 1e-4;

/// What is known of every node of a tree.
#[derive(Debug)]
pub(crate) struct Flats {
    flats: Vec<Option<Flat>>,
}

/// Blocks that are looked at for each block that there is: twice the levels of a large tree in balance, few of a chain, as slivers
/// around a corner make it. What is larger is known by its parts.
const MOST_LOOKS: usize = 24;

/// Cosine from which on two planes may be one.
const NEARLY_ONE: f32 = 0.9999;

/// Planes that are taken of a node, about at right angles at best: ground, and the walls that stand on it.
const PLANES: usize = 3;

/// Directions this near to that of a plane, by the cosine, do not get one of their own.
const ALIKE: f64 = 0.9;

/// What is known of the triangles below a node.
#[derive(Clone, Copy, Debug)]
struct Flat {
    lower: Vec3,
    upper: Vec3,
    slabs: [Slab; PLANES],
    /// Mean of the directions that they face, and the cosine of the largest angle from it; -1 where that says nothing.
    axis: Vec3,
    cosine: f32,
}

/// The lowest and the highest corner along a direction, seen from a point.
#[derive(Clone, Copy, Debug, Default)]
struct Slab {
    from: Vec3,
    normal: Vec3,
    low: f32,
    high: f32,
}

impl Flats {
    /// Looks at all triangles of a tree, some times for every level that they are on, from the smallest parts to the largest.
    pub(crate) fn of(tree: &Tree) -> Flats {
        let (order, ranges) = ranges(tree);
        let mut nodes: Vec<usize> = (0..ranges.len()).collect();
        nodes.sort_by_key(|&node| ranges[node].len());
        let mut flats = vec![None; ranges.len()];
        let mut looked = 0;
        for node in nodes {
            looked += ranges[node].len();
            flats[node] = if looked <= MOST_LOOKS * order.len() {
                Some(Flat::of(tree, &order[ranges[node].clone()]))
            } else {
                // The smaller parts come first: they are known.
                Flat::around(tree, node, &flats)
            };
        }
        if !order.is_empty() {
            for slab in Flat::of(tree, &order).slabs {
                share(tree, &slab, &mut flats);
            }
        }
        Flats { flats }
    }

    /// Whether a triangle below a node may count.
    pub(crate) fn may_reach(&self, node: usize, half: &Half) -> bool {
        let Some(flat) = &self.flats[node] else {
            return true;
        };
        let least = half.least_in((flat.lower, flat.upper));
        let reaches = |slab: &Slab| flat.highest(slab, (half.from, half.normal)) > least;
        flat.slabs.iter().all(reaches) && !(half.is_faced() && flat.faces_along(half.normal))
    }
}

impl Flats {
    /// A direction along which all corners below a node lie below an origin, beyond the rounding of their translation to it.
    pub(crate) fn plane_below(&self, node: usize, origin: Vec3) -> Option<Vec3> {
        let flat = self.flats[node].as_ref()?;
        let from = origin.as_dvec3();
        let [lower, upper] = [flat.lower, flat.upper].map(|corner| (corner.as_dvec3() - from).abs());
        let (away, size) = (lower.max(upper), f64::from(flat.lower.abs().max(flat.upper.abs()).max_element()));
        flat.slabs.iter().find_map(|slab| {
            let normal = slab.normal.as_dvec3();
            let height = normal.dot(from - slab.from.as_dvec3());
            let rounding = TRANSLATION * normal.abs().dot(away) + ROUNDING * size.max(from.abs().max_element());
            let is_above = |above: f64| above > rounding;
            match (is_above(height - f64::from(slab.high)), is_above(f64::from(slab.low) - height)) {
                (true, _) => Some(slab.normal),
                (_, true) => Some(-slab.normal),
                _ => None,
            }
        })
    }
}

impl Flat {
    fn of(tree: &Tree, blocks: &[u32]) -> Flat {
        let (mut lower, mut upper, mut facings) = (Vec3::INFINITY, Vec3::NEG_INFINITY, DVec3::ZERO);
        for corners in triangles(tree, blocks) {
            corners.iter().for_each(|&p| (lower, upper) = (lower.min(p), upper.max(p)));
            facings += facing(corners);
        }
        let axis = facings.normalize_or_zero();
        let ways = triangles(tree, blocks).filter_map(|corners| facing(corners).try_normalize());
        let cosine = ways.map(|way| way.dot(axis)).fold(1.0, f64::min);
        let mut slabs = [Slab::default(); PLANES];
        for k in 0..PLANES {
            slabs[k] = Slab::of(tree, blocks, &slabs[..k]);
        }
        Flat { lower, upper, slabs, axis: axis.as_vec3(), cosine: cosine as f32 }
    }

    /// About the children of a node, by what is known of them: bounds that are not the least.
    fn around(tree: &Tree, node: usize, flats: &[Option<Flat>]) -> Option<Flat> {
        let children = tree.nodes[node].children.iter().filter(|&&child| child != Child::NONE);
        let part = |child: &Child| match child.as_block() {
            Some(block) => Some(Flat::of(tree, &[block as u32])),
            None => flats[child.index()],
        };
        let mut parts = children.map(part).collect::<Option<Vec<Flat>>>()?;
        let size = |flat: &Flat| (flat.upper - flat.lower).length_squared();
        parts.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let bounds = parts.iter().map(|part| (part.lower, part.upper));
        let (lower, upper) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let mut slabs = [Slab::default(); PLANES];
        let mut count = 0;
        for slab in parts.iter().flat_map(|part| part.slabs) {
            let is_new = slabs[..count].iter().all(|taken| f64::from(taken.normal.dot(slab.normal).abs()) <= ALIKE);
            if count < PLANES && is_new {
                slabs[count] = slab.around(&parts);
                count += 1;
            }
        }
        Some(Flat { lower, upper, slabs, axis: Vec3::ZERO, cosine: -1.0 })
    }

    /// Bound on the height of the corners above a point: by a slab along its normal, by the box across.
    fn highest(&self, slab: &Slab, (above, direction): (DVec3, DVec3)) -> f64 {
        let (normal, from) = (slab.normal.as_dvec3(), slab.from.as_dvec3());
        // direction = along * normal + across holds for any split.
        let along = direction.dot(normal);
        let across = direction - along * normal;
        let sides = (across * (self.lower.as_dvec3() - from)).max(across * (self.upper.as_dvec3() - from));
        let thick = f64::max(along * f64::from(slab.low), along * f64::from(slab.high));
        let size = f64::from(self.lower.abs().max(self.upper.abs()).max_element()).max(above.abs().max_element());
        direction.dot(from - above) + thick + sides.element_sum() + ROUNDING * size
    }

    /// Whether all triangles surely face along a direction rather than against it.
    fn faces_along(&self, direction: DVec3) -> bool {
        let cosine = f64::from(self.cosine);
        cosine > 0.0 && self.axis.as_dvec3().dot(direction) > (1.0 - cosine * cosine).max(0.0).sqrt() + CONE_SLACK
    }
}

impl Slab {
    /// About the plane of the largest triangle that lies in no direction of `others`.
    fn of(tree: &Tree, blocks: &[u32], others: &[Slab]) -> Slab {
        let mut largest = (0.0, [Vec3::ZERO; 3]);
        for corners in triangles(tree, blocks) {
            let way = facing(corners);
            let area = way.length();
            let taken = |slab: &Slab| slab.normal.as_dvec3().dot(way).abs() > ALIKE * area;
            if area > largest.0 && !others.iter().any(taken) {
                largest = (area, corners);
            }
        }
        let from = largest.1[0];
        let normal = plane(tree, blocks, largest.1).as_vec3();
        let heights = triangles(tree, blocks).flatten().map(|p| normal.as_dvec3().dot(p.as_dvec3() - from.as_dvec3()));
        let (low, high) = heights.fold((0.0, 0.0), |(low, high), h| (f64::min(low, h), f64::max(high, h)));
        Slab { from, normal, low: (low as f32).next_down(), high: (high as f32).next_up() }
    }

    fn thickness(&self) -> f64 {
        f64::from(self.high) - f64::from(self.low)
    }
}

impl Slab {
    /// About the same plane, around all parts.
    fn around(self, parts: &[Flat]) -> Slab {
        let (from, normal) = (self.from.as_dvec3(), self.normal.as_dvec3());
        let bound = |direction: DVec3| {
            let least = |part: &Flat| {
                part.slabs.iter().map(|slab| part.highest(slab, (from, direction))).fold(f64::INFINITY, f64::min)
            };
            parts.iter().map(least).fold(0.0, f64::max)
        };
        Slab { low: (-bound(-normal) as f32).next_down(), high: (bound(normal) as f32).next_up(), ..self }
    }
}

/// Gives a plane to all parts of a tree that lie in it: a sliver alone tells badly how its plane leans.
fn share(tree: &Tree, plane: &Slab, flats: &mut [Option<Flat>]) {
    let (from, normal) = (plane.from.as_dvec3(), plane.normal.as_dvec3());
    let mut ends = vec![(0.0, 0.0); flats.len()];
    // Children stand after their parents.
    for node in (0..flats.len()).rev() {
        let children = tree.nodes[node].children.iter().filter(|&&child| child != Child::NONE);
        let around = |(low, high): (f64, f64), child: &Child| match child.as_block() {
            Some(block) => {
                let one = [block as u32];
                let heights = triangles(tree, &one).flatten().map(|p| normal.dot(p.as_dvec3() - from));
                heights.fold((low, high), |(low, high), h| (low.min(h), high.max(h)))
            }
            None => (low.min(ends[child.index()].0), high.max(ends[child.index()].1)),
        };
        let (low, high) = children.fold((0.0, 0.0), around);
        ends[node] = (low, high);
        let Some(flat) = &mut flats[node] else { continue };
        let size = f64::from(flat.lower.abs().max(flat.upper.abs()).max_element());
        let alike = |slab: &&mut Slab| slab.normal.dot(plane.normal).abs() > NEARLY_ONE;
        if let Some(slab) = flat.slabs.iter_mut().find(alike)
            && high - low <= slab.thickness() + 4.0 * STEP * size
        {
            *slab = Slab { low: (low as f32).next_down(), high: (high as f32).next_up(), ..*plane };
        }
    }
}

/// A unit normal of the plane of a triangle and of all corners that lie in it for all that single precision can tell; small
/// triangles alone would tell it badly, far from the origin above all.
fn plane(tree: &Tree, blocks: &[u32], corners: [Vec3; 3]) -> DVec3 {
    let from = corners[0].as_dvec3();
    let way = facing(corners);
    let normal = way.normalize_or(DVec3::Y);
    let longest = (corners[1] - corners[0]).length().max((corners[2] - corners[0]).length());
    let rounding = STEP * f64::from(corners[0].abs().max_element());
    // A corner off by its rounding turns the plane by that over the triangle's height.
    let turn = rounding * f64::from(longest) / way.length().max(f64::MIN_POSITIVE);
    let within = |away: &DVec3| away.dot(normal).abs() <= rounding + turn * away.length();
    let farthest = |measure: &dyn Fn(DVec3) -> f64| {
        let aways = triangles(tree, blocks).flatten().map(|p| p.as_dvec3() - from).filter(within);
        aways.fold((0.0, DVec3::ZERO), |best, away| {
            let amount = measure(away);
            if amount > best.0 { (amount, away) } else { best }
        })
    };
    let (_, first) = farthest(&|away| away.length_squared());
    let line = first.normalize_or_zero();
    let (_, second) = farthest(&|away| line.cross(away).length_squared());
    first.cross(second).normalize_or(normal)
}

fn triangles<'a>(tree: &'a Tree, blocks: &'a [u32]) -> impl Iterator<Item = [Vec3; 3]> + 'a {
    blocks.iter().map(|&index| &tree.blocks[index as usize]).flat_map(|block| {
        let lanes = (0..4).filter(|lane| block.valid >> lane & 1 == 1);
        lanes.map(|lane| block.corners(lane))
    })
}

/// The blocks in an order in which those below each node are neighbours, and their range for each node.
fn ranges(tree: &Tree) -> (Vec<u32>, Vec<Range<usize>>) {
    let children = |node: usize| tree.nodes[node].children.iter().filter(|&&child| child != Child::NONE);
    let mut counts = vec![0usize; tree.nodes.len()];
    // Children stand after their parents.
    for node in (0..tree.nodes.len()).rev() {
        counts[node] = children(node).map(|c| if c.as_block().is_some() { 1 } else { counts[c.index()] }).sum();
    }
    let mut order = vec![0; counts.first().copied().unwrap_or(0)];
    let mut firsts = vec![0; tree.nodes.len()];
    for node in 0..tree.nodes.len() {
        let mut next = firsts[node];
        for child in children(node) {
            match child.as_block() {
                Some(block) => {
                    order[next] = block as u32;
                    next += 1;
                }
                None => {
                    firsts[child.index()] = next;
                    next += counts[child.index()];
                }
            }
        }
    }
    let ranges = firsts.iter().zip(&counts).map(|(&first, &count)| first..first + count).collect();
    (order, ranges)
}
