//! Vertices joined by position, and the edges between them.

use std::collections::HashMap;

use glam::Vec3;

/// Number of distinct positions, and for each position in turn which of them it is.
pub(crate) fn weld(positions: impl Iterator<Item = Vec3>) -> (u32, Vec<u32>) {
    let mut number = HashMap::new();
    let welded = positions
        .map(|p| {
            let next = number.len() as u32;
            // Adding zero makes -0 and 0 one position.
            *number.entry((p + 0.0).to_array().map(f32::to_bits)).or_insert(next)
        })
        .collect();
    (number.len() as u32, welded)
}

/// One side of an undirected edge as one triangle has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct HalfEdge {
    /// Smaller welded vertex.
    pub(crate) low: u32,
    /// Larger welded vertex.
    pub(crate) high: u32,
    /// Whether the triangle runs from `low` to `high`.
    pub(crate) rising: bool,
    /// 3 x triangle + corner at which the edge starts.
    pub(crate) corner: u32,
}

/// All half edges, those of one edge side by side.
pub(crate) fn half_edges(triangles: &[[u32; 3]]) -> Vec<HalfEdge> {
    let mut edges: Vec<HalfEdge> = triangles
        .iter()
        .enumerate()
        .flat_map(|(t, triangle)| {
            (0..3).map(move |k| {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                HalfEdge { low: a.min(b), high: a.max(b), rising: a < b, corner: (3 * t + k) as u32 }
            })
        })
        .collect();
    edges.sort_unstable();
    edges
}

/// Whether the half edges of one edge are those of a closed, evenly oriented surface: two, running opposite ways.
pub(crate) fn is_inner(edge: &[HalfEdge]) -> bool {
    edge.len() == 2 && edge[0].rising != edge[1].rising
}

/// The edges as runs of half edges.
pub(crate) fn edges(half_edges: &[HalfEdge]) -> impl Iterator<Item = &[HalfEdge]> {
    half_edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high))
}
