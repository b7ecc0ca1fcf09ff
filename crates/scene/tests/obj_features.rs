//! What OBJ and MTL files say is what the scene holds.

mod made;

use std::fmt::Write;

use glam::{Vec2, Vec3, Vec4};
use made::Folder;
use scene::{AlphaMode, Mesh, Scene};
use testkit::assert_close;

fn load(text: &str) -> Scene {
    made::load("a.obj", text).unwrap_or_else(|error| panic!("{error}"))
}

fn area(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum()
}

/// A mesh as OBJ text, with positions alone.
fn bare(mesh: &Mesh) -> String {
    let mut text = String::new();
    for p in &mesh.positions {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).expect("a string");
    }
    for t in &mesh.triangles {
        writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1).expect("a string");
    }
    text
}

#[test]
fn polygons_keep_their_area() {
    // An L of area 3 in the plane x + z = 1, so that a fan from its first corner would cover too much.
    let l = [(2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.), (0., 0.)];
    let mut text = String::new();
    for (s, t) in l {
        writeln!(text, "v {} {t} {}", s, 1.0 - s).expect("a string");
    }
    let scene = load(&(text + "f 1 2 3 4 5 6\n"));
    assert_eq!(scene.triangle_count(), 4);
    assert_close!(area(&scene.meshes[0]), 3.0 * 2f64.sqrt(), 1e-6, 0.0);
    let normals: Vec<Vec3> = (0..4).map(|t| scene.meshes[0].face_normal(t)).collect();
    assert!(normals.iter().all(|n| n.dot(normals[0]) > 0.999), "{normals:?}");
}

#[test]
fn a_fan_can_fail() {
    let corner = |s: f64, t: f64| glam::DVec2::new(s, t);
    let l = [corner(2., 0.), corner(2., 1.), corner(1., 1.), corner(1., 2.), corner(0., 2.), corner(0., 0.)];
    let fan: f64 = l.windows(2).skip(1).map(|w| 0.5 * (w[0] - l[0]).perp_dot(w[1] - l[0]).abs()).sum();
    assert!((fan - 3.0).abs() > 0.5, "a fan covers {fan}");
}

#[test]
fn indices_count_from_both_ends() {
    let scene = load("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 -2 -1\nv 0 0 1\nf -1 3 4 # a comment\n");
    assert_eq!(scene.triangle_count(), 2);
    assert_close!(area(&scene.meshes[0]), 0.5 + 0.5 * 3f64.sqrt(), 1e-6, 0.0);
    assert_eq!(scene.report.unused_vertices, 1);
}

#[test]
fn lines_points_and_continued_statements_are_understood() {
    let scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0\np 1\nl 1 2 3\nf 1 2\nf 1 \\\n 2 3\n");
    assert_eq!(scene.triangle_count(), 1, "a polyline is no polygon");
    assert!(scene.report.warnings.iter().any(|w| w.message.starts_with("3 points")), "{:?}", scene.report.warnings);
}

#[test]
fn colours_are_kept_where_all_vertices_have_them() {
    let colored = load("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
    assert_eq!(colored.meshes[0].colors[0], Vec4::new(1.0, 0.0, 0.0, 1.0));
    let mixed = load("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(mixed.meshes[0].colors.is_empty());
    assert!(mixed.report.warnings.iter().any(|w| w.message.contains("1 of 3 have colours")));
}

#[test]
fn rows_of_pictures_run_downwards() {
    let scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 0.75\nf 1/1 2/2 3/3\n");
    assert_eq!(scene.meshes[0].uv0, [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 0.25)]);
}

#[test]
fn missing_normals_are_smooth_below_the_crease_and_sharp_above() {
    let sphere = load(&bare(&scene::builtin("sphere").expect("a builtin").meshes[0]));
    let mesh = &sphere.meshes[0];
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(p.normalize().dot(*n) > 0.999, "at {p} the normal is {n}");
    }
    assert_eq!(mesh.positions.len(), 64 * 31 + 2, "no seam is left, two poles");
    let cube = load(&bare(&scene::builtin("furnace-box").expect("a builtin").meshes[0]));
    let mesh = &cube.meshes[0];
    assert_eq!(mesh.positions.len(), 6 * 9 * 9, "edges of a cube stay sharp");
    assert!(mesh.normals.iter().all(|n| (n.abs().max_element() - 1.0).abs() < 1e-6));
    assert_eq!(cube.report.generated_normals, 6 * 9 * 9);
}

#[test]
fn normals_that_some_corners_lack_are_made_and_the_others_stay() {
    let scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2 3\n");
    assert_eq!(scene.meshes[0].normals, [Vec3::X, Vec3::Z, Vec3::Z]);
    assert!(scene.report.warnings.iter().any(|w| w.message.contains("normals: 2 corners have none")));
}

#[test]
fn solids_are_single_sided_and_sheets_double() {
    let cube = bare(&scene::builtin("furnace-box").expect("a builtin").meshes[0]);
    assert!(!load(&cube).material(0).double_sided);
    // The same faces under two names are still one solid.
    let half = cube.lines().filter(|l| l.starts_with('f')).count() / 2;
    let mut faces = 0;
    let named: String = cube
        .lines()
        .map(|line| {
            faces += usize::from(line.starts_with('f'));
            if line.starts_with('f') && faces == half { format!("o second\n{line}\n") } else { format!("{line}\n") }
        })
        .collect();
    let two = load(&named);
    assert_eq!(two.meshes.len(), 2);
    assert!(two.materials.iter().all(|m| !m.double_sided));
    assert!(
        load(&bare(&scene::builtin("bowl").expect("a builtin").meshes[0])).material(0).double_sided,
        "a bowl is open"
    );
}

#[test]
fn materials_are_read_and_odd_statements_survived() {
    let folder = Folder::new();
    folder.write(
        "a b.mtl",
        "Kd 1 1 1\nnewmtl\nnewmtl one two\nKd 0.5\nKs 1 1 1\nNs 30\nd 0.25\nnewmtl odd\nKd spectral x.rfl\nKd 0.1 0.2\nillum\n\
         Ke 1 2 3\nmap_kd -s 1 1 1 -clamp on my picture.png\nPm 0.5\nPr 0.125\nmap_Kd\n",
    );
    let text = "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl one two\nf 1 2 3\nusemtl odd\nf 3 2 1\nusemtl none\nf 1 3 2\n";
    let scene = folder.load("a.obj", text).unwrap_or_else(|error| panic!("{error}"));
    let [first, odd, none] = [0, 1, 2].map(|m| scene.material(m));
    assert_eq!(first.base_color, Vec4::new(0.5, 0.5, 0.5, 0.25));
    assert_eq!(first.alpha, AlphaMode::Blend);
    // (2 / (30 + 2))^(1/4) = 1/2.
    assert_close!(first.roughness, 0.5, 1e-6, 0.0);
    assert_eq!((odd.metallic, odd.roughness, odd.emissive), (0.5, 0.125, Vec3::new(1.0, 2.0, 3.0)));
    assert_eq!(scene.textures[0].name, "my picture.png");
    assert_eq!(none.base_color, Vec4::new(0.8, 0.8, 0.8, 1.0));
    for part in ["my picture.png", "material none", "\"newmtl\"", "Kd spectral", "Kd 0.1 0.2", "and 2 more"] {
        let said = scene.report.warnings.iter().any(|w| format!("{}: {}", w.object, w.message).contains(part));
        assert!(said, "{part}: {:?}", scene.report.warnings);
    }
}
