//! Files from practice whose scene must equal that of a plain file.

use scene::{Mesh, Scene};

fn case(name: &str) -> Option<Scene> {
    let Some(data) = testkit::data_dir() else {
        testkit::skip(name);
        return None;
    };
    Some(scene::load(&data.join("cases").join(name)).unwrap_or_else(|error| panic!("{error}")))
}

/// Largest distance of a corner from that of the other scene, where both have the same triangles in the same order.
fn furthest(a: &Scene, b: &Scene) -> f32 {
    assert_eq!(a.meshes.len(), b.meshes.len());
    let corners = |mesh: &Mesh, t: [u32; 3]| t.map(|i| (mesh.positions[i as usize], mesh.normals[i as usize]));
    let mut worst = 0.0f32;
    for (a, b) in a.meshes.iter().zip(&b.meshes) {
        assert_eq!(a.triangles.len(), b.triangles.len(), "{}", a.name);
        for (s, t) in a.triangles.iter().zip(&b.triangles) {
            let pairs = corners(a, *s).into_iter().zip(corners(b, *t));
            worst = pairs.map(|(a, b)| a.0.distance(b.0).max(a.1.distance(b.1))).fold(worst, f32::max);
        }
    }
    worst
}

fn told(scene: &Scene, what: &str) -> usize {
    scene.report.warnings.iter().filter(|warning| warning.message.contains(what)).count()
}

#[test]
fn channels_without_a_node_change_nothing() {
    let Some(reference) = case("reference/red-box.gltf") else { return };
    for name in ["no-node", "pointer"] {
        let Some(scene) = case(&format!("animation-target/{name}.gltf")) else { return };
        assert_eq!(furthest(&scene, &reference), 0.0, "{name}");
        assert_eq!(scene.albedo(1, 0, 0.3, 0.3), reference.albedo(1, 0, 0.3, 0.3));
        assert!(scene.moving.is_empty() && scene.report.warnings.is_empty(), "{:?}", scene.report);
    }
}

#[test]
fn specular_glossiness_is_read() {
    let Some(reference) = case("reference/red-box.gltf") else { return };
    let Some(factor) = case("specular-glossiness/factor.gltf") else { return };
    let (got, expected) = (factor.material(1), reference.material(1));
    assert!(got.base_color.abs_diff_eq(expected.base_color, 1e-6), "{}", got.base_color);
    assert_eq!((got.metallic, got.roughness), (0.0, 0.9));
    let Some(texture) = case("specular-glossiness/texture.gltf") else { return };
    let material = texture.material(1);
    assert_eq!((material.metallic, material.roughness), (0.0, 0.8));
    let colors: Vec<_> = (0..12).map(|t| texture.albedo(1, t, 0.05, 0.1)).collect();
    let red = colors.iter().any(|c| c.x > 0.3 && c.x > 2.0 * c.z);
    let blue = (0..12).flat_map(|t| (1..9).map(move |k| (t, k as f32 * 0.1)));
    let blue = blue.map(|(t, u)| texture.albedo(1, t, u, 0.05)).any(|c| c.z > 0.3 && c.z > 2.0 * c.x);
    assert!(red && blue, "{colors:?}");
}

#[test]
fn skins_stand_at_rest() {
    let (Some(body), Some(control)) =
        (case("skin-at-rest/body-at-root.gltf"), case("skin-at-rest/control-body-below-armature.gltf"))
    else {
        return;
    };
    assert!(furthest(&body, &control) < 1e-6, "{}", furthest(&body, &control));
    let bounds = body.meshes[1].bounds().expect("a body");
    assert!(bounds.min.abs_diff_eq(glam::Vec3::new(-0.2, 0.0, -0.15), 1e-5), "{bounds:?}");
    assert!(bounds.max.abs_diff_eq(glam::Vec3::new(0.2, 1.8, 0.15), 1e-5), "{bounds:?}");
}

#[test]
fn instances_are_placed() {
    for name in ["used", "required"] {
        let Some(scene) = case(&format!("gpu-instancing/{name}.gltf")) else { return };
        assert_eq!(scene.meshes.len(), 17, "{name}");
        let heights: Vec<f32> = scene.meshes[1..].iter().map(|m| m.bounds().expect("a crate").size().y).collect();
        let (low, high) = (heights.iter().copied().fold(9.0, f32::min), heights.iter().copied().fold(0.0, f32::max));
        assert!((high / low - 4.0).abs() < 1e-3, "scales of 0.5 to 2: {heights:?}");
    }
}

#[test]
fn flat_pictures_of_any_size_are_read() {
    let Some(scene) = case("flat-4k-textures/nine-flat-4k-textures.gltf") else { return };
    assert!(scene.report.warnings.is_empty(), "{:?}", scene.report.warnings);
    let texels: usize = scene.textures.iter().map(|texture| texture.rgba.len()).sum();
    assert!(texels < 100, "{texels} texels are kept of flat pictures");
    for mesh in 1..10 {
        let albedo = scene.albedo(mesh, 0, 0.3, 0.3);
        assert!(albedo.abs_diff_eq(glam::Vec3::new(0.7, 0.6, 0.3), 1e-3), "{mesh}: {albedo}");
        assert_eq!(scene.shine(mesh, 0, 0.3, 0.3)[0], 0.0);
    }
}

#[test]
fn far_scenes_equal_near_ones() {
    let (Some(far), Some(near)) =
        (case("far-from-origin/tower-utm.gltf"), case("far-from-origin/control-tower-origin.gltf"))
    else {
        return;
    };
    assert_eq!(far.origin, [500_000.0, 0.0, -5_300_000.0]);
    assert_eq!(near.origin, [0.0; 3]);
    assert_eq!(furthest(&far, &near), 0.0);
    assert_eq!((far.cameras[0].eye, far.cameras[0].target), (near.cameras[0].eye, near.cameras[0].target));
    assert_eq!((told(&far, "taken off"), told(&near, "taken off")), (1, 0));
}

#[test]
fn unlit_is_read() {
    let Some(scene) = case("unlit/unlit-box.gltf") else { return };
    assert!(scene.material(1).unlit && !scene.material(0).unlit);
}
