//! Light that leaks through walls, and receivers inside bodies.

use super::Case;
use super::baking::{askew, fixed, grey, placed, quiet, radiance, shares, white};
use super::case::{worse, worst};
use super::published::{Start, merged, open_share, rays_over};
use glam::Vec3;
use raytrace::Tracer;
use scene::{Mesh, Scene};

pub(crate) fn sealed_box() -> Case {
    Case {
        title: "sealed box of 2 cm, albedo 1, 20 bounces, white sky",
        bound: "radiance inside: no ray leaves, so nothing comes in; 1e-6 is asked for",
        limit: 1e-6,
        ours: || worst(radiance(&quiet(&room(0.01), &fixed(3, 256, 20)), &white(3)).into_iter().map(f64::abs)),
        naive_method: "determinants below 1e-5 do not count; open share",
        naive: || {
            let mesh = &room(0.01).meshes[0];
            worst((0..mesh.positions.len()).step_by(20).map(|v| open_share(mesh, v, Start::OtherIndices, 256)))
        },
    }
}

pub(crate) fn corners_of_a_box() -> Case {
    Case {
        title: "sealed box of six sheets, askew: receivers in its edges and corners",
        bound: "radiance inside, as above",
        limit: 1e-6,
        ours: || worst(radiance(&quiet(&room(1.0), &fixed(3, 1024, 2)), &white(3)).into_iter().map(f64::abs)),
        naive_method: "rays start above the vertex itself; open share",
        naive: || {
            let mesh = &room(1.0).meshes[0];
            worst((0..mesh.positions.len()).map(|v| exact_share(mesh, v)))
        },
    }
}

pub(crate) fn paper_walls() -> Case {
    Case {
        title: "sealed box of two-sided sheets without thickness, albedo 1",
        bound: "radiance inside, and 1 - radiance outside",
        limit: 1e-6,
        ours: || sides(|inside, outside| worse(inside.abs(), (1.0 - outside).abs())),
        naive_method: "one receiver for both sides of a sheet (closed form: any one number is 1/2 off on one side)",
        naive: || sides(|inside, _| worse(inside.abs(), (1.0 - inside).abs())),
    }
}

pub(crate) fn thin_gap() -> Case {
    Case {
        title: "plate of 2 m under another, 0.1 mm apart",
        bound: "open share half a metre and more from the edge: its form factor is (0.1 mm / 0.5 m)² = 4e-8",
        limit: 1e-6,
        ours: || {
            let prt = quiet(&plates(), &fixed(1, 1024, 0));
            let inner = |p: &[f32; 3]| p[1] == 0.0 && p[0].abs() <= 0.5 && p[2].abs() <= 0.5;
            let shares = prt.geometry.positions.iter().zip(shares(&prt)).filter(|(p, _)| inner(p));
            worst(shares.map(|(_, share)| share))
        },
        naive_method: "rays start 1 mm off the surface",
        naive: || {
            let both = merged(&plates().meshes);
            let middle = both.positions.iter().position(|p| *p == Vec3::ZERO).expect("a vertex in the middle");
            open_share(&both, middle, Start::Off(1e-3), 256)
        },
    }
}

pub(crate) fn buried_receivers() -> Case {
    Case {
        title: "vertices of the ground inside a block",
        bound: "how far their open share falls below 1/2, which is free at the foot of any wall; 256 rays tell it to about 1/100",
        limit: 0.01,
        ours: || {
            let prt = quiet(&block_on_ground(), &fixed(1, 256, 0));
            shortfall(&prt.geometry.positions, &shares(&prt))
        },
        naive_method: "what their own rays see",
        naive: || {
            let scene = block_on_ground();
            let (all, ground) = (merged(&scene.meshes), scene.meshes[0].positions.len());
            let shares: Vec<f64> = (0..ground).map(|v| exact_share(&all, v)).collect();
            let positions: Vec<[f32; 3]> = all.positions.iter().map(|p| p.to_array()).collect();
            shortfall(&positions[..ground], &shares)
        },
    }
}

/// The closed room, askew, of this half edge.
fn room(scale: f32) -> Scene {
    placed(grey("closed-room", 1.0), askew(), scale, Vec3::ZERO)
}

/// Open share of a vertex whose rays start just above it, exact rays.
fn exact_share(mesh: &Mesh, vertex: usize) -> f64 {
    let tracer = Tracer::build(&mesh.positions, &mesh.triangles, &[]);
    let rays = rays_over(mesh, vertex);
    rays.iter().filter(|ray| !tracer.occluded(ray, &|_, _, _| true)).count() as f64 / rays.len() as f64
}

/// Worst of some measure of the radiance on both sides of a box's sheets.
fn sides(measure: fn(f64, f64) -> f64) -> f64 {
    let mut scene = room(1.0);
    scene.materials[0].double_sided = true;
    let values = radiance(&quiet(&scene, &fixed(3, 256, 5)), &white(3));
    let (inside, outside) = values.split_at(values.len() / 2);
    worst(inside.iter().zip(outside).map(|(&inside, &outside)| measure(inside, outside)))
}

/// Two plates of 2 m edge.
fn plates() -> Scene {
    let mut scene = grey("facing-planes", 0.5);
    for mesh in &mut scene.meshes {
        mesh.positions.iter_mut().for_each(|p| p.y *= 1e-4);
    }
    scene
}

/// A plane that runs through a closed block of 0.8 m.
fn block_on_ground() -> Scene {
    let mut scene = grey("plane", 0.5);
    let mut block = grey("furnace-box", 0.5).meshes.remove(0);
    block.positions.iter_mut().for_each(|p| *p *= 0.4);
    scene.meshes.push(block);
    scene
}

/// How far the ground inside the block falls below the half of the sky that is free at the foot of a wall.
fn shortfall(positions: &[[f32; 3]], shares: &[f64]) -> f64 {
    let ground = positions.iter().zip(shares).filter(|(p, _)| p[1] == 0.0);
    let inside = ground.filter(|(p, _)| p[0].abs().max(p[2].abs()) < 0.35);
    worst(inside.map(|(_, share)| 0.5 - share))
}
