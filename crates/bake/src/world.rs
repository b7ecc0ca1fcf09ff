//! The scene as rays meet it: one list of triangles, and what a hit needs to know.

use crate::Error;
use crate::bodies::Bodies;
use crate::cells::Cells;
use crate::hit::NearPoint;
use crate::receivers::Receiver;
use crate::start;
use crate::transmittance::Translucent;
use glam::Vec3;
use raytrace::{Hit, Ray, Tracer};
use sampling::frame::Frame;
use scene::{AlphaMode, Material, Mesh, Scene};
use sh_math::brdf::{DIELECTRIC, MEAN_DIFFUSE_LOSS, mean_environment_brdf};

/// Bits 30 and 31 of a packed triangle say what was hit of it.
const MAX_TRIANGLES: usize = (1 << 30) - 1;
/// Vertices that fit beside the bits of senders.
const MAX_VERTICES: usize = (1 << 29) - 1;

/// Most surfaces behind each other that a way is followed through.
pub(crate) const MOST_CROSSINGS: usize = 256;
/// Triangles that are met for each of them at most: around the tip of a fan all are met in one place.
const MOST_MET: usize = 4;

/// Share of a corner that is none but for rounding.
const RIM: f32 = 1e-6;

/// Three directions at 45 degrees from the normal.
const TRIPOD: [[f32; 3]; 3] = [[0.707, 0.0, 0.707], [-0.354, 0.612, 0.707], [-0.354, -0.612, 0.707]];

/// All surfaces that block light, flattened.
pub(crate) struct World<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) tracer: Tracer,
    /// Largest coordinates of each mesh by amount.
    pub(crate) extents: Vec<Vec3>,
    /// The same of all that rays meet.
    pub(crate) extent: Vec3,
    /// Longest edge of all that rays meet, metres.
    pub(crate) longest: f32,
    /// Of each traced triangle: its corners as vertices of the whole scene.
    pub(crate) corners: Vec<[u32; 3]>,
    /// Of each traced triangle: its mesh and its index within the mesh.
    sources: Vec<[u32; 2]>,
    /// Surfaces that stop a part of the light; none where the scene has none. Their triangles come last.
    pub(crate) translucent: Option<Translucent>,
    /// Whether any traced triangle has a mask.
    has_masks: bool,
    /// Whether rays are traced even for receivers that nothing stands above.
    pub(crate) trace_all: bool,
    /// Albedo of each mesh, where it is the same all over it.
    even: Vec<Option<Vec3>>,
    /// Of each material; empty where all are matte.
    shine: Vec<Shine>,
    /// What the mirror of each material sends to all sides, where it is the same everywhere on it.
    mirrored: Vec<Option<f32>>,
    /// Which triangles bound bodies.
    pub(crate) bodies: Bodies,
    /// Cells of triangles that are too large to carry bounces.
    pub(crate) cells: Cells,
}

/// Albedo of a mesh, where neither textures nor vertices give it colours.
fn even_albedo(scene: &Scene, m: usize, mesh: &Mesh) -> Option<Vec3> {
    let material = scene.material(m);
    let is_even = material.base_color_texture.is_none()
        && (material.metallic <= 0.0 || material.metallic_roughness_texture.is_none())
        && mesh.colors.is_empty()
        && !mesh.triangles.is_empty();
    is_even.then(|| scene.albedo(m, 0, 0.0, 0.0))
}

/// What the mirror of a dielectric part sends to all sides of light from all sides.
fn mean_mirrored(metallic: f32, roughness: f32) -> f32 {
    let [scale, bias] = mean_environment_brdf(roughness);
    (1.0 - metallic) * (DIELECTRIC * scale + bias)
}

/// What becomes of light that a material mirrors, on its way to other surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shine {
    /// It mirrors none.
    Matte,
    /// It goes to all sides. A metal's is left out.
    Mean,
    /// Fronts mirror it.
    Direction,
}

