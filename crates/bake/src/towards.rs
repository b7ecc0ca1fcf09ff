//! Splits large triangles towards small objects that stand near them, so that some vertex sees each.

use crate::Error;
use crate::proximity::Proximity;
use crate::refine::{LEAST_TRIANGLES, check_count};
use crate::sharing::halve_shared;
use crate::small::first_vertices;
use crate::split::{Edge, EdgePlace, Place, edge_place, edges, length, place_of, sorted};
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
        // The fewest are called for where triangles may stay coarsest.
        let fewest = called(&scene, &firsts, &small, COARSER[COARSER.len() - 1], &[]).len();
        let within = triangles(&scene) + fewest <= most;
        for coarser in COARSER.into_iter().filter(|_| within) {
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
    let mut known = Vec::new();
    for _ in 0..ROUNDS {
        let now = refined.as_ref().unwrap_or(scene);
        let mut marked = called(now, &firsts, small, coarser, &known);
        if marked.is_empty() {
            break;
        }
        // Each edge that is halved has a triangle at least.
        let room = most.saturating_sub(triangles(now));
        if marked.len() <= room {
            close(now, &mut marked);
        }
        if marked.len() > room {
            return Ok(Outcome::TooMany);
        }
        let refined = refined.get_or_insert_with(|| scene.clone());
        known = refined.meshes.iter().map(|mesh| mesh.positions.len() as u32).collect();
        for (mesh, firsts) in refined.meshes.iter_mut().zip(&mut firsts) {
            let halved = halve_shared(mesh, |mesh, edge| marked.contains(&edge_place(mesh, edge)));
            firsts.resize(mesh.positions.len(), 0);
            let middles = halved.middles.into_iter();
            middles.for_each(|([a, _], middle)| firsts[middle as usize] = firsts[a as usize]);
            check_count(&scene.name, mesh)?;
        }
        if triangles(refined) > most {
            return Ok(Outcome::TooMany);
        }
    }
    Ok(refined.map_or(Outcome::Nothing, |refined| Outcome::Split(Box::new(refined))))
}

/// The longest edges of all triangles that are too large for what stands near them. Triangles between the `known` vertices, a count per mesh,
/// were asked about before.
fn called(scene: &Scene, firsts: &[Vec<u32>], small: &Proximity, coarser: f32, known: &[u32]) -> HashSet<EdgePlace> {
    let mut marked = HashSet::new();
    for ((m, mesh), firsts) in (0..).zip(&scene.meshes).zip(firsts) {
        let two_sided = scene.materials[mesh.material as usize].double_sided;
        let known = known.get(m as usize).copied().unwrap_or(0);
        let edge = |triangle: &[u32; 3]| {
            let edge = longest_edge(mesh, triangle);
            let corners = triangle.map(|v| mesh.positions[v as usize]);
            let own = [m, firsts[triangle[0] as usize]];
            small.calls_for_split(corners, length(mesh, edge) / coarser, two_sided, own).then(|| edge_place(mesh, edge))
        };
        let new = mesh.triangles.par_iter().filter(|triangle| triangle.iter().any(|&v| v >= known));
        marked.par_extend(new.filter_map(edge));
    }
    marked
}

/// Marks with every edge of a triangle its longest one too, so that triangles stay as compact as they were (M.-C. Rivara, *Algorithms for
/// refining triangular grids*, 1984).
fn close(scene: &Scene, marked: &mut HashSet<EdgePlace>) {
    let mut new: Vec<EdgePlace> = marked.iter().copied().collect();
    while !new.is_empty() {
        let ends: HashSet<Place> = new.iter().flatten().copied().collect();
        let followed = scene.meshes.iter().flat_map(|mesh| {
            let is_end: Vec<bool> = mesh.positions.par_iter().map(|p| ends.contains(&place_of(*p))).collect();
            let is_marked =
                |edge: &Edge| edge.iter().all(|&v| is_end[v as usize]) && marked.contains(&edge_place(mesh, *edge));
            let longest = |triangle: &[u32; 3]| {
                edges(triangle).iter().any(is_marked).then(|| edge_place(mesh, longest_edge(mesh, triangle)))
            };
            mesh.triangles.par_iter().filter_map(longest).collect::<Vec<_>>()
        });
        let followed: Vec<EdgePlace> = followed.collect();
        new = followed.into_iter().filter(|place| marked.insert(*place)).collect();
    }
}

/// The longest edge of a triangle; of equal ones the same whatever the winding and the mesh.
fn longest_edge(mesh: &Mesh, triangle: &[u32; 3]) -> Edge {
    let [a, b, c] = edges(triangle).map(|edge| (length(mesh, edge), sorted(edge)));
    let longer = |one: (f32, Edge), other: (f32, Edge)| {
        let order = one.0.total_cmp(&other.0).then_with(|| edge_place(mesh, one.1).cmp(&edge_place(mesh, other.1)));
        if order.is_lt() { other } else { one }
    };
    longer(longer(a, b), c).1
}
