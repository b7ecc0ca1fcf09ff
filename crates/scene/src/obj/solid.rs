//! Telling solids from sheets, since OBJ has no double-sided flag.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use crate::weld::{edges, half_edges, is_inner, weld};
use crate::{Material, Scene, Warning};

/// Largest share of a mesh's edges that may be open, crowded or unevenly oriented in a solid.
const OPEN_SHARE: f64 = 0.01;
/// Greatest length of open edges over the root of the area in a solid: does not shrink with the size of triangles as
/// the share does. A hemisphere has 2.5 and a square 4; the Stanford bunny with its five holes has 1.4.
const OPEN_LENGTH: f64 = 2.0;

/// Gives double-sided copies of their materials to the meshes that are not solids.
///
/// Edges are found over the whole file with positions joined, so that a solid may be made of several meshes.
pub(super) fn mark_double_sided(scene: &mut Scene) {
    let solids = solids(scene);
    let mut copies = HashMap::new();
    let mut sheets = 0;
    for (mesh, _) in scene.meshes.iter_mut().zip(&solids).filter(|(_, solid)| !**solid) {
        sheets += 1;
        mesh.material = *copies.entry(mesh.material).or_insert_with(|| {
            let material = Material { double_sided: true, ..scene.materials[mesh.material as usize].clone() };
            scene.materials.push(material);
            scene.materials.len() as u32 - 1
        });
    }
    if sheets > 0 {
        let message = format!("{sheets} of {} are open surfaces and were taken as double-sided", solids.len());
        scene.report.warnings.push(Warning { object: "meshes".into(), message });
    }
}

/// Open edges and all edges of one mesh, and its surface.
#[derive(Default, Clone, Copy)]
struct Tally {
    edges: usize,
    open: usize,
    /// Metres.
    open_length: f64,
    /// Square metres.
    area: f64,
}

impl Tally {
    fn is_solid(&self) -> bool {
        let few = self.open as f64 <= OPEN_SHARE * self.edges as f64;
        self.edges > 0 && few && self.open_length <= OPEN_LENGTH * self.area.sqrt()
    }
}

/// Whether each mesh bounds a solid, up to small holes. An edge is open unless just two triangles share it, which
/// run along it in opposite directions.
fn solids(scene: &Scene) -> Vec<bool> {
    let positions: Vec<Vec3> = scene.meshes.iter().flat_map(|m| m.positions.iter().copied()).collect();
    let (count, welded) = weld(positions.iter().copied());
    let mut place = vec![DVec3::ZERO; count as usize];
    for (position, weld) in positions.iter().zip(&welded) {
        place[*weld as usize] = position.as_dvec3();
    }
    let mut tallies = vec![Tally::default(); scene.meshes.len()];
    let (mut triangles, mut owner) = (Vec::new(), Vec::new());
    let mut first = 0;
    for (m, mesh) in scene.meshes.iter().enumerate() {
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|i| welded[first + i as usize]);
            // Triangles without area would make their neighbours look open.
            if a != b && b != c && c != a {
                triangles.push([a, b, c]);
                owner.push(m);
                tallies[m].area += mesh.area(t);
            }
        }
        first += mesh.positions.len();
    }
    for edge in edges(&half_edges(&triangles)) {
        let open = !is_inner(edge);
        for half in edge {
            let tally = &mut tallies[owner[half.corner as usize / 3]];
            tally.edges += 1;
            if open {
                tally.open += 1;
                tally.open_length += place[half.low as usize].distance(place[half.high as usize]);
            }
        }
    }
    tallies.iter().map(Tally::is_solid).collect()
}
