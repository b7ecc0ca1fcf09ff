//! The scenes for measuring are what they claim to be.

use std::collections::HashMap;

use glam::{Vec3, Vec3Swizzles};

use super::{PAPER_SCENES, builtin};
use crate::lightmap::{faults, share};
use crate::{Camera, Mesh, Scene};

/// Triangles of the paper's scenes (table 1), which these meet to 3 %.
const PAPER: [(&str, usize); 4] =
    [("paper-plants", 18_000), ("paper-room", 21_000), ("paper-heads", 441_000), ("paper-dragon", 1_300_000)];
/// Width over height of the pictures.
const ASPECT: f32 = 16.0 / 9.0;

fn every(check: impl Fn(&str, &Scene)) {
    for (name, what) in PAPER_SCENES {
        assert!(!what.is_empty());
        check(name, &builtin(name).expect("listed"));
    }
}

/// Sheets are the meshes of two triangles; all else is bodies.
fn is_sheet(mesh: &Mesh) -> bool {
    mesh.triangles.len() == 2
}

fn bodies(scene: &Scene) -> impl Iterator<Item = &Mesh> {
    scene.meshes.iter().filter(|mesh| !is_sheet(mesh))
}

/// Whether every directed edge, joined by position, is met by its opposite.
fn is_closed(mesh: &Mesh) -> bool {
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let mut place = Vec::with_capacity(mesh.positions.len());
    for p in &mesh.positions {
        let next = numbers.len() as u32;
        place.push(*numbers.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next));
    }
    let mut forth = Vec::with_capacity(3 * mesh.triangles.len());
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| place[v as usize]);
        forth.extend([(a, b), (b, c), (c, a)]);
    }
    let mut back: Vec<_> = forth.iter().map(|&(a, b)| (b, a)).collect();
    forth.sort_unstable();
    back.sort_unstable();
    forth == back
}

/// Volume by the divergence theorem; positive where triangles face outwards.
fn volume(mesh: &Mesh) -> f64 {
    let corner = |i: u32| mesh.positions[i as usize].as_dvec3();
    mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0).sum()
}

/// Smallest cosine between a triangle and the normals of its corners.
fn least_along(mesh: &Mesh) -> f32 {
    let along = |t: usize| {
        let face = mesh.face_normal(t);
        mesh.triangles[t].map(|v| mesh.normals[v as usize].dot(face)).into_iter().fold(1.0, f32::min)
    };
    (0..mesh.triangles.len()).map(along).fold(1.0, f32::min)
}

/// Where the point appears, from -1 to 1 along both sides of the picture; `None` behind the camera.
fn seen(camera: &Camera, point: Vec3) -> Option<[f32; 2]> {
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let to = point - camera.eye;
    let depth = to.dot(forward) * (0.5 * camera.vertical_fov).tan();
    (depth > 0.0).then(|| [to.dot(right) / (depth * ASPECT), to.dot(right.cross(forward)) / depth])
}

/// Whether the rays through all corners of the picture meet the ground inside `half`: then so do all between them.
fn ground_fills(camera: &Camera, half: Vec3) -> bool {
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let tan = (0.5 * camera.vertical_fov).tan();
    [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].into_iter().all(|(x, y)| {
        let ray = forward + right * (x * tan * ASPECT) + right.cross(forward) * (y * tan);
        let hit = camera.eye - ray * (camera.eye.y / ray.y);
        ray.y < 0.0 && hit.abs().cmple(half).all()
    })
}

#[test]
fn they_are_as_large_as_the_papers() {
    assert_eq!(PAPER.map(|(name, _)| name).to_vec(), PAPER_SCENES.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    for (name, expected) in PAPER {
        let triangles: usize = builtin(name).expect("listed").meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        assert!(triangles.abs_diff(expected) * 100 <= 3 * expected, "{name}: {triangles} triangles, not {expected}");
    }
    assert!(builtin("paper-nothing").is_none());
}

#[test]
fn bodies_are_closed_and_face_outwards() {
    every(|name, scene| {
        for mesh in bodies(scene) {
            assert!(is_closed(mesh), "{name}: {} is open", mesh.name);
            assert!(volume(mesh) > 0.0, "{name}: {} is inside out", mesh.name);
        }
        for mesh in &scene.meshes {
            assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "{name}: normals of {}", mesh.name);
            let least = least_along(mesh);
            assert!(least > 0.2, "{name}: {}: a normal leans from its triangle by cosine {least}", mesh.name);
        }
    });
}

