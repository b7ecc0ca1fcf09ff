//! Telling solids from sheets, since OBJ has no double-sided flag.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use crate::weld::{HalfEdge, edges, half_edges, weld};
use crate::{Material, Mesh, Scene, Warning, vertices};

/// Largest share of a component's edges that may be open or unevenly oriented in a solid.
const OPEN_SHARE: f64 = 0.01;
/// Greatest length of open edges over the root of the area in a solid: does not shrink with the size of triangles as
/// the share does. A hemisphere has 2.5 and a square 4; the Stanford bunny with its five holes has 1.4.
const OPEN_LENGTH: f64 = 2.0;

/// Gives double-sided copies of their materials to the connected components that are not solids.
///
/// Components are found over the whole file with positions joined, so that a solid may be made of several meshes, and
/// a mesh may hold solids and sheets: such a mesh becomes two.
pub(super) fn mark_double_sided(scene: &mut Scene) {
    let solid = solid_triangles(scene);
    let mut copies = HashMap::new();
    let (mut sheets, mut first) = (0, 0);
    let mut meshes = Vec::with_capacity(scene.meshes.len());
    for mut mesh in std::mem::take(&mut scene.meshes) {
        let count = mesh.triangles.len();
        let (mine, name) = (&solid[first..first + count], mesh.material);
        // Triangles without area go with the others.
        let unsaid = mine.iter().flatten().next().copied().unwrap_or(true);
        let mine: Vec<bool> = mine.iter().map(|solid| solid.unwrap_or(unsaid)).collect();
        first += count;
        let mut double_sided = || {
            *copies.entry(name).or_insert_with(|| {
                let material = Material { double_sided: true, ..scene.materials[name as usize].clone() };
                scene.materials.push(material);
                scene.materials.len() as u32 - 1
            })
        };
        match mine.iter().filter(|solid| **solid).count() {
            n if n == count => meshes.push(mesh),
            0 => {
                mesh.material = double_sided();
                meshes.push(mesh);
                sheets += 1;
            }
            _ => {
                let sheet = Mesh { material: double_sided(), ..part(&mesh, &mine, false) };
                meshes.extend([part(&mesh, &mine, true), sheet]);
                sheets += 1;
            }
        }
    }
    scene.meshes = meshes;
    if sheets > 0 {
        let message = format!("{sheets} of {} are open surfaces and were taken as double-sided", scene.meshes.len());
        scene.report.warnings.push(Warning { object: "meshes".into(), message });
    }
}

/// The triangles of a mesh that are `wanted`, with the vertices that they use.
fn part(mesh: &Mesh, solid: &[bool], wanted: bool) -> Mesh {
    let mut part = mesh.clone();
    let mut of_part = solid.iter();
    part.triangles.retain(|_| of_part.next() == Some(&wanted));
    vertices::drop_unused(&mut part);
    part
}

/// Open edges and all edges of one component, and its surface.
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

/// For each triangle of all meshes whether its component bounds a solid, up to small holes; nothing for those without
/// area.
///
/// Components grow over edges that just two triangles share: bodies that touch along an edge, and a fin on a body, are
/// not one. An edge of a component is open unless as many of its triangles run along it in one direction as in the
/// other.
fn solid_triangles(scene: &Scene) -> Vec<Option<bool>> {
    let positions: Vec<Vec3> = scene.meshes.iter().flat_map(|m| m.positions.iter().copied()).collect();
    let (count, welded) = weld(positions.iter().copied());
    let mut place = vec![DVec3::ZERO; count as usize];
    for (position, weld) in positions.iter().zip(&welded) {
        place[*weld as usize] = position.as_dvec3();
    }
    let (mut triangles, mut areas) = (Vec::new(), Vec::new());
    let mut first = 0;
    for mesh in &scene.meshes {
        triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| welded[first + i as usize])));
        areas.extend((0..mesh.triangles.len()).map(|t| mesh.area(t)));
        first += mesh.positions.len();
    }
    // Triangles without area would make their neighbours look open.
    let is_flat = |t: &[u32; 3]| t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    let kept: Vec<usize> = (0..triangles.len()).filter(|&t| !is_flat(&triangles[t])).collect();
    let halves = half_edges(&kept.iter().map(|&t| triangles[t]).collect::<Vec<_>>());
    let owner = |half: &HalfEdge| half.corner as usize / 3;
    let mut component: Vec<usize> = (0..kept.len()).collect();
    for edge in edges(&halves).filter(|edge| edge.len() == 2) {
        let (a, b) = (root(&mut component, owner(&edge[0])), root(&mut component, owner(&edge[1])));
        component[a.max(b)] = a.min(b);
    }
    let component: Vec<usize> = (0..kept.len()).map(|t| root(&mut component, t)).collect();
    let mut tallies = vec![Tally::default(); kept.len()];
    for (&of, &t) in component.iter().zip(&kept) {
        tallies[of].area += areas[t];
    }
    for edge in edges(&halves) {
        let balance = |of: usize| {
            let mine = edge.iter().filter(|half| component[owner(half)] == of);
            mine.map(|half| if half.rising { 1 } else { -1 }).sum::<i64>()
        };
        for half in edge {
            let of = component[owner(half)];
            let tally = &mut tallies[of];
            tally.edges += 1;
            // Edges at which thousands meet are of no solid; nobody counts them out.
            if edge.len() > MOST_AT_EDGE || balance(of) != 0 {
                tally.open += 1;
                tally.open_length += place[half.low as usize].distance(place[half.high as usize]);
            }
        }
    }
    let mut solid = vec![None; triangles.len()];
    for (&of, &t) in component.iter().zip(&kept) {
        solid[t] = Some(tallies[of].is_solid());
    }
    solid
}

/// Most triangles at one edge whose directions are counted.
const MOST_AT_EDGE: usize = 64;

/// The least triangle of the component that `at` is in.
fn root(component: &mut [usize], mut at: usize) -> usize {
    while component[at] != at {
        // Path halving keeps the walks short.
        component[at] = component[component[at]];
        at = component[at];
    }
    at
}
