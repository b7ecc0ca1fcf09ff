//! Blocks whose bottoms lie in the plane of the floor: about as few steps as lifted blocks take. Steps are counted, not timed.

use bake::Receivers;
use glam::{Vec3, vec3};
use raytrace::{FanState, Tracer, offset_origin};
use scene::{Material, Mesh, Scene};

/// Mean steps of the question whether anything stands above a receiver, and of a small fan from it, once the tracer has learned.
fn steps(scene: &Scene) -> [f64; 2] {
    let (mut positions, mut triangles): (Vec<Vec3>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    for mesh in &scene.meshes {
        let first = positions.len() as u32;
        positions.extend(&mesh.positions);
        triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let receivers = Receivers::of(scene).list;
    let mut mean = [0.0; 2];
    // The first round is the lesson.
    for _ in 0..2 {
        let (mut above, mut state) = (0, FanState::new());
        for receiver in &receivers {
            above += tracer.steps_above(receiver.vertex, receiver.normal);
            let (x, y) = receiver.normal.any_orthonormal_pair();
            let tilted = [x, y, -x, -y].map(|side| (side + receiver.normal).normalize());
            let each = [0, 1, 2].map(|axis| tilted.map(|d| d[axis]));
            let origin = offset_origin(receiver.position, receiver.geometric_normal);
            let solid = |_, _, _| true;
            tracer.occluded_fan(origin, &each[0], &each[1], &each[2], &solid, &mut state, &mut [0]);
        }
        mean = [above, state.steps()].map(|steps| steps as f64 / receivers.len() as f64);
    }
    mean
}

/// A floor of 8 x 8 squares with blocks on it, each lifted by up to so many metres.
fn blocks(count: u32, lifted: f32) -> Scene {
    let mut mesh = Mesh::default();
    let mut quad = |corners: [Vec3; 4]| {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners);
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    for k in 0..64 {
        let at = vec3((k % 8) as f32, 0.0, (k / 8) as f32);
        quad([at, at + Vec3::Z, at + Vec3::X + Vec3::Z, at + Vec3::X]);
    }
    let side = (count as f32).sqrt().ceil() as u32;
    for k in 0..count {
        let along = |i: u32| 0.1 + 7.8 * i as f32 / side as f32;
        let at = vec3(along(k % side), lifted * (k * 7919 % 100) as f32 / 100.0, along(k / side));
        let corner = |i: u32| at + 4.0 / side as f32 * vec3((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32);
        for face in [[0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5], [0, 2, 3, 1], [4, 5, 7, 6]] {
            quad(face.map(corner));
        }
    }
    Scene { meshes: vec![mesh], materials: vec![Material::default()], ..Scene::default() }
}

fn check(flush: &Scene, lifted: &Scene) {
    let ([above, fan], [control, control_fan]) = (steps(flush), steps(lifted));
    assert!(above < 2.0 * control, "{above} steps, {control} with the blocks lifted");
    assert!(fan < 2.0 * control_fan, "{fan} steps of a fan, {control_fan} with the blocks lifted");
}

#[test]
fn flush_blocks_take_the_steps_of_lifted_ones() {
    check(&blocks(400, 0.0), &blocks(400, 0.05));
    let (few, many) = (steps(&blocks(400, 0.0)), steps(&blocks(1_600, 0.0)));
    assert!(many[0] < 2.0 * few[0] && many[1] < 2.0 * few[1], "{few:?} steps, {many:?} of four times the blocks");
}

/// The control itself grows with the scene: steps that were not counted would not.
#[test]
fn flush_blocks_take_the_steps_of_lifted_ones_can_fail() {
    let [above, fan] = steps(&blocks(400, 0.05));
    assert!(above > 1.0 && fan > 4.0, "{above} and {fan} steps");
}

#[test]
fn the_flush_blocks_of_the_cases_take_the_steps_of_their_control() {
    let Some(data) = testkit::data_dir() else {
        testkit::skip("flush-blocks");
        return;
    };
    let load = |name: &str| scene::load(&data.join("cases/flush-blocks").join(name)).expect("the case loads");
    check(&load("blocks-on-floor-1000.glb"), &load("control-blocks-lifted-1000.glb"));
}
