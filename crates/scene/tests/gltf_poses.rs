//! Meshes stand where nodes, joints, weights and instances put them at rest.

mod gltf_text;
mod made;

use glam::Vec3;
use gltf_text::{data_uri, floats, mesh, triangle};
use scene::Scene;

fn load(text: &str) -> Scene {
    made::load("a.gltf", text).unwrap_or_else(|error| panic!("{error}"))
}

/// A node list that the scene shows from node 0 on, after the triangle mesh and what `more` adds.
fn nodes(more: &str, nodes: &str) -> Scene {
    load(&triangle(&format!(r#"{}{more},"nodes":[{nodes}],"scenes":[{{"nodes":[0]}}]"#, mesh(""))))
}

#[test]
fn channels_without_a_node_are_left_out() {
    let animation = |target: &str| {
        let all = r#","nodes":[{"name":"still","mesh":0},{"name":"other"}],"scenes":[{"nodes":[0,1]}]"#;
        load(&triangle(&format!(
            r#"{}{all},"animations":[{{"samplers":[{{"input":0,"output":0}}],"channels":[{{"sampler":0,"target":{target}}}]}}]"#,
            mesh("")
        )))
    };
    let pointer = |path: &str| {
        animation(&format!(r#"{{"path":"pointer","extensions":{{"KHR_animation_pointer":{{"pointer":"{path}"}}}}}}"#))
    };
    assert!(animation(r#"{"path":"rotation"}"#).moving.is_empty());
    assert!(pointer("/materials/0/pbrMetallicRoughness/baseColorFactor").moving.is_empty());
    assert_eq!(pointer("/nodes/0/translation").moving, ["still"], "a pointer to a node moves it");
    assert_eq!(animation(r#"{"node":0,"path":"rotation"}"#).moving, ["still"], "can fail");
}

#[test]
fn scenes_may_lack_nodes() {
    for scenes in ["", r#","scenes":[]"#, r#","scenes":[{}]"#, r#","scenes":[{"name":"empty"}],"scene":0"#] {
        let scene = load(&triangle(&format!(r#"{},"nodes":[{{"mesh":0,"translation":[0,0,3]}}]{scenes}"#, mesh(""))));
        assert_eq!(scene.meshes[0].positions[0], Vec3::Z * 3.0, "{scenes}");
    }
    assert_eq!(load(&triangle(&format!(r#"{},"scenes":[{{}}]"#, mesh("")))).triangle_count(), 1, "no nodes at all");
}

#[test]
fn hidden_nodes_and_all_below_them_are_left_out() {
    let hidden = r#""extensions":{"KHR_node_visibility":{"visible":false}}"#;
    let scene = nodes(
        r#","cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}]"#,
        &format!(
            r#"{{"children":[1,3]}},{{"children":[2],{hidden}}},{{"name":"child","mesh":0,"camera":0,
            "extensions":{{"KHR_node_visibility":{{"visible":true}}}}}},{{"name":"seen","mesh":0}}"#
        ),
    );
    let names: Vec<&str> = scene.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!(names, ["seen"]);
    assert_eq!(scene.cameras.len(), 1, "cameras see from hidden nodes too");
    assert!(scene.report.warnings.iter().any(|w| w.object == "child" && w.message.contains("hidden")));
}

/// A buffer after those of the triangle: views and accessors of `parts` (bytes, accessor type, component, normalised).
fn with_accessors(parts: &[(Vec<u8>, &str, u32, bool)], rest: &str) -> Scene {
    let all: Vec<u8> = parts.iter().flat_map(|part| part.0.clone()).collect();
    let (mut views, mut accessors, mut at) = (String::new(), String::new(), 0);
    for (index, (bytes, kind, component, normalized)) in parts.iter().enumerate() {
        let width = match component {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        };
        let components = match *kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let (length, count, view) = (bytes.len(), bytes.len() / width / components, index + 2);
        views.push_str(&format!(r#",{{"buffer":1,"byteOffset":{at},"byteLength":{length}}}"#));
        accessors.push_str(&format!(
            r#",{{"bufferView":{view},"componentType":{component},"count":{count},"type":"{kind}","normalized":{normalized}}}"#
        ));
        at += length;
    }
    let text = triangle(rest);
    // The triangle's own text ends its lists of buffers, views and accessors in these ways.
    let buffer = format!(r#"}},{{"uri":"{}","byteLength":{}}}],"#, data_uri(&all), all.len());
    let text = text.replacen("\"byteLength\":60}],", &format!("\"byteLength\":60{buffer}"), 1);
    let text = text.replacen("\"byteLength\":24}],", &format!("\"byteLength\":24}}{views}],"), 1);
    load(&text.replacen("\"type\":\"VEC2\"}]", &format!("\"type\":\"VEC2\"}}{accessors}]"), 1))
}

/// Column-major bytes of a scale and a translation.
fn matrix(scale: f32, [x, y, z]: [f32; 3]) -> Vec<u8> {
    floats(&[scale, 0., 0., 0., 0., scale, 0., 0., 0., 0., scale, 0., x, y, z, 1.])
}

/// The triangle of a skin with two joints: corner 0 on the first, 1 on the second, 2 on both by halves.
fn skinned(joints: &str, weights: (Vec<u8>, u32), binds: Vec<u8>) -> Scene {
    let numbers: Vec<u8> = vec![0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0];
    let (weights, component) = weights;
    with_accessors(
        &[
            (numbers, "VEC4", 5121, false),
            (weights, "VEC4", component, component != 5126),
            (binds, "MAT4", 5126, false),
        ],
        &format!(
            r#","meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3}}}}]}}],
            "skins":[{{"joints":[2,3],"inverseBindMatrices":4}}],
            "nodes":[{{"children":[1,2]}},{{"name":"body","mesh":0,"skin":0,"translation":[100,0,0],"scale":[9,9,9]}},{joints}],
            "scenes":[{{"nodes":[0]}}]"#
        ),
    )
}

#[test]
fn joints_place_vertices_and_the_skinned_node_does_not() {
    // The second joint is scaled, and hangs on the first.
    let joints = r#"{"translation":[0,0,5],"scale":[2,2,2],"children":[3]},{"translation":[10,0,0],"scale":[3,1,1]}"#;
    let binds = [matrix(1.0, [0.0; 3]), matrix(1.0, [0.0, 1.0, 0.0])].concat();
    let weights = floats(&[1., 0., 0., 0., 1., 0., 0., 0., 0.5, 0.5, 0., 0.]);
    let scene = skinned(joints, (weights, 5126), binds.clone());
    // First: p -> 2 p + (0, 0, 5). Second: q = p + (0, 1, 0), then (3 q.x + 10, q.y, q.z), then as the first.
    let first = |p: Vec3| p * 2.0 + Vec3::Z * 5.0;
    let second = |p: Vec3| first(Vec3::new(3.0 * p.x + 10.0, p.y + 1.0, p.z));
    let expected = [first(Vec3::ZERO), second(Vec3::X), 0.5 * (first(Vec3::Y) + second(Vec3::Y))];
    assert_eq!(scene.meshes[0].positions, expected);
    assert_eq!(scene.moving, ["body"]);
    // The same weights as normalised bytes; and not normalised to one, as some exporters leave them.
    let bytes = vec![255, 0, 0, 0, 255, 0, 0, 0, 128, 128, 0, 0];
    assert_eq!(skinned(joints, (bytes, 5121), binds.clone()).meshes[0].positions, expected);
    let halves = floats(&[0.5, 0., 0., 0., 0.25, 0., 0., 0., 3.0, 3.0, 0., 0.]);
    assert_eq!(skinned(joints, (halves, 5126), binds.clone()).meshes[0].positions, expected);
    let other = floats(&[1., 0., 0., 0., 1., 0., 0., 0., 1.0, 0.0, 0., 0.]);
    assert_ne!(skinned(joints, (other, 5126), binds).meshes[0].positions, expected, "can fail: other weights");
}

#[test]
fn mirrored_joints_keep_the_front_in_front() {
    let joints = r#"{"scale":[-1,1,1]},{"scale":[-1,1,1]}"#;
    let binds = [matrix(1.0, [0.0; 3]), matrix(1.0, [0.0; 3])].concat();
    let scene = skinned(joints, (floats(&[1., 0., 0., 0., 1., 0., 0., 0., 0.5, 0.5, 0., 0.]), 5126), binds);
    assert!(scene.meshes[0].positions.contains(&Vec3::NEG_X), "{:?}", scene.meshes[0].positions);
    assert!((scene.meshes[0].face_normal(0) - Vec3::Z).length() < 1e-6);
}

#[test]
fn a_joint_that_is_not_there_is_refused() {
    let attributes = r#"{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3}"#;
    let rest = format!(
        r#","meshes":[{{"primitives":[{{"attributes":{attributes}}}]}}],"skins":[{{"joints":[0]}}],
        "nodes":[{{"name":"body","mesh":0,"skin":0}}],"scenes":[{{"nodes":[0]}}]"#
    );
    let parts = [
        (vec![7, 0, 0, 0, 7, 0, 0, 0, 7, 0, 0, 0], "VEC4", 5121, false),
        (floats(&[1., 0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0.]), "VEC4", 5126, false),
    ];
    let outcome = std::panic::catch_unwind(|| with_accessors(&parts, &rest));
    let message = *outcome.expect_err("refused").downcast::<String>().expect("a message");
    assert!(message.contains("body: vertex 0 hangs on joint 7, but the skin has 1"), "{message}");
}

#[test]
fn morph_targets_stand_by_their_default_weights() {
    let target = floats(&[0., 0., 1., 0., 0., 2., 0., 0., 3.]);
    let turned = floats(&[0., 3., 0., 0., 3., 0., 0., 3., 0.]);
    let normals = floats(&[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let rest = |mesh: &str, node: &str| {
        format!(
            r#","meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":4}},
            "targets":[{{"POSITION":2,"NORMAL":3}},{{"POSITION":2}}]}}]{mesh}}}],
            "nodes":[{{"mesh":0{node}}}],"scenes":[{{"nodes":[0]}}]"#
        )
    };
    let parts = [(target, "VEC3", 5126, false), (turned, "VEC3", 5126, false), (normals, "VEC3", 5126, false)];
    let heights = |mesh: &str, node: &str| {
        let scene = with_accessors(&parts, &rest(mesh, node));
        (scene.meshes[0].positions.iter().map(|p| p.z).collect::<Vec<_>>(), scene.meshes[0].normals[0])
    };
    let (half, normal) = heights(r#","weights":[0.25,0.25]"#, "");
    assert_eq!(half, [0.5, 1.0, 1.5]);
    // (0, 0, 1) + 0.25 (0, 3, 0), unit: (0, 0.6, 0.8).
    assert!((normal - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-6, "{normal}");
    assert_eq!(heights(r#","weights":[0.25,0.25]"#, r#","weights":[0,1]"#).0, [1.0, 2.0, 3.0], "the node's go first");
    assert_eq!(heights("", "").0, [0.0; 3], "can fail: no weights, no displacement");
}

#[test]
fn instances_stand_where_their_attributes_say() {
    let translations = floats(&[0., 0., 0., 1., 2., 3.]);
    let scales = floats(&[1., 1., 1., 2., 2., 2.]);
    // A half turn about z as normalised shorts, and one of an eighth that is no unit quaternion.
    let rotations: Vec<u8> = [0i16, 0, 0, 32_767, 0, 0, 32_767, 0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let parts = [
        (translations, "VEC3", 5126, false),
        (rotations, "VEC4", 5122, true),
        (scales, "VEC3", 5126, false),
        (floats(&[7., 8.]), "SCALAR", 5126, false),
    ];
    let second = |attributes: &str| {
        let node = format!(
            r#"{{"name":"crate","mesh":0,"translation":[0,0,10],"children":[1],
            "extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{{attributes}}}}}}}}},{{"name":"lid","mesh":0}}"#
        );
        let scene = with_accessors(&parts, &format!(r#"{},"nodes":[{node}],"scenes":[{{"nodes":[0]}}]"#, mesh("")));
        assert_eq!(scene.meshes.len(), 3, "two crates and a lid that is not instanced: {attributes}");
        assert_eq!(scene.meshes[0].positions[1], Vec3::new(1.0, 0.0, 10.0));
        scene.meshes[1].positions[1]
    };
    // The corner (1, 0, 0).
    assert_eq!(second(r#""TRANSLATION":2"#), Vec3::new(2.0, 2.0, 13.0));
    assert_eq!(second(r#""SCALE":4"#), Vec3::new(2.0, 0.0, 10.0));
    let turned = second(r#""TRANSLATION":2,"ROTATION":3,"SCALE":4"#);
    assert!((turned - Vec3::new(-1.0, 2.0, 13.0)).length() < 1e-6, "{turned}");
    assert_eq!(second(r#""_ID":5"#), Vec3::new(1.0, 0.0, 10.0), "an attribute of its own counts the copies");
}

/// A tower of 24 m at UTM coordinates: near the origin, without rounding, and the camera with it.
#[test]
fn far_scenes_are_moved_near_their_origin() {
    let far = |x: &str, unit: f64| {
        let scene = nodes(
            r#","cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}]"#,
            &format!(
                r#"{{"translation":[{x},0,-5300000.125],"children":[1,2]}},{{"mesh":0,"scale":[{unit},{unit},{unit}]}},
                {{"camera":0,"translation":[12,9,15]}}"#
            ),
        );
        let world = |p: Vec3| [0, 1, 2].map(|k| scene.origin[k] + f64::from(p[k]));
        (scene.meshes[0].positions.iter().map(|p| world(*p)).collect::<Vec<_>>(), world(scene.cameras[0].eye), scene)
    };
    let (corners, eye, scene) = far("500000.015625", 24.0);
    assert_eq!(corners[0], [500_000.015_625, 0.0, -5_300_000.125]);
    assert_eq!(corners[1], [500_024.015_625, 0.0, -5_300_000.125]);
    assert_eq!(eye, [500_012.015_625, 9.0, -5_299_985.125]);
    assert_eq!(scene.origin[1], 0.0, "an axis along which it is near keeps its numbers");
    let told: Vec<_> = scene.report.warnings.iter().filter(|w| w.message.contains("taken off")).collect();
    assert_eq!(told.len(), 1, "{:?}", scene.report.warnings);
    // Near: as it was, to the bit.
    let (_, _, near) = far("0", 1e6);
    assert_eq!(near.origin, [0.0; 3]);
    assert_eq!(near.meshes[0].positions[1], Vec3::new(1e6, 0.0, -5_300_000.125));
}

#[test]
fn positions_that_the_file_has_rounded_are_told() {
    let parts = [(floats(&[5.3e6, 0., 0., 5.3e6 + 24.0, 0., 0., 5.3e6, 24.0, 0.]), "VEC3", 5126, false)];
    let rest = r#","meshes":[{"primitives":[{"attributes":{"POSITION":2}}]}],"nodes":[{"name":"tower","mesh":0}]"#;
    let scene = with_accessors(&parts, rest);
    let told = scene.report.warnings.iter().any(|w| w.object == "tower" && w.message.contains("steps of 0.5 m"));
    assert!(told, "{:?}", scene.report.warnings);
    assert_eq!(scene.meshes[0].positions[1].x + scene.origin[0] as f32, 5_300_024.0);
}

#[test]
fn far_obj_files_keep_their_digits() {
    let obj = |offset: f64| {
        let vertex = |x: f64, y: f64, z: f64| format!("v {} {y} {} 1 0.5 0\n", x + offset, z - 10.0 * offset);
        let text = format!("{}{}{}f 1 2 3\n", vertex(0.0, 0.0, 0.0), vertex(8.125, 0.0, 0.0), vertex(0.0, 6.0, 0.25));
        made::load("a.obj", text).unwrap_or_else(|error| panic!("{error}"))
    };
    let (near, far) = (obj(0.0), obj(524_288.5));
    assert_eq!(near.origin, [0.0; 3]);
    assert!(far.report.warnings.iter().any(|w| w.message.contains("taken off")));
    for (a, b) in near.meshes[0].positions.iter().zip(&far.meshes[0].positions) {
        let world = [0, 1, 2].map(|k| far.origin[k] + f64::from(b[k]));
        let expected = [f64::from(a.x) + 524_288.5, f64::from(a.y), f64::from(a.z) - 5_242_885.0];
        assert_eq!(world, expected);
    }
    assert_eq!(near.meshes[0].colors, far.meshes[0].colors);
}
