//! What counts as the inside of a body: receivers that see leaves, slats or sheets from behind keep what they see.

mod support;

use bake::{Receiver, Receivers};
use coeff_io::{Prt, Refine, Sampler, Settings};
use glam::{DVec3, Mat3, Vec3};
use scene::{AlphaMode, Material, Mesh, Scene};
use support::{fixed, quiet, rectangle};

/// Rays by brute force along a side of the square that they are drawn from.
const SIDE: u32 = 36;
/// Largest difference of an open share from that of brute force; its own noise is below 0.01.
const AGREE: f64 = 0.035;

fn settings() -> Settings {
    Settings { refine: Refine::Off, ..fixed(2, Sampler::OwenSobol, 1024, 0) }
}

fn scene(meshes: Vec<Mesh>) -> Scene {
    Scene { meshes, materials: vec![Material::default()], ..Scene::default() }
}

/// The faces of a box; `lid` and `bottom` may be missing.
fn box_of(low: Vec3, size: Vec3, cells: u32, [lid, bottom]: [bool; 2]) -> Vec<Mesh> {
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    let high = low + size;
    let face = |corner, along, across| rectangle(corner, along, across, [cells; 2]);
    let mut faces = vec![face(low, y, x), face(low, z, y), face(high, -x, -y), face(high, -y, -z)];
    faces.extend(lid.then(|| face(high, -z, -x)));
    faces.extend(bottom.then(|| face(low, x, z)));
    faces
}

fn crate_at(low: Vec3, size: Vec3) -> Vec<Mesh> {
    box_of(low, size, 3, [true, true])
}

/// The same surface seen from the other side.
fn flipped(mut meshes: Vec<Mesh>) -> Vec<Mesh> {
    for mesh in &mut meshes {
        mesh.normals.iter_mut().for_each(|n| *n = -*n);
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    meshes
}

/// A ground of 4 m at height 0 whose vertices are 0.2 m apart.
fn ground() -> Mesh {
    rectangle(Vec3::new(-2.0, 0.0, 2.0), Vec3::X * 4.0, Vec3::NEG_Z * 4.0, [20, 20])
}

/// Numbers from 0 to 1 that look random.
fn noise(seed: u32) -> impl FnMut() -> f32 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
        ((word >> 22) ^ word) as f32 / u32::MAX as f32
    }
}

/// Leaves of 0.2 m, one-sided, in a ball of 0.6 m.
fn crown(count: u32) -> Vec<Mesh> {
    let mut next = noise(7);
    let mut ball = move || loop {
        let p = Vec3::new(next(), next(), next()) * 2.0 - 1.0;
        if p.length() < 1.0 && p.length() > 0.01 {
            return p;
        }
    };
    (0..count)
        .map(|_| {
            let (at, facing) = (Vec3::Y + 0.6 * ball(), ball().normalize());
            let frame =
                Mat3::from_cols(facing.any_orthonormal_vector(), facing.cross(facing.any_orthonormal_vector()), facing);
            rectangle(at - 0.1 * (frame.x_axis + frame.y_axis), 0.2 * frame.x_axis, 0.2 * frame.y_axis, [1, 1])
        })
        .collect()
}

/// Slats that face up, 3 cm apart and 4 cm deep.
fn blinds() -> Vec<Mesh> {
    let slat = |k: u32| {
        let low = Vec3::new(-0.5, 0.03 * k as f32, 0.0);
        rectangle(low, Vec3::X, Vec3::new(0.0, 0.01, -0.04), [8, 2])
    };
    (0..20).map(slat).collect()
}

/// An upright pipe, open at both ends, that faces outwards, above a small quad.
fn tube() -> Vec<Mesh> {
    let mut mesh = Mesh::default();
    for k in 0..=24 {
        let (sin, cos) = (std::f32::consts::TAU * (k % 24) as f32 / 24.0).sin_cos();
        for y in [0.3, 1.3] {
            mesh.positions.push(Vec3::new(0.5 * cos, y, -0.5 * sin));
            mesh.normals.push(Vec3::new(cos, 0.0, -sin));
        }
    }
    mesh.triangles = (0..24).flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]]).collect();
    vec![mesh, rectangle(Vec3::new(-0.3, 0.5, 0.3), Vec3::X * 0.6, Vec3::NEG_Z * 0.6, [3, 3])]
}

