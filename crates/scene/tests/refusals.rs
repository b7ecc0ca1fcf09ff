//! The wall of failure messages: what is wrong, where, with the value.

mod gltf_text;
mod made;

use gltf_text::{SHOWN, data_uri, mesh, triangle};
use made::Folder;

/// Case, and what its message must hold.
type Case = (&'static str, String, &'static [&'static str]);

fn check(file: &str, cases: &[Case]) {
    for (what, content, expected) in cases {
        let message = match made::load(file, content) {
            Ok(_) => panic!("{what}: was loaded"),
            Err(error) => error.to_string(),
        };
        assert!(message.contains(file), "{what}: names no file: {message}");
        for part in *expected {
            assert!(message.contains(part), "{what}: lacks {part:?}: {message}");
        }
    }
}

fn required(name: &str) -> String {
    triangle(&format!(r#","extensionsRequired":["{name}"],"extensionsUsed":["{name}"]{}{SHOWN}"#, mesh("")))
}

#[test]
fn required_extensions_are_refused_by_name() {
    let names = ["ACME_made_up", "KHR_gaussian_splatting"];
    for name in names {
        let error = made::load("a.gltf", required(name)).expect_err(name);
        assert!(matches!(error, scene::Error::Unsupported { .. }), "{error:?}");
        assert!(error.to_string().contains(&format!("extensionsRequired: {name}")), "{error}");
    }
    let looks =
        ["KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_iridescence", "KHR_materials_dispersion"];
    let notes = ["KHR_animation_pointer", "KHR_xmp_json_ld", "EXT_lights_image_based", "EXT_mesh_manifold"];
    let done = ["KHR_materials_volume", "KHR_draco_mesh_compression", "EXT_texture_webp", "EXT_texture_avif"];
    for name in looks.into_iter().chain(notes).chain(done) {
        assert!(made::load("a.gltf", required(name)).is_ok(), "a file that requires {name} loads");
    }
}

#[test]
fn broken_gltf_is_refused() {
    let primitive = |p: &str| triangle(&format!(r#","meshes":[{{"primitives":[{p}]}}]{SHOWN}"#));
    let nodes = |n: &str| triangle(&format!(r#"{},"nodes":[{n}],"scenes":[{{"nodes":[0]}}]"#, mesh("")));
    let deep: Vec<String> = (1..3000).map(|n| format!(r#"{{"children":[{n}]}}"#)).chain(["{}".into()]).collect();
    check(
        "a.gltf",
        &[
            ("not JSON", "{".into(), &["JSON", "line 1"]),
            ("glTF 1.0", r#"{"asset":{"version":"1.0"},"meshes":{}}"#.into(), &["asset.version", "1.0"]),
            ("nothing", r#"{"asset":{"version":"2.0"}}"#.into(), &["no triangle"]),
            (
                "attribute",
                primitive(r#"{"attributes":{"POSITION":9}}"#),
                &["meshes[0].primitives[0]", "accessor 9 of 2"],
            ),
            ("no position", primitive(r#"{"attributes":{"TEXCOORD_0":1}}"#), &["POSITION", "missing"]),
            ("type", primitive(r#"{"attributes":{"POSITION":1}}"#), &["accessors[1]", "2 components", "3 are wanted"]),
            ("indices", primitive(r#"{"attributes":{"POSITION":0},"indices":7}"#), &["indices", "out of bounds"]),
            ("float indices", primitive(r#"{"attributes":{"POSITION":0},"indices":1}"#), &["accessors[1]", "wanted"]),
            ("material", triangle(&(mesh(r#","material":4"#) + SHOWN)), &["material", "out of bounds"]),
            ("loop", nodes(r#"{"children":[1]},{"children":[0]}"#), &["nodes[0]", "loop"]),
            ("two parents", nodes(r#"{"children":[1,2]},{"children":[2]},{}"#), &["nodes[2]", "nodes[0] and nodes[1]"]),
            ("child", nodes(r#"{"children":[5]}"#), &["nodes[0].children[0]", "out of bounds"]),
            ("depth", nodes(&deep.join(",")), &["1024 levels deep"]),
            ("rotation", nodes(r#"{"mesh":0,"rotation":[0,0,0,0]}"#), &["nodes[0].rotation", "length 0"]),
            ("matrix", nodes(r#"{"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}"#), &["nodes[0].matrix", "last row"]),
            ("infinite", nodes(r#"{"translation":[1e309,0,0]}"#), &["number out of range"]),
        ],
    );
}

#[test]
fn ranges_outside_the_data_are_refused() {
    let accessor = |view: &str, accessor: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"{}","byteLength":64}}],
            "bufferViews":[{{"buffer":0{view}}}],
            "accessors":[{{"type":"VEC3","componentType":5126{accessor}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]{SHOWN} }}"#,
            data_uri(&[0; 64])
        )
    };
    let whole = r#","byteLength":64"#;
    let sparse = |count: &str, offset: &str| {
        format!(
            r#","count":4,"sparse":{{"count":{count},
            "indices":{{"bufferView":0,"byteOffset":{offset},"componentType":5123}},"values":{{"bufferView":0}}}}"#
        )
    };
    check(
        "a.gltf",
        &[
            (
                "view",
                accessor(r#","byteOffset":60,"byteLength":5"#, r#","bufferView":0,"count":1"#),
                &["bufferViews[0]", "60 + 5"],
            ),
            (
                "view overflow",
                accessor(r#","byteOffset":18446744073709551615,"byteLength":5"#, r#","bufferView":0,"count":1"#),
                &["bufferViews[0]"],
            ),
            (
                "count",
                accessor(whole, r#","bufferView":0,"count":6"#),
                &["accessors[0]", "6 elements of 12 bytes", "64 bytes"],
            ),
            (
                "huge count",
                accessor(whole, r#","bufferView":0,"count":1152921504606846976"#),
                &["accessors[0]", "do not fit"],
            ),
            (
                "offset",
                accessor(whole, r#","bufferView":0,"byteOffset":18446744073709551610,"count":1"#),
                &["accessors[0]", "do not fit"],
            ),
            (
                "stride",
                accessor(r#","byteLength":64,"byteStride":8"#, r#","bufferView":0,"count":3"#),
                &["accessors[0]", "byteStride 8"],
            ),
            (
                "zeros",
                accessor(whole, r#","count":99999999"#),
                &["accessors[0]", "99999999 elements without a bufferView"],
            ),
            ("sparse count", accessor(whole, &sparse("5", "0")), &["accessors[0].sparse", "5 of 4"]),
            ("sparse place", accessor(whole, &sparse("2", "63")), &["accessors[0].sparse", "do not fit"]),
        ],
    );
}

#[test]
fn files_elsewhere_are_not_fetched() {
    let buffer = |uri: &str| format!(r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"{uri}","byteLength":1}}]}}"#);
    check(
        "a.gltf",
        &[
            ("network", buffer("https://example.org/a.bin"), &["buffers[0]", "https://example.org/a.bin", "URL"]),
            ("file scheme", buffer("file:///etc/passwd"), &["buffers[0]", "URL"]),
            ("absolute", buffer("/etc/passwd"), &["buffers[0]", "absolute"]),
            ("parent", buffer("../../a.bin"), &["buffers[0]", "leaves the scene's folder"]),
            ("escaped parent", buffer("%2e%2e/a.bin"), &["buffers[0]", "leaves the scene's folder"]),
            ("missing", buffer("gone.bin"), &["buffers[0]", "gone.bin"]),
            ("base64", buffer("data:;base64,?"), &["buffers[0]", "base64"]),
            ("short", buffer("data:,"), &["buffers[0]", "byteLength is 1", "0 bytes"]),
        ],
    );
}

#[test]
fn broken_obj_is_refused_with_its_line() {
    let corners = |faces: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n{faces}\n");
    check(
        "a.obj",
        &[
            ("empty", String::new(), &["no triangle"]),
            ("short vertex", "v 0 0\n".into(), &["line 1", "2 numbers instead of 3"]),
            ("no number", "v 0 0 0\nv 0 3.1+e2 0\n".into(), &["line 2", "3.1+e2"]),
            ("weight", "v 0 0 0 0\n".into(), &["line 1", "weight"]),
            ("index 0", corners("f 0 1 2"), &["line 6", "index 0"]),
            ("beyond", corners("f 1 2 4"), &["line 6", "vertex index 4", "there are 3"]),
            ("before", corners("f -4 1 2"), &["line 6", "vertex index -4"]),
            ("huge", corners("f 1 2 9223372036854775807"), &["line 6", "9223372036854775807"]),
            ("tiny", corners("f 1 2 -9223372036854775808"), &["line 6", "-9223372036854775808"]),
            ("after a joined line", "v 0 0 \\\n0\r\nv 1 0 0\rv 0 1 0\nf 1 2 9\n".into(), &["line 5", "index 9"]),
            ("parts", corners("f 1/1/1/1 2 3"), &["line 6", "too many parts"]),
            ("word", corners("f 1 2 x"), &["line 6", "\"x\""]),
            ("no vertex", corners("f /1 2 3"), &["line 6", "names no vertex"]),
            ("not finite", "v nan 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n".into(), &["no triangle", "not finite"]),
            ("flat", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".into(), &["no triangle", "zero area"]),
            ("far", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n".into(), &["no triangle", "scale the scene down"]),
        ],
    );
}

#[test]
fn other_files_are_refused() {
    check("a.fbx", &[("type", String::new(), &["\"fbx\"", "convert"])]);
    let error = scene::load(&std::env::temp_dir().join("no such folder/a.obj")).expect_err("not there");
    assert!(matches!(error, scene::Error::Io { .. }), "{error:?}");
    assert!(scene::load(&std::env::temp_dir()).is_err(), "a folder is no scene");
}

/// A valid GLB of one triangle.
fn glb() -> Vec<u8> {
    let text = triangle(&(mesh("") + SHOWN));
    let mut json = text.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let words = [2, 20 + json.len() as u32, json.len() as u32, 0x4E4F_534A];
    let mut file = b"glTF".to_vec();
    file.extend(words.iter().flat_map(|w| w.to_le_bytes()));
    file.extend(json);
    file
}

#[test]
fn every_truncation_of_a_glb_is_refused() {
    let (folder, whole) = (Folder::new(), glb());
    assert!(folder.load("a.glb", &whole).is_ok());
    for length in (0..whole.len()).step_by(7) {
        assert!(folder.load("a.glb", &whole[..length]).is_err(), "{length} bytes");
    }
}

#[test]
fn no_changed_byte_does_worse_than_an_error() {
    let (folder, whole) = (Folder::new(), glb());
    for at in 0..whole.len() {
        for change in [0x01, 0x08, 0x80] {
            let mut changed = whole.clone();
            changed[at] ^= change;
            // Either outcome is right; a panic is not.
            let _outcome = folder.load("a.glb", &changed);
        }
    }
}
