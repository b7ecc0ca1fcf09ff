//! OBJ and MTL files as programs write them: what differs only in writing is the same scene.

mod made;

use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use made::Folder;
use scene::{AlphaMode, Scene, Wrap};

/// A red cube with coordinates on a grey floor; its only face with normals is the one on top.
const CUBE: &str = "mtllib a.mtl\no cube\nv -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 1 -0.5\nv -0.5 1 -0.5\nv -0.5 0 0.5\n\
    v 0.5 0 0.5\nv 0.5 1 0.5\nv -0.5 1 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl red\nf 1/1 4/2 3/3 2/4\n\
    f 5/1 6/2 7/3 8/4\nf 1/1 5/2 8/3 4/4\nf 2/1 3/2 7/3 6/4\nf 4/1 8/2 7/3 3/4\nf 1/1 2/2 6/3 5/4\no floor\n\
    v -4 0 -4\nv 4 0 -4\nv 4 0 4\nv -4 0 4\nusemtl floor\nf 9 12 11 10\n";
const LIBRARY: &str = "newmtl floor\nKd 0.6 0.6 0.6\n\nnewmtl red\nKd 0.8 0.1 0.1\n";

fn cube(obj: impl AsRef<[u8]>, mtl: impl AsRef<[u8]>) -> Scene {
    let folder = Folder::new();
    folder.write("a.mtl", mtl);
    folder.load("a.obj", obj).unwrap_or_else(|error| panic!("{error}"))
}

fn case(name: &str) -> Option<PathBuf> {
    let data = testkit::data_dir().map(|data| data.join("cases").join(name)).filter(|path| path.exists());
    if data.is_none() {
        testkit::skip(name);
    }
    data
}

fn loaded(path: &Path) -> Scene {
    scene::load(path).unwrap_or_else(|error| panic!("{error}"))
}

/// Every corner of every triangle with position, normal, colour and opacity, whatever mesh it is in.
fn corners(scene: &Scene) -> Vec<[i64; 10]> {
    let mut corners = Vec::new();
    for (m, mesh) in scene.meshes.iter().enumerate() {
        let color = scene.material(m).base_color;
        for i in mesh.triangles.iter().flatten().map(|i| *i as usize) {
            let (p, n) = (mesh.positions[i], mesh.normals[i]);
            let all = [p.x, p.y, p.z, n.x, n.y, n.z, color.x, color.y, color.z, color.w];
            corners.push(all.map(|value| (f64::from(value) * 1e5).round() as i64));
        }
    }
    corners.sort_unstable();
    corners
}

fn warned(scene: &Scene, part: &str) -> bool {
    scene.report.warnings.iter().any(|w| format!("{}: {}", w.object, w.message).contains(part))
}

