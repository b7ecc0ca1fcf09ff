//! What is solid, told by rays alone: which places lie inside things, where nothing shows.

use bake::Receiver;
use glam::Vec3;
use raytrace::{Hit, Ray, Tracer, offset_origin};
use sampling::frame::Frame;
use sampling::rng::Rng;
use sampling::warp::square_to_cosine_concentric;
use scene::{AlphaMode, Scene};
use std::cell::RefCell;
use std::collections::HashMap;

/// Rays that decide whether a place is buried, and whether what lies behind a surface is solid.
const PROBES: [u32; 2] = [256, 64];
/// Share of the blocked rays that meet the insides of solid things from which a place counts as buried. The bake mends its
/// receivers from a share of one half on; between the two its estimate and this one may differ.
const BURIED: f32 = 0.4;
/// Most open rays and fewest that meet backs, of those that start behind a surface around something solid.
const SEALED: [f32; 2] = [0.02, 0.6];

/// The surfaces that stop light.
pub(crate) struct Solids<'a> {
    scene: &'a Scene,
    tracer: Tracer,
    /// Mesh and triangle in it of each traced triangle.
    parts: Vec<[usize; 2]>,
    /// Of triangles that were asked about: whether something solid lies behind them.
    known: RefCell<HashMap<u32, bool>>,
}

/// Shares of rays.
struct Seen {
    blocked: f32,
    backs: f32,
}

impl<'a> Solids<'a> {
    pub(crate) fn of(scene: &'a Scene) -> Self {
        let (mut positions, mut triangles, mut masked, mut parts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (m, mesh) in scene.meshes.iter().enumerate().filter(|(m, _)| scene.material(*m).blocks_rays()) {
            let first = positions.len() as u32;
            positions.extend_from_slice(&mesh.positions);
            triangles.extend(mesh.triangles.iter().map(|t| t.map(|corner| first + corner)));
            masked.extend(mesh.triangles.iter().map(|_| scene.material(m).is_masked()));
            parts.extend((0..mesh.triangles.len()).map(|t| [m, t]));
        }
        let tracer = Tracer::build(&positions, &triangles, &masked);
        Self { scene, tracer, parts, known: RefCell::default() }
    }

    /// Whether a receiver sees mostly the insides of solid things, or nothing but surfaces and mostly their backs.
    pub(crate) fn bury(&self, receiver: &Receiver, rng: &mut Rng) -> bool {
        let origin = offset_origin(receiver.position, receiver.geometric_normal);
        let is_mostly = |seen: &Seen| seen.blocked > BURIED && seen.backs > BURIED * seen.blocked;
        let any = self.look(origin, receiver.normal, PROBES[0], rng, &|hit| self.is_back(hit));
        if !is_mostly(&any) || any.blocked >= 1.0 {
            return is_mostly(&any);
        }
        is_mostly(&self.look(origin, receiver.normal, PROBES[0], rng, &|hit| self.is_back(hit) && self.is_solid(hit)))
    }

    fn look(&self, origin: Vec3, normal: Vec3, rays: u32, rng: &mut Rng, counts: &dyn Fn(&Hit) -> bool) -> Seen {
        let frame = Frame::from_normal(normal);
        let solid = |t: u32, u: f32, v: f32| {
            let [mesh, triangle] = self.parts[t as usize];
            self.scene.coverage(mesh, triangle, u, v) > 0.0
        };
        let (mut blocked, mut backs) = (0, 0);
        for _ in 0..rays {
            let direction = frame.to_world(square_to_cosine_concentric(rng.next_square()));
            if let Some(hit) = self.tracer.closest(&Ray::new(origin, direction), &solid) {
                blocked += 1;
                backs += u32::from(counts(&hit));
            }
        }
        let share = |count: u32| count as f32 / rays as f32;
        Seen { blocked: share(blocked), backs: share(backs) }
    }

    /// Whether a hit is on the back of an opaque one-sided surface.
    fn is_back(&self, hit: &Hit) -> bool {
        let material = self.scene.material(self.parts[hit.triangle as usize][0]);
        !hit.front && !material.double_sided && material.alpha == AlphaMode::Opaque
    }

    /// Whether no sky shows behind a surface, and backs all around: it bounds something solid. Leaves and sheets do not.
    fn is_solid(&self, hit: &Hit) -> bool {
        if let Some(&known) = self.known.borrow().get(&hit.triangle) {
            return known;
        }
        let [mesh, triangle] = self.parts[hit.triangle as usize];
        let mesh = &self.scene.meshes[mesh];
        let [a, b, c] = mesh.triangles[triangle].map(|v| mesh.positions[v as usize]);
        let behind = -(b - a).cross(c - a).normalize_or_zero();
        let mut rng = Rng::new(u64::from(hit.triangle), 7);
        let origin = offset_origin(a + hit.u * (b - a) + hit.v * (c - a), behind);
        let seen = self.look(origin, behind, PROBES[1], &mut rng, &|hit| self.is_back(hit));
        let is = 1.0 - seen.blocked <= SEALED[0] && seen.backs >= SEALED[1];
        self.known.borrow_mut().insert(hit.triangle, is);
        is
    }
}
