//! Meshes that are baked as they are, however large their triangles: bounces gain no light, and the error between vertices is told.

mod support;

use coeff_io::{Prt, Refine, Sampler, Settings};
use glam::{Vec3, Vec4};
use rayon::prelude::*;
use sampling::rng::Rng;
use scene::{Material, Mesh, Scene};
use support::{fixed, quiet, under_white};

/// Albedo of every surface.
const ALBEDO: f32 = 0.7;

/// A box by its lowest and highest corner.
type Solid = [Vec3; 2];

fn solid(low: [f32; 3], high: [f32; 3]) -> Solid {
    [low.into(), high.into()]
}

/// A room of 5 by 3 by 4 metres with a window, on a ground that reaches 10 m beyond its walls; the last box is a table's top.
fn room() -> Vec<Solid> {
    vec![
        solid([-10.0, -0.5, -10.0], [15.0, 0.0, 14.0]),
        solid([-0.2, 3.0, -0.2], [5.2, 3.2, 4.2]),
        solid([-0.2, 0.0, -0.2], [5.2, 1.0, 0.0]),
        solid([-0.2, 2.2, -0.2], [5.2, 3.0, 0.0]),
        solid([-0.2, 1.0, -0.2], [1.5, 2.2, 0.0]),
        solid([3.5, 1.0, -0.2], [5.2, 2.2, 0.0]),
        solid([-0.2, 0.0, 4.0], [5.2, 3.0, 4.2]),
        solid([-0.2, 0.0, 0.0], [0.0, 3.0, 4.0]),
        solid([5.0, 0.0, 0.0], [5.2, 3.0, 4.0]),
        solid([1.5, 0.7, 1.5], [2.7, 0.75, 2.3]),
    ]
}

/// The six faces of a box, two triangles each.
fn mesh([low, high]: Solid) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for (at, sign) in [(low, -1.0), (high, 1.0)] {
            let mut normal = Vec3::ZERO;
            normal[axis] = sign;
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let first = mesh.positions.len() as u32;
            for corner in [[0, 0], [1, 0], [1, 1], [0, 1]] {
                let mut p = at;
                p[u] = [low, high][corner[0]][u];
                p[v] = [low, high][corner[1]][v];
                mesh.positions.push(p);
                mesh.normals.push(normal);
            }
            let order = if sign > 0.0 { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
            mesh.triangles.extend(order.chunks_exact(3).map(|c| [first + c[0], first + c[1], first + c[2]]));
        }
    }
    mesh
}

fn scene(solids: &[Solid]) -> Scene {
    let material = Material { base_color: Vec4::new(ALBEDO, ALBEDO, ALBEDO, 1.0), ..Material::default() };
    Scene { meshes: solids.iter().copied().map(mesh).collect(), materials: vec![material], ..Scene::default() }
}

/// Distance to the nearest box along a ray, and the normal there, by slabs.
fn nearest(solids: &[Solid], origin: Vec3, direction: Vec3) -> Option<(f32, Vec3)> {
    let mut best: Option<(f32, Vec3)> = None;
    for [low, high] in solids {
        let (a, b) = ((*low - origin) / direction, (*high - origin) / direction);
        let (enter, leave) = (a.min(b), a.max(b));
        let t = enter.max_element();
        if t > 0.0 && t <= leave.min_element() && best.is_none_or(|(known, _)| t < known) {
            let axis = (0..3).find(|&k| enter[k] == t).expect("the largest of three");
            let mut normal = Vec3::ZERO;
            normal[axis] = -direction[axis].signum();
            best = Some((t, normal));
        }
    }
    best
}

/// Radiance of a point under a white sky after so many bounces at most, by random paths between boxes.
fn traced(solids: &[Solid], at: Vec3, normal: Vec3, bounces: u32, albedo: f32, paths: u64) -> f64 {
    let mut sum = 0.0;
    for path in 0..paths {
        let mut random = Rng::new(7, path);
        let (mut at, mut normal, mut throughput) = (at, normal, albedo);
        for bounce in 0..=bounces {
            // A unit vector around the normal's tip is spread by the cosine (Lambert).
            let [u, v] = random.next_square();
            let (z, angle) = (2.0 * u - 1.0, std::f32::consts::TAU * v);
            let ring = (1.0 - z * z).max(0.0).sqrt();
            let direction = (normal + Vec3::new(ring * angle.cos(), ring * angle.sin(), z)).normalize_or(normal);
            match nearest(solids, at + 1e-4 * normal, direction) {
                None => {
                    sum += f64::from(throughput);
                    break;
                }
                Some((t, surface)) if bounce < bounces => {
                    at += 1e-4 * normal + t * direction;
                    (normal, throughput) = (surface, throughput * albedo);
                }
                Some(_) => break,
            }
        }
    }
    sum / paths as f64
}

