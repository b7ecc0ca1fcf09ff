//! The scene as rays see it: what they hit, and the surface that is there.

use crate::gloss::{Gloss, shining};
use crate::mirror::{Mirror, Polish};
use glam::Vec3;
use raytrace::{Hit, Ray, Tracer, offset_origin_on};
use sampling::rng::Rng;
use scene::{Material, Scene};

/// A scene prepared for tracing.
#[derive(Debug)]
pub struct World<'a> {
    /// Surfaces that stop light.
    solid: Layer<'a>,
    /// Surfaces that stop a part of the light: they blend or transmit. None where the scene has none.
    veils: Option<Layer<'a>>,
}

/// The triangles of some of the meshes, in one tracer.
struct Layer<'a> {
    scene: &'a Scene,
    tracer: Tracer,
    /// Mesh and triangle in it of each traced triangle.
    parts: Vec<[u32; 2]>,
    /// Unit normal of each traced triangle, on the side of its counter-clockwise winding.
    normals: Vec<Vec3>,
    /// Whether normal maps bend shading normals.
    bent: bool,
    /// How the materials mirror for which it says so; none where all is matte.
    gloss: Option<(Gloss, Vec<bool>)>,
}

/// One side of a surface at a point, as far as light needs to know it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface {
    /// Just off the surface on this side: where rays start.
    pub(crate) origin: Vec3,
    /// Unit shading normal on this side, from which the cosine counts.
    pub(crate) normal: Vec3,
    /// The same before a normal map bent it: light comes from above its plane only.
    pub(crate) facing: Vec3,
    /// Diffuse, RGB in [0, 1].
    pub(crate) albedo: Vec3,
    /// What it mirrors towards where it is seen from; none where it is matte.
    pub(crate) mirror: Option<Mirror>,
}

impl Surface {
    /// Whether light from a direction would have to come through the surface itself: a bent normal turns towards some.
    pub(crate) fn is_below(&self, direction: Vec3) -> bool {
        self.facing != self.normal && self.facing.dot(direction) <= 0.0
    }
}

/// What a camera ray shows: a lit surface and its own emission.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    /// The side of the surface that faces the camera.
    pub(crate) surface: Surface,
    /// Radiance that it emits.
    pub(crate) emission: Vec3,
    /// Base colour of an unlit material, which the camera sees as it is; none where light matters.
    pub(crate) unlit: Option<Vec3>,
}

impl<'a> World<'a> {
    /// Builds the trees; the scene stays where it is.
    #[must_use]
    pub fn new(scene: &'a Scene) -> Self {
        Self::with_normal_maps(scene, false)
    }

    /// [`World::new`] with diffuse shading by the normals of normal maps, or without.
    #[must_use]
    pub fn with_normal_maps(scene: &'a Scene, bent: bool) -> Self {
        let solid = Layer::new(scene, bent, Material::blocks_rays);
        let veils = Layer::new(scene, bent, |material| !material.blocks_rays());
        Self { solid, veils: (!veils.parts.is_empty()).then_some(veils) }
    }

    /// The same world with materials that mirror; without, all is diffuse.
    #[must_use]
    pub fn with_gloss(mut self, gloss: Gloss) -> Self {
        for layer in std::iter::once(&mut self.solid).chain(&mut self.veils) {
            layer.gloss = Some((gloss, shining(layer.scene)));
        }
        self
    }

    /// Share of the light from infinity that arrives at a point, RGB: the product of what every veil on the way passes.
    pub(crate) fn transmittance(&self, origin: Vec3, direction: Vec3) -> Vec3 {
        let mut ray = Ray::new(origin, direction);
        if self.solid.tracer.occluded(&ray, &|t, u, v| self.solid.is_there(t, u, v)) {
            return Vec3::ZERO;
        }
        let mut share = Vec3::ONE;
        if let Some(veils) = &self.veils {
            while let Some(hit) = veils.closest(&ray).filter(|_| share.max_element() > 0.0) {
                share *= veils.passes(&hit);
                ray.t_min = hit.t.next_up();
            }
        }
        share
    }

