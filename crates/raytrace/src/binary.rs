//! The binary tree over triangles: pairs of neighbours, or halves where those would be found one pair at a time.
//!
//! Boxes pair where each is the other's best neighbour (D. Meister, J. Bittner, *Parallel Locally-Ordered Clustering for Bounding Volume
//! Hierarchy Construction*, 2018). Of an even row of boxes each is as good a neighbour as the other, of a growing one the smaller is better for all:
//! one pair is found in a round then, and a row of 20,000 pickets takes 20,000 rounds.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::morton::morton_encode_u64;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::splits::split_aabbs_preset;
use obvhs::triangle::Triangle;

/// Largest number of references per triangle that splitting large triangles may make.
const MOST_SPLITS: usize = 3;
/// Boxes on either side among which the best neighbour is looked for, as obvhs does under that name.
const DISTANCE: PlocSearchDistance = PlocSearchDistance::Medium;
const NEIGHBOURS: usize = 14;
/// So few boxes may pair one by one.
const FEW: usize = 1024;
/// Boxes that are looked at in all rounds, for each that there is, from which on pairing is slow. Most scenes take 3 to 5.
const SLOW: usize = 12;
/// So few boxes pair in a moment, however many rounds they take.
const PAIRED: usize = 256;
/// Least part of the boxes on either side of a cut, so that halves of halves come to an end soon.
const LEAST_PART: usize = 8;

/// Over triangles, one reference to one of them per leaf; large triangles have several.
pub(crate) fn binary_tree(triangles: &[Triangle]) -> Bvh2 {
    let (boxes, numbers) = references(triangles);
    let splits = boxes.len() > triangles.len();
    let mut tree = if looks(&boxes, SLOW * boxes.len()) >= SLOW * boxes.len() {
        halved(&boxes, numbers)
    } else {
        PlocBuilder::with_capacity(boxes.len()).build(DISTANCE, &boxes, numbers, SortPrecision::U128, 1)
    };
    tree.uses_spatial_splits = splits;
    ReinsertionOptimizer::default().run(&mut tree, 1.0, None);
    tree
}

/// The boxes of triangles, and whose they are; large triangles are split, unless there are too many.
fn references(triangles: &[Triangle]) -> (Vec<Aabb>, Vec<u32>) {
    let whole: Vec<Aabb> = triangles.iter().map(Triangle::aabb).collect();
    let own: Vec<u32> = (0..triangles.len() as u32).collect();
    let (mut largest, mut sum) = (0.0f32, 0.0f32);
    for one in &whole {
        largest = one.half_area().max(largest);
        sum += one.half_area();
    }
    let (mut boxes, mut numbers) = (whole.clone(), own.clone());
    split_aabbs_preset(&mut boxes, &mut numbers, triangles, sum / triangles.len() as f32, largest);
    if boxes.len() <= MOST_SPLITS * triangles.len() + 64 { (boxes, numbers) } else { (whole, own) }
}

/// Boxes that pairing looks at in all its rounds, until few are left or `most` were looked at.
fn looks(boxes: &[Aabb], most: usize) -> usize {
    let mut left: Vec<Aabb> = along_curve(boxes).into_iter().map(|index| boxes[index]).collect();
    let mut looked = 0;
    let mut best = Vec::new();
    while left.len() > FEW && looked < most {
        looked += left.len();
        best.clear();
        best.extend((0..left.len()).map(|index| best_neighbour(&left, index)));
        let mut paired = Vec::with_capacity(left.len());
        for (index, &other) in best.iter().enumerate() {
            match best[other] == index {
                true if other > index => paired.push(left[index].union(&left[other])),
                true => {}
                false => paired.push(left[index]),
            }
        }
        left = paired;
    }
    looked
}

