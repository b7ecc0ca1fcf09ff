//! Materials of other models than metallic-roughness, and pictures that are large or missing.

mod gltf_text;
mod made;

use glam::{Vec3, Vec4};
use gltf_text::{SHOWN, data_uri, mesh, triangle};
use scene::Scene;

fn png(width: u32, height: u32, rgba: Vec<u8>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_raw(width, height, rgba).expect("texels");
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
    bytes.into_inner()
}

/// One triangle with a material and textures 0, 1, ... of `pictures`.
fn with_material(pictures: &[Vec<u8>], material: &str) -> Scene {
    let images: Vec<String> = pictures.iter().map(|p| format!(r#"{{"uri":"{}"}}"#, data_uri(p))).collect();
    let textures: Vec<String> = (0..pictures.len()).map(|i| format!(r#"{{"source":{i}}}"#)).collect();
    let lists = match pictures {
        [] => String::new(),
        _ => format!(r#","images":[{}],"textures":[{}]"#, images.join(","), textures.join(",")),
    };
    let text = format!(r#"{lists},"materials":[{material}]{}{SHOWN}"#, mesh(r#","material":0"#));
    made::load("a.gltf", triangle(&text)).unwrap_or_else(|error| panic!("{error}"))
}

fn glossy(members: &str) -> String {
    format!(r#"{{"extensions":{{"KHR_materials_pbrSpecularGlossiness":{{{members}}}}}}}"#)
}

#[test]
fn specular_glossiness_factors_are_converted() {
    let plastic = r#""diffuseFactor":[0.8,0.1,0.1,0.5],"specularFactor":[0.04,0.04,0.04],"glossinessFactor":0.1"#;
    let scene = with_material(&[], &glossy(plastic));
    let material = scene.material(0);
    assert!(material.base_color.abs_diff_eq(Vec4::new(0.8, 0.1, 0.1, 0.5), 1e-6), "{}", material.base_color);
    assert_eq!((material.metallic, material.roughness), (0.0, 0.9));
    let silver = r#""diffuseFactor":[0,0,0,1],"specularFactor":[0.97,0.96,0.91],"glossinessFactor":0.8"#;
    let scene = with_material(&[], &glossy(silver));
    let material = scene.material(0);
    assert!(material.base_color.abs_diff_eq(Vec4::new(0.97, 0.96, 0.91, 1.0), 1e-3), "{}", material.base_color);
    assert!(material.metallic > 0.999 && (material.roughness - 0.2).abs() < 1e-6);
    // No factor at all: by the defaults a mirror.
    assert!(with_material(&[], &glossy("")).material(0).metallic > 0.999);
    let both = r#"{"pbrMetallicRoughness":{"baseColorFactor":[0,1,0,1]},"extensions":{"KHR_materials_pbrSpecularGlossiness":
        {"diffuseFactor":[0,0,1,1],"specularFactor":[0,0,0]}}}"#;
    assert!(with_material(&[], both).albedo(0, 0, 0.3, 0.3).z > 0.99, "the extension goes before the plain material");
}

#[test]
fn diffuse_textures_of_plain_dielectrics_stay_as_they_are() {
    let checks = png(2, 1, vec![200, 0, 0, 255, 0, 0, 200, 255]);
    let members = r#""diffuseTexture":{"index":0},"specularFactor":[0.04,0.04,0.04],"glossinessFactor":0.2"#;
    let scene = with_material(&[checks], &glossy(members));
    assert_eq!(scene.textures.len(), 1);
    assert_eq!(scene.textures[0].rgba, [[200, 0, 0, 255], [0, 0, 200, 255]]);
    let material = scene.material(0);
    assert_eq!((material.base_color, material.metallic, material.roughness), (Vec4::ONE, 0.0, 0.8));
}

/// Left: gold, glossy. Right: blue paint, rough.
#[test]
fn specular_glossiness_textures_are_converted_texel_by_texel() {
    let diffuse = png(2, 1, vec![0, 0, 0, 255, 20, 60, 200, 255]);
    let finish = png(2, 1, vec![255, 226, 155, 230, 56, 56, 56, 51]);
    let members = r#""diffuseTexture":{"index":0},"specularGlossinessTexture":{"index":1}"#;
    let scene = with_material(&[diffuse, finish], &glossy(members));
    // The coordinates of the triangle are (0,0), (1,0), (0,1): u is the first weight.
    let at = |u: f32| {
        let [metallic, roughness] = scene.shine(0, 0, u, 0.0);
        (scene.base_color(0, 0, u, 0.0).truncate(), metallic, roughness)
    };
    let linear = |rgb: [u8; 3]| Vec3::from_array(rgb.map(scene::linear_from_srgb));
    let (gold, metal, smooth) = at(0.25);
    assert!(gold.abs_diff_eq(linear([255, 226, 155]), 0.01), "{gold}");
    assert!(metal > 0.99 && (smooth - (1.0 - 230.0 / 255.0)).abs() < 0.003, "{metal} {smooth}");
    let (blue, matte, rough) = at(0.75);
    assert!(blue.abs_diff_eq(linear([20, 60, 200]), 0.01), "{blue}");
    assert!(matte == 0.0 && (rough - 0.8).abs() < 0.003, "{matte} {rough}");
    assert!((gold - blue).length() > 0.5, "can fail: the halves differ");
}

/// A glossiness picture alone: green of the new picture is 1 - glossiness, and its factor counts.
#[test]
fn glossiness_textures_become_roughness() {
    let finish = png(2, 1, vec![56, 56, 56, 255, 56, 56, 56, 0]);
    let members = r#""diffuseFactor":[0.3,0.3,0.3,1],"specularGlossinessTexture":{"index":0},"glossinessFactor":0.5"#;
    let scene = with_material(&[finish], &glossy(members));
    let roughness = |u: f32| scene.shine(0, 0, u, 0.0)[1];
    assert!((roughness(0.25) - 0.5).abs() < 0.003 && (roughness(0.75) - 1.0).abs() < 0.003);
    assert!((scene.albedo(0, 0, 0.3, 0.0).x - 0.3).abs() < 0.003, "{}", scene.albedo(0, 0, 0.3, 0.0));
}

#[test]
fn an_unreadable_metallic_roughness_picture_is_no_metal() {
    for picture in [b"broken".to_vec(), Vec::new()] {
        let material =
            r#"{"pbrMetallicRoughness":{"baseColorFactor":[0.7,0.6,0.3,1],"metallicRoughnessTexture":{"index":0}}}"#;
        let scene = with_material(&[picture], material);
        assert_eq!(scene.shine(0, 0, 0.3, 0.3), [0.0, 1.0]);
        assert!(scene.albedo(0, 0, 0.3, 0.3).abs_diff_eq(Vec3::new(0.7, 0.6, 0.3), 1e-6));
        assert!(scene.report.warnings.iter().any(|w| w.message.contains("not metallic")), "{:?}", scene.report);
    }
    let metal = with_material(&[], r#"{"pbrMetallicRoughness":{"baseColorFactor":[0.7,0.6,0.3,1]}}"#);
    assert_eq!(metal.shine(0, 0, 0.3, 0.3), [1.0, 1.0], "can fail: without a picture the factor says metal");
}

#[test]
fn an_unreadable_normal_map_bends_nothing() {
    let scene = with_material(&[b"broken".to_vec()], r#"{"normalTexture":{"index":0}}"#);
    assert!(scene.material(0).normal_texture.is_none());
    assert_eq!(scene.bent_normal(0, 0, 0.3, 0.3), scene.meshes[0].normal(0, 0.3, 0.3));
}

#[test]
fn many_warnings_alike_are_one() {
    let node = |i: usize| format!(r#"{{"name":"lamp\u001b{i}","extensions":{{"KHR_lights_punctual":{{"light":0}}}}}}"#);
    let nodes: Vec<String> = (0..300).map(node).collect();
    let all: Vec<String> = (0..=300).map(|i| i.to_string()).collect();
    let text = format!(
        r#"{},"extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"point"}}]}}}},
        "nodes":[{{"mesh":0,"name":"a\u0007b"}},{}],"scenes":[{{"nodes":[{}]}}]"#,
        mesh(""),
        nodes.join(","),
        all.join(",")
    );
    let scene = made::load("a.gltf", triangle(&text)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.lights.len(), 300);
    assert_eq!(scene.report.warnings.len(), 1, "{:?}", scene.report.warnings);
    assert_eq!(scene.report.warnings[0].object, r"lamp\u{1b}0, lamp\u{1b}1, lamp\u{1b}2 and 297 more");
}