    /// The surface that a ray of light meets, on the side where it arrives, and the share of its light that the veils before it pass.
    ///
    /// A veil is met with the probability of its opacity, so the mean over rays is that of [`World::transmittance`].
    pub(crate) fn closest(&self, origin: Vec3, direction: Vec3, rng: &mut Rng) -> (Option<Surface>, Vec3) {
        let mut ray = Ray::new(origin, direction);
        let behind = self.solid.closest(&ray);
        let mut share = Vec3::ONE;
        if let Some(veils) = &self.veils {
            ray.t_max = behind.map_or(f32::INFINITY, |hit| hit.t);
            while let Some(hit) = veils.closest(&ray) {
                let opacity = veils.opacity(&hit);
                if rng.next_f32() < opacity {
                    return (Some(veils.surface(&hit, direction)), share);
                }
                // It went on with the probability of the rest.
                share *= veils.passes(&hit) / (1.0 - opacity);
                ray.t_min = hit.t.next_up();
            }
        }
        (behind.map(|hit| self.solid.surface(&hit, direction)), share)
    }

    /// The surface that a camera ray shows. Backs of single-sided surfaces are not drawn; a veil is seen with the
    /// probability of its opacity.
    pub(crate) fn seen(&self, origin: Vec3, direction: Vec3, rng: &mut Rng) -> Option<Seen> {
        let mut ray = Ray::new(origin, direction);
        let behind = self.solid.drawn(ray);
        if let Some(veils) = &self.veils {
            ray.t_max = behind.map_or(f32::INFINITY, |hit| hit.t);
            while let Some(hit) = veils.drawn(ray) {
                if rng.next_f32() < veils.opacity(&hit) {
                    return Some(veils.seen(&hit, direction));
                }
                ray.t_min = hit.t.next_up();
            }
        }
        behind.map(|hit| self.solid.seen(&hit, direction))
    }
}

impl<'a> Layer<'a> {
    fn new(scene: &'a Scene, bent: bool, belongs: impl Fn(&Material) -> bool) -> Self {
        let (mut positions, mut triangles, mut masked) = (Vec::new(), Vec::new(), Vec::new());
        let (mut parts, mut normals) = (Vec::new(), Vec::new());
        for (m, mesh) in scene.meshes.iter().enumerate().filter(|(m, _)| belongs(scene.material(*m))) {
            let first = positions.len() as u32;
            positions.extend_from_slice(&mesh.positions);
            for (t, corners) in mesh.triangles.iter().enumerate() {
                triangles.push(corners.map(|corner| first + corner));
                parts.push([m as u32, t as u32]);
                normals.push(mesh.face_normal(t));
                masked.push(scene.material(m).is_masked());
            }
        }
        Self { scene, tracer: Tracer::build(&positions, &triangles, &masked), parts, normals, bent, gloss: None }
    }

    fn part(&self, triangle: u32) -> (usize, usize) {
        let [mesh, triangle] = self.parts[triangle as usize];
        (mesh as usize, triangle as usize)
    }

