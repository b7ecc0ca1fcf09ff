//! Splits large triangles towards small objects that stand near them, so that some vertex sees each.

use crate::Error;
use crate::proximity::Proximity;
use crate::refine::{LEAST_TRIANGLES, check_count};
use crate::small::first_vertices;
use crate::split::{Edge, EdgePlace, edge_place, edges, halve, length, sorted};
use rayon::prelude::*;
use scene::{Mesh, Scene};
use std::borrow::Cow;
use std::collections::HashSet;

/// How much coarser edges near small objects may become before the smallest objects are left out.
const COARSER: [f32; 3] = [1.0, 2.0, 4.0];
/// Rounds of halving longest edges; two of them halve a triangle's size.
const ROUNDS: usize = 40;

/// The scene with triangles near small objects split down to the size of these, and the objects that this was done for. Where there are
/// too many, triangles stay coarser, then the smallest are left out.
pub(crate) fn towards(scene: Cow<'_, Scene>, mut small: Proximity) -> Result<(Cow<'_, Scene>, Proximity), Error> {
    let most = most_triangles(&scene);
    if small.is_empty() {
        return Ok((scene, small));
    }
    let firsts: Vec<Vec<u32>> = scene.meshes.par_iter().map(first_vertices).collect();
    while !small.is_empty() {
        for coarser in COARSER {
            match split(&scene, firsts.clone(), &small, coarser, most)? {
                Outcome::Nothing => return Ok((scene, small)),
                Outcome::Split(refined) => return Ok((Cow::Owned(*refined), small)),
                Outcome::TooMany => {}
            }
        }
        small = small.above(2.0 * small.smallest());
    }
    Ok((scene, small))
}

/// Triangles that small objects may bring a scene to: one of few triangles may double, one of many hardly grows.
pub(crate) fn most_triangles(scene: &Scene) -> usize {
    let count = triangles(scene);
    let few = (LEAST_TRIANGLES / count as f64).min(1.0);
    count + (few * few * LEAST_TRIANGLES) as usize
}

/// Triangles of a scene.
pub(crate) fn triangles(scene: &Scene) -> usize {
    scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
}

enum Outcome {
    Nothing,
    Split(Box<Scene>),
    TooMany,
}

/// Splits until nothing calls for it, or until there are more than `most` triangles. `firsts` are the first vertices that those of each mesh
/// are connected with.
fn split(
    scene: &Scene,
    mut firsts: Vec<Vec<u32>>,
    small: &Proximity,
    coarser: f32,
    most: usize,
) -> Result<Outcome, Error> {
    let mut refined: Option<Scene> = None;
    for _ in 0..ROUNDS {
        let now = refined.as_ref().unwrap_or(scene);
        let marked = called(now, &firsts, small, coarser);
        if marked.is_empty() {
            break;
        }
        let marked = closed(now, small, marked);
        let refined = refined.get_or_insert_with(|| scene.clone());
        for (mesh, firsts) in refined.meshes.iter_mut().zip(&mut firsts) {
            let middles = halve(mesh, |mesh, edge| marked.contains(&edge_place(mesh, edge)));
            firsts.resize(mesh.positions.len(), 0);
            middles.into_iter().for_each(|([a, _], middle)| firsts[middle as usize] = firsts[a as usize]);
            check_count(&scene.name, mesh)?;
        }
        if triangles(refined) > most {
            return Ok(Outcome::TooMany);
        }
    }
    Ok(refined.map_or(Outcome::Nothing, |refined| Outcome::Split(Box::new(refined))))
}

/// The longest edges of all triangles that are too large for what stands near them.
fn called(scene: &Scene, firsts: &[Vec<u32>], small: &Proximity, coarser: f32) -> HashSet<EdgePlace> {
    let mut marked = HashSet::new();
    for ((m, mesh), firsts) in (0..).zip(&scene.meshes).zip(firsts) {
        let two_sided = scene.materials[mesh.material as usize].double_sided;
        let edge = |triangle: &[u32; 3]| {
            let edge = longest_edge(mesh, triangle);
            let corners = triangle.map(|v| mesh.positions[v as usize]);
            let own = [m, firsts[triangle[0] as usize]];
            small.calls_for_split(corners, length(mesh, edge) / coarser, two_sided, own).then(|| edge_place(mesh, edge))
        };
        marked.par_extend(mesh.triangles.par_iter().filter_map(edge));
    }
    marked
}

/// With every edge of a triangle its longest one too, so that triangles stay as compact as they were (M.-C. Rivara, *Algorithms for refining
/// triangular grids*, 1984).
fn closed(scene: &Scene, small: &Proximity, mut marked: HashSet<EdgePlace>) -> HashSet<EdgePlace> {
    // A longest edge is no shorter than the one that called for it.
    let smallest = small.least_edge();
    let large = |mesh: &Mesh| -> Vec<[u32; 3]> {
        let is_large = |t: &&[u32; 3]| edges(t).iter().any(|&edge| length(mesh, edge) > smallest);
        mesh.triangles.par_iter().filter(is_large).copied().collect()
    };
    let lists: Vec<Vec<[u32; 3]>> = scene.meshes.iter().map(large).collect();
    loop {
        let before = marked.len();
        for (mesh, list) in scene.meshes.iter().zip(&lists) {
            for triangle in list {
                if edges(triangle).iter().any(|&edge| marked.contains(&edge_place(mesh, edge))) {
                    marked.insert(edge_place(mesh, longest_edge(mesh, triangle)));
                }
            }
        }
        if marked.len() == before {
            return marked;
        }
    }
}

/// The longest edge of a triangle; of equal ones the same whatever the winding and the mesh.
fn longest_edge(mesh: &Mesh, triangle: &[u32; 3]) -> Edge {
    let key = |edge: &Edge| (length(mesh, *edge).to_bits(), edge_place(mesh, *edge));
    let [a, b, c] = edges(triangle);
    [b, c].into_iter().fold(sorted(a), |best, edge| if key(&edge) > key(&best) { sorted(edge) } else { best })
}
