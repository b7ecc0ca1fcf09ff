//! Small objects on large triangles: refinement finds them at any ratio of sizes, and what lies between vertices is right.

mod support;

use coeff_io::{Prt, Refine, Sampler, Settings};
use glam::{Vec2, Vec3};
use scene::{Material, Mesh, Scene};
use support::{fixed, quiet};

/// A box by its lowest and highest corner.
type Solid = [Vec3; 2];

/// The ground, a square of two triangles about the origin whose sides have the given length, and boxes that stand on it or hang over it.
fn scene(side: f32, boxes: &[Solid]) -> Scene {
    let h = 0.5 * side;
    let shift = Vec3::new(0.237 * h, 0.0, -0.119 * h);
    let corners = [[-h, -h], [-h, h], [h, h], [h, -h]];
    let ground = Mesh {
        positions: corners.map(|[x, z]| Vec3::new(x, 0.0, z) + shift).to_vec(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let mut meshes = vec![ground];
    for [low, high] in boxes {
        let corner = |i: u32| {
            let high = [i & 1, i >> 1 & 1, i >> 2].map(|bit| bit == 1);
            Vec3::from_array(std::array::from_fn(|k| if high[k] { self::high(boxes, low)[k] } else { low[k] }))
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mut mesh = Mesh::default();
        for quad in quads {
            let at = quad.map(corner);
            let normal = (at[1] - at[0]).cross(at[2] - at[0]).normalize();
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(at);
            mesh.normals.extend([normal; 4]);
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        debug_assert!(low.cmple(*high).all());
        meshes.push(mesh);
    }
    Scene { meshes, materials: vec![Material::default()], ..Scene::default() }
}

/// Highest corner of the box with a lowest one.
fn high(boxes: &[Solid], low: &Vec3) -> Vec3 {
    boxes.iter().find(|[other, _]| other == low).expect("one of the boxes")[1]
}

/// Open share of a point of the ground: even steps of the cosine lobe's disk, each ray against each box.
fn open_share(boxes: &[Solid], at: Vec2) -> f64 {
    const STEPS: i32 = 200;
    let (mut open, mut all) = (0, 0);
    for i in -STEPS..STEPS {
        for j in -STEPS..STEPS {
            let foot = (Vec2::new(i as f32, j as f32) + 0.5) / STEPS as f32;
            if foot.length_squared() >= 1.0 {
                continue;
            }
            all += 1;
            let up = (1.0 - foot.length_squared()).sqrt();
            let direction = Vec3::new(foot.x, up, foot.y);
            let origin = Vec3::new(at.x, 0.0, at.y);
            let hit = |[low, high]: &Solid| {
                let (a, b) = ((*low - origin) / direction, (*high - origin) / direction);
                a.min(b).max_element().max(0.0) < a.max(b).min_element()
            };
            open += i32::from(!boxes.iter().any(hit));
        }
    }
    f64::from(open) / f64::from(all)
}

/// Open share of a point of the ground as renderers have it: interpolated over the triangle of the first mesh that holds it.
fn drawn_share(prt: &Prt, at: Vec2) -> f64 {
    let (triangles, positions) = (&prt.geometry.triangles, &prt.geometry.positions);
    let ground = &prt.meshes[0];
    let own = &triangles[ground.first_triangle as usize..(ground.first_triangle + ground.triangles) as usize];
    for triangle in own {
        let [a, b, c] = triangle.map(|v| Vec2::new(positions[v as usize][0], positions[v as usize][2]));
        let area = (b - a).perp_dot(c - a);
        let (u, v) = ((at - a).perp_dot(c - a) / area, (b - a).perp_dot(at - a) / area);
        if u >= -1e-4 && v >= -1e-4 && u + v <= 1.0002 {
            let shares = [1.0 - u - v, u, v];
            let open = |v: u32| f64::from(prt.transfer.openness[v as usize]);
            return triangle.iter().zip(shares).map(|(&v, share)| f64::from(share) * open(v)).sum();
        }
    }
    panic!("no triangle of the ground holds {at}");
}

/// Mean and worst difference of the open share over points around the first box, up to its own width away.
fn error(side: f32, boxes: &[Solid], refine: Refine) -> [f64; 2] {
    let settings = Settings { refine, ..fixed(3, Sampler::OwenSobol, 512, 0) };
    let prt = quiet(&scene(side, boxes), &settings);
    let [low, high] = boxes[0];
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let width = 2.0 * half.x.max(half.z);
    let mut differences = Vec::new();
    for k in 0..64 {
        let angle = std::f32::consts::TAU * (k as f32 + 0.3) / 64.0;
        let away = Vec2::new(half.x, half.z) * 1.15 + width * (k % 8) as f32 / 8.0;
        let at = Vec2::new(middle.x, middle.z) + away * Vec2::new(angle.cos(), angle.sin()) * 1.45;
        let inside =
            |[low, high]: &Solid| at.x > low.x && at.x < high.x && at.y > low.z && at.y < high.z && low.y < 1e-6;
        if !boxes.iter().any(inside) {
            differences.push((drawn_share(&prt, at) - open_share(boxes, at)).abs());
        }
    }
    let mean = differences.iter().sum::<f64>() / differences.len() as f64;
    [mean, differences.into_iter().fold(0.0, f64::max)]
}

fn solid(low: [f32; 3], high: [f32; 3], unit: f32) -> Solid {
    [low, high].map(|corner| unit * Vec3::from_array(corner))
}

/// A crate of half a metre on grounds of up to a kilometre, in metres and in millimetres.
#[test]
fn a_crate_has_its_shadow_however_large_the_ground_is() {
    for (side, unit) in [(50.0, 1.0), (1000.0, 1.0), (200.0, 1000.0)] {
        let boxes = [solid([-0.25, 0.0, -0.25], [0.25, 0.5, 0.25], unit)];
        let [mean, worst] = error(side * unit, &boxes, Refine::Auto);
        assert!(mean < 0.03 && worst < 0.12, "{side} m in units of {unit}: mean {mean}, worst {worst}");
    }
}

/// Splitting evenly alone, as long as it was before: the crate stands between the vertices, or darkens a large triangle.
#[test]
fn a_crate_has_its_shadow_however_large_the_ground_is_can_fail() {
    let boxes = [solid([-0.25, 0.0, -0.25], [0.25, 0.5, 0.25], 1.0)];
    let [mean, worst] = error(1000.0, &boxes, Refine::Edge(28.0));
    assert!(mean > 0.05 && worst > 0.2, "mean {mean}, worst {worst}");
}

/// A lamp close under a ceiling, here upside down; posts of a street; a plate on a wall, lying.
#[test]
fn other_small_things_have_their_shadows() {
    let lamp = vec![solid([1.3, 0.01, 2.1], [1.7, 0.06, 2.5], 1.0)];
    let posts: Vec<Solid> =
        (0..12).map(|k| solid([4.0 * k as f32 - 20.0, 0.0, 3.0], [4.0 * k as f32 - 19.9, 5.0, 3.1], 1.0)).collect();
    let plate = vec![solid([-3.0, 0.0, -2.0], [-2.5, 0.03, -1.6], 1.0)];
    for (name, side, boxes) in [("lamp", 20.0, lamp), ("posts", 100.0, posts), ("plate", 30.0, plate)] {
        let [mean, worst] = error(side, &boxes, Refine::Auto);
        assert!(mean < 0.05 && worst < 0.25, "{name}: mean {mean}, worst {worst}");
    }
}

/// The number of vertices follows the number of small things, not the size of the ground.
#[test]
fn the_number_of_vertices_stays_bounded() {
    let count = |boxes: &[Solid]| {
        let settings = Settings { refine: Refine::Auto, ..bake::settings::standard() };
        bake::refine(&scene(1000.0, boxes), &settings).expect("splits").vertex_count()
    };
    let boxes = |n: usize| -> Vec<Solid> {
        let at = |k: usize| [(k % 40) as f32 * 20.0 - 400.0, (k / 40) as f32 * 20.0 - 300.0];
        (0..n).map(|k| [at(k), at(k)]).map(|[[x, z], _]| solid([x, 0.0, z], [x + 0.5, 0.5, z + 0.5], 1.0)).collect()
    };
    let (one, many, most) = (count(&boxes(1)), count(&boxes(9)), count(&boxes(1200)));
    assert!(one < 6000 && many - one < 9000, "{one} and {many} vertices");
    assert!(most < 80_000, "{most} vertices for 1,200 boxes of 24");
}
