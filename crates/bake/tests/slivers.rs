//! Flat ground cut into slivers has about as many receivers as ground of compact triangles, and light that is as right. Receivers are counted, not
//! timed.

mod support;

use bake::settings;
use coeff_io::{Prt, Refine, Sampler, Settings};
use glam::{Vec2, Vec3, vec3};
use scene::{Material, Mesh, Scene};
use std::f32::consts::TAU;
use support::grounds::{Kind, compact, disc, polygon, star};
use support::{fixed, quiet};

/// What is cut into slivers; the spikes of the star, which no neighbour joins, are halved one by one.
const SLIVERS: [Kind; 3] = [("disc", disc), ("polygon", polygon), ("star", star)];

/// A cone, which is no flat ground.
fn cone(n: u32) -> Mesh {
    let mut mesh = disc(n);
    mesh.positions[n as usize].y = 0.5;
    mesh
}

/// A box by its lowest and highest corner.
type Solid = [Vec3; 2];

/// Stands on the ground, off the middle.
const POST: Solid = [Vec3::new(0.45, 0.0, -0.85), Vec3::new(1.05, 0.9, -0.25)];

fn solid([low, high]: Solid) -> Mesh {
    let corner = |i: u32| Vec3::select(glam::BVec3::new(i & 1 == 1, i >> 1 & 1 == 1, i >> 2 == 1), high, low);
    let mut mesh = Mesh::default();
    for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(quad.map(corner));
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}

fn scene(ground: Mesh) -> Scene {
    Scene { meshes: vec![ground, solid(POST)], materials: vec![Material::default()], ..Scene::default() }
}

fn with(refine: Refine) -> Settings {
    Settings { refine, ..fixed(3, Sampler::OwenSobol, 512, 0) }
}

/// The ground as it is baked.
fn refined(ground: Mesh, refine: Refine) -> Mesh {
    let scene = scene(ground);
    let settings = Settings { refine, ..settings::standard() };
    bake::refine(&scene, &settings).expect("it splits").meshes[0].clone()
}

fn area(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum()
}

fn edges(mesh: &Mesh) -> impl Iterator<Item = [u32; 2]> + '_ {
    mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
}

fn longest(mesh: &Mesh) -> f32 {
    let length = |[a, b]: [u32; 2]| mesh.positions[a as usize].distance(mesh.positions[b as usize]);
    edges(mesh).map(length).fold(0.0, f32::max)
}

/// Length of the edges that no neighbour walks the other way.
fn border(mesh: &Mesh) -> f64 {
    let all: std::collections::HashSet<[u32; 2]> = edges(mesh).collect();
    let open = all.iter().filter(|[a, b]| !all.contains(&[*b, *a]));
    open.map(|[a, b]| f64::from(mesh.positions[*a as usize].distance(mesh.positions[*b as usize]))).sum()
}

/// Corners of the rim are there from the start; beside them there are no more receivers than compact ground has, and a tenth.
#[test]
fn slivers_have_the_receivers_of_compact_ground() {
    for count in [1_000, 2_000, 4_000] {
        let control = refined(compact(count), Refine::Auto).positions.len();
        for (name, ground) in &SLIVERS[..2] {
            let given = ground(count).positions.len();
            let found = refined(ground(count), Refine::Auto).positions.len();
            assert!(found < given + control * 11 / 10, "{name} of {count}: {found} of {given}, compact {control}");
        }
    }
}

/// Twin: where edges may not be turned, on a cone, the slivers have several times as many.
#[test]
fn slivers_have_the_receivers_of_compact_ground_can_fail() {
    let control = refined(compact(1_000), Refine::Auto).positions.len();
    let found = refined(cone(1_000), Refine::Auto).positions.len();
    assert!(found > 3 * (1_001 + control * 11 / 10), "{found} of a cone, compact {control}");
}

/// The surface stays as it is: its area, its border, its vertices, edges as short as asked for, and texture coordinates where they were.
#[test]
fn shared_vertices_leave_the_surface_as_it_is() {
    let uv = |p: Vec3| Vec2::new(0.3 * p.x + 0.1 * p.z, 0.7 - 0.2 * p.z);
    for (name, ground) in SLIVERS {
        for edge in [0.5, 0.2] {
            let mut given = ground(1_000);
            given.uv0 = given.positions.iter().map(|&p| uv(p)).collect();
            given.normals = vec![Vec3::Y; given.positions.len()];
            let found = refined(given.clone(), Refine::Edge(edge));
            assert!(longest(&found) <= edge, "{name}: an edge of {}", longest(&found));
            assert!((area(&found) / area(&given) - 1.0).abs() < 1e-6, "{name}: {} square metres", area(&found));
            assert!((border(&found) / border(&given) - 1.0).abs() < 1e-6, "{name}: a border of {}", border(&found));
            assert_eq!(&found.positions[..given.positions.len()], &given.positions[..]);
            assert!((0..found.triangles.len()).all(|t| found.area(t) > 0.0), "{name} has a triangle without area");
            let off = found.positions.iter().zip(&found.uv0).map(|(&p, &at)| uv(p).distance(at)).fold(0.0, f32::max);
            assert!(off < 1e-5, "{name}: texture coordinates are {off} off");
        }
    }
}

