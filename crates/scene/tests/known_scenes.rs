//! The built-in scenes are what they claim to be.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use scene::{Mesh, Scene, known};
use testkit::assert_close;

/// Rows and columns of the quadrature over the hemisphere.
const GRID: u32 = 600;
/// Error of that quadrature at the edge of a blocker, of the order of 1/GRID.
const QUADRATURE: f64 = 1.5e-3;

fn builtin(name: &str) -> Scene {
    scene::builtin(name).unwrap_or_else(|| panic!("{name} is not built in"))
}

fn area(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum()
}

/// Whether every directed edge (joined by position) is met once by its opposite.
fn is_closed(meshes: &[&Mesh]) -> bool {
    let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
    for mesh in meshes {
        let key = |i: u32| (mesh.positions[i as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
        for t in &mesh.triangles {
            for k in 0..3 {
                let (a, b) = (key(t[k]), key(t[(k + 1) % 3]));
                *edges.entry([a, b]).or_default() += 1;
                *edges.entry([b, a]).or_default() -= 1;
            }
        }
    }
    edges.values().all(|n| *n == 0)
}

/// Volume by the divergence theorem; positive where triangles face outwards.
fn volume(mesh: &Mesh) -> f64 {
    let corner = |i: u32| mesh.positions[i as usize].as_dvec3();
    mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0).sum()
}

#[test]
fn every_scene_is_sound_and_has_a_camera() {
    for (name, what) in scene::BUILTINS {
        let scene = builtin(name);
        assert!(!what.is_empty() && scene.cameras.len() == 1, "{name}");
        for (m, mesh) in scene.meshes.iter().enumerate() {
            assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "{name}, {}: normals", mesh.name);
            for t in 0..mesh.triangles.len() {
                // At the sharp foot of cup and saucer the smooth normals lean furthest, by 77 degrees.
                let face = mesh.face_normal(t);
                let along = mesh.triangles[t].map(|i| mesh.normals[i as usize].dot(face));
                assert!(along.iter().all(|d| *d > 0.2), "{name}, {}: triangle {t} faces {face}: {along:?}", mesh.name);
            }
            let albedo = scene.albedo(m, 0, 0.3, 0.3);
            assert!(albedo.min_element() >= 0.0 && albedo.max_element() <= 1.0, "{name}: albedo {albedo}");
        }
    }
    assert!(scene::builtin("nothing").is_none());
}

#[test]
fn closed_scenes_are_closed() {
    for name in ["furnace-box", "closed-room", "sphere"] {
        assert!(is_closed(&[&builtin(name).meshes[0]]), "{name}");
    }
    assert!(is_closed(&[&builtin("half-blocked-plane").meshes[1]]), "wall");
    assert!(is_closed(&[&builtin("sphere-on-plane").meshes[1]]), "ball");
    let rooms = builtin("two-rooms");
    assert!(is_closed(&[&rooms.meshes[0]]), "sealed room");
    assert!(is_closed(&[&rooms.meshes[1], &rooms.meshes[2]]), "open room and outside");
    let teacup = builtin("teacup");
    for mesh in &teacup.meshes[1..4] {
        assert!(is_closed(&[mesh]), "{}", mesh.name);
        assert!(volume(mesh) > 0.0, "{} faces outwards", mesh.name);
    }
}

#[test]
fn closedness_can_fail() {
    assert!(!is_closed(&[&builtin("bowl").meshes[0]]), "a bowl is open");
    let mut cube = builtin("furnace-box").meshes.remove(0);
    cube.triangles.swap_remove(5);
    assert!(!is_closed(&[&cube]), "a triangle is missing");
    assert!(!is_closed(&[&builtin("two-rooms").meshes[1]]), "a room without a roof");
}

