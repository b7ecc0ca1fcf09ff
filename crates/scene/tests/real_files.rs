//! Real scenes load whole, and no malformed file does worse than an error.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use glam::Vec3;
use scene::{AlphaMode, Scene};

/// Longest time for any malformed file.
const PATIENCE: Duration = Duration::from_secs(10);

/// File, triangles, vertices, textures of the data set's manifest, and whether vertices are kept as they are.
///
/// Where normals or tangents are generated, vertices are split; where vertices repeat, they are merged: then only
/// the triangles can be compared, and the positions.
const SCENES: &[(&str, usize, usize, usize, bool)] = &[
    ("cornell-box/cornell_box.obj", 36, 76, 0, false),
    ("cornell-box-lightmap-uv/CornellBox.glb", 36, 74, 0, true),
    ("stanford-bunny/stanford-bunny.obj", 69_451, 35_947, 0, false),
    ("teapot/teapot.obj", 25_200, 12_993, 0, true),
    ("suzanne/Suzanne.gltf", 3_936, 11_808, 2, true),
    ("spot/spot_triangulated.obj", 5_856, 2_930, 0, false),
    ("spot/spot_quadrangulated.obj", 5_856, 2_930, 0, false),
    ("sponza/sponza.gltf", 262_267, 192_812, 35, false),
    ("water-bottle/WaterBottle.gltf", 4_510, 2_549, 4, true),
    ("house-lightmap-uv/house.glb", 10_497, 13_141, 1, true),
    ("glass-table/glass-table.glb", 592, 712, 0, true),
    ("transmission-roughness-test/TransmissionRoughnessTest.glb", 77_792, 47_260, 5, true),
    ("pandora-level/pandora.obj", 60_810, 35_780, 35, false),
];

fn real(name: &str) -> Option<Scene> {
    let Some(data) = testkit::data_dir() else {
        testkit::skip(name);
        return None;
    };
    Some(scene::load(&data.join("scenes").join(name)).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn real_scenes_load_with_the_counts_of_the_manifest() {
    for (name, triangles, vertices, textures, kept) in SCENES {
        let Some(scene) = real(name) else { return };
        let report = &scene.report;
        assert_eq!(scene.triangle_count() + report.degenerate_triangles, *triangles, "{name}: triangles");
        assert_eq!(scene.textures.len(), *textures, "{name}: textures");
        if *kept {
            let all = scene.vertex_count() + report.duplicate_vertices + report.unused_vertices;
            assert_eq!(all, *vertices, "{name}: vertices");
        }
        check_sound(&scene);
    }
}

/// What every loaded scene promises.
fn check_sound(scene: &Scene) {
    for mesh in &scene.meshes {
        let n = mesh.positions.len();
        let lengths = [mesh.normals.len(), mesh.tangents.len(), mesh.uv0.len(), mesh.uv1.len(), mesh.colors.len()];
        assert!(lengths[0] == n && lengths.iter().all(|l| *l == 0 || *l == n), "{}: {lengths:?} of {n}", mesh.name);
        assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < n), "{}: indices", mesh.name);
        assert!(mesh.positions.iter().all(|p| p.is_finite()), "{}: positions", mesh.name);
        assert!(mesh.normals.iter().all(|v| (v.length() - 1.0).abs() < 1e-5), "{}: normals", mesh.name);
        let has_map = scene.materials[mesh.material as usize].normal_texture.is_some();
        assert_eq!(mesh.tangents.len(), if has_map { n } else { 0 }, "{}: tangents", mesh.name);
        for (tangent, normal) in mesh.tangents.iter().zip(&mesh.normals) {
            assert!((tangent.truncate().length() - 1.0).abs() < 1e-5, "{}: tangent length", mesh.name);
            assert!(tangent.truncate().dot(*normal).abs() < 1e-5, "{}: tangent across normal", mesh.name);
            assert!(tangent.w.abs() == 1.0, "{}: handedness", mesh.name);
        }
        assert!((0..mesh.triangles.len()).all(|t| mesh.area(t) > 0.0), "{}: areas", mesh.name);
    }
}