/// Texture coordinates of each sliver's own keep the slivers apart: turned edges would tear the texture.
#[test]
fn shared_vertices_leave_the_surface_as_it_is_can_fail() {
    let mut given = disc(1_000);
    given.uv0 = given.positions.iter().map(|p| Vec2::new(p.length(), p.x.atan2(p.z))).collect();
    let (plain, apart) = (refined(disc(1_000), Refine::Edge(0.2)), refined(given, Refine::Edge(0.2)));
    assert!(apart.positions.len() > 5 * plain.positions.len(), "{} vertices", apart.positions.len());
}

/// Open share of a point of the ground, by even steps of the disk of the cosine lobe, each ray against the post.
fn open_share(at: Vec2) -> f64 {
    const STEPS: i32 = 150;
    let (mut open, mut all) = (0, 0);
    for cell in (-STEPS..STEPS).flat_map(|i| (-STEPS..STEPS).map(move |j| [i, j])) {
        let foot = Vec2::from(cell.map(|k| (k as f32 + 0.5) / STEPS as f32));
        if foot.length_squared() < 1.0 {
            let direction = vec3(foot.x, (1.0 - foot.length_squared()).sqrt(), foot.y);
            let [a, b] = POST.map(|corner| (corner - vec3(at.x, 0.0, at.y)) / direction);
            open += i32::from(a.min(b).max_element().max(0.0) >= a.max(b).min_element());
            all += 1;
        }
    }
    f64::from(open) / f64::from(all)
}

/// Open share as renderers have it, interpolated over the triangle of the ground that holds the point.
fn drawn_share(prt: &Prt, at: Vec2) -> f64 {
    let (ground, positions) = (&prt.meshes[0], &prt.geometry.positions);
    let first = ground.first_triangle as usize;
    let own = &prt.geometry.triangles[first..first + ground.triangles as usize];
    let shares = own.iter().find_map(|triangle| {
        let [a, b, c] = triangle.map(|v| Vec2::new(positions[v as usize][0], positions[v as usize][2]));
        let parts = [[b, c], [c, a], [a, b]].map(|[p, q]| (p - at).perp_dot(q - at) / (b - a).perp_dot(c - a));
        parts.iter().all(|&part| part > -1e-3).then_some((triangle, parts))
    });
    let (triangle, parts) = shares.unwrap_or_else(|| panic!("no triangle of the ground holds {at}"));
    let open = |v: u32| f64::from(prt.transfer.openness[v as usize]);
    triangle.iter().zip(parts).map(|(&v, part)| f64::from(part) * open(v)).sum()
}

/// Mean and worst difference of the open share along lines that leave the post on all sides.
fn error(ground: Mesh, refine: Refine) -> [f64; 2] {
    let prt = quiet(&scene(ground), &with(refine));
    let middle = 0.5 * (POST[0] + POST[1]);
    let point = |k: u32| {
        let way = Vec2::from_angle(TAU * ((k / 16) as f32 + 0.37) / 13.0);
        let side = 0.3 / way.abs().max_element();
        Vec2::new(middle.x, middle.z) + way * (side + 0.02 + 0.05 * (k % 16) as f32)
    };
    let off: Vec<f64> = (0..13 * 16).map(point).map(|at| (drawn_share(&prt, at) - open_share(at)).abs()).collect();
    [off.iter().sum::<f64>() / off.len() as f64, off.iter().copied().fold(0.0, f64::max)]
}

/// At the foot of a post and along its shadow the light on slivers is as right as on compact ground.
#[test]
fn slivers_have_the_light_of_compact_ground() {
    let [control, worst_control] = error(compact(1_000), Refine::Auto);
    for (name, ground) in SLIVERS {
        let [mean, worst] = error(ground(1_000), Refine::Auto);
        assert!(mean < 1.1 * control && worst < 1.25 * worst_control, "{name}: {mean} and {worst}, compact {control}");
    }
}

/// Slivers that are not split at all have a shadow that is spread over metres.
#[test]
fn slivers_have_the_light_of_compact_ground_can_fail() {
    let [control, _] = error(compact(1_000), Refine::Auto);
    let [mean, _] = error(disc(1_000), Refine::Off);
    assert!(mean > 4.0 * control, "{mean}, compact {control}");
}

/// A fan of fewer slivers than share vertices before it is first cut: a rod of 1 m that ends in a point.
fn rod() -> Mesh {
    let rim = (0..=100).map(|k| vec3(1.0, 0.0, 2e-3 * (k as f32 / 100.0 - 0.5)));
    let positions = std::iter::once(Vec3::ZERO).chain(rim).collect();
    Mesh { positions, triangles: (1..=100).map(|k| [0, k, k + 1]).collect(), ..Mesh::default() }
}

/// Slivers may come to share vertices only after a round; the edges that are turned then take more rounds than halves do.
#[test]
fn slivers_that_come_later_are_split_to_the_end() {
    let scene = Scene { meshes: vec![rod()], materials: vec![Material::default()], ..Scene::default() };
    let edge = 1.0 / 4000.0;
    let refined = bake::refine(&scene, &with(Refine::Edge(edge))).expect("it splits");
    assert!(longest(&refined.meshes[0]) <= edge);
    assert!((area(&refined.meshes[0]) / area(&scene.meshes[0]) - 1.0).abs() < 1e-4);
}