#[test]
fn areas_and_volumes_are_those_of_the_shapes() {
    let cube = &builtin("furnace-box").meshes[0];
    assert_close!(area(cube), 24.0, 1e-5, 0.0);
    assert_close!(volume(cube), 8.0, 1e-5, 0.0);
    assert_close!(volume(&builtin("closed-room").meshes[0]), -8.0, 1e-5, 0.0);
    // The block less two rooms, of which the open one reaches through the roof.
    let rooms: f64 = builtin("two-rooms").meshes.iter().map(volume).sum();
    assert_close!(rooms, 4.1875 * 2.125 * 2.125 - 8.0 - 8.25, 1e-4, 0.0);
    assert_close!(area(&builtin("plane").meshes[0]), 16.0, 1e-5, 0.0);
    // Inscribed meshes are smaller by about (pi/n)^2.
    assert_close!(area(&builtin("sphere").meshes[0]), 4.0 * PI, 0.0, 0.005);
    assert_close!(area(&builtin("bowl").meshes[0]), 2.0 * PI, 0.0, 0.003);
    assert_close!(volume(&builtin("sphere-on-plane").meshes[1]), PI / 6.0, 0.0, 0.004);
}

#[test]
fn show_pieces_are_of_a_size_for_vertex_baking() {
    for (name, range) in [("atrium", 10_000..20_000), ("teacup", 5_000..20_000), ("cornell-box", 4_000..10_000)] {
        let n = builtin(name).vertex_count();
        assert!(range.contains(&n), "{name}: {n} vertices");
    }
}

/// Cosine-weighted share of the hemisphere about `normal` (+y or -y) in which `blocked` is false.
fn share(blocked: impl Fn(DVec3) -> bool, up: f64) -> f64 {
    let mut open = 0u64;
    for i in 0..GRID {
        for j in 0..GRID {
            // Malley: uniform on the disc is cosine-weighted on the hemisphere.
            let radius = ((f64::from(i) + 0.5) / f64::from(GRID)).sqrt();
            let angle = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(GRID);
            let direction = DVec3::new(radius * angle.cos(), up * (1.0 - radius * radius).sqrt(), radius * angle.sin());
            open += u64::from(!blocked(direction));
        }
    }
    open as f64 / f64::from(GRID * GRID)
}

#[test]
fn the_wall_hides_what_its_form_factor_says() {
    for (x, z) in [(0.02, 0.0), (0.5, 1.0), (2.0, -1.5), (4.0, 2.0)] {
        let wall = |d: DVec3| {
            let t = -x / d.x;
            d.x < 0.0 && t * d.y <= 40.0 && (z + t * d.z).abs() <= 60.0
        };
        assert_close!(known::half_blocked_plane_share(x, z), share(wall, 1.0), QUADRATURE, 0.0, "at {x}, {z}");
    }
    assert_close!(known::half_blocked_plane_share(0.02, 0.0), 0.5, 1e-3, 0.0, "at the foot");
}

#[test]
fn facing_planes_hide_what_their_form_factor_says() {
    for (x, z) in [(0.0, 0.0), (0.5, -0.25), (1.0, 1.0), (-1.0, 0.3)] {
        let plate = |d: DVec3| {
            let t = 1.0 / d.y;
            (x + t * d.x).abs() <= 1.0 && (z + t * d.z).abs() <= 1.0
        };
        assert_close!(known::facing_planes_share(x, z), share(plate, 1.0), QUADRATURE, 0.0, "at {x}, {z}");
    }
}

#[test]
fn the_sphere_hides_what_its_form_factor_says() {
    for rho in [0.1, 0.5, 1.0, 2.5] {
        let ball = |d: DVec3| {
            let to_center = DVec3::new(-rho, 0.5, 0.0);
            let along = to_center.dot(d);
            along > 0.0 && to_center.length_squared() - along * along <= 0.25
        };
        assert_close!(known::sphere_on_plane_share(rho), share(ball, 1.0), QUADRATURE, 0.0, "at {rho}");
    }
}

#[test]
fn form_factors_can_fail() {
    let half = share(|d| d.x < 0.0, 1.0);
    assert!(!testkit::close(known::half_blocked_plane_share(2.0, 0.0), half, QUADRATURE, 0.0), "2 m away is not half");
    assert!(!testkit::close(known::sphere_on_plane_share(0.5), 1.0, QUADRATURE, 0.0), "the ball hides something");
}

#[test]
fn the_bowl_tends_to_its_geometric_limit() {
    assert_close!(known::bowl_radiance(0), 0.4, 1e-12, 0.0);
    assert_close!(known::bowl_radiance(1), 0.4 + 0.16, 1e-12, 0.0);
    assert_close!(known::bowl_radiance(60), 0.8 * 0.5 / (1.0 - 0.8 * 0.5), 1e-12, 0.0);
}