/// Mean radiance of the table's vertices, baked over traced with some albedo.
fn ratio(solids: &[Solid], prt: &Prt, bounces: u32, albedo: f32) -> f64 {
    let table = prt.meshes.last().expect("the table");
    let vertices = table.first_vertex as usize..(table.first_vertex + table.vertices) as usize;
    let radiance = under_white(prt);
    let baked: f64 = vertices.clone().map(|v| radiance[v]).sum();
    let expected = vertices.into_par_iter().map(|v| {
        let (at, normal) = (Vec3::from(prt.geometry.positions[v]), Vec3::from(prt.geometry.normals[v]));
        // Receivers are drawn in from the border of their face by a thousandth.
        let middle = 0.5 * (solids[solids.len() - 1][0] + solids[solids.len() - 1][1]);
        let inward = (middle - at) - (middle - at).dot(normal) * normal;
        traced(solids, at + 1e-3 * inward, normal, bounces, albedo, 100_000)
    });
    baked / expected.sum::<f64>()
}

/// The ground's corners see the whole sky; the floor of the room, which is the same two triangles, hardly any of it.
#[test]
fn light_from_beyond_a_wall_does_not_reach_a_room() {
    let solids = room();
    for bounces in [1, 2, 3] {
        let prt = quiet(&scene(&solids), &fixed(2, Sampler::OwenSobol, 4096, bounces));
        let ratio = ratio(&solids, &prt, bounces, ALBEDO);
        // 2,400,000 paths err by 0.2 %, 4,096 rays by as much; 256 rays erred by 2 % in either direction.
        assert!((0.985..1.005).contains(&ratio), "{bounces} bounces: {ratio} of the light");
    }
}

#[test]
fn light_from_beyond_a_wall_does_not_reach_a_room_can_fail() {
    let solids = room();
    let prt = quiet(&scene(&solids), &fixed(2, Sampler::OwenSobol, 256, 2));
    // What more light between surfaces would be: the albedo of those that lend it.
    let less = ratio(&solids, &prt, 2, 0.9 * ALBEDO);
    assert!(less > 1.1, "an excess is seen: {less}");
}

/// A ground of two triangles below a low box, as it is and split.
#[test]
fn error_between_vertices_is_told() {
    let solids = [solid([-4.0, -1.0, -4.0], [4.0, 0.0, 4.0]), solid([-2.5, 0.001, -2.5], [2.5, 0.5, 2.5])];
    let told = |refine| {
        let settings = Settings { refine, ..fixed(3, Sampler::OwenSobol, 256, 0) };
        quiet(&scene(&solids), &settings).achieved.interpolation.expect("it is measured")
    };
    let [_, _, coarse] = told(Refine::Off);
    // The middle of the ground sees nothing; its corners see all but a low box 2 m away.
    assert!((0.8..1.1).contains(&coarse), "worst of the mesh as it is: {coarse}");
    let [median, most, fine] = told(Refine::Auto);
    assert!(median < 0.02 && most < 0.1, "split: median {median}, 95 % below {most}");
    assert!(fine < 0.5 * coarse, "split: worst {fine}, can fail: {coarse}");
}

/// What is told does not depend on the number of threads, and nothing is told where nothing is traced.
#[test]
fn error_between_vertices_is_the_same_each_time() {
    let solids = [solid([-4.0, -1.0, -4.0], [4.0, 0.0, 4.0]), solid([-0.5, 0.001, -0.5], [0.5, 0.5, 0.5])];
    let told = || quiet(&scene(&solids), &fixed(3, Sampler::OwenSobol, 64, 1)).achieved;
    let (a, b) = (told(), told());
    assert_eq!((a.interpolation, a.worst_between), (b.interpolation, b.worst_between));
    let open = quiet(&scene(&solids[..1]), &fixed(3, Sampler::OwenSobol, 64, 1)).achieved;
    assert_eq!(open.interpolation, None, "a convex body is exact between its vertices");
}
