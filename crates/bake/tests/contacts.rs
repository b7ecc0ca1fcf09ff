//! Where surfaces touch or nearly do: light must not leak in from vertices that stand outside.

mod support;

use bake::refine;
use coeff_io::{Prt, Refine, Sampler, Settings};
use glam::{Vec3, Vec4};
use raytrace::{Ray, Tracer};
use sampling::frame::Frame;
use scene::{Material, Mesh, Scene};
use support::{fixed, quiet, under_white};

/// Albedo of every surface.
const ALBEDO: f32 = 0.8;

/// A rectangle of `cells` by `cells` quads from a corner along two sides, seen from where their cross product points.
fn rectangle(corner: Vec3, along: Vec3, across: Vec3, cells: u32) -> Mesh {
    let n = cells + 1;
    let at = |i: u32| corner + along * ((i % n) as f32 / cells as f32) + across * ((i / n) as f32 / cells as f32);
    let quads = (0..cells * cells).map(|k| (k % cells) + (k / cells) * n);
    Mesh {
        positions: (0..n * n).map(at).collect(),
        normals: vec![along.cross(across).normalize(); (n * n) as usize],
        triangles: quads.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect(),
        ..Mesh::default()
    }
}

/// The six faces of a box, each of `cells` by `cells` quads, its underside first.
fn closed_box(low: Vec3, size: Vec3, cells: u32) -> Vec<Mesh> {
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    let high = low + size;
    vec![
        rectangle(low, x, z, cells),
        rectangle(low, y, x, cells),
        rectangle(low, z, y, cells),
        rectangle(high, -z, -x, cells),
        rectangle(high, -x, -y, cells),
        rectangle(high, -y, -z, cells),
    ]
}

fn scene(meshes: Vec<Mesh>) -> Scene {
    let material = Material { base_color: Vec4::new(ALBEDO, ALBEDO, ALBEDO, 1.0), ..Material::default() };
    Scene { meshes, materials: vec![material], ..Scene::default() }
}

/// A wall of 1 m on a floor whose two rows of vertices stand 1 m before the wall and inside it.
fn floor_into_wall() -> Scene {
    let mut floor = rectangle(Vec3::new(-1.0, 0.0, 40.0), Vec3::X * 2.0, Vec3::Z * -80.0, 1);
    let normals = floor.normals.clone();
    assert_eq!(normals[0], Vec3::Y, "the floor looks up");
    floor.name = "floor".into();
    let mut meshes = vec![floor];
    meshes.extend(closed_box(Vec3::new(0.0, -1.0, -60.0), Vec3::new(1.5, 2.0, 120.0), 1));
    scene(meshes)
}

/// Open shares of the floor's vertices, those before the wall and those inside it.
fn shares(prt: &Prt) -> [Vec<f64>; 2] {
    let floor = prt.geometry.positions.iter().zip(&prt.transfer.openness).take(4);
    let of = |inside: bool| floor.clone().filter(|(p, _)| (p[0] > 0.0) == inside).map(|(_, o)| f64::from(*o)).collect();
    [of(false), of(true)]
}

/// Open share at a distance from a long wall of height 1, form factor of a wall at right angles (Howell B-4): half of what
/// 1 - cos of the wall's elevation leaves.
fn beside_wall(distance: f64) -> f64 {
    0.5 + 0.5 * distance / distance.hypot(1.0)
}

#[test]
fn a_vertex_inside_a_wall_is_as_dark_as_the_foot_of_the_wall() {
    let [before, inside] = shares(&quiet(&floor_into_wall(), &fixed(2, Sampler::OwenSobol, 4096, 0)));
    for share in &before {
        assert!((share - beside_wall(1.0)).abs() < 0.01, "1 m before the wall: {share}");
    }
    for share in &inside {
        // The receiver stands at 98 % of the way to the wall; the ends of the wall are 20 m away.
        assert!((share - beside_wall(0.02)).abs() < 0.01, "inside the wall: {share}");
    }
    // Twin: what a mean of the neighbours would give.
    assert!(before.iter().all(|share| (share - beside_wall(0.02)).abs() > 0.3), "the neighbours are lit: {before:?}");
}