impl<'a> World<'a> {
    /// Flattens the scene and builds the tree; `blocks` says at which materials rays stop, `tested` of which the alpha mask is
    /// tested.
    pub(crate) fn new(
        scene: &'a Scene,
        blocks: &dyn Fn(usize) -> bool,
        tested: &dyn Fn(usize) -> bool,
    ) -> Result<Self, Error> {
        let mut world = Self {
            scene,
            tracer: Tracer::build(&[], &[], &[]),
            extents: scene.meshes.iter().map(start::extent).collect(),
            extent: Vec3::ZERO,
            longest: 0.0,
            even: scene.meshes.iter().enumerate().map(|(m, mesh)| even_albedo(scene, m, mesh)).collect(),
            corners: Vec::new(),
            sources: Vec::new(),
            translucent: None,
            has_masks: false,
            trace_all: false,
            shine: Vec::new(),
            mirrored: Vec::new(),
            bodies: Bodies::default(),
            cells: Cells::default(),
        };
        let mut positions: Vec<Vec3> = Vec::new();
        let mut masked = Vec::new();
        for (m, mesh) in scene.meshes.iter().enumerate() {
            let first = positions.len() as u32;
            positions.extend_from_slice(&mesh.positions);
            check_count(scene, "vertices", positions.len(), MAX_VERTICES)?;
            if !blocks(mesh.material as usize) {
                continue;
            }
            world.extent = world.extent.max(world.extents[m]);
            let has_mask = tested(mesh.material as usize);
            world.has_masks |= has_mask;
            for (t, corners) in mesh.triangles.iter().enumerate() {
                world.corners.push(corners.map(|v| v + first));
                world.sources.push([m as u32, t as u32]);
                masked.push(has_mask);
            }
            check_count(scene, "triangles", world.corners.len(), MAX_TRIANGLES)?;
        }
        if !world.has_masks {
            masked.clear();
        }
        world.tracer = Tracer::build(&positions, &world.corners, &masked);
        world.bodies = Bodies::of(&world);
        world.longest = world.longest_from(0);
        Ok(world)
    }

    /// Adds the surfaces that stop a part of the light, as `is_translucent` says of materials; `tints` where some of them tint it.
    pub(crate) fn add_translucent(&mut self, is_translucent: &dyn Fn(usize) -> bool, tints: bool) -> Result<(), Error> {
        let opaque = self.corners.len();
        let (mut positions, mut corners) = (Vec::new(), Vec::new());
        let mut first = 0;
        for (m, mesh) in self.scene.meshes.iter().enumerate() {
            if is_translucent(mesh.material as usize) {
                self.extent = self.extent.max(self.extents[m]);
                let own = positions.len() as u32;
                positions.extend_from_slice(&mesh.positions);
                corners.extend(mesh.triangles.iter().map(|corners| corners.map(|v| v + own)));
                self.corners.extend(mesh.triangles.iter().map(|corners| corners.map(|v| v + first)));
                self.sources.extend((0..mesh.triangles.len() as u32).map(|t| [m as u32, t]));
                check_count(self.scene, "triangles", self.corners.len(), MAX_TRIANGLES)?;
            }
            first += mesh.positions.len() as u32;
        }
        if !corners.is_empty() {
            let tracer = Tracer::build(&positions, &corners, &vec![true; corners.len()]);
            self.translucent = Some(Translucent { tracer, first: opaque as u32, tints });
            self.longest = self.longest.max(self.longest_from(opaque));
        }
        Ok(())
    }

    /// Share of the light from behind that a translucent triangle hides at a point, and the share that it passes, RGB: all of it beside
    /// what is covered, and through what is covered the part that it transmits, in its base colour.
    pub(crate) fn translucency(&self, triangle: u32, u: f32, v: f32) -> (f32, Vec3) {
        let (mesh, local) = self.locate(triangle);
        let covered = self.scene.coverage(mesh, local, u, v);
        let transmission = self.scene.material(mesh).transmission.clamp(0.0, 1.0);
        let beside = Vec3::splat(1.0 - covered);
        if transmission <= 0.0 {
            return (covered, beside);
        }
        let tint = self.scene.base_color(mesh, local, u, v).truncate().clamp(Vec3::ZERO, Vec3::ONE);
        (covered * (1.0 - transmission), beside + covered * transmission * tint)
    }

    /// Whether some surfaces tint the light that they pass.
    pub(crate) fn tints(&self) -> bool {
        self.translucent.as_ref().is_some_and(|layer| layer.tints)
    }

    /// Whether rays are needed: where something can stand between a receiver and the sky, and what arrives shows.
    pub(crate) fn can_shadow(&self, receiver: &Receiver) -> bool {
        !receiver.dark && (self.trace_all && receiver.sound || self.anything_above(receiver))
    }

    /// Whether anything stands above the tangent plane of a receiver, exactly, through the tree.
    pub(crate) fn anything_above(&self, receiver: &Receiver) -> bool {
        let Receiver { vertex, normal, .. } = *receiver;
        let veiled = || self.translucent.as_ref().is_some_and(|layer| layer.tracer.anything_above(vertex, normal));
        receiver.sound && (self.tracer.anything_above(vertex, normal) || self.touches(receiver) || veiled())
    }