/// A hedge: cards in rows, all facing the same way.
fn hedge() -> Vec<Mesh> {
    let card = |k: u32| rectangle(Vec3::new(-0.5, 0.0, -0.05 * k as f32), Vec3::X, Vec3::Y * 0.8, [4, 4]);
    (0..8).map(card).collect()
}

/// A ground that is bent like a terrain and ends in a skirt, with a crate of its own below.
fn skirt() -> Vec<Mesh> {
    let mut meshes = box_of(Vec3::new(-2.0, -0.5, -2.0), Vec3::new(4.0, 0.5, 4.0), 10, [true, false]);
    meshes.push(rectangle(Vec3::new(-0.5, -0.3, 0.5), Vec3::X, Vec3::NEG_Z, [3, 3]));
    meshes
}

fn with_ground(mut meshes: Vec<Mesh>) -> Vec<Mesh> {
    meshes.push(ground());
    meshes
}

/// A crate that the ground runs through.
fn pierced(material: Material) -> Scene {
    let meshes = with_ground(crate_at(Vec3::new(-0.7, -0.5, -0.7), Vec3::splat(1.4)));
    let mut scene = scene(meshes);
    scene.materials.push(material);
    let count = scene.meshes.len() - 1;
    scene.meshes[..count].iter_mut().for_each(|mesh| mesh.material = 1);
    scene
}

/// Every triangle of a scene.
fn triangles(scene: &Scene) -> Vec<[DVec3; 3]> {
    let of = |mesh: &Mesh| {
        let corner = |v: u32| mesh.positions[v as usize].as_dvec3();
        mesh.triangles.iter().map(|t| t.map(corner)).collect::<Vec<_>>()
    };
    scene.meshes.iter().flat_map(of).collect()
}

fn meets(from: DVec3, way: DVec3, &[a, b, c]: &[DVec3; 3]) -> bool {
    let (e, f) = (b - a, c - a);
    let across = way.cross(f);
    let determinant = e.dot(across);
    if determinant.abs() < 1e-14 {
        return false;
    }
    let to = from - a;
    let (u, turned) = (to.dot(across) / determinant, to.cross(e));
    let (v, t) = (way.dot(turned) / determinant, f.dot(turned) / determinant);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 1e-6
}

/// Cosine-weighted share of open directions, each ray against each triangle.
fn open_share(triangles: &[[DVec3; 3]], receiver: &Receiver) -> f64 {
    let normal = receiver.normal.as_dvec3();
    let along = normal.any_orthonormal_vector();
    let from = receiver.position.as_dvec3() + 1e-6 * receiver.geometric_normal.as_dvec3();
    let open = (0..SIDE * SIDE).filter(|k| {
        let (u, v) = (f64::from(k / SIDE) + 0.5, f64::from(k % SIDE) + 0.5);
        let (u, angle) = (u / f64::from(SIDE), std::f64::consts::TAU * v / f64::from(SIDE));
        let (sin, cos) = angle.sin_cos();
        let way = (along * cos + normal.cross(along) * sin) * u.sqrt() + normal * (1.0 - u).sqrt();
        !triangles.iter().any(|triangle| meets(from, way, triangle))
    });
    open.count() as f64 / f64::from(SIDE * SIDE)
}

fn openness(prt: &Prt) -> Vec<f32> {
    let count = prt.geometry.positions.len();
    if prt.transfer.openness.is_empty() { vec![1.0; count] } else { prt.transfer.openness.clone() }
}

