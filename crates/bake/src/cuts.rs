//! Shares at which edges are cut, the same for all meshes that share an edge.

use crate::split::{Edge, EdgePlace, cut, edge_place, place_of};
use scene::{Mesh, Scene};
use std::collections::HashMap;

/// Shares along an edge are multiples of this: theirs and what is left of 1 are exact.
const STEPS: f32 = 4096.0;

/// Where edges are cut: their ends by position, and the share of the way from the first.
#[derive(Debug, Default)]
pub(crate) struct Cuts(HashMap<EdgePlace, f32>);

impl Cuts {
    /// Notes that an edge is cut at a share of the way from its first vertex; the first note of an edge holds.
    pub(crate) fn add(&mut self, mesh: &Mesh, edge: Edge, share: f32) {
        let share = (share * STEPS).round().clamp(1.0, STEPS - 1.0) / STEPS;
        self.0.entry(edge_place(mesh, edge)).or_insert(turned(mesh, edge, share));
    }

    /// Whether no edge is cut.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Cuts the edges of all meshes.
    pub(crate) fn apply(&self, scene: &mut Scene) {
        for mesh in &mut scene.meshes {
            cut(mesh, |mesh, edge| {
                let share = *self.0.get(&edge_place(mesh, edge))?;
                Some(turned(mesh, edge, share))
            });
        }
    }
}

/// A share of the way along an edge as its place counts it, which has the ends in an order of its own; and back.
fn turned(mesh: &Mesh, edge: Edge, share: f32) -> f32 {
    let [a, b] = edge.map(|v| place_of(mesh.positions[v as usize]));
    if a <= b { share } else { 1.0 - share }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Meshes that share an edge cut it at the same place, also where one has -0 for 0 and has the ends the other way round.
    #[test]
    fn an_edge_is_cut_at_one_place() {
        let mesh = |x: f32| Mesh { positions: vec![Vec3::new(x, 0.0, 0.0), Vec3::X], ..Mesh::default() };
        assert_eq!(edge_place(&mesh(0.0), [0, 1]), edge_place(&mesh(-0.0), [1, 0]));
        let shares = [0.0, -0.0].map(|x| turned(&mesh(x), [0, 1], 0.25));
        assert_eq!(shares, [0.25; 2]);
        assert_eq!(turned(&mesh(-0.0), [1, 0], 0.75), 0.25);
        // Twin: by their bits the ends of the second would be the other way round.
        assert!((-0.0f32).to_bits() > 1.0f32.to_bits());
    }
}
