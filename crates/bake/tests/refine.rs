//! Splitting keeps the surface: same area, no gaps, no edge too long, attributes for every vertex.

use bake::{refine, settings};
use coeff_io::{Refine, Settings};
use glam::{Quat, Vec3};
use scene::{Mesh, Scene};
use std::borrow::Cow;
use std::collections::BTreeMap;

fn with(refine: Refine) -> Settings {
    Settings { refine, ..settings::standard() }
}

fn area(scene: &Scene) -> f64 {
    scene.meshes.iter().flat_map(|m| (0..m.triangles.len()).map(|t| m.area(t))).sum()
}

/// Edges by the bits of their ends' positions, with the times that each is walked one way less those the other way.
fn open_edges(scene: &Scene) -> usize {
    let mut walked: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    let key = |m: &Mesh, v: u32| m.positions[v as usize].to_array().map(f32::to_bits);
    for mesh in &scene.meshes {
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| (key(mesh, a), key(mesh, b))) {
                *walked.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            }
        }
    }
    walked.values().filter(|&&n| n != 0).count()
}

fn longest(scene: &Scene) -> f32 {
    let edges = scene.meshes.iter().flat_map(|m| {
        m.triangles
            .iter()
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
            .map(|(a, b)| m.positions[a as usize].distance(m.positions[b as usize]))
    });
    edges.fold(0.0, f32::max)
}

#[test]
fn surface_stays_the_same() {
    let scene = scene::builtin("closed-room").expect("builtin");
    for edge in [0.5, 0.11, 0.0313] {
        let refined = refine(&scene, &with(Refine::Edge(edge))).expect("splits");
        assert!((area(&refined) / area(&scene) - 1.0).abs() < 1e-5, "area is kept at {edge}");
        assert_eq!(open_edges(&refined), 0, "no gap opens at {edge}");
        assert!(longest(&refined) <= edge, "edges of {} at {edge}", longest(&refined));
        for mesh in &refined.meshes {
            assert_eq!(mesh.normals.len(), mesh.positions.len(), "every vertex has a normal");
            assert!(mesh.normals.iter().all(|n| n.is_normalized()), "normals stay unit");
        }
    }
}

/// The check for gaps sees one: a vertex on an edge that only one side of it knows.
#[test]
fn surface_stays_the_same_can_fail() {
    let mut scene = scene::builtin("closed-room").expect("builtin");
    let mesh = &mut scene.meshes[0];
    let [a, b, c] = mesh.triangles[0];
    let middle = mesh.positions.len() as u32;
    mesh.positions.push(0.5 * (mesh.positions[a as usize] + mesh.positions[b as usize]));
    mesh.triangles[0] = [a, middle, c];
    mesh.triangles.push([middle, b, c]);
    assert!(open_edges(&scene) > 0, "a T-junction must be seen");
}

/// Vertices of one mesh that lie within an edge of another triangle, which lacks them: pictures have pinholes along such edges.
fn junctions(scene: &Scene) -> usize {
    let points: Vec<Vec3> = scene.meshes.iter().flat_map(|m| m.positions.iter().copied()).collect();
    let mut by_x: Vec<Vec3> = points;
    by_x.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).expect("numbers"));
    by_x.dedup();
    let mut found = 0;
    for mesh in &scene.meshes {
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let (a, b) = (mesh.positions[a as usize], mesh.positions[b as usize]);
                let (low, high) = (a.min(b), a.max(b));
                let first = by_x.partition_point(|p| p.x < low.x - 1e-6);
                for p in by_x[first..].iter().take_while(|p| p.x <= high.x + 1e-6) {
                    let (way, along) = (*p - a, (b - a).normalize());
                    let far = way.dot(along);
                    let margin = 1e-3 * (b - a).length();
                    found += usize::from(
                        far > margin && far < (b - a).length() - margin && (way - far * along).length() < 1e-5,
                    );
                }
            }
        }
    }
    found
}