/// Largest difference of the baked open shares from brute force over some forty receivers.
fn worst(scene: &Scene, prt: &Prt) -> f64 {
    let (triangles, receivers) = (triangles(scene), Receivers::of(scene));
    let step = (receivers.permanent / 40).max(1);
    let away = |(baked, receiver): (f32, &Receiver)| (f64::from(baked) - open_share(&triangles, receiver)).abs();
    openness(prt).into_iter().zip(&receivers.list).step_by(step).map(away).fold(0.0, f64::max)
}

/// The same of receivers that see more than a fiftieth of the sky.
fn worst_seen(scene: &Scene, prt: &Prt) -> f64 {
    let (triangles, receivers) = (triangles(scene), Receivers::of(scene));
    let step = (receivers.permanent / 40).max(1);
    let pairs = openness(prt).into_iter().zip(&receivers.list).step_by(step);
    let pairs = pairs.map(|(baked, receiver)| (f64::from(baked), open_share(&triangles, receiver)));
    pairs.filter(|(_, open)| *open > 0.02).map(|(baked, open)| (baked - open).abs()).fold(0.0, f64::max)
}

/// No receiver is taken for one inside a body, and each that sees the sky holds what it sees from its own place.
fn stays(name: &str, meshes: Vec<Mesh>) {
    stays_in(name, &scene(meshes));
}

fn stays_in(name: &str, scene: &Scene) {
    let prt = quiet(scene, &settings());
    assert_eq!(prt.achieved.repairs.inside, 0, "{name}: nothing is inside a body");
    let worst = worst_seen(scene, &prt);
    assert!(worst < AGREE, "{name}: {worst} off what brute force sees");
}

#[test]
fn sheets_are_no_bodies() {
    stays("leaves", crown(60));
    stays("leaves over a ground", with_ground(crown(60)));
    stays("blinds", blinds());
    stays("a hedge", with_ground(hedge()));
    stays("an open tube", tube());
    stays("an open tube over a ground", with_ground(tube()));
    stays("an open tube among leaves", [tube(), crown(60)].concat());
    stays("a terrain with a skirt", skirt());
}

/// Twin: vertices of a ground inside a crate do not hold what they see.
#[test]
fn sheets_are_no_bodies_can_fail() {
    let scene = pierced(Material::default());
    let prt = quiet(&scene, &settings());
    assert!(prt.achieved.repairs.inside > 20, "a crate is a body: {:?}", prt.achieved.repairs);
    assert!(worst(&scene, &prt) > 0.3, "inside it all is dark");
}

#[test]
fn only_opaque_one_sided_outward_shells_are_bodies() {
    let masked = Material { alpha: AlphaMode::Mask(0.5), ..Material::default() };
    // Under a masked shell it is dark and nobody sees it; vertices beside its rim are lit as the ground before it is.
    stays_in("a masked shell", &pierced(masked));
    let double_sided = Material { double_sided: true, ..Material::default() };
    let scene = pierced(double_sided);
    let prt = quiet(&scene, &settings());
    assert_eq!(prt.achieved.repairs.inside, 0, "a two-sided shell");
    let shell = crate_at(Vec3::new(-0.7, -0.5, -0.7), Vec3::splat(1.4));
    stays("a shell that faces inwards", with_ground(flipped(shell)));
}

/// Open share of the ground's vertices within 0.6 m of the middle: they lie inside.
fn ground_inside(prt: &Prt) -> Vec<f32> {
    let all = openness(prt);
    let count = prt.geometry.positions.len();
    let ground = count - 21 * 21..count;
    ground.filter(|&v| prt.geometry.positions[v].iter().all(|x| x.abs() < 0.65)).map(|v| all[v]).collect()
}

/// What is inside holds what the ground sees beside the body, not darkness.
fn is_mended(name: &str, meshes: Vec<Mesh>) {
    let prt = quiet(&scene(with_ground(meshes)), &settings());
    let inside = ground_inside(&prt);
    let least = inside.iter().copied().fold(1.0, f32::min);
    // Beside a wall of about 1 m and as wide the ground sees a half to three quarters of the sky.
    assert!(least > 0.4, "{name}: {least} of {} vertices", inside.len());
}