    /// Whether a surface that faces the receiver lies between its tangent plane and itself. On a curved surface a receiver is drawn
    /// in behind that plane, and where a body rests on the ground that is enough for the ground to hide all from its foot.
    fn touches(&self, receiver: &Receiver) -> bool {
        let way = receiver.vertex - receiver.position;
        let depth = way.dot(receiver.normal);
        // On a flat surface the way lies in the plane but for rounding, and a two-sided one would face its own back.
        depth > 1e-5 * way.length() && self.tracer.anything_faced(receiver.vertex, receiver.normal, depth)
    }

    /// Whether the surface is there at a point of a masked triangle.
    pub(crate) fn solid(&self, triangle: u32, u: f32, v: f32) -> bool {
        let (mesh, local) = self.locate(triangle);
        match self.scene.material(mesh).alpha {
            AlphaMode::Mask(cutoff) => self.scene.coverage(mesh, local, u, v) >= cutoff,
            AlphaMode::Opaque | AlphaMode::Blend => true,
        }
    }

    /// The nearest surface along a ray.
    pub(crate) fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.tracer.closest(ray, &|triangle, u, v| self.solid(triangle, u, v))
    }

    /// All surfaces along a ray, from the nearest on, [`MOST_CROSSINGS`] at most. Several in one place count each; one that is met where its
    /// triangles meet counts once.
    pub(crate) fn along(&self, ray: Ray) -> impl Iterator<Item = Hit> {
        // What was met in the place of the last.
        let mut here: Vec<Hit> = Vec::new();
        let solid = |triangle, u, v| self.solid(triangle, u, v);
        let mut rounds = 0;
        let next = move || {
            while rounds < MOST_MET * MOST_CROSSINGS {
                rounds += 1;
                let hit = match here.last() {
                    Some(last) => self.tracer.closest_after(&ray, last, &solid)?,
                    None => self.closest(&ray)?,
                };
                let is_near = |other: &Hit| hit.t - other.t <= f32::EPSILON * hit.t;
                here.retain(is_near);
                let is_known = here.iter().any(|other| self.is_one_crossing(other, &hit));
                here.push(hit);
                if !is_known {
                    return Some(hit);
                }
            }
            None
        };
        std::iter::from_fn(next).take(MOST_CROSSINGS)
    }

    /// Whether two hits of a ray in one place are one of a surface: where two of its triangles meet that face alike.
    fn is_one_crossing(&self, one: &Hit, other: &Hit) -> bool {
        let is_at_rim = |hit: &Hit| hit.u.min(hit.v).min(1.0 - hit.u - hit.v) <= RIM;
        if one.front != other.front || !is_at_rim(one) || !is_at_rim(other) {
            return false;
        }
        let [a, b] = [one, other].map(|hit| self.points(hit.triangle));
        let shared = a.iter().filter(|corner| b.contains(corner)).count();
        (1..3).contains(&shared)
    }

    /// Whether a triangle is opaque and has one side, so that its back may be the inside of a body.
    pub(crate) fn is_one_sided(&self, triangle: u32) -> bool {
        let material = self.material(triangle);
        material.alpha == AlphaMode::Opaque && material.transmission <= 0.0 && !material.double_sided
    }

    /// Where rays from a receiver start.
    pub(crate) fn start_above(&self, receiver: &Receiver) -> Vec3 {
        self.start(receiver.position, receiver.geometric_normal, receiver.rounding)
    }

    /// Whether most of three rays from a receiver meet a body from within.
    pub(crate) fn surrounds(&self, receiver: &Receiver) -> bool {
        let origin = self.start_above(receiver);
        let frame = Frame::from_normal(receiver.normal);
        let meets_inside = |way: [f32; 3]| {
            let ray = Ray::new(origin, frame.to_world(Vec3::from_array(way)));
            self.closest(&ray).is_some_and(|hit| self.bodies.is_inside(&hit))
        };
        let [a, b, c] = TRIPOD;
        match [meets_inside(a), meets_inside(b)] {
            [true, true] => true,
            [false, false] => false,
            _ => meets_inside(c),
        }
    }

    /// Takes over what becomes of light that each material mirrors.
    pub(crate) fn set_shine(&mut self, shine: Vec<Shine>) {
        self.shine = shine;
        let even = |material: &scene::Material| {
            let [metallic, roughness] = [material.metallic, material.roughness].map(|share| share.clamp(0.0, 1.0));
            material.metallic_roughness_texture.is_none().then(|| mean_mirrored(metallic, roughness))
        };
        self.mirrored = self.scene.materials.iter().map(even).collect();
    }

    /// Whether the back of a traced triangle is drawn too.
    pub(crate) fn is_two_sided(&self, triangle: u32) -> bool {
        self.material(triangle).double_sided
    }

    /// Whether a mask cuts holes into a traced triangle's surface.
    pub(crate) fn has_holes(&self, triangle: u32) -> bool {
        matches!(self.material(triangle).alpha, AlphaMode::Mask(_))
    }

    fn material(&self, triangle: u32) -> &Material {
        self.scene.material(self.locate(triangle).0)
    }

    /// Share of the light at a hit that the surface sends on to all sides, linear: its albedo; where it shines less what its mirror takes, and
    /// more by what the mirror of a dielectric returns on its mean where that is not sent by direction; never more than all.
    pub(crate) fn sent(&self, hit: &Hit) -> Vec3 {
        let (mesh, local) = self.locate(hit.triangle);
        let albedo = self.even[mesh].unwrap_or_else(|| self.scene.albedo(mesh, local, hit.u, hit.v));
        let shine = self.shine.get(self.scene.meshes[mesh].material as usize).copied().unwrap_or(Shine::Matte);
        let by_direction = match shine {
            Shine::Matte => return albedo,
            Shine::Mean => false,
            Shine::Direction => hit.front,
        };
        let body = albedo * (1.0 - MEAN_DIFFUSE_LOSS);
        if by_direction {
            return body;
        }
        let material = self.scene.meshes[mesh].material as usize;
        let mirrored = self.mirrored[material].unwrap_or_else(|| {
            let [metallic, roughness] = self.scene.shine(mesh, local, hit.u, hit.v);
            mean_mirrored(metallic, roughness)
        });
        // glTF's mix returns up to 2 % more than it takes; over many bounces that would grow without end.
        (body + mirrored).min(Vec3::ONE)
    }

    /// Longest edge of the traced triangles from a number on.
    fn longest_from(&self, first: usize) -> f32 {
        (first..self.corners.len()).map(|t| self.extent(t as u32)).fold(0.0, f32::max)
    }

    /// Longest edge of a traced triangle, metres.
    pub(crate) fn extent(&self, triangle: u32) -> f32 {
        let [a, b, c] = self.points(triangle);
        a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt()
    }

    /// A receiver at a point of a traced triangle, on one side.
    pub(crate) fn receiver_at(&self, point: &NearPoint) -> Receiver {
        let (mesh, local) = self.locate(point.triangle);
        let receiver = receiver_on(&self.scene.meshes[mesh], local, point.barycentrics).of_extent(self.extents[mesh]);
        if point.front { receiver } else { receiver.back() }
    }

    /// Corners of a traced triangle, world space.
    pub(crate) fn points(&self, triangle: u32) -> [Vec3; 3] {
        let (mesh, local) = self.locate(triangle);
        let mesh = &self.scene.meshes[mesh];
        mesh.triangles[local].map(|v| mesh.positions[v as usize])
    }

    /// Mesh of a traced triangle, and its index within the mesh.
    pub(crate) fn locate(&self, triangle: u32) -> (usize, usize) {
        let [mesh, local] = self.sources[triangle as usize];
        (mesh as usize, local as usize)
    }
}

/// A receiver on the front of a triangle of a mesh.
pub(crate) fn receiver_on(mesh: &Mesh, triangle: usize, [u, v]: [f32; 2]) -> Receiver {
    let [a, b, c] = mesh.triangles[triangle].map(|v| mesh.positions[v as usize]);
    let mix = |a: Vec3, b: Vec3, c: Vec3| a + u * (b - a) + v * (c - a);
    let shading = match mesh.triangles[triangle].map(|v| mesh.normals.get(v as usize).copied()) {
        [Some(a), Some(b), Some(c)] => Some(mix(a, b, c)),
        _ => None,
    };
    let at = mix(a, b, c);
    Receiver::new(at, shading, (b - a).cross(c - a), at).0
}

fn check_count(scene: &Scene, what: &'static str, count: usize, limit: usize) -> Result<(), Error> {
    if count > limit {
        return Err(Error::TooLarge { scene: scene.name.clone(), what, count, limit });
    }
    Ok(())
}