/// The neighbour with which a box makes the smallest one; the last of those that are as good.
fn best_neighbour(boxes: &[Aabb], index: usize) -> usize {
    let near = index.saturating_sub(NEIGHBOURS)..(index + NEIGHBOURS + 1).min(boxes.len());
    let mut best = (f32::INFINITY, index);
    for other in near.filter(|&other| other != index) {
        let area = boxes[index].union(&boxes[other]).half_area();
        if area <= best.0 {
            best = (area, other);
        }
    }
    best.1
}

/// Numbers of boxes along a Morton curve through their middles.
fn along_curve(boxes: &[Aabb]) -> Vec<usize> {
    let all = boxes.iter().fold(Aabb::empty(), |all, one| all.union(one));
    let scale = 2_097_151.0 / all.diagonal().max(Vec3A::splat(f32::MIN_POSITIVE)).as_dvec3();
    let mut keyed: Vec<(u64, usize)> = boxes
        .iter()
        .enumerate()
        .map(|(index, one)| {
            let [x, y, z] = ((one.center() - all.min).as_dvec3() * scale).to_array().map(|x| x as u32);
            (morton_encode_u64(x, y, z), index)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, index)| index).collect()
}

/// Cuts the boxes in two where that is cheapest, across any axis, and the parts in turn, until so few are left that they pair soon.
fn halved(boxes: &[Aabb], numbers: Vec<u32>) -> Bvh2 {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut open = vec![(0, 0..order.len())];
    while let Some((node, range)) = open.pop() {
        let part = &mut order[range.clone()];
        if part.len() <= PAIRED {
            let own: Vec<Aabb> = part.iter().map(|&one| boxes[one as usize]).collect();
            let whose = part.iter().map(|&one| numbers[one as usize]).collect();
            graft(&mut nodes, node, &own, whose);
            continue;
        }
        let around = part.iter().fold(Aabb::empty(), |all, &one| all.union(&boxes[one as usize]));
        let (children, middle) = (nodes.len(), range.start + cut(boxes, part));
        nodes[node] = Bvh2Node::new(around, 0, children as u32);
        nodes.extend([Bvh2Node::default(); 2]);
        open.extend([(children, range.start..middle), (children + 1, middle..range.end)]);
    }
    Bvh2 { nodes, primitive_indices: numbers, children_are_ordered_after_parents: true, ..Bvh2::default() }
}

/// Puts the tree of a few boxes, found by pairing, in the place of a node.
fn graft(nodes: &mut Vec<Bvh2Node>, node: usize, boxes: &[Aabb], numbers: Vec<u32>) {
    let tree = PlocBuilder::with_capacity(boxes.len()).build(DISTANCE, boxes, numbers, SortPrecision::U128, 1);
    let before = nodes.len() as u32 - 1;
    let moved = |mut one: Bvh2Node| {
        one.first_index += if one.is_leaf() { 0 } else { before };
        one
    };
    let mut grafted = tree.nodes.iter().copied().map(moved);
    nodes[node] = grafted.next().unwrap_or_default();
    nodes.extend(grafted);
}

/// Sorts boxes along the axis on which a cut is cheapest; how many come before it.
fn cut(boxes: &[Aabb], part: &mut [u32]) -> usize {
    let cheapest = |axis: usize| {
        let mut sorted = part.to_vec();
        sort(boxes, &mut sorted, axis);
        let (cost, before) = cheapest_cut(boxes, &sorted);
        (cost, before, sorted)
    };
    let [x, y, z] = [0, 1, 2].map(cheapest);
    let (_, before, sorted) = [y, z].into_iter().fold(x, |best, one| if one.0 < best.0 { one } else { best });
    part.copy_from_slice(&sorted);
    before
}

/// Sorts boxes by their middles along an axis.
fn sort(boxes: &[Aabb], part: &mut [u32], axis: usize) {
    let middle = |one: u32| boxes[one as usize].center()[axis];
    part.sort_unstable_by(|&a, &b| middle(a).total_cmp(&middle(b)).then(a.cmp(&b)));
}