fn utf16(text: &str) -> Vec<u8> {
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

#[test]
fn writing_does_not_change_the_scene() {
    let reference = corners(&cube(CUBE, LIBRARY));
    assert_eq!(reference.len(), 3 * 14);
    let marked = |bytes: &[u8]| [b"\xef\xbb\xbf".as_slice(), bytes].concat();
    let (old_mac, dos) = (CUBE.replace('\n', "\r"), CUBE.replace('\n', "\r\n"));
    let last = format!("{}mtllib a.mtl\n", CUBE.replace("mtllib a.mtl\n", ""));
    let counted = CUBE.replace("f 9 12 11 10", "f -4 -1 \\\n -2 -3 # the floor");
    let said = CUBE.replace("usemtl red", "usemtl red   # the box").replace("mtllib a.mtl", "mtllib a.mtl # colours");
    let joined = (CUBE.replace("o floor\nv -4", "\u{feff}v -4"), LIBRARY.replace("newmtl red", "\u{feff}newmtl red"));
    let files: [(&str, Vec<u8>, Vec<u8>); 10] = [
        ("marks within", joined.0.into(), joined.1.into()),
        ("byte order mark", marked(CUBE.as_bytes()), marked(LIBRARY.as_bytes())),
        ("mark and CR in the library", CUBE.into(), marked(LIBRARY.replace('\n', "\r").as_bytes())),
        ("CR", old_mac.into(), LIBRARY.into()),
        ("CR LF", dos.into(), LIBRARY.replace('\n', "\r\n").into()),
        ("UTF-16", [b"\xff\xfe".as_slice(), &utf16(CUBE)].concat(), utf16(LIBRARY)),
        ("library last", last.into(), LIBRARY.into()),
        ("negative indices on a joined line", counted.into(), LIBRARY.into()),
        ("comments behind names", said.into(), LIBRARY.replace("newmtl red", "newmtl red # bright").into()),
        ("both libraries", CUBE.replace("mtllib a.mtl", "mtllib none.mtl A.MTL").into(), LIBRARY.into()),
    ];
    for (what, obj, mtl) in files {
        assert_eq!(corners(&cube(obj, mtl)), reference, "{what}");
    }
}

#[test]
fn sameness_can_fail() {
    let reference = corners(&cube(CUBE, LIBRARY));
    assert_ne!(corners(&cube(CUBE, "newmtl red\nKd 0.8 0.1 0.1\n")), reference, "a grey floor of another grey");
    assert_ne!(corners(&cube(CUBE.replace("v 0.5 1 0.5", "v 0.5 1.1 0.5"), LIBRARY)), reference, "a corner moved");
}

#[test]
fn cases_of_marks_equal_the_reference() {
    let Some(reference) = case("reference/red-cube-obj/a.obj") else { return };
    let reference = corners(&loaded(&reference));
    for name in ["mtllib-first", "in-the-mtl"] {
        let Some(path) = case(&format!("obj-bom/{name}/a.obj")) else { return };
        assert_eq!(corners(&loaded(&path)), reference, "{name}");
    }
    let Some(path) = case("obj-bom/vertex-first/a.obj") else { return };
    let shape = |all: &[[i64; 10]]| {
        let mut shape: Vec<[i64; 6]> = all.iter().map(|c| std::array::from_fn(|k| c[k])).collect();
        shape.sort_unstable();
        shape
    };
    assert_eq!(shape(&corners(&loaded(&path))), shape(&reference));
}

#[test]
fn indices_that_point_nowhere_cost_the_attribute() {
    let reference = corners(&cube(CUBE, LIBRARY));
    let zero = CUBE.replace("f 1/1 4/2 3/3 2/4", "f 1/0/0 4/9/7 3/-9/-1 2//");
    let scene = cube(&zero, LIBRARY);
    assert_eq!(corners(&scene), reference);
    assert!(warned(&scene, "3 texture coordinate indices point nowhere (first line 16: 0 of 4)"), "{:?}", scene.report);
    assert!(warned(&scene, "3 normal indices point nowhere (first line 16: 0 of 0)"));
    assert!(warned(&scene, "4 corners have none while others"));
    // The other faces keep their coordinates.
    let places = |scene: &Scene| scene.meshes[0].uv0.iter().filter(|uv| **uv == Vec2::new(1.0, 1.0)).count();
    assert!(places(&scene) >= 5, "{:?}", scene.meshes[0].uv0);
    for name in ["normal-index-0", "no-vt-no-vn"] {
        let Some(path) = case(&format!("obj-optional-indices/{name}/a.obj")) else { return };
        let (scene, floorless) = (loaded(&path), |c: &&[i64; 10]| c[6] == 80_000);
        let found: Vec<_> = corners(&scene).iter().filter(floorless).copied().collect();
        let expected: Vec<_> = reference.iter().filter(floorless).copied().collect();
        assert_eq!(found, expected, "{name}");
        assert!(warned(&scene, "point nowhere"), "{name}");
    }
}

#[test]
fn normals_stay_where_a_file_has_them() {
    // A tilted normal on the top face alone: the other faces are as flat as without.
    let text = CUBE.replace("f 4/1 8/2 7/3 3/4", "vn 0.6 0.8 0\nf 4/1/1 8/2/1 7/3/1 3/4/1");
    let scene = cube(text, LIBRARY);
    let (mut tilted, mut flat) = (0, 0);
    for (t, triangle) in scene.meshes[0].triangles.iter().enumerate() {
        for n in triangle.map(|i| scene.meshes[0].normals[i as usize]) {
            tilted += usize::from(n.distance(Vec3::new(0.6, 0.8, 0.0)) < 1e-6);
            flat += usize::from(n.distance(scene.meshes[0].face_normal(t)) < 1e-6);
        }
    }
    assert_eq!((tilted, flat), (6, 30));
}

#[test]
fn numbers_that_are_none_cost_their_face() {
    let scene = cube(CUBE.replace("v 4 0 -4", "v 1.#IND 0 -nan(ind)").replace("vt 1 1\n", "vt 1,0 1.#QNAN\n"), LIBRARY);
    assert_eq!(scene.triangle_count(), 12 + 1, "one triangle of the floor is left");
    assert!(warned(&scene, "not finite"));
    assert!(scene.meshes.iter().all(|m| m.uv0.iter().all(|uv| uv.is_finite())));
}

#[test]
fn materials_that_writers_meant_to_be_opaque_are() {
    let reference = corners(&cube(CUBE, LIBRARY));
    let meshlab = LIBRARY.replace("newmtl red\n", "newmtl red\nTr 1.000000\nillum 2\n");
    let scene = cube(CUBE, &meshlab);
    assert_eq!(corners(&scene), reference);
    assert!(warned(&scene, "material red: Tr 1"), "{:?}", scene.report);
    assert!(scene.materials.iter().all(|m| m.alpha == AlphaMode::Opaque));
    for (statements, opacity) in
        [("Tr 0.25", 0.75), ("d 0.5\nTr 1", 0.5), ("d 1\nTr 1", 1.0), ("Tr 0", 1.0), ("d 0\nTr 0", 1.0), ("d 0", 0.0)]
    {
        let scene = cube(CUBE, LIBRARY.replace("newmtl red", &format!("newmtl red\n{statements}")));
        assert_eq!(scene.material(0).base_color.w, opacity, "{statements}");
        assert_eq!(
            warned(&scene, "material red"),
            statements.starts_with("d 0\n") || statements == "d 0",
            "{statements}"
        );
    }
    let (Some(path), Some(like)) = (case("mtl-tr-1/a.obj"), case("reference/red-cube-obj/a.obj")) else { return };
    let scene = loaded(&path);
    assert_eq!(corners(&scene), corners(&loaded(&like)));
    assert!(warned(&scene, "material floor, material red: Tr 1"), "{:?}", scene.report);
}

/// A PNG of 2 x 2 texels: red, green, blue, white.
fn png() -> Vec<u8> {
    let mut file = std::io::Cursor::new(Vec::new());
    let texels = vec![255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255];
    let picture = image::RgbImage::from_raw(2, 2, texels).expect("2 x 2 texels");
    picture.write_to(&mut file, image::ImageFormat::Png).expect("a PNG");
    file.into_inner()
}

/// The red material of the cube with these statements in a library of another folder.
fn textured(statements: &str) -> Scene {
    let folder = Folder::new();
    folder.write("looks/a.mtl", format!("newmtl red\n{statements}\n"));
    folder.write("looks/tex.png", png());
    folder.write("pictures/Other One.png", png());
    folder.load("a.obj", CUBE.replace("a.mtl", "looks/a.mtl")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn textures_are_found_where_they_are() {
    let paths = [
        "tex.png",
        "C:\\Users\\me\\maps\\tex.png",
        "/home/me/tex.png",
        "looks/tex.png",
        "TEX.PNG",
        "../pictures/other one.png",
        "pictures\\Other One.png",
        "\"pictures/Other One.png\"",
        "-s 1 1 1 ../../tex.png # colours",
    ];
    for path in paths {
        let scene = textured(&format!("map_Kd {path}"));
        assert_eq!(scene.textures[0].width, 2, "{path}: {:?}", scene.report.warnings);
    }
    assert!(warned(&textured("map_Kd gone.png"), "white is used"), "and none is found that is not there");
}

#[test]
fn map_options_place_the_picture() {
    // What the picture shows at OBJ's (u, v), by the definition of the options: at uv s + o.
    let at = |scene: &Scene, u: f32, v: f32| {
        let slot = scene.material(0).base_color_texture.expect("a texture");
        scene.textures[slot.texture as usize].sample(slot.place(Vec2::new(u, 1.0 - v)), true).truncate()
    };
    let plain = textured("map_Kd tex.png");
    let moved = textured("map_Kd -o 0.25 0.5 -s 2 0.5 1 tex.png");
    let clamped = textured("map_Kd -s 3 3 -clamp on tex.png");
    for (u, v) in [(0.1, 0.1), (0.3, 0.8), (0.9, 0.6)] {
        let expected = at(&plain, 2.0 * u + 0.25, 0.5 * v + 0.5);
        assert!(at(&moved, u, v).distance(expected) < 1e-5, "({u}, {v})");
    }
    assert_eq!((plain.textures[0].wrap, clamped.textures[0].wrap), ([Wrap::Repeat; 2], [Wrap::Clamp; 2]));
    assert!(at(&clamped, 0.9, 0.9).distance(Vec3::new(0.0, 1.0, 0.0)) < 1e-5, "the upper right texel goes on");
    let told = textured("map_Kd -mm 0 2 -texres 64 -cc on tex.png\nbump -bm 0.2 tex.png");
    assert_eq!(told.textures[0].width, 2);
    assert!(warned(&told, "-mm is not supported") && warned(&told, "-cc is not") && !warned(&told, "-texres"));
    assert!(warned(&textured("map_Kd tex.png\nmap_d -s 2 2 tex.png"), "map_d lies as map_Kd does"));
}

#[test]
fn pictures_that_are_not_read_are_told() {
    let told = |more: &str| cube(CUBE, format!("{LIBRARY}{more}"));
    let scene = told("map_Ks a.png\nmap_Pr -imfchan g b.png\ndisp c.png\n");
    assert!(["map_Ks", "map_Pr", "disp"].iter().all(|word| warned(&scene, word)), "{:?}", scene.report);
    let scene = told("map_Ka a.png\nmap_aat on\nrefl -type sphere b.png\nillum 2\n");
    assert!(!warned(&scene, "not supported"), "what changes nothing is not told: {:?}", scene.report);
    assert_eq!(corners(&cube(CUBE.replace("usemtl red", "usemtl \"red\""), LIBRARY)), corners(&told("")));
}

#[test]
fn cases_of_map_options_have_their_checks() {
    // Changes of colour along the middle of a row of checks: 4 x 4 per face become 16 x 16.
    let changes = |name: &str| {
        let scene = loaded(&case(&format!("obj-map-options/{name}/a.obj"))?);
        let red = (0..scene.meshes.len()).find(|m| scene.material(*m).name == "red").expect("the box");
        let slot = scene.material(red).base_color_texture.expect("a texture");
        let bright = |i: usize| {
            let uv = slot.place(Vec2::new((i as f32 + 0.5) / 1024.0, 1.0 - 1.0 / 33.0));
            scene.textures[slot.texture as usize].sample(uv, true).x > 0.5
        };
        Some((0..1023).filter(|i| bright(*i) != bright(i + 1)).count())
    };
    let (Some(plain), Some(scaled)) = (changes("control-none"), changes("scale-4")) else { return };
    assert_eq!((plain, scaled), (3, 15));
    let Some(path) = case("obj-map-options/offset-scale-clamp/a.obj") else { return };
    assert_eq!(loaded(&path).textures[0].wrap, [Wrap::Clamp; 2]);
}

#[test]
fn names_hold_blanks_and_hashes() {
    let library =
        "newmtl wall #1\nKd 0.1 0.1 0.1\nnewmtl wall #2\nKd 0.2 0.2 0.2\nnewmtl the roof # tiles\nKd 0.3 0.3 0.3\n";
    for (used, shade) in [("wall #2", 0.2), ("wall #1", 0.1), ("the roof", 0.3), ("the roof #x", 0.3), ("the", 0.8)] {
        let scene = cube(CUBE.replace("usemtl red", &format!("usemtl {used}")), library);
        assert_eq!(scene.material(0).base_color.x, shade, "{used}");
    }
}

#[test]
fn many_alike_are_one_warning_with_printable_names() {
    let used: String = (0..40).map(|i| format!("usemtl \u{1b}[31m{i}\nf 1 2 3\n")).collect();
    let scene = cube(format!("{CUBE}{used}"), LIBRARY);
    let unknown: Vec<_> = scene.report.warnings.iter().filter(|w| w.message.contains("not defined")).collect();
    assert_eq!(unknown.len(), 1);
    assert_eq!(unknown[0].object, "material \\u{1b}[31m0, \\u{1b}[31m1, \\u{1b}[31m2 and 37 more");
    let many: String = (0..300).map(|i| format!("newmtl m{i}\nTr 1\n")).collect();
    let scene = cube(CUBE, LIBRARY.to_owned() + &many);
    assert_eq!(scene.report.warnings.iter().filter(|w| w.message.contains("Tr 1")).count(), 1);
}

#[test]
fn sides_are_decided_by_connected_component() {
    // A box and a loose quad in one mesh; two boxes that touch along an edge; a box with a fin.
    let two_sided = |text: &str| -> (usize, usize) {
        let scene = made::load("a.obj", text).unwrap_or_else(|error| panic!("{error}"));
        let of = |sides: bool| {
            let meshes = (0..scene.meshes.len()).filter(|m| scene.material(*m).double_sided == sides);
            meshes.map(|m| scene.meshes[m].triangles.len()).sum()
        };
        (of(false), of(true))
    };
    let solid = CUBE.lines().filter(|l| !l.starts_with("usemtl") && !l.starts_with('o')).collect::<Vec<_>>().join("\n");
    assert_eq!(two_sided(&solid), (12, 2), "box and floor in one mesh");
    let second = "v 1.5 0 -1.5\nv 1.5 1 -1.5\nv 0.5 0 -1.5\nv 0.5 1 -1.5\nv 1.5 0 -0.5\nv 1.5 1 -0.5\n\
        f 15 16 14 13\nf 13 14 18 17\nf 17 18 3 2\nf 2 3 16 15\nf 16 3 18 14\nf 15 13 17 2\n";
    // The second one's edge from vertex 2 to 3 is the first one's.
    let touching =
        solid.replace("v -4 0 -4\nv 4 0 -4\nv 4 0 4\nv -4 0 4\nf 9 12 11 10", "v 9 9 9\nv 9 9 9\nv 9 9 9\nv 9 9 9");
    assert_eq!(two_sided(&format!("{touching}\n{second}")), (24, 0), "boxes that touch along an edge");
    assert_eq!(two_sided(&format!("{touching}\nv 2 0 -0.5\nf 2 13 3\n")), (12, 1), "a fin");
    let turned = solid.replace("f 1/1 4/2 3/3 2/4", "f 2/4 3/3 4/2 1/1");
    assert_eq!(two_sided(&turned), (0, 14), "an unevenly oriented box is no solid");
}

#[test]
fn the_cornell_box_keeps_its_walls() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("the Cornell box") };
    let scene = loaded(&data.join("scenes/cornell-box/cornell_box.obj"));
    for (m, mesh) in scene.meshes.iter().enumerate() {
        let is_room = ["back_wall", "ceiling", "green_wall", "red_wall", "light"].contains(&mesh.name.as_str());
        let is_block = mesh.name.contains("block");
        assert!(!is_room || scene.material(m).double_sided, "{}: the room is open", mesh.name);
        assert!(!is_block || !scene.material(m).double_sided, "{}: with their bottoms blocks are closed", mesh.name);
    }
}