#[test]
fn closedness_and_facing_can_fail() {
    let mut leaves = builtin("paper-plants").expect("listed").meshes.remove(2);
    leaves.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    assert!(is_closed(&leaves) && volume(&leaves) < 0.0 && least_along(&leaves) < 0.0, "turned inside out");
    leaves.triangles.swap_remove(40);
    assert!(!is_closed(&leaves), "a triangle is missing");
}

#[test]
fn surfaces_carry_coordinates_and_shine_by_pictures() {
    every(|name, scene| {
        for mesh in &scene.meshes {
            assert_eq!(mesh.uv0.len(), mesh.positions.len(), "{name}: {}", mesh.name);
            let inside = |uv: &glam::Vec2| uv.min_element() >= 0.0 && uv.max_element() <= 32.0;
            assert!(mesh.uv0.iter().all(inside), "{name}: {}", mesh.name);
            let material = &scene.materials[mesh.material as usize];
            let gloss = material.metallic_roughness_texture.expect("a picture").texture as usize;
            let rough = |i: usize| scene.textures[gloss].rgba[i][1];
            let (low, high) = (0..4096).map(rough).fold((255, 0), |(a, b), r| (a.min(r), b.max(r)));
            assert!(low < 60 && high > 100, "{name}: {}: roughness from {low} to {high} of 255", material.name);
            assert_eq!(material.normal_texture.is_some(), !mesh.tangents.is_empty(), "{name}: {}", mesh.name);
        }
    });
    let floor = &builtin("paper-room").expect("listed").meshes[0];
    assert_eq!((floor.triangles.len(), floor.tangents.len()), (2, floor.positions.len()), "the floor has a normal map");
}

#[test]
fn what_brings_a_sheet_brings_a_good_one() {
    let mut dragon = builtin("paper-dragon").expect("listed");
    assert_eq!(faults(&dragon, &[0, 1]), Vec::new());
    assert!(dragon.meshes.iter().map(share).sum::<f64>() > 0.8, "the sheet is filled");
    dragon.meshes[0].uv1.iter_mut().for_each(|uv| *uv += 0.3);
    assert!(!faults(&dragon, &[0, 1]).is_empty(), "the test can fail");
}

#[test]
fn no_two_sheets_or_boards_lie_in_each_other() {
    every(|name, scene| {
        // Level faces of one height and one facing, whose boxes overlap, would flicker: sheets against bodies.
        let level: Vec<_> = scene.meshes.iter().filter(|m| is_sheet(m) && m.normals[0].y > 0.9).collect();
        for mesh in bodies(scene) {
            for t in (0..mesh.triangles.len()).filter(|t| mesh.face_normal(*t).y.abs() > 0.999) {
                let height = mesh.positions[mesh.triangles[t][0] as usize].y;
                assert!(
                    level.iter().all(|sheet| (sheet.positions[0].y - height).abs() > 1e-4),
                    "{name}: {}",
                    mesh.name
                );
            }
        }
    });
}

#[test]
fn cameras_see_what_is_to_be_seen() {
    every(|name, scene| {
        let [main, close] = &scene.cameras[..] else { panic!("{name}: two cameras") };
        assert_eq!([&main.name[..], &close.name[..]], ["main", "close"], "{name}");
        let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
        for point in bodies(scene).flat_map(|mesh| &mesh.positions) {
            let at = seen(main, *point).expect("before the camera");
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(at[k]), high[k].max(at[k]));
            }
        }
        assert!(low.iter().chain(&high).all(|x| x.abs() < 1.0), "{name}: from {low:?} to {high:?}");
        assert!(high[1] - low[1] > 1.0, "{name}: fills the height from {} to {}", low[1], high[1]);
        let half = scene.meshes[0].positions.iter().fold(Vec3::ZERO, |a, p| a.max(p.abs()));
        assert!(ground_fills(close, half), "{name}: ground behind every pixel of {close:?}, {:?}", half.xz());
        assert!(!ground_fills(main, half), "{name}: the test can fail");
        let middle = bodies(scene)
            .flat_map(|mesh| &mesh.positions)
            .filter(|p| seen(close, **p).is_some_and(|[x, y]| x.abs() < 0.5 && y.abs() < 0.5));
        assert!(middle.count() > 500, "{name}: {close:?} sees bodies");
    });
}