    /// The filter of masked triangles.
    fn is_there(&self, triangle: u32, u: f32, v: f32) -> bool {
        let (mesh, triangle) = self.part(triangle);
        self.scene.coverage(mesh, triangle, u, v) > 0.0
    }

    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.tracer.closest(ray, &|t, u, v| self.is_there(t, u, v))
    }

    /// The first hit that is drawn: a front, or a back of a double-sided surface.
    fn drawn(&self, ray: Ray) -> Option<Hit> {
        let mut hit = self.closest(&ray)?;
        while !hit.front && !self.scene.material(self.part(hit.triangle).0).double_sided {
            // A front may lie in the same place: signs have a face to each side.
            hit = self.tracer.closest_after(&ray, &hit, &|t, u, v| self.is_there(t, u, v))?;
        }
        Some(hit)
    }

    /// Share of light from behind that a veil hides.
    fn opacity(&self, hit: &Hit) -> f32 {
        let (mesh, triangle) = self.part(hit.triangle);
        self.scene.coverage(mesh, triangle, hit.u, hit.v) * (1.0 - self.scene.material(mesh).transmission)
    }

    /// Share of light from behind that a veil passes, RGB: all of it beside the surface, and through the surface what it transmits, in
    /// its base colour.
    fn passes(&self, hit: &Hit) -> Vec3 {
        let (mesh, triangle) = self.part(hit.triangle);
        let covered = self.scene.coverage(mesh, triangle, hit.u, hit.v);
        let transmission = self.scene.material(mesh).transmission;
        if transmission <= 0.0 {
            return Vec3::splat(1.0 - covered);
        }
        let tint = self.scene.base_color(mesh, triangle, hit.u, hit.v).truncate().clamp(Vec3::ZERO, Vec3::ONE);
        Vec3::splat(1.0 - covered) + covered * transmission * tint
    }

    fn seen(&self, hit: &Hit, direction: Vec3) -> Seen {
        let (mesh, triangle) = self.part(hit.triangle);
        let unlit = self.scene.material(mesh).unlit;
        Seen {
            surface: self.surface(hit, direction),
            emission: self.scene.emission(mesh, triangle, hit.u, hit.v),
            unlit: unlit.then(|| self.scene.base_color(mesh, triangle, hit.u, hit.v).truncate()),
        }
    }

    /// The side of the surface that a ray along `direction` hit. The shading normal goes with the side of the winding.
    fn surface(&self, hit: &Hit, direction: Vec3) -> Surface {
        let (m, triangle) = self.part(hit.triangle);
        let mesh = &self.scene.meshes[m];
        let side = self.normals[hit.triangle as usize] * if hit.front { 1.0 } else { -1.0 };
        let corners = mesh.triangles[triangle].map(|corner| mesh.positions[corner as usize]);
        let facing = mesh.normal(triangle, hit.u, hit.v);
        let normal = if self.bent { self.scene.bent_normal(m, triangle, hit.u, hit.v) } else { facing };
        let turn = if facing.dot(side) < 0.0 { -1.0 } else { 1.0 };
        Surface {
            origin: offset_origin_on(corners, mesh.position(triangle, hit.u, hit.v), side),
            normal: normal * turn,
            facing: facing * turn,
            albedo: self.scene.albedo(m, triangle, hit.u, hit.v),
            mirror: self.mirror(hit, facing * turn, turn, direction),
        }
    }

    /// What the side of the surface that faces along `facing` mirrors back along a ray.
    fn mirror(&self, hit: &Hit, facing: Vec3, turn: f32, direction: Vec3) -> Option<Mirror> {
        let (m, triangle) = self.part(hit.triangle);
        let (gloss, shines) = self.gloss.as_ref()?;
        if !shines[self.scene.meshes[m].material as usize] {
            return None;
        }
        let [metallic, roughness] = self.scene.shine(m, triangle, hit.u, hit.v);
        let polish = Polish {
            mirroring: gloss.mirroring,
            normal: if gloss.bent { self.scene.bent_normal(m, triangle, hit.u, hit.v) * turn } else { facing },
            facing,
            base: self.scene.base_color(m, triangle, hit.u, hit.v).truncate().clamp(Vec3::ZERO, Vec3::ONE),
            metallic,
            roughness: gloss.roughness.unwrap_or(roughness).clamp(0.0, 1.0),
        };
        Some(Mirror::new(&polish, -direction))
    }
}

impl std::fmt::Debug for Layer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Layer").field("scene", &self.scene.name).field("triangles", &self.parts.len()).finish()
    }
}
