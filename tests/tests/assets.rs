//! The files of `assets/` are what their recipe makes, open as any others, and light each other as closed forms and the path tracer say.

#[path = "../recipe/mod.rs"]
mod recipe;

use std::path::PathBuf;

fn asset(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../assets").join(name)
}

#[test]
fn files_are_as_their_recipe_makes_them() {
    let scene = std::fs::read(asset("pavilion.glb")).expect("the scene is there");
    assert!(scene == recipe::scene::glb(), "run: cargo run --release --example assets -- assets");
    assert!(scene.len() < 200_000, "{} bytes", scene.len());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let made = folder.path().join("evening.hdr");
    let rows = recipe::sky::ROWS;
    probe_io::write_hdr(&made, 2 * rows, rows, &recipe::sky::pixels()).expect("a picture");
    let probe = std::fs::read(asset("evening.hdr")).expect("the light probe is there");
    assert!(probe == std::fs::read(&made).expect("just written"), "as above");
}

/// Surfaces face outwards: the volume that each closed part encloses, by the divergence theorem, is the one of its shape.
#[test]
fn parts_of_the_scene_face_outwards() {
    let scene = scene::load(&asset("pavilion.glb")).expect("the scene loads");
    assert_eq!((scene.meshes.len(), scene.cameras.len()), (7, 1));
    let volume = |name: &str| -> f64 {
        let mesh = scene.meshes.iter().find(|mesh| mesh.name == name).expect("a part of the scene");
        let corner = |v: u32| mesh.positions[v as usize].as_dvec3();
        let of = |t: &[u32; 3]| corner(t[0]).cross(corner(t[1])).dot(corner(t[2])) / 6.0;
        mesh.triangles.iter().map(of).sum()
    };
    let bench = 0.5 * 0.5 * 1.4;
    assert!((volume("bench") - bench).abs() < 1e-5, "{}", volume("bench"));
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    assert!((volume("ball") / ball - 1.0).abs() < 0.03, "{}", volume("ball"));
    // Twin: turned inside out its sign would differ.
    assert!(volume("ball") > 0.0 && volume("roof") > 0.0);
}

/// Mean radiance of the sky over the sphere: the sun's disc is most of it, so that no sampling may drop it.
#[test]
fn the_sun_of_the_probe_is_kept() {
    let (probe, _) =
        probe_io::Environment::load(&asset("evening.hdr"), &probe_io::LoadOptions::strict()).expect("it loads");
    let light = sh_math::project(sh_math::Bands::new(1).expect("one band"), probe.samples());
    let mean = f64::from(light.values[0][0]) / (4.0 * std::f64::consts::PI).sqrt();
    let (mut sum, mut weight) = (0.0, 0.0);
    for (k, pixel) in recipe::sky::pixels().iter().enumerate() {
        let row = k / (2 * recipe::sky::ROWS);
        let polar = std::f64::consts::PI * (row as f64 + 0.5) / recipe::sky::ROWS as f64;
        sum += f64::from(pixel[0]) * polar.sin();
        weight += polar.sin();
    }
    assert!((mean / (sum / weight) - 1.0).abs() < 0.01, "{mean} against {}", sum / weight);
}