/// Height of the box over the floor.
const GAP: f32 = 0.01;

/// A box of half a metre that hovers over the middle of a floor of two triangles.
fn hovering_box(floor_cells: u32) -> Scene {
    let floor = rectangle(Vec3::new(-1.0, 0.0, 1.0), Vec3::X * 2.0, Vec3::Z * -2.0, floor_cells);
    let mut meshes = closed_box(Vec3::new(-0.25, GAP, -0.25), Vec3::new(0.5, 0.3, 0.5), 10);
    meshes.push(floor);
    scene(meshes)
}

/// The underside of the box sees floor that it shades itself; the corners of that floor are lit.
#[test]
fn light_does_not_leak_into_a_gap() {
    let prt = quiet(&hovering_box(1), &fixed(2, Sampler::OwenSobol, 2048, 1));
    let radiance = under_white(&prt);
    // 0.1 m from the rim, sky or lit floor shows below an elevation of GAP / 0.1: at most its squared sine of the cosine lobe.
    let most = f64::from(ALBEDO) * 2.0 * f64::from(GAP / 0.1).powi(2);
    let underside = 0..prt.meshes[0].vertices as usize;
    let deep = underside.filter(|&v| {
        let [x, _, z] = prt.geometry.positions[v];
        x.abs().max(z.abs()) < 0.25 - 0.099
    });
    let worst = deep.map(|v| radiance[v]).fold(0.0, f64::max);
    assert!(worst < most, "light of {worst} in the gap, at most {most}");
    // Twin: the mean of the floor's corners, reflected twice, is what interpolation alone would find.
    let floor = prt.meshes.last().expect("the floor").first_vertex as usize;
    let interpolated = f64::from(ALBEDO) * radiance[floor..].iter().sum::<f64>() / 4.0;
    assert!(interpolated > 20.0 * most, "the corners are lit: {interpolated}");
}

/// Vertices per area within 0.1 m of the rim of the box's shadow, over those of the rest of the floor.
fn density_at_rim(scene: &Scene) -> f64 {
    let floor = scene.meshes.last().expect("the floor");
    let at_rim = |p: &&Vec3| (p.x.abs().max(p.z.abs()) - 0.25).abs() < 0.1;
    let rim = floor.positions.iter().filter(at_rim).count() as f64;
    let rest = floor.positions.len() as f64 - rim;
    let rim_area = 0.7 * 0.7 - 0.3 * 0.3;
    (rim / rim_area) / (rest / (4.0 - rim_area))
}

#[test]
fn vertices_gather_where_transfer_bends() {
    let coarse = hovering_box(20);
    let split = |refine| bake::refine(&coarse, &Settings { refine, ..bake::settings::standard() }).expect("splits");
    let bent = split(Refine::Auto);
    assert!(density_at_rim(&bent) > 1.4, "at bends: {}", density_at_rim(&bent));
    // Twin: splitting by length alone gathers none.
    let even = density_at_rim(&split(Refine::Edge(0.04)));
    assert!((0.8..1.2).contains(&even), "even splitting: {even}");
    let again = refine(&coarse, &bake::settings::standard()).expect("splits");
    let triangles = |scene: &Scene| scene.meshes.iter().map(|m| m.triangles.clone()).collect::<Vec<_>>();
    assert_eq!(triangles(&bent), triangles(&again), "splitting is the same each time");
}