#[test]
#[should_panic(expected = "normals")]
fn check_sound_can_fail() {
    let mut scene = scene::builtin("plane").expect("a builtin");
    scene.meshes[0].normals[0] *= 1.1;
    check_sound(&scene);
}

#[test]
fn the_bunny_keeps_its_points_and_counts_its_strays() {
    let Some(bunny) = real("stanford-bunny/stanford-bunny.obj") else { return };
    assert_eq!(bunny.report.unused_vertices, 1_113);
    let distinct: std::collections::HashSet<[u32; 3]> =
        bunny.meshes[0].positions.iter().map(|p| p.to_array().map(f32::to_bits)).collect();
    assert_eq!(distinct.len(), 35_947 - 1_113);
    assert!(!bunny.material(0).double_sided, "five holes do not make a sheet of a solid");
}

#[test]
fn pandora_drops_its_116_flat_triangles_and_misses_its_textures() {
    let Some(pandora) = real("pandora-level/pandora.obj") else { return };
    assert_eq!(pandora.report.degenerate_triangles, 116);
    let missing: Vec<_> = pandora.report.warnings.iter().filter(|w| w.message.ends_with("white is used")).collect();
    assert_eq!(missing.len(), 1, "one warning for all files: {missing:?}");
    assert!(missing[0].object.ends_with("and 32 more"), "{missing:?}");
}

#[test]
fn sponza_is_30_metres_long_with_three_masked_materials() {
    let Some(sponza) = real("sponza/sponza.gltf") else { return };
    let size = sponza.bounds().expect("vertices").size();
    assert!((size - Vec3::new(29.77, 12.45, 18.31)).abs().max_element() < 0.01, "{size}");
    let masked = sponza.materials.iter().filter(|m| m.is_masked()).collect::<Vec<_>>();
    assert_eq!(masked.len(), 3);
    assert!(masked.iter().all(|m| m.double_sided && m.alpha == AlphaMode::Mask(0.5)));
    assert_eq!(sponza.materials.iter().filter(|m| m.normal_texture.is_some()).count(), 11);
}

#[test]
fn glass_transmits_and_lamps_shine() {
    let Some(table) = real("glass-table/glass-table.glb") else { return };
    assert!(table.materials.iter().any(|m| m.transmission > 0.0 && !m.blocks_rays()), "glass");
    let Some(cornell) = real("cornell-box-lightmap-uv/CornellBox.glb") else { return };
    let brightest = cornell.materials.iter().map(|m| m.emissive.max_element()).fold(0.0, f32::max);
    assert!(brightest > 1.0, "KHR_materials_emissive_strength: {brightest}");
    assert!(cornell.meshes.iter().all(|m| !m.uv1.is_empty()), "light map coordinates");
    assert!(cornell.meshes.iter().any(|m| !m.colors.is_empty()), "vertex colours");
}

#[test]
fn every_malformed_file_ends_in_an_error_or_a_warned_load() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("malformed files") };
    let files = scene_files(&data.join("bad"));
    assert!(files.len() >= 60, "{} files", files.len());
    for file in files {
        let start = Instant::now();
        match scene::load(&file) {
            Ok(scene) => check_sound(&scene),
            Err(error) => {
                let message = error.to_string();
                let stem = file.file_stem().expect("a name").to_string_lossy().into_owned();
                assert!(message.contains(&stem), "names no file: {message}");
            }
        }
        assert!(start.elapsed() < PATIENCE, "{} took {:?}", file.display(), start.elapsed());
    }
}

/// All files below a folder whose type this crate reads.
fn scene_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()) {
        if entry.is_dir() {
            found.extend(scene_files(&entry));
        } else if entry.extension().is_some_and(|e| ["gltf", "glb", "obj"].iter().any(|k| e == *k)) {
            found.push(entry);
        }
    }
    found
}
