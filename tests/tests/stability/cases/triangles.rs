//! Triangles that are thin, flat, double, torn apart, alone or not there.

use super::Case;
use super::baking::{askew, fixed, grey, placed, quiet, radiance, shares, values, white};
use super::case::{difference, worst};
use super::published::{Start, escapes, merged, open_share, random_direction};
use bake::{Error, settings};
use coeff_io::{Refine, Settings};
use glam::Vec3;
use raytrace::{Ray, Tracer};
use sampling::rng::Rng;
use scene::{Material, Mesh, Scene};
use std::ops::ControlFlow;

pub(crate) fn slivers() -> Case {
    Case {
        title: "closed body of slivers, 1 : 10,000",
        bound: "rays that leave it, of 5,000 to anywhere, corners and edges: none, as hits are exact in sign",
        limit: 0.0,
        ours: || leaving(|_, tracer, ray| !tracer.occluded(ray, &|_, _, _| true)),
        naive_method: "determinants below 1e-5 do not count",
        naive: || leaving(|mesh, _, ray| escapes(mesh, ray.origin, ray.direction)),
    }
}

pub(crate) fn zero_area() -> Case {
    Case {
        title: "triangles of zero area, two corners in one place or three on a line",
        bound: "change of the transfer: they weigh nothing in any sum",
        limit: 1e-6,
        ours: || changed(with_flat_triangles),
        naive_method: "vertex normals from unit face normals, (b - a) × (c - a) over its length",
        naive: naive_vertex_normals,
    }
}

pub(crate) fn coincident_faces() -> Case {
    Case {
        title: "every face twice in one place, askew",
        bound: "change of the direct transfer: rays start above both",
        limit: 0.0,
        ours: || changed(doubled),
        naive_method: "triangles that share the vertex by its index do not count; change of the open share",
        naive: || published_change(doubled),
    }
}

pub(crate) fn duplicated_vertices() -> Case {
    Case {
        title: "bowl whose triangles share no vertex (seams everywhere)",
        bound: "open share - 1/2 with 2048 rays, as for the bowl in one piece",
        limit: 0.01,
        ours: || {
            let prt = quiet(&torn_bowl(), &fixed(1, 2048, 0));
            worst(shares(&prt).into_iter().map(|share| (share - 0.5).abs()))
        },
        naive_method: "triangles that share the vertex by its index do not count",
        naive: || worst_share(&torn_bowl().meshes[0], 0.5),
    }
}

pub(crate) fn single_triangle() -> Case {
    Case {
        title: "a single triangle, askew, albedo 1, split to edges of 0.3",
        bound: "radiance - 1 under a white sky: closed form, rounded to f32",
        limit: 1e-6,
        ours: || {
            let prt = quiet(&one_triangle(), &split());
            worst(radiance(&prt, &white(5)).into_iter().map(|value| (value - 1.0).abs()))
        },
        naive_method: "rays start on the surface, hits with t > 0 count; 1 - open share",
        naive: || {
            let scene = one_triangle();
            let mesh = &bake::refine(&scene, &split()).expect("splits").meshes[0];
            worst((0..mesh.positions.len()).map(|v| 1.0 - open_share(mesh, v, Start::Off(0.0), 256)))
        },
    }
}

pub(crate) fn empty_meshes() -> Case {
    Case {
        title: "meshes without triangles, without vertices, and nothing else",
        bound: "change of the others' transfer, infinite where a scene of nothing else is not refused",
        limit: 0.0,
        ours: beside_nothing,
        naive_method: "the scene's middle as the mean of its meshes' means, and its change",
        naive: || difference(&middle(&subject()), &middle(&with_nothing(subject()))),
    }
}

/// Whether a ray from inside a needle leaves it.
type Leaves = fn(&Mesh, &Tracer, &Ray) -> bool;

/// Rays that leave a closed body, 1e-4 wide and 1 high.
fn leaving(leaves: Leaves) -> f64 {
    let mut mesh = scene::builtin("sphere").expect("builtin").meshes.remove(0);
    mesh.positions.iter_mut().for_each(|p| *p = askew() * (*p * Vec3::new(1e-4, 1.0, 1e-4)));
    let tracer = Tracer::build(&mesh.positions, &mesh.triangles, &[]);
    let mut rng = Rng::new(3, 0);
    let left = (0..5000).filter(|i| {
        let corners =
            mesh.triangles[rng.next_u64() as usize % mesh.triangles.len()].map(|v| mesh.positions[v as usize]);
        let target = match i % 3 {
            0 => random_direction(&mut rng),
            1 => corners[0],
            _ => corners[0].lerp(corners[1], rng.next_f32()),
        };
        leaves(&mesh, &tracer, &Ray::new(Vec3::ZERO, target.normalize()))
    });
    left.count() as f64
}

/// A sphere over a plane, askew, so that no face lies in an axis plane.
fn subject() -> Scene {
    placed(grey("sphere-on-plane", 0.5), askew(), 1.0, Vec3::new(0.3, 1.7, -0.9))
}