#[test]
fn bodies_are_bodies() {
    let (low, size) = (Vec3::new(-0.7, -0.5, -0.7), Vec3::splat(1.4));
    is_mended("a closed crate", crate_at(low, size));
    is_mended("a crate without a bottom, sunk into the ground", box_of(low, size, 3, [true, false]));
    let standing = box_of(Vec3::new(-0.7, 0.0, -0.7), size, 3, [true, false]);
    is_mended("a crate without a bottom on the ground", standing);
    let mut pierced = box_of(low, size, 3, [true, false]);
    pierced.extend(crate_at(Vec3::new(-0.8, -0.4, -0.8), Vec3::new(1.6, 0.1, 1.6)));
    is_mended("a crate without a bottom, sunk into the ground and a slab in it", pierced);
    let hovering = |height: f32| box_of(Vec3::new(-0.7, height, -0.7), size, 3, [true, false]);
    is_mended("a crate without a bottom that hovers a hair above the ground", hovering(0.01));
    let mut hollow = crate_at(low, size);
    hollow.extend(flipped(crate_at(low + 0.2, size - 0.4)));
    let prt = quiet(&scene(with_ground(hollow)), &settings());
    // Between the walls lies the ring of vertices 0.6 m from the middle.
    assert_eq!(prt.achieved.repairs.inside, 24, "within the wall of a hollow crate");
}

/// Twin: from a gap that one can look into, the inside shows.
#[test]
fn bodies_are_bodies_can_fail() {
    let raised = box_of(Vec3::new(-0.7, 0.15, -0.7), Vec3::splat(1.4), 3, [true, false]);
    assert_eq!(quiet(&scene(with_ground(raised)), &settings()).achieved.repairs.inside, 0);
}

/// Corners that rounding moved, and sides that are cut more finely than the lid, leave a crate closed.
#[test]
fn seams_do_not_open_a_body() {
    let (low, size) = (Vec3::new(-0.7, -0.5, -0.7), Vec3::splat(1.4));
    let mut faces = box_of(low, size, 2, [false, true]);
    faces.push(rectangle(low + size, Vec3::NEG_Z * size.z, Vec3::NEG_X * size.x, [6, 6]));
    for p in &mut faces[0].positions {
        p.x = p.x.next_up();
    }
    let prt = quiet(&scene(with_ground(faces.clone())), &settings());
    assert!(ground_inside(&prt).iter().all(|&share| share > 0.4), "a closed crate");
    // Twin: without its lid a crate that stands free is no body.
    faces.pop();
    for mesh in &mut faces {
        mesh.positions.iter_mut().for_each(|p| p.y += 3.0);
    }
    assert_eq!(quiet(&scene(with_ground(faces)), &settings()).achieved.repairs.inside, 0);
}

/// Boxes that run through each other: the corner of each that is buried in the other is mended.
#[test]
fn bodies_within_bodies_are_mended() {
    let mut meshes = crate_at(Vec3::ZERO, Vec3::ONE);
    meshes.extend(crate_at(Vec3::new(0.45, 0.45, 0.45), Vec3::ONE));
    let scene = scene(meshes);
    let prt = quiet(&scene, &settings());
    let buried = |p: Vec3| {
        let within = |low: f32| p.min_element() > low + 1e-3 && p.max_element() < low + 1.0 - 1e-3;
        within(0.0) || within(0.45)
    };
    let shares = openness(&prt);
    let inside: Vec<f32> =
        prt.geometry.positions.iter().zip(&shares).filter(|(p, _)| buried(Vec3::from(**p))).map(|(_, s)| *s).collect();
    assert!(inside.len() > 10, "{}", inside.len());
    assert!(inside.iter().all(|&share| share > 0.2), "{inside:?}");
    assert_eq!(prt.achieved.repairs.inside as usize, inside.len());
}