/// The cost of the cheapest cut of boxes in their order, and how many come before it.
fn cheapest_cut(boxes: &[Aabb], sorted: &[u32]) -> (f32, usize) {
    let costs = |around: &mut Aabb, &one: &u32| {
        *around = around.union(&boxes[one as usize]);
        Some(around.half_area())
    };
    let before: Vec<f32> = sorted.iter().scan(Aabb::empty(), costs).collect();
    let after: Vec<f32> = sorted.iter().rev().scan(Aabb::empty(), costs).collect();
    let n = sorted.len();
    let least = (n / LEAST_PART).max(1);
    let cost = |k: usize| (before[k - 1] * k as f32 + after[n - k - 1] * (n - k) as f32, k);
    (least..=n - least).map(cost).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f32::INFINITY, n / 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(count: u32, at: impl Fn(u32) -> f32, size: impl Fn(u32) -> f32) -> Vec<Triangle> {
        let one = |k| {
            let v0 = Vec3A::new(at(k), 0.0, 0.0);
            Triangle { v0, v1: v0 + size(k) * Vec3A::X, v2: v0 + size(k) * Vec3A::Z }
        };
        (0..count).map(one).collect()
    }

    fn slow_rows(count: u32) -> Vec<Vec<Triangle>> {
        vec![
            row(count, |k| k as f32 / 64.0, |_| 1.0 / 128.0),
            row(count, |k| 1.0005f32.powi(k as i32), |k| 1e-4 * 1.0005f32.powi(k as i32)),
            // Long ones that lie over each other.
            row(count, |k| k as f32 / 2048.0, |_| 16.0),
        ]
    }

    fn looks_of(triangles: &[Triangle]) -> usize {
        let boxes: Vec<Aabb> = triangles.iter().map(Triangle::aabb).collect();
        looks(&boxes, usize::MAX) / boxes.len()
    }

    /// Rounds of pairing, level by level, as the tree of halves has them: about as many as its levels, which a row of pairs has for each box.
    fn depth(tree: &Bvh2) -> usize {
        let mut deepest = 0;
        let mut open = vec![(0usize, 1)];
        while let Some((node, depth)) = open.pop() {
            deepest = deepest.max(depth);
            if !tree.nodes[node].is_leaf() {
                let first = tree.nodes[node].first_index as usize;
                open.extend([(first, depth + 1), (first + 1, depth + 1)]);
            }
        }
        deepest
    }

    #[test]
    fn rows_are_halved() {
        for triangles in slow_rows(4_000) {
            let tree = binary_tree(&triangles);
            assert!(depth(&tree) < 40, "{} levels", depth(&tree));
            let mut seen: Vec<u32> =
                tree.nodes.iter().filter(|node| node.is_leaf()).map(|node| node.first_index).collect();
            seen.sort_unstable();
            seen.dedup();
            assert_eq!(seen, (0..4_000).collect::<Vec<_>>(), "each triangle has a leaf");
            for node in tree.nodes.iter().filter(|node| !node.is_leaf()) {
                let first = node.first_index as usize;
                let children = tree.nodes[first].aabb().union(tree.nodes[first + 1].aabb());
                assert_eq!((children.min, children.max), (node.aabb().min, node.aabb().max));
            }
        }
    }

    /// Twin: pairing takes as many more looks as there are more boxes, of a cloud it does not.
    #[test]
    fn rows_are_halved_can_fail() {
        for (few, many) in slow_rows(2_000).iter().zip(&slow_rows(8_000)) {
            assert!(looks_of(many) > 3 * looks_of(few), "{} and {} looks", looks_of(few), looks_of(many));
        }
        let uneven = |k: u32| (k.wrapping_mul(2_654_435_769) >> 8) as f32 / 65_536.0;
        for count in [2_000, 8_000, 32_000] {
            let found = looks_of(&row(count, uneven, |_| 0.01));
            assert!(found < SLOW / 2, "{found} looks of {count}");
        }
    }
}