/// Points of the saucer's well around the foot of the cup, with the open share there between the receivers and the normal.
fn around_the_foot(prt: &Prt) -> Vec<(Vec3, Vec3, f64)> {
    let saucer = prt.meshes.iter().find(|mesh| mesh.name == "saucer").expect("the teacup has one");
    let triangles = prt.geometry.triangles[saucer.first_triangle as usize..][..saucer.triangles as usize].to_vec();
    let [positions, normals] =
        [&prt.geometry.positions, &prt.geometry.normals].map(|list| move |v: u32| Vec3::from(list[v as usize]));
    // The upper side of the well.
    let well: Vec<[u32; 3]> =
        triangles.into_iter().filter(|t| t.iter().all(|&v| normals(v).y > 0.5 && positions(v).y < 0.0075)).collect();
    let row = (prt.transfer.bands * prt.transfer.bands * prt.transfer.channels) as usize;
    let open = |v: u32| f64::from(prt.transfer.values[v as usize * row]) * (4.0 * std::f64::consts::PI).sqrt();
    let mut points = Vec::new();
    for (radius, k) in [0.0242, 0.0250, 0.0258, 0.0266].into_iter().flat_map(|r| (0..144).map(move |k| (r, k))) {
        let angle = (k as f32 + 0.25) / 144.0 * std::f32::consts::TAU;
        let (x, z) = (radius * angle.sin(), radius * angle.cos());
        let shares = |t: &[u32; 3]| {
            let [a, b, c] = t.map(&positions);
            let side = |p: Vec3, q: Vec3| (p.x - x) * (q.z - z) - (q.x - x) * (p.z - z);
            let parts = Vec3::new(side(b, c), side(c, a), side(a, b));
            let shares = parts / parts.element_sum();
            (shares.min_element() >= -1e-4).then_some(shares)
        };
        let (t, shares) = well.iter().find_map(|t| Some((t, shares(t)?))).expect("the well is whole");
        let mean = |of: &dyn Fn(u32) -> Vec3| (0..3).map(|i| shares[i] * of(t[i])).sum::<Vec3>();
        let between = (0..3).map(|i| f64::from(shares[i]) * open(t[i])).sum();
        points.push((mean(&positions), mean(&normals).normalize(), between));
    }
    points
}

/// Open share of the sky of a point: rays through the middles of cells of equal weight.
fn open_share(tracer: &Tracer, point: Vec3, normal: Vec3) -> f64 {
    let frame = Frame::from_normal(normal);
    let (rows, columns) = (24, 96);
    let open = (0..rows * columns).filter(|k| {
        let sine = (((k / columns) as f32 + 0.5) / rows as f32).sqrt();
        let angle = ((k % columns) as f32 + 0.5) / columns as f32 * std::f32::consts::TAU;
        let way = Vec3::new(sine * angle.cos(), sine * angle.sin(), (1.0 - sine * sine).sqrt());
        let ray = Ray::new(point + 1e-6 * normal, frame.to_world(way));
        tracer.closest(&ray, &|_, _, _| true).is_none()
    });
    open.count() as f64 / f64::from(rows * columns)
}

/// Largest difference around the foot between the open share of the file and that by rays to the scene as it is.
fn worst_around_the_foot(scene: &Scene, refine: Refine) -> f64 {
    let settings = Settings { refine, ..fixed(2, Sampler::OwenSobol, 512, 0) };
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for mesh in &scene.meshes {
        let first = positions.len() as u32;
        positions.extend_from_slice(&mesh.positions);
        triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let off = |(point, normal, between): (Vec3, Vec3, f64)| (open_share(&tracer, point, normal) - between).abs();
    around_the_foot(&quiet(scene, &settings)).into_iter().map(off).fold(0.0, f64::max)
}

/// Edges that come out of the gap under the foot of a cup are split all around it: its shadow has no teeth.
#[test]
fn the_shadow_at_a_foot_has_no_teeth() {
    let cup = scene::builtin("teacup").expect("a built-in scene");
    let worst = worst_around_the_foot(&cup, Refine::Auto);
    assert!(worst < 0.04, "{worst} off");
}

/// Edges that are not split there show.
#[test]
fn the_shadow_at_a_foot_has_no_teeth_can_fail() {
    let cup = scene::builtin("teacup").expect("a built-in scene");
    let worst = worst_around_the_foot(&cup, Refine::Off);
    assert!(worst > 0.07, "{worst} off where nothing is split");
}
