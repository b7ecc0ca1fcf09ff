//! Where surfaces touch or nearly do: light must not leak in from vertices that stand outside.

mod support;

use bake::refine;
use coeff_io::{Prt, Refine, Sampler, Settings};
use glam::{Vec3, Vec4};
use scene::{Material, Mesh, Scene};
use support::{fixed, quiet, under_white};

/// Albedo of every surface.
const ALBEDO: f32 = 0.8;

/// A rectangle of `cells` by `cells` quads from a corner along two sides, seen from where their cross product points.
fn rectangle(corner: Vec3, along: Vec3, across: Vec3, cells: u32) -> Mesh {
    let n = cells + 1;
    let at = |i: u32| corner + along * ((i % n) as f32 / cells as f32) + across * ((i / n) as f32 / cells as f32);
    let quads = (0..cells * cells).map(|k| (k % cells) + (k / cells) * n);
    Mesh {
        positions: (0..n * n).map(at).collect(),
        normals: vec![along.cross(across).normalize(); (n * n) as usize],
        triangles: quads.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect(),
        ..Mesh::default()
    }
}

/// The six faces of a box, each of `cells` by `cells` quads, its underside first.
fn closed_box(low: Vec3, size: Vec3, cells: u32) -> Vec<Mesh> {
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    let high = low + size;
    vec![
        rectangle(low, x, z, cells),
        rectangle(low, y, x, cells),
        rectangle(low, z, y, cells),
        rectangle(high, -z, -x, cells),
        rectangle(high, -x, -y, cells),
        rectangle(high, -y, -z, cells),
    ]
}

fn scene(meshes: Vec<Mesh>) -> Scene {
    let material = Material { base_color: Vec4::new(ALBEDO, ALBEDO, ALBEDO, 1.0), ..Material::default() };
    Scene { meshes, materials: vec![material], ..Scene::default() }
}

/// A wall of 1 m on a floor whose two rows of vertices stand 1 m before the wall and inside it.
fn floor_into_wall() -> Scene {
    let mut floor = rectangle(Vec3::new(-1.0, 0.0, 40.0), Vec3::X * 2.0, Vec3::Z * -80.0, 1);
    let normals = floor.normals.clone();
    assert_eq!(normals[0], Vec3::Y, "the floor looks up");
    floor.name = "floor".into();
    let mut meshes = vec![floor];
    meshes.extend(closed_box(Vec3::new(0.0, -1.0, -60.0), Vec3::new(1.5, 2.0, 120.0), 1));
    scene(meshes)
}

/// Open shares of the floor's vertices, those before the wall and those inside it.
fn shares(prt: &Prt) -> [Vec<f64>; 2] {
    let floor = prt.geometry.positions.iter().zip(&prt.transfer.openness).take(4);
    let of = |inside: bool| floor.clone().filter(|(p, _)| (p[0] > 0.0) == inside).map(|(_, o)| f64::from(*o)).collect();
    [of(false), of(true)]
}

/// Open share at a distance from a long wall of height 1, form factor of a wall at right angles (Howell B-4): half of what
/// 1 - cos of the wall's elevation leaves.
fn beside_wall(distance: f64) -> f64 {
    0.5 + 0.5 * distance / distance.hypot(1.0)
}

#[test]
fn a_vertex_inside_a_wall_is_as_dark_as_the_foot_of_the_wall() {
    let [before, inside] = shares(&quiet(&floor_into_wall(), &fixed(2, Sampler::OwenSobol, 4096, 0)));
    for share in &before {
        assert!((share - beside_wall(1.0)).abs() < 0.01, "1 m before the wall: {share}");
    }
    for share in &inside {
        // The receiver stands at 98 % of the way to the wall; the ends of the wall are 20 m away.
        assert!((share - beside_wall(0.02)).abs() < 0.01, "inside the wall: {share}");
    }
    // Twin: what a mean of the neighbours would give.
    assert!(before.iter().all(|share| (share - beside_wall(0.02)).abs() > 0.3), "the neighbours are lit: {before:?}");
}

/// Height of the box over the floor.
const GAP: f32 = 0.01;

/// A box of half a metre that hovers over the middle of a floor of two triangles.
fn hovering_box(floor_cells: u32) -> Scene {
    let floor = rectangle(Vec3::new(-1.0, 0.0, 1.0), Vec3::X * 2.0, Vec3::Z * -2.0, floor_cells);
    let mut meshes = closed_box(Vec3::new(-0.25, GAP, -0.25), Vec3::new(0.5, 0.3, 0.5), 10);
    meshes.push(floor);
    scene(meshes)
}

/// The underside of the box sees floor that it shades itself; the corners of that floor are lit.
#[test]
fn light_does_not_leak_into_a_gap() {
    let prt = quiet(&hovering_box(1), &fixed(2, Sampler::OwenSobol, 2048, 1));
    let radiance = under_white(&prt);
    // 0.1 m from the rim, sky or lit floor shows below an elevation of GAP / 0.1: at most its squared sine of the cosine lobe.
    let most = f64::from(ALBEDO) * 2.0 * f64::from(GAP / 0.1).powi(2);
    let underside = 0..prt.meshes[0].vertices as usize;
    let deep = underside.filter(|&v| {
        let [x, _, z] = prt.geometry.positions[v];
        x.abs().max(z.abs()) < 0.25 - 0.099
    });
    let worst = deep.map(|v| radiance[v]).fold(0.0, f64::max);
    assert!(worst < most, "light of {worst} in the gap, at most {most}");
    // Twin: the mean of the floor's corners, reflected twice, is what interpolation alone would find.
    let floor = prt.meshes.last().expect("the floor").first_vertex as usize;
    let interpolated = f64::from(ALBEDO) * radiance[floor..].iter().sum::<f64>() / 4.0;
    assert!(interpolated > 20.0 * most, "the corners are lit: {interpolated}");
}

/// Vertices per area within 0.1 m of the rim of the box's shadow, over those of the rest of the floor.
fn density_at_rim(scene: &Scene) -> f64 {
    let floor = scene.meshes.last().expect("the floor");
    let at_rim = |p: &&Vec3| (p.x.abs().max(p.z.abs()) - 0.25).abs() < 0.1;
    let rim = floor.positions.iter().filter(at_rim).count() as f64;
    let rest = floor.positions.len() as f64 - rim;
    let rim_area = 0.7 * 0.7 - 0.3 * 0.3;
    (rim / rim_area) / (rest / (4.0 - rim_area))
}

#[test]
fn vertices_gather_where_transfer_bends() {
    let coarse = hovering_box(20);
    let split = |refine| bake::refine(&coarse, &Settings { refine, ..bake::settings::standard() }).expect("splits");
    let bent = split(Refine::Auto);
    assert!(density_at_rim(&bent) > 1.4, "at bends: {}", density_at_rim(&bent));
    // Twin: splitting by length alone gathers none.
    let even = density_at_rim(&split(Refine::Edge(0.04)));
    assert!((0.8..1.2).contains(&even), "even splitting: {even}");
    let again = refine(&coarse, &bake::settings::standard()).expect("splits");
    let triangles = |scene: &Scene| scene.meshes.iter().map(|m| m.triangles.clone()).collect::<Vec<_>>();
    assert_eq!(triangles(&bent), triangles(&again), "splitting is the same each time");
}
