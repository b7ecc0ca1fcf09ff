//! Telling solids from sheets, since OBJ has no double-sided flag.

use std::collections::HashMap;

use crate::weld::{edges, half_edges, is_inner, weld};
use crate::{Material, Scene, Warning};

/// Largest share of a mesh's edges that may be open, crowded or unevenly oriented in a solid.
const OPEN_SHARE: f64 = 0.01;

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

/// Whether each mesh bounds a solid: at most [`OPEN_SHARE`] of its edges are not shared by just two triangles that
/// run along them in opposite directions.
fn solids(scene: &Scene) -> Vec<bool> {
    let (_, welded) = weld(scene.meshes.iter().flat_map(|m| m.positions.iter().copied()));
    let (mut triangles, mut owner) = (Vec::new(), Vec::new());
    let mut first = 0;
    for (m, mesh) in scene.meshes.iter().enumerate() {
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| welded[first + i as usize]);
            // Triangles without area would make their neighbours look open.
            if a != b && b != c && c != a {
                triangles.push([a, b, c]);
                owner.push(m);
            }
        }
        first += mesh.positions.len();
    }
    let (mut all, mut open) = (vec![0usize; scene.meshes.len()], vec![0usize; scene.meshes.len()]);
    for edge in edges(&half_edges(&triangles)) {
        let inner = is_inner(edge);
        for half in edge {
            let m = owner[half.corner as usize / 3];
            all[m] += 1;
            open[m] += usize::from(!inner);
        }
    }
    all.iter().zip(&open).map(|(all, open)| *open as f64 <= OPEN_SHARE * *all as f64 && *all > 0).collect()
}