/// Refinement makes no such vertices, and joins those edges that had some: the roof of the Cornell box has an opening.
#[test]
fn splitting_makes_no_junctions() {
    for name in ["closed-room", "cornell-box", "sphere-on-plane"] {
        let scene = scene::builtin(name).expect("builtin");
        let refined = refine(&scene, &with(Refine::Auto)).expect("splits");
        assert_eq!(junctions(&refined), 0, "{name} with {} before", junctions(&scene));
    }
}

#[test]
fn splitting_makes_no_junctions_can_fail() {
    let mut scene = scene::builtin("closed-room").expect("builtin");
    assert_eq!(junctions(&scene), 0, "as it is written");
    let mesh = &mut scene.meshes[0];
    let [a, b, c] = mesh.triangles[0];
    let middle = mesh.positions.len() as u32;
    mesh.positions.push(0.5 * (mesh.positions[a as usize] + mesh.positions[b as usize]));
    mesh.normals.push(mesh.normals[a as usize]);
    mesh.triangles[0] = [a, middle, c];
    mesh.triangles.push([middle, b, c]);
    assert!(junctions(&scene) > 0, "a vertex on one side of an edge is seen");
}

/// Two meshes that share a border stay joined, since only the length of an edge decides.
#[test]
fn meshes_stay_joined() {
    let quad = |corners: [[f32; 3]; 4]| Mesh {
        positions: corners.map(Vec3::from_array).to_vec(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let left = quad([[0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [1.7, 0.0, 3.0], [1.7, 0.0, 0.0]]);
    let right = quad([[1.7, 0.0, 0.0], [1.7, 0.0, 3.0], [9.0, 0.0, 3.0], [9.0, 0.0, 0.0]]);
    let scene = Scene { meshes: vec![left, right], materials: vec![scene::Material::default()], ..Scene::default() };
    let refined = refine(&scene, &with(Refine::Edge(0.4))).expect("splits");
    let on_border = |m: &Mesh| {
        let mut z: Vec<u32> = m.positions.iter().filter(|p| p.x == 1.7).map(|p| p.z.to_bits()).collect();
        z.sort_unstable();
        z.dedup();
        z
    };
    assert_eq!(on_border(&refined.meshes[0]), on_border(&refined.meshes[1]), "the border is cut alike");
    assert!(on_border(&refined.meshes[0]).len() > 8, "the border is cut");
}

/// What nothing shadows is left alone: its transfer varies with the normal only.
#[test]
fn auto_splits_only_what_calls_for_it() {
    for name in ["plane", "sphere", "furnace-box"] {
        let scene = scene::builtin(name).expect("builtin");
        assert!(matches!(refine(&scene, &with(Refine::Auto)), Ok(Cow::Borrowed(_))), "{name} needs no splitting");
    }
    let mut coarse = scene::builtin("sphere-on-plane").expect("builtin");
    let mut plane = scene::builtin("plane").expect("builtin").meshes.remove(0);
    plane.positions = vec![Vec3::new(-3.0, 0.0, -3.0), Vec3::new(-3.0, 0.0, 3.0), Vec3::new(3.0, 0.0, 3.0)];
    plane.normals = vec![Vec3::Y; 3];
    plane.triangles = vec![[0, 1, 2]];
    coarse.meshes.retain(|m| m.positions.iter().any(|p| p.y > 0.1));
    coarse.meshes.push(plane);
    let refined = refine(&coarse, &with(Refine::Auto)).expect("splits");
    assert!(refined.vertex_count() > coarse.vertex_count() + 1000, "one triangle cannot hold a shadow");
    let off = refine(&coarse, &with(Refine::Off)).expect("nothing to do");
    assert!(matches!(off, Cow::Borrowed(_)), "off is off");
    assert!(refine(&coarse, &with(Refine::Edge(0.0))).is_err(), "no edge has length 0");
}

/// A box of 4 by 2 by 3 whose floor and back wall are of several meshes, or of one: some edges run along parts of others. Turned, so that
/// no plane and no edge is along an axis.
fn patched_box(turn: Quat, one_mesh: bool) -> Scene {
    let quad = |corner: [f32; 3], along: [f32; 3], up: [f32; 3]| {
        let [corner, along, up] = [corner, along, up].map(Vec3::from_array);
        Mesh {
            positions: [corner, corner + along, corner + along + up, corner + up].map(|p| turn * p).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        }
    };
    let mut meshes = vec![
        quad([0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [0.7, 0.0, 0.0]),
        quad([0.7, 0.0, 0.0], [0.0, 0.0, 3.0], [2.2, 0.0, 0.0]),
        quad([2.9, 0.0, 0.0], [0.0, 0.0, 3.0], [1.1, 0.0, 0.0]),
        quad([0.0, 2.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 3.0]),
        // The back wall, one part of which begins within one part of the floor and ends within another.
        quad([0.0, 0.0, 0.0], [1.3, 0.0, 0.0], [0.0, 2.0, 0.0]),
        quad([1.3, 0.0, 0.0], [2.7, 0.0, 0.0], [0.0, 2.0, 0.0]),
        quad([0.0, 0.0, 3.0], [0.0, 2.0, 0.0], [4.0, 0.0, 0.0]),
        quad([0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]),
        quad([4.0, 0.0, 0.0], [0.0, 0.0, 3.0], [0.0, 2.0, 0.0]),
    ];
    if one_mesh {
        let mut whole = Mesh::default();
        for mesh in meshes.drain(..) {
            let first = whole.positions.len() as u32;
            whole.positions.extend(mesh.positions);
            whole.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
        }
        meshes.push(whole);
    }
    Scene { meshes, materials: vec![scene::Material::default()], ..Scene::default() }
}

/// Where an edge runs along a part of a longer one, both get the same vertices, in one mesh and across meshes, however the scene is turned.
#[test]
fn edges_along_parts_of_others_are_split_alike() {
    for turn in [Quat::IDENTITY, Quat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7)] {
        for one_mesh in [false, true] {
            let scene = patched_box(turn, one_mesh);
            let before = junctions(&scene);
            assert!(before >= 6, "can fail: {before} junctions before");
            for how in [Refine::Auto, Refine::Edge(0.23)] {
                let refined = refine(&scene, &with(how)).expect("splits");
                assert_eq!(junctions(&refined), 0, "{how:?}, one mesh {one_mesh}, turned {turn}");
                assert_eq!(open_edges(&refined), 0, "every edge has its like");
                assert!((area(&refined) / area(&scene) - 1.0).abs() < 1e-5, "the surface stays the same");
                let kept = scene.meshes.iter().zip(&refined.meshes);
                assert!(
                    kept.into_iter().all(|(a, b)| b.positions.starts_with(&a.positions)),
                    "vertices keep their indices"
                );
            }
        }
    }
}

/// Three sheets that meet in a line from 0 to 4, each cut more finely than the one before; the line of the second runs along that of the
/// first and has a vertex of the third within it. `order` is that of the sheets, in meshes of their own or in one.
fn sheets(order: [usize; 3], one_mesh: bool) -> Scene {
    let cuts: [&[f32]; 3] = [&[0.0, 4.0], &[0.0, 2.0, 4.0], &[0.0, 0.6, 2.0, 4.0]];
    let mut meshes: Vec<Mesh> = Vec::new();
    for k in order {
        if meshes.is_empty() || !one_mesh {
            meshes.push(Mesh::default());
        }
        let mesh = meshes.last_mut().expect("one at least");
        for ends in cuts[k].windows(2) {
            let v = mesh.positions.len() as u32;
            let [a, b] = [ends[0], ends[1]].map(|x| Vec3::new(x, 0.0, 0.0));
            let up = [Vec3::Y, Vec3::Z, Vec3::NEG_Z][k];
            mesh.positions.extend([a, b, b + up, a + up]);
            mesh.triangles.extend([[v, v + 1, v + 2], [v, v + 2, v + 3]]);
        }
    }
    Scene { meshes, materials: vec![scene::Material::default()], ..Scene::default() }
}

/// Edges at one place are cut alike wherever they are, and the same way each time: tables have an order of their own in every run.
#[test]
fn edges_along_parts_of_parts_are_split_alike() {
    for (order, one_mesh) in [([0, 1, 2], true), ([0, 1, 2], false), ([2, 1, 0], true), ([1, 0, 2], false)] {
        let scene = sheets(order, one_mesh);
        assert_eq!(junctions(&scene), 3, "can fail: two in the edge of the first, one in that of the second");
        let first = refine(&scene, &with(Refine::Edge(1.8))).expect("splits").into_owned();
        assert_eq!(junctions(&first), 0, "{order:?}, one mesh {one_mesh}");
        for _ in 0..16 {
            let again = refine(&scene, &with(Refine::Edge(1.8))).expect("splits");
            let same = |(a, b): (&Mesh, &Mesh)| a.positions == b.positions && a.triangles == b.triangles;
            assert!(first.meshes.iter().zip(&again.meshes).all(same), "{order:?}, one mesh {one_mesh}");
        }
    }
}

/// An edge that only meets others, or runs beside them, stays whole.
#[test]
fn edges_that_only_meet_are_left_alone() {
    let quad = |corners: [[f32; 3]; 4]| Mesh {
        positions: corners.map(Vec3::from_array).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let ground = quad([[0.0, 0.0, 0.0], [0.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, 0.0]]);
    // Its corner touches the ground's edge; the other one runs along it, a millimetre away.
    let touching = quad([[1.3, 0.0, 0.0], [1.8, 0.5, -1.0], [1.3, 1.0, -2.0], [0.8, 0.5, -1.0]]);
    let beside = quad([[2.3, 0.0, -0.001], [3.4, 0.0, -0.001], [3.4, 0.0, -2.0], [2.3, 0.0, -2.0]]);
    let with_others = |others: Vec<Mesh>| {
        let meshes = std::iter::once(ground.clone()).chain(others).collect();
        let scene = Scene { meshes, materials: vec![scene::Material::default()], ..Scene::default() };
        refine(&scene, &with(Refine::Edge(3.0))).expect("splits").meshes[0].positions.clone()
    };
    let alone = with_others(Vec::new());
    assert_eq!(with_others(vec![touching, beside.clone()]), alone);
    let mut along = beside;
    along.positions.iter_mut().filter(|p| p.z == -0.001).for_each(|p| p.z = 0.0);
    assert_ne!(with_others(vec![along]), alone, "can fail");
}

/// Pages of a book, whose edges lie on one line of 1 m and a little, none with the ends of another.
fn book(pages: u32) -> Scene {
    let page = |k: u32| {
        let (from, turn) = (k as f32 / pages as f32, 0.4 + 2.3 * k as f32 / pages as f32);
        let (along, up) = (Vec3::X, Vec3::new(0.0, turn.sin(), turn.cos()));
        let a = from * Vec3::X;
        Mesh {
            positions: vec![a, a + along, a + along + up, a + up],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        }
    };
    Scene { meshes: (0..pages).map(page).collect(), materials: vec![scene::Material::default()], ..Scene::default() }
}

/// Triangles of a book whose edges are to be as short as 0.6 m: where nothing is cut each page becomes 16.
fn triangles_of_book(pages: u32) -> usize {
    let book = book(pages);
    let refined = refine(&book, &with(Refine::Edge(0.6))).expect("splits");
    refined.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
}

/// Edges of a few pages are cut at each other's ends; those of hundreds would be cut into parts by the square of their number.
#[test]
fn edges_of_many_on_one_line_stay_few() {
    assert_eq!(triangles_of_book(1), 16);
    assert!(triangles_of_book(20) > 20 * 32, "can fail: a few are cut at the ends of all others");
    let many = triangles_of_book(2_000);
    assert!(many < 2_000 * 64, "{many}");
}
