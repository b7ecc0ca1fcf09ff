//! One bowl at three sizes and far from the origin.

use super::Case;
use super::baking::{askew, fixed, grey, placed, quiet, shares};
use super::case::worst;
use super::published::{Start, open_share};
use glam::Vec3;
use scene::Scene;

const HALF: &str = "open share - 1/2, which is exact in a sphere: 2048 rays find the rim to about 2048^-0.7, the worst of 2425 receivers to twice that";
const LIMIT: f64 = 0.01;
const FAR: Vec3 = Vec3::new(1e7, -0.7e7, 0.4e7);

pub(crate) fn tiny_scene() -> Case {
    Case {
        title: "bowl of 1e-4 units",
        bound: HALF,
        limit: LIMIT,
        ours: || share_error(&bowl(1e-4, Vec3::ZERO)),
        naive_method: "determinants below 1e-5 do not count",
        naive: || published_error(&bowl(1e-4, Vec3::ZERO), Start::OtherIndices),
    }
}

pub(crate) fn huge_scene() -> Case {
    Case {
        title: "bowl of 1e6 units",
        bound: HALF,
        limit: LIMIT,
        ours: || share_error(&bowl(1e6, Vec3::ZERO)),
        naive_method: "rays start 0.001 units off the surface",
        naive: || published_error(&bowl(1e6, Vec3::ZERO), Start::Off(1e-3)),
    }
}

pub(crate) fn far_scene() -> Case {
    Case {
        title: "bowl of 1e6 units, 1e7 from the origin",
        bound: HALF,
        limit: LIMIT,
        ours: || share_error(&bowl(1e6, FAR)),
        naive_method: "rays start 0.001 units off the surface",
        naive: || published_error(&bowl(1e6, FAR), Start::Off(1e-3)),
    }
}

fn bowl(scale: f32, place: Vec3) -> Scene {
    placed(grey("bowl", 0.5), askew(), scale, place)
}

fn share_error(scene: &Scene) -> f64 {
    let prt = quiet(scene, &fixed(1, 2048, 0));
    worst(shares(&prt).into_iter().map(|share| (share - 0.5).abs()))
}

/// The published test on every fiftieth vertex.
fn published_error(scene: &Scene, start: Start) -> f64 {
    let mesh = &scene.meshes[0];
    let vertices = (0..mesh.positions.len()).step_by(50);
    // a random estimate of 1/2: what its own noise explains does not count
    let noise = 3.0 * (0.25f64 / 512.0).sqrt();
    worst(vertices.map(|v| (open_share(mesh, v, start, 512) - 0.5).abs() - noise))
}
