//! Vertices under shells that are drawn from outside alone: their dark is not seen, and does not reach what is.

mod support;

use coeff_io::{Refine, Sampler, Settings};
use glam::Vec3;
use scene::{AlphaMode, Material, Mesh, Scene};
use support::{fixed, quiet};

/// Vertices along a side of the ground.
const SIDE: u32 = 21;

/// Ground of 2 m by 2 m in squares of 10 cm.
fn ground() -> Mesh {
    let place = |k: u32| Vec3::new((k % SIDE) as f32 * 0.1 - 1.0, 0.0, 1.0 - (k / SIDE) as f32 * 0.1);
    let corners = (0..(SIDE - 1) * (SIDE - 1)).map(|k| k / (SIDE - 1) * SIDE + k % (SIDE - 1));
    Mesh {
        positions: (0..SIDE * SIDE).map(place).collect(),
        normals: vec![Vec3::Y; (SIDE * SIDE) as usize],
        triangles: corners.flat_map(|k| [[k, k + 1, k + SIDE + 1], [k, k + SIDE + 1, k + SIDE]]).collect(),
        ..Mesh::default()
    }
}

/// The ground with a masked box without bottom over a part of it; its wall stands at x = 0.03, between two vertices.
fn shell_on_ground(double_sided: bool) -> Scene {
    let quad = |corner: [f32; 3], along: [f32; 3], up: [f32; 3]| {
        let [corner, along, up] = [corner, along, up].map(Vec3::from_array);
        Mesh {
            positions: vec![corner, corner + along, corner + along + up, corner + up],
            normals: vec![along.cross(up).normalize(); 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            material: 1,
            ..Mesh::default()
        }
    };
    let (x, y, z) = ([0.87, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.8]);
    let meshes = vec![
        ground(),
        quad([0.03, 0.0, -0.9], z, y),
        quad([0.9, 0.0, -0.9], y, z),
        quad([0.03, 0.0, 0.9], x, y),
        quad([0.03, 0.0, -0.9], y, x),
        quad([0.03, 1.0, -0.9], z, x),
    ];
    let shell = Material { alpha: AlphaMode::Mask(0.5), double_sided, ..Material::default() };
    Scene { meshes, materials: vec![Material::default(), shell], ..Scene::default() }
}

/// A cavity behind the same wall: all but the wall shows its front to the inside.
fn cavity_behind_wall(alpha: AlphaMode) -> Scene {
    let mut scene = shell_on_ground(false);
    scene.materials[1].alpha = alpha;
    for mesh in &mut scene.meshes[2..] {
        mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        mesh.normals.iter_mut().for_each(|normal| *normal = -*normal);
    }
    scene
}

/// Light of a white sky on the ground just before the wall, as renderers find it between a vertex before it and one under the shell.
fn before_the_wall(scene: &Scene) -> f32 {
    let settings = Settings { refine: Refine::Off, ..fixed(2, Sampler::OwenSobol, 1024, 0) };
    let prt = quiet(scene, &settings);
    let row = (prt.transfer.bands * prt.transfer.bands * prt.transfer.channels) as usize;
    let light = |column: u32| {
        let vertex = (SIDE / 2 * SIDE + column) as usize;
        (4.0 * std::f32::consts::PI).sqrt() * prt.transfer.values[vertex * row]
    };
    // The vertices lie at 0 and at 0.1.
    let share = 0.02 / 0.1;
    (1.0 - share) * light(10) + share * light(11)
}

/// Ground before a wall sees half of the sky and, so near a wall of 1 m, hardly more (Howell B-4).
#[test]
fn the_dark_under_a_shell_stays_there() {
    let light = before_the_wall(&shell_on_ground(false));
    assert!((0.48..0.58).contains(&light), "{light}");
}

/// The inside of a shell with two sides is seen, and is dark.
#[test]
fn the_dark_under_a_shell_stays_there_can_fail() {
    let light = before_the_wall(&shell_on_ground(true));
    assert!(light < 0.45, "{light}");
}

/// Behind a wall that is drawn from outside alone its back is half of what is seen, whatever else is there.
#[test]
fn the_dark_behind_a_wall_stays_there() {
    let light = before_the_wall(&cavity_behind_wall(AlphaMode::Opaque));
    assert!((0.48..0.58).contains(&light), "{light}");
}

/// Half of a view being backs is what leaves show to each other: a vertex among them keeps its dark.
#[test]
fn the_dark_behind_a_wall_stays_there_can_fail() {
    let light = before_the_wall(&cavity_behind_wall(AlphaMode::Mask(0.5)));
    assert!(light < 0.45, "{light}");
}
