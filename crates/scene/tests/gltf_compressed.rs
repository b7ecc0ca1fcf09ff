//! Compressed geometry and pictures are those of the plain file, to the digits that their encoders kept.

mod gltf_text;
mod made;

use glam::{Quat, Vec2, Vec3};
use gltf_text::{SHOWN, data_uri, mesh, triangle};
use made::Folder;
use scene::{Mesh, Scene};
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compressed").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(file(name)).expect("a file of the tests")
}

fn load(name: &str) -> Scene {
    scene::load(&file(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// Corners of all triangles: position, normal, coordinates.
fn corners(meshes: &[Mesh]) -> Vec<[(Vec3, Vec3, Vec2); 3]> {
    let corner = |mesh: &Mesh, i: u32| {
        let uv = mesh.uv0.get(i as usize).copied().unwrap_or_default();
        (mesh.positions[i as usize], mesh.normals[i as usize], uv)
    };
    meshes.iter().flat_map(|mesh| mesh.triangles.iter().map(|t| t.map(|i| corner(mesh, i)))).collect()
}

/// Largest distances of positions, normals and coordinates from those of the nearest triangle of the plain scene,
/// turned by `turn` about the node's place; encoders change the order of triangles, and where they begin.
fn furthest(plain: &[Mesh], meshes: &[Mesh], turn: Quat) -> [f32; 3] {
    let place = Vec3::new(0.25, 0.5, 0.0);
    let expected: Vec<_> =
        corners(plain).into_iter().map(|t| t.map(|(p, n, uv)| (turn * (p - place) + place, turn * n, uv))).collect();
    let mut worst = [0.0f32; 3];
    for triangle in corners(meshes) {
        let turns = (0..3).map(|k| [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]]);
        let distance = |a: &[(Vec3, Vec3, Vec2); 3], b: &[(Vec3, Vec3, Vec2); 3]| {
            let of = |f: &dyn Fn(usize) -> f32| (0..3).map(f).fold(0.0, f32::max);
            [of(&|k| a[k].0.distance(b[k].0)), of(&|k| a[k].1.distance(b[k].1)), of(&|k| a[k].2.distance(b[k].2))]
        };
        let all = turns.flat_map(|t| expected.iter().map(move |e| distance(&t, e)).collect::<Vec<_>>());
        let nearest = all.min_by(|a, b| a[0].total_cmp(&b[0])).expect("a triangle");
        worst = std::array::from_fn(|k| worst[k].max(nearest[k]));
    }
    worst
}

/// Bounds: 14 bits of a box of 4 units, normals of 8 to 10 bits, coordinates of 12 bits.
fn is_near([position, normal, uv]: [f32; 3]) -> bool {
    position < 4.0 / 16_384.0 && normal < 0.02 && uv < 1.0 / 4_096.0
}

#[test]
fn compressed_meshes_are_the_plain_ones() {
    let plain = load("plain.glb");
    for name in ["draco-edgebreaker.glb", "draco-sequential.glb", "meshopt-medium.glb", "meshopt-high.glb", "webp.glb"]
    {
        let scene = load(name);
        assert_eq!(scene.triangle_count(), plain.triangle_count(), "{name}");
        assert_eq!(scene.meshes.len(), 2, "{name}: both primitives");
        let distances = furthest(&plain.meshes, &scene.meshes, Quat::IDENTITY);
        assert!(is_near(distances), "{name}: {distances:?}");
        for (a, b) in plain.meshes.iter().zip(&scene.meshes) {
            assert_eq!(plain.materials[a.material as usize].name, scene.materials[b.material as usize].name);
        }
    }
}

#[test]
fn filtered_views_and_turned_instances_are_decoded() {
    let plain = load("plain.glb");
    for name in ["meshopt-filters-ext.glb", "meshopt-filters-khr.glb"] {
        let scene = load(name);
        assert_eq!(scene.triangle_count(), 2 * plain.triangle_count(), "{name}: two instances");
        let first = furthest(&plain.meshes, &scene.meshes[..2], Quat::IDENTITY);
        let turn = Quat::from_xyzw(0.0, 0.6, 0.0, 0.8);
        let second = furthest(&plain.meshes, &scene.meshes[2..], turn);
        assert!(is_near(first) && is_near(second), "{name}: {first:?} {second:?}");
        let other = furthest(&plain.meshes, &scene.meshes[2..], Quat::IDENTITY);
        assert!(!is_near(other), "can fail: the second is turned: {other:?}");
    }
}

/// Largest difference of a byte of two pictures.
fn difference(a: &scene::Texture, b: &scene::Texture) -> u8 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let bytes = a.rgba.iter().flatten().zip(b.rgba.iter().flatten());
    bytes.map(|(a, b)| a.abs_diff(*b)).max().expect("texels")
}

/// A triangle with a texture whose sources are `sources` (members of the texture), images 0 and 1 being given.
fn with_images(images: [&[u8]; 2], texture: &str) -> Result<Scene, scene::Error> {
    let [a, b] = images.map(data_uri);
    let text = format!(
        r#","images":[{{"uri":"{a}"}},{{"uri":"{b}"}}],"textures":[{{{texture}}}],
        "extensionsUsed":["EXT_texture_webp","KHR_texture_basisu"],
        "materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"baseColorTexture":{{"index":0}}}}}}]{}{SHOWN}"#,
        mesh(r#","material":0"#)
    );
    made::load("a.gltf", triangle(&text))
}

/// The picture of a GLB's first image.
fn picture_of(name: &str) -> scene::Texture {
    load(name).textures.swap_remove(0)
}

#[test]
fn webp_and_basis_pictures_are_those_of_the_png() {
    let plain = picture_of("plain.glb");
    assert_eq!(plain.rgba[0], [200, 40, 40, 255]);
    assert_eq!(difference(&picture_of("webp.glb"), &plain), 0, "lossless");
    for (name, bound) in [("uastc.ktx2", 6), ("etc1s.ktx2", 12)] {
        let ktx = bytes(name);
        let scene = with_images([&ktx, b""], r#""extensions":{"KHR_texture_basisu":{"source":0}}"#).expect("a scene");
        let difference = difference(&scene.textures[0], &plain);
        assert!(difference <= bound, "{name}: {difference} of 255");
    }
}

#[test]
fn other_sources_stand_in_for_one_that_cannot_be_read() {
    let mut png = std::io::Cursor::new(Vec::new());
    let picture = image::RgbImage::from_raw(1, 1, vec![10, 20, 30]).expect("a texel");
    picture.write_to(&mut png, image::ImageFormat::Png).expect("a PNG");
    let png = png.into_inner();
    let texture = r#""source":0,"extensions":{"EXT_texture_webp":{"source":1}}"#;
    let scene = with_images([&png, b"broken"], texture).expect("a scene");
    assert_eq!(scene.textures[0].rgba, [[10, 20, 30, 255]]);
    let told = |scene: &Scene, what: &str| scene.report.warnings.iter().any(|w| w.message.contains(what));
    assert!(told(&scene, "another source of the texture is used"), "{:?}", scene.report.warnings);
    let none = with_images([b"broken", b""], r#""source":0"#).expect("a scene");
    assert!(none.textures.is_empty() && told(&none, "white is used"));
}

#[test]
fn pictures_that_nothing_stands_in_for_are_refused_with_the_tool() {
    let refused = |texture: &str, image: &[u8]| with_images([image, b""], texture).expect_err("refused").to_string();
    let avif = refused(r#""extensions":{"EXT_texture_avif":{"source":0}}"#, b"");
    assert!(avif.contains("EXT_texture_avif") && avif.contains("gltf-transform png"), "{avif}");
    let mut ktx = bytes("uastc.ktx2");
    ktx.truncate(90);
    let broken = refused(r#""extensions":{"KHR_texture_basisu":{"source":0}}"#, &ktx);
    assert!(broken.contains("gltf-transform ktxdecompress"), "{broken}");
}

/// Views that claim more bytes than numbers can count are too many, whatever was claimed before them.
#[test]
fn views_beyond_counting_are_refused() {
    let view = |count: u64| {
        format!(
            r#""extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteLength":20,"byteStride":4,"count":{count},
            "mode":"ATTRIBUTES"}}}}"#
        )
    };
    let with = |counts: [u64; 2]| {
        let mut text = triangle(&format!("{}{SHOWN}", mesh("")));
        for (plain, count) in [r#""byteLength":36}"#, r#""byteLength":24}"#].into_iter().zip(counts) {
            text = text.replacen(plain, &format!("{},{}}}", &plain[..plain.len() - 1], view(count)), 1);
        }
        made::load("a.gltf", text)
    };
    let error = with([1, 1 << 62]).expect_err("too many").to_string();
    assert!(error.contains("bytes after decompression"), "{error}");
    assert!(with([1, 1]).is_ok(), "can fail: the plain data stand in for what is broken");
}

/// Broken compressed data are an error or a scene, never a panic, and soon.
#[test]
fn no_changed_byte_does_worse_than_an_error() {
    let folder = Folder::new();
    let mut state = 7u64;
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for name in
        ["draco-edgebreaker.glb", "draco-sequential.glb", "meshopt-high.glb", "meshopt-filters-khr.glb", "webp.glb"]
    {
        let whole = bytes(name);
        let json = 20 + u32::from_le_bytes(whole[12..16].try_into().expect("four bytes")) as usize;
        for _ in 0..200 {
            let mut changed = whole.clone();
            for _ in 0..=next(3) {
                let at = json + 8 + next(whole.len() - json - 8);
                changed[at] = next(256) as u8;
            }
            let _outcome = folder.load("a.glb", &changed);
        }
    }
    for name in ["uastc.ktx2", "etc1s.ktx2"] {
        let whole = bytes(name);
        for _ in 0..300 {
            let mut changed = whole.clone();
            let at = 20 + next(whole.len() - 20);
            changed[at] = next(256) as u8;
            changed.truncate(whole.len() - next(2) * next(whole.len() / 2));
            let _outcome = with_images([&changed, b""], r#""extensions":{"KHR_texture_basisu":{"source":0}}"#);
        }
    }
}
