//! What glTF files say is what the scene holds.

mod gltf_text;
mod made;

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3, Vec4};
use gltf_text::{SHOWN, data_uri, floats, mesh, triangle};
use made::Folder;
use scene::{LightKind, Scene, Wrap};
use testkit::assert_close;

fn load(text: &str) -> Scene {
    made::load("a.gltf", text).unwrap_or_else(|error| panic!("{error}"))
}

/// A PNG of 2 x 1 texels, red and blue.
fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbImage::from_raw(2, 1, vec![255, 0, 0, 0, 0, 255]).expect("two texels");
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
    bytes.into_inner()
}

/// One triangle with a material given by its JSON, and a texture 0 that mirrors and clamps.
fn with_material(material: &str) -> Scene {
    load(&triangle(&format!(
        r#","images":[{{"uri":"{}"}}],"samplers":[{{"wrapS":33648,"wrapT":33071}}],
        "textures":[{{"source":0,"sampler":0}}],"materials":[{material}]{}{SHOWN}"#,
        data_uri(&png()),
        mesh(r#","material":0"#)
    )))
}

#[test]
fn textures_transforms_and_wrapping_are_read() {
    let transform = r#""extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"rotation":1.57079632679,"scale":[2,3],"texCoord":1}}"#;
    let scene = with_material(&format!(
        r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0,{transform}}}}},"normalTexture":{{"index":0,"scale":0.5,{transform}}}}}"#
    ));
    let material = scene.material(0);
    // A quarter turn counter-clockwise on the picture: u' = 0.5 + 3 v, v' = 0.25 - 2 u.
    for slot in [material.base_color_texture, material.normal_texture].map(|s| s.expect("a texture")) {
        assert!((slot.place(Vec2::new(0.1, 0.2)) - Vec2::new(1.1, 0.05)).length() < 1e-6, "{slot:?}");
        assert_eq!((slot.texture, slot.uv_set), (0, 1));
    }
    assert_close!(material.normal_scale, 0.5, 0.0, 0.0);
    assert_eq!(scene.textures[0].wrap, [Wrap::Mirror, Wrap::Clamp]);
    assert_eq!(scene.textures[0].rgba, [[255, 0, 0, 255], [0, 0, 255, 255]]);
    assert_eq!(scene.textures.len(), 1, "one picture, one texture");
}

#[test]
fn texture_transform_can_fail() {
    let quarter = glam::Affine2::from_angle(FRAC_PI_2).transform_point2(Vec2::new(0.1, 0.2));
    assert!((quarter - Vec2::new(0.2, -0.1)).length() > 0.1, "the other sense of rotation is told apart");
}

#[test]
fn emission_transmission_and_unlit_are_read() {
    let scene = with_material(
        r#"{"emissiveFactor":[1,0.5,0],"alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,
        "pbrMetallicRoughness":{"metallicFactor":0.75,"roughnessFactor":0.5,"baseColorFactor":[0.1,0.2,0.3,0.4]},
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":8},
        "KHR_materials_transmission":{"transmissionFactor":0.9}}}"#,
    );
    let material = scene.material(0);
    assert_eq!(material.emissive, Vec3::new(8.0, 4.0, 0.0));
    assert_eq!((material.transmission, material.metallic, material.roughness), (0.9, 0.75, 0.5));
    assert_eq!(material.base_color, Vec4::new(0.1, 0.2, 0.3, 0.4));
    assert!(material.is_masked() && material.double_sided && !material.blocks_rays());
    let unlit = with_material(r#"{"extensions":{"KHR_materials_unlit":{}}}"#);
    assert_eq!((unlit.material(0).metallic, unlit.material(0).roughness), (0.0, 1.0));
}

#[test]
fn missing_pictures_are_white_with_a_warning() {
    for image in [r#"{"uri":"gone.png"}"#, r#"{"uri":"https://example.org/a.png"}"#, r#"{"uri":"data:,abc"}"#, "{}"] {
        let scene = load(&triangle(&format!(
            r#","images":[{image}],"textures":[{{"source":0}}],
            "materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"baseColorTexture":{{"index":0}}}}}}]{}{SHOWN}"#,
            mesh(r#","material":0"#)
        )));
        assert_eq!(scene.albedo(0, 0, 0.3, 0.3), Vec3::ONE, "{image}");
        assert!(scene.report.warnings.iter().any(|w| w.message.ends_with("white is used")), "{image}");
    }
}

#[test]
fn nodes_nest_mirror_and_show_cameras_and_lights() {
    let scene = load(&triangle(&format!(
        r#"{},"cameras":[{{"type":"perspective","perspective":{{"yfov":0.7,"znear":0.1}}}}],
        "extensionsUsed":["KHR_lights_punctual"],
        "extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"spot","intensity":3,"color":[1,0.5,0],"spot":{{"innerConeAngle":0.1,"outerConeAngle":0.2}}}}]}}}},
        "nodes":[{{"name":"top","translation":[0,0,5],"children":[1,2]}},
                 {{"name":"mirrored","mesh":0,"scale":[-2,1,1]}},
                 {{"name":"eye","rotation":[0,0.70710678,0,0.70710678],"camera":0,"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}}],
        "scenes":[{{"nodes":[0]}}]"#,
        mesh("")
    )));
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.name, "mirrored");
    assert!(mesh.positions.contains(&Vec3::new(-2.0, 0.0, 5.0)), "{:?}", mesh.positions);
    assert!((mesh.face_normal(0) - Vec3::Z).length() < 1e-6, "mirroring keeps the front in front");
    assert!((mesh.normals[0] - Vec3::Z).length() < 1e-6, "the normal too");
    let camera = &scene.cameras[0];
    assert!((camera.target - camera.eye - Vec3::NEG_X).length() < 1e-5, "a quarter turn left looks along -x");
    assert_eq!((camera.vertical_fov, camera.eye), (0.7, Vec3::new(0.0, 0.0, 5.0)));
    let light = &scene.lights[0];
    assert_eq!(light.kind, LightKind::Spot { inner: 0.1, outer: 0.2 });
    assert_eq!(light.intensity, Vec3::new(3.0, 1.5, 0.0));
    assert!((light.direction - Vec3::NEG_X).length() < 1e-5);
}

/// A scene of 4 points (0,0) (1,0) (0,1) (1,1) in z = 0 drawn in a mode.
fn quad(mode: u32) -> Scene {
    let bytes = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]);
    load(&format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"{}","byteLength":48}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":{mode}}}]}}]{SHOWN} }}"#,
        data_uri(&bytes)
    ))
}

