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
/// The same of backs that are not drawn, where next to no sky is seen. Among leaves half of what one sees are backs.
const SHELL: f32 = 0.8;
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

/// Walks that decide whether a place has a way out, and steps of each.
const WALKS: u32 = 512;
const STEPS: u32 = 12;

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

    /// Whether somebody who stands outside of things can see a place.
    pub(crate) fn shows(&self, receiver: &Receiver, rng: &mut Rng) -> bool {
        !self.is_under_shell(receiver, rng) && !self.bury(receiver, rng) && !self.is_sealed(receiver, rng)
    }

    /// Whether a place sees next to no sky and mostly backs that are not drawn, those of masked shells too: the dark there is not seen.
    fn is_under_shell(&self, receiver: &Receiver, rng: &mut Rng) -> bool {
        let origin = offset_origin(receiver.position, receiver.geometric_normal);
        let seen = self.look(origin, receiver.normal, PROBES[0], rng, &|hit| self.is_undrawn(hit));
        1.0 - seen.blocked <= SEALED[0] && seen.backs > SHELL * seen.blocked
    }

    /// Whether no walk from front to front finds the sky and most end on backs: a pocket between things that run into each other. What
    /// is inside things sees fronts of others there. A closed room has no backs, and shows.
    fn is_sealed(&self, receiver: &Receiver, rng: &mut Rng) -> bool {
        let mut ended = 0;
        for _ in 0..WALKS {
            let mut origin = offset_origin(receiver.position, receiver.geometric_normal);
            let mut frame = Frame::from_normal(receiver.normal);
            for _ in 0..STEPS {
                let direction = frame.to_world(square_to_cosine_concentric(rng.next_square()));
                let Some(hit) = self.closest(&Ray::new(origin, direction)) else { return false };
                if self.is_undrawn(&hit) {
                    ended += 1;
                    break;
                }
                let (at, across) = self.place(&hit);
                let normal = if hit.front { across } else { -across };
                origin = offset_origin(at, normal);
                frame = Frame::from_normal(normal);
            }
        }
        2 * ended > WALKS
    }

    /// Whether a receiver sees mostly the insides of solid things, or nothing but surfaces and mostly their backs.
    fn bury(&self, receiver: &Receiver, rng: &mut Rng) -> bool {
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
        let (mut blocked, mut backs) = (0, 0);
        for _ in 0..rays {
            let direction = frame.to_world(square_to_cosine_concentric(rng.next_square()));
            if let Some(hit) = self.closest(&Ray::new(origin, direction)) {
                blocked += 1;
                backs += u32::from(counts(&hit));
            }
        }
        let share = |count: u32| count as f32 / rays as f32;
        Seen { blocked: share(blocked), backs: share(backs) }
    }

    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let solid = |t: u32, u: f32, v: f32| {
            let [mesh, triangle] = self.parts[t as usize];
            self.scene.coverage(mesh, triangle, u, v) > 0.0
        };
        self.tracer.closest(ray, &solid)
    }

    /// Where a hit is, and the unit normal of the front there.
    fn place(&self, hit: &Hit) -> (Vec3, Vec3) {
        let [mesh, triangle] = self.parts[hit.triangle as usize];
        let mesh = &self.scene.meshes[mesh];
        let [a, b, c] = mesh.triangles[triangle].map(|v| mesh.positions[v as usize]);
        (a + hit.u * (b - a) + hit.v * (c - a), (b - a).cross(c - a).normalize_or_zero())
    }

    /// Whether a hit is on a back that is not drawn.
    fn is_undrawn(&self, hit: &Hit) -> bool {
        !hit.front && !self.scene.material(self.parts[hit.triangle as usize][0]).double_sided
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
        let (at, across) = self.place(hit);
        let behind = -across;
        let mut rng = Rng::new(u64::from(hit.triangle), 7);
        let origin = offset_origin(at, behind);
        let seen = self.look(origin, behind, PROBES[1], &mut rng, &|hit| self.is_back(hit));
        let is = 1.0 - seen.blocked <= SEALED[0] && seen.backs >= SEALED[1];
        self.known.borrow_mut().insert(hit.triangle, is);
        is
    }
}
