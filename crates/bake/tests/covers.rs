//! Sheets close to larger surfaces: edges are cut just beyond their rims, and nowhere else.

mod support;

use coeff_io::{Refine, Sampler, Settings};
use glam::Vec3;
use scene::{Material, Mesh, Scene};
use std::collections::BTreeSet;
use support::{fixed, rectangle};

/// Half the side of the sheet, and its distance from the ceiling, metres.
const HALF: f32 = 0.6373;
const GAP: f32 = 0.004;

fn settings() -> Settings {
    Settings { refine: Refine::Auto, ..fixed(3, Sampler::OwenSobol, 64, 1) }
}

/// A ceiling of 8 by 8 metres over lit ground, turned over where asked for, with a sheet that hangs below it: hardly any sky is seen from there, so
/// that only the light of the ground tells the sheet's rim.
fn sheet_at(gap: f32, is_ceiling_turned: bool) -> Scene {
    let side = 2.0 * HALF;
    let sheet = rectangle(Vec3::new(-HALF, -gap, -HALF), Vec3::X * side, Vec3::Z * side, [1, 1]);
    let [along, across] = if is_ceiling_turned { [Vec3::Z, Vec3::X] } else { [Vec3::X, Vec3::Z] };
    let ceiling = rectangle(Vec3::new(-4.0, 0.0, -4.0), 8.0 * along, 8.0 * across, [1, 1]);
    let ground = rectangle(Vec3::new(-10.0, -3.0, -10.0), 20.0 * Vec3::Z, 20.0 * Vec3::X, [1, 1]);
    let two_sided = Material { double_sided: true, ..Material::default() };
    Scene { meshes: vec![ceiling, sheet, ground], materials: vec![two_sided], ..Scene::default() }
}

/// Vertices of the ceiling at these distances from the rim of the sheet, outside of it.
fn beyond(scene: &Scene, [near, far]: [f32; 2]) -> usize {
    let refined = bake::refine(scene, &settings()).expect("the scene is split");
    let places: BTreeSet<[u32; 3]> = refined.meshes[0]
        .positions
        .iter()
        .filter(|p| {
            let away = p.x.abs().max(p.z.abs()) - HALF;
            near <= away && away <= far
        })
        .map(|p| p.to_array().map(f32::to_bits))
        .collect();
    places.len()
}

/// The cuts lie at three gaps from the rim (two along a diagonal), on both sides of the ceiling alike.
#[test]
fn edges_are_cut_beyond_the_rims_of_close_covers() {
    let zone = [1.5 * GAP, 4.0 * GAP];
    for turned in [false, true] {
        let cut = beyond(&sheet_at(GAP, turned), zone);
        assert!(cut > 20, "{cut} vertices, turned over: {turned}");
    }
    // Twin: a sheet that hangs lower than edges are long calls for none there.
    let uncut = beyond(&sheet_at(0.6, false), zone);
    assert!(uncut < 5, "{uncut} vertices above a low sheet");
}

/// A wall is no cover of the floor that it stands on, also where both share vertices with a normal between.
#[test]
fn creases_are_not_cut() {
    let mut mesh = Mesh::default();
    let profile = [Vec3::new(0.0, 2.0, 0.0), Vec3::ZERO, Vec3::new(0.0, 0.0, 2.0)];
    let normals = [Vec3::Z, (Vec3::Y + Vec3::Z).normalize(), Vec3::Y];
    for k in 0..=4u32 {
        mesh.positions.extend(profile.map(|point| point + Vec3::X * (k as f32 - 2.0)));
        mesh.normals.extend(normals);
        if k > 0 {
            for row in 0..2 {
                let a = 3 * (k - 1) + row;
                mesh.triangles.extend([[a, a + 1, a + 4], [a, a + 4, a + 3]]);
            }
        }
    }
    let scene = Scene { meshes: vec![mesh], materials: vec![Material::default()], ..Scene::default() };
    let refined = bake::refine(&scene, &settings()).expect("the scene is split");
    let beside = |p: &&Vec3| (1e-4..0.03).contains(&p.y.max(p.z));
    let found = refined.meshes[0].positions.iter().filter(beside).count();
    assert_eq!(found, 0, "vertices beside the crease");
}