#[test]
fn strips_and_fans_are_triangles_of_one_orientation() {
    let strip = quad(5);
    assert_eq!(strip.triangle_count(), 2);
    assert!((0..2).all(|t| strip.meshes[0].face_normal(t) == Vec3::Z), "both halves of a strip face one way");
    assert_eq!(quad(6).triangle_count(), 2);
    assert_eq!(quad(4).triangle_count(), 1);
}

#[test]
fn quantised_and_sparse_positions_are_decoded() {
    // Unsigned shorts, normalised: 65535 is 1. Six bytes a position, padded to eight.
    let corners: [[u16; 4]; 3] = [[0, 0, 0, 0], [65_535, 0, 0, 0], [0, 13_107, 0, 0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let quantised = load(&format!(
        r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":["KHR_mesh_quantization"],
        "buffers":[{{"uri":"{}","byteLength":24}}],"bufferViews":[{{"buffer":0,"byteLength":24,"byteStride":8}}],
        "accessors":[{{"bufferView":0,"componentType":5123,"normalized":true,"count":3,"type":"VEC3"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]{SHOWN} }}"#,
        data_uri(&bytes)
    ));
    assert_eq!(quantised.meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y * 0.2]);
    // No base data: zeros but for vertices 1 and 2.
    let bytes = [vec![1u8, 2, 0, 0], floats(&[3., 0., 0., 0., 4., 0.])].concat();
    let sparse = load(&format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"{}","byteLength":28}}],
        "bufferViews":[{{"buffer":0,"byteLength":4}},{{"buffer":0,"byteOffset":4,"byteLength":24}}],
        "accessors":[{{"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[3,4,0],
          "sparse":{{"count":2,"indices":{{"bufferView":0,"componentType":5121}},"values":{{"bufferView":1}}}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]{SHOWN} }}"#,
        data_uri(&bytes)
    ));
    assert_eq!(sparse.meshes[0].positions, [Vec3::ZERO, Vec3::X * 3.0, Vec3::Y * 4.0]);
}

#[test]
fn generated_tangents_agree_with_those_of_the_file() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("tangents of the water bottle") };
    let source = data.join("scenes/water-bottle");
    let given = scene::load(&source.join("WaterBottle.gltf")).unwrap_or_else(|error| panic!("{error}"));
    // The same without its tangents, which become an attribute of unknown meaning.
    let text = std::fs::read_to_string(source.join("WaterBottle.gltf")).expect("the bottle");
    let folder = Folder::new();
    for file in std::fs::read_dir(&source).expect("its folder").map(|file| file.expect("a file").path()) {
        let name = file.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        folder.write(&name, std::fs::read(&file).expect("its data"));
    }
    let made = folder.load("a.gltf", text.replace("\"TANGENT\"", "\"_TANGENT\"")).unwrap_or_else(|e| panic!("{e}"));
    let (given, made) = (&given.meshes[0], &made.meshes[0]);
    assert_eq!(given.triangles.len(), made.triangles.len());
    let (mut alike, mut corners) = (0usize, 0usize);
    for (a, b) in given.triangles.iter().zip(&made.triangles) {
        let [p, q, r] = a.map(|i| given.uv0[i as usize]);
        // Triangles that are a line on the picture have no handedness of their own.
        if (q - p).perp_dot(r - p).abs() < 1e-9 {
            continue;
        }
        for (a, b) in a.iter().zip(b).map(|(a, b)| (given.tangents[*a as usize], made.tangents[*b as usize])) {
            corners += 1;
            alike += usize::from(a.truncate().dot(b.truncate()) > 0.98);
            assert_eq!(a.w, b.w, "handedness of {a} and {b}");
        }
    }
    assert!(corners > 13_000, "{corners}");
    // The file's own tangents are averaged a little differently where its unwrapping meets itself.
    assert!(alike as f64 > 0.97 * corners as f64, "{alike} of {corners} within 11 degrees");
}

/// What an animation moves, with all that hangs on it, is named; what stands still is not.
#[test]
fn moving_meshes_are_named() {
    let nodes = r#","nodes":[{"name":"arm","children":[1]},{"name":"hand","mesh":0},{"name":"table","mesh":0}],
        "scenes":[{"nodes":[0,2]}],"scene":0"#;
    let animation = r#","animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],
        "samplers":[{"input":0,"output":0}]}]"#;
    let moving = load(&triangle(&format!("{}{nodes}{animation}", mesh("")))).moving;
    assert_eq!(moving, ["hand"]);
    let still = load(&triangle(&format!("{}{nodes}", mesh("")))).moving;
    assert!(still.is_empty(), "can fail: without the animation nothing moves, yet {still:?}");
}
