//! Whether a receiver sees anything at all on its side of its tangent plane.

use crate::tracer::Tracer;
use crate::tree::Child;
use glam::Vec3;

/// A corner counts as above the plane from this part of the largest coordinate in play: half of the step by which
/// rays leave a surface, so that whatever lies lower is below where the rays start.
const TOLERANCE: f64 = 1.0 / 4_194_304.0;

impl Tracer {
    /// Whether any triangle has a corner above the plane through `origin` with unit `normal`, by more than 2^-22 of
    /// the largest coordinate of the two; where none has, no ray from a point stepped off that plane is blocked.
    pub fn anything_above(&self, origin: Vec3, normal: Vec3) -> bool {
        self.find(origin, normal, 0.0, &|height, size, _| height > TOLERANCE * size)
    }

    /// The same for triangles whose front faces against `normal`, which count from `slack` metres below the plane on and where
    /// they touch it: ground that a body rests on, as a point just above the foot of that body sees it.
    pub fn anything_faced(&self, origin: Vec3, normal: Vec3, slack: f32) -> bool {
        let slack = f64::from(slack);
        let n = normal.as_dvec3();
        let faces = |[a, b, c]: [Vec3; 3]| (b - a).as_dvec3().cross((c - a).as_dvec3()).dot(n) < 0.0;
        self.find(origin, normal, slack, &|height, size, corners| {
            height > -(slack + TOLERANCE * size) && faces(corners)
        })
    }

    /// Whether some triangle has a corner that counts, by its height above the plane, the largest coordinate and the triangle;
    /// only what may reach to `slack` below the plane is asked for.
    fn find(&self, origin: Vec3, normal: Vec3, slack: f64, counts: &dyn Fn(f64, f64, [Vec3; 3]) -> bool) -> bool {
        let (from, n) = (origin.as_dvec3(), normal.as_dvec3());
        let any = |corners: [Vec3; 3]| {
            corners.iter().any(|p| {
                let size = f64::from(p.abs().max(origin.abs()).max_element());
                counts((p.as_dvec3() - from).dot(n), size, corners)
            })
        };
        let mut open = if self.tree.nodes.is_empty() { vec![] } else { vec![Child::node(0)] };
        while let Some(child) = open.pop() {
            if let Some(index) = child.as_block() {
                let block = &self.tree.blocks[index];
                let lanes = (0..4).filter(|lane| block.valid >> lane & 1 == 1);
                if lanes.map(|lane| block.corners(lane)).any(any) {
                    return true;
                }
                continue;
            }
            let node = &self.tree.nodes[child.index()];
            let slots = (0..8).filter(|&slot| node.children[slot] != Child::NONE);
            open.extend(
                slots.filter(|&slot| reaches(node.child_bounds(slot), from, n, slack)).map(|slot| node.children[slot]),
            );
        }
        false
    }
}

/// Whether the corner of a box that lies farthest along the normal is at most `slack` below the plane.
fn reaches((lower, upper): (Vec3, Vec3), from: glam::DVec3, normal: glam::DVec3, slack: f64) -> bool {
    let far = Vec3::select(normal.as_vec3().cmpgt(Vec3::ZERO), upper, lower);
    // The boxes of split triangles are rounded; the exact test of the corners decides.
    let size = f64::from(far.abs().max_element()).max(from.abs().max_element());
    (far.as_dvec3() - from).dot(normal) > -(slack + TOLERANCE * size)
}