/// Largest change of the direct transfer of the scene's own vertices.
fn changed(change: fn(Scene) -> Scene) -> f64 {
    let settings = fixed(3, 128, 0);
    let before = values(&quiet(&subject(), &settings));
    let mut after = values(&quiet(&change(subject()), &settings));
    after.truncate(before.len());
    difference(&before, &after)
}

/// Adds triangles of two corners, and of three neighbours on a line of the grid.
fn with_flat_triangles(mut scene: Scene) -> Scene {
    for mesh in &mut scene.meshes {
        let flat = mesh.triangles.iter().step_by(7).flat_map(|&[a, b, c]| [[a, a, b], [c, c, c]]);
        let mut flat: Vec<[u32; 3]> = flat.collect();
        if mesh.name == "ground" {
            flat.extend((0..70).map(|i| [i, i + 1, i + 2]));
        }
        mesh.triangles.extend(flat);
    }
    scene
}

/// Largest change of a vertex normal that is the mean of unit face normals.
fn naive_vertex_normals() -> f64 {
    let normals = |scene: &Scene| {
        let mesh = &scene.meshes[0];
        let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
            let cross = (b - a).cross(c - a);
            t.iter().for_each(|&v| sums[v as usize] += cross / cross.length());
        }
        sums.into_iter().flat_map(|n| (n / n.length()).to_array().map(f64::from)).collect::<Vec<f64>>()
    };
    difference(&normals(&subject()), &normals(&with_flat_triangles(subject())))
}

/// Every mesh once more.
fn doubled(mut scene: Scene) -> Scene {
    let copies = scene.meshes.clone();
    scene.meshes.extend(copies);
    scene
}

/// Largest change of some of the scene's own open shares by the published test, with the same rays.
fn published_change(change: fn(Scene) -> Scene) -> f64 {
    let [before, after] = [subject(), change(subject())].map(|scene| merged(&scene.meshes));
    let share = |mesh: &Mesh, v| open_share(mesh, v, Start::OtherIndices, 256);
    let n = before.positions.len();
    worst((0..n).step_by(n / 20).map(|v| (share(&before, v) - share(&after, v)).abs()))
}

/// Worst open share by the published test over some vertices.
fn worst_share(mesh: &Mesh, expected: f64) -> f64 {
    let noise = 3.0 * (0.25f64 / 256.0).sqrt();
    let error = |v| (open_share(mesh, v, Start::OtherIndices, 256) - expected).abs() - noise;
    worst((0..mesh.positions.len()).step_by(mesh.positions.len() / 20).map(error))
}

/// The bowl, askew, with vertices of its own for each triangle.
fn torn_bowl() -> Scene {
    let mut scene = placed(grey("bowl", 0.5), askew(), 1.0, Vec3::new(0.3, 1.7, -0.9));
    let mesh = &mut scene.meshes[0];
    let corners: Vec<u32> = mesh.triangles.iter().step_by(2).flatten().copied().collect();
    let rest: Vec<u32> = mesh.triangles.iter().skip(1).step_by(2).flatten().copied().collect();
    let order: Vec<u32> = corners.into_iter().chain(rest).collect();
    mesh.positions = order.iter().map(|&v| mesh.positions[v as usize]).collect();
    mesh.normals = order.iter().map(|&v| mesh.normals[v as usize]).collect();
    mesh.triangles = (0..order.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    scene
}

fn one_triangle() -> Scene {
    let place = Vec3::new(300.0, -200.0, 700.0);
    let corners = [Vec3::new(0.1, 0.2, 0.3), Vec3::new(1.3, 0.1, -0.2), Vec3::new(0.4, 1.1, 0.7)];
    let positions = corners.map(|corner| place + corner).to_vec();
    let normal = (positions[1] - positions[0]).cross(positions[2] - positions[0]).normalize();
    let mesh = Mesh { positions, normals: vec![normal; 3], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    Scene { meshes: vec![mesh], materials: vec![Material::default()], ..Scene::default() }
}

fn split() -> Settings {
    Settings { refine: Refine::Edge(0.3), ..settings::standard() }
}

/// Change of a scene beside empty meshes; infinite where empty meshes alone are baked.
fn beside_nothing() -> f64 {
    let alone = Scene { meshes: nothing().to_vec(), materials: vec![Material::default()], ..Scene::default() };
    let refused = bake::bake(&alone, &settings::preview(), &|_| ControlFlow::Continue(()));
    if !matches!(refused, Err(Error::EmptyScene { .. })) {
        return f64::INFINITY;
    }
    changed(with_nothing)
}

/// Meshes without triangles or without anything: what is no surface.
fn nothing() -> [Mesh; 2] {
    let points = Mesh { positions: vec![Vec3::ONE; 5], normals: vec![Vec3::Y; 5], ..Mesh::default() };
    [Mesh::default(), points]
}

fn with_nothing(mut scene: Scene) -> Scene {
    scene.meshes.extend(nothing());
    scene
}

/// The mean of the means of the meshes' positions.
fn middle(scene: &Scene) -> Vec<f64> {
    let mean = |mesh: &Mesh| mesh.positions.iter().sum::<Vec3>() / mesh.positions.len() as f32;
    let middle = scene.meshes.iter().map(mean).sum::<Vec3>() / scene.meshes.len() as f32;
    middle.to_array().map(f64::from).to_vec()
}
