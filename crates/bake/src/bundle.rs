//! Puts a scene, its plan and its transfer together as a file that needs nothing else.

use crate::extras::Extras;
use crate::field::Field;
use crate::material::Facts;
use crate::plan::simulates;
use crate::receivers::{NONE, Receivers};
use coeff_io::{Achieved, Codebooks, Effect, Geometry, Plan, Prt, Settings, Transfer};
use scene::{AlphaMode, Mesh, Scene, TextureSlot, Wrap};
use std::collections::BTreeMap;

/// What a bake found, receiver by receiver.
pub(crate) struct Baked<'a> {
    pub(crate) transfer: &'a Field,
    /// Open share of each permanent receiver; empty where nothing is blocked.
    pub(crate) openness: Vec<f32>,
    pub(crate) plan: Plan,
    pub(crate) achieved: Achieved,
    pub(crate) extras: &'a Extras,
}

/// Builds the file. Receivers keep their order: fronts, then the backs of two-sided materials.
pub(crate) fn bundle(scene: &Scene, receivers: &Receivers, settings: &Settings, baked: Baked<'_>) -> Prt {
    let mut parts = Parts::new(scene, &baked.plan, baked.extras);
    for (index, mesh) in scene.meshes.iter().enumerate() {
        parts.add_front(index, mesh);
    }
    let mut first = 0;
    for (index, mesh) in scene.meshes.iter().enumerate() {
        if receivers.back_of.get(first as usize).is_some_and(|&b| b != NONE && (b as usize) < receivers.permanent)
            && scene.materials[mesh.material as usize].double_sided
        {
            parts.add_back(index, mesh);
        }
        first += mesh.positions.len() as u32;
    }
    // The transfer is about the receivers' normals, which are those of the mesh but for bad ones.
    for (normal, receiver) in parts.geometry.normals.iter_mut().zip(&receivers.list) {
        *normal = receiver.normal.to_array();
    }
    let albedo = parts.albedo;
    let cameras = if scene.cameras.is_empty() { vec![scene::default_camera(scene)] } else { scene.cameras.clone() };
    Prt {
        generator: concat!("relume ", env!("CARGO_PKG_VERSION")).to_owned(),
        convention: sh_math::CONVENTION.to_owned(),
        scene: scene.name.clone(),
        origin: scene.origin,
        settings: settings.clone(),
        transfer: flattened(baked.transfer, receivers.permanent, baked.plan.bands, baked.openness, albedo),
        plan: baked.plan,
        achieved: baked.achieved,
        meshes: parts.meshes,
        materials: parts.materials,
        cameras: cameras.iter().map(camera).collect(),
        geometry: parts.geometry,
        textures: parts.textures,
        maps: None,
        volume: None,
        gloss: None,
        transfer_textures: None,
        codebooks: Codebooks::default(),
        compressed: None,
    }
}

/// The lists of the file while they grow.
struct Parts<'a> {
    scene: &'a Scene,
    keep_tangents: bool,
    has_uv0: bool,
    has_uv1: bool,
    has_colors: bool,
    meshes: Vec<coeff_io::Mesh>,
    materials: Vec<coeff_io::Material>,
    textures: Vec<coeff_io::Texture>,
    geometry: Geometry,
    albedo: Vec<[f32; 3]>,
}

impl<'a> Parts<'a> {
    fn new(scene: &'a Scene, plan: &Plan, extras: &Extras) -> Self {
        let mut kept = KeptTextures { scene, index: BTreeMap::new(), textures: Vec::new() };
        let materials: Vec<coeff_io::Material> = (0..scene.materials.len()).map(|m| kept.material(m, plan)).collect();
        let slots = || {
            materials.iter().flat_map(|m| {
                [m.base_color_texture, m.metallic_roughness_texture, m.normal_texture, m.emissive_texture]
                    .into_iter()
                    .flatten()
            })
        };
        let any = |test: &dyn Fn(&Mesh) -> bool| scene.meshes.iter().any(test);
        Self {
            scene,
            keep_tangents: materials.iter().any(|m| m.normal_texture.is_some()) && any(&|m| !m.tangents.is_empty()),
            has_uv0: slots().any(|s| s.uv_set == 0) && any(&|m| !m.uv0.is_empty()),
            has_uv1: (extras.maps.is_some() || extras.textures.is_some() || slots().any(|s| s.uv_set == 1))
                && any(&|m| !m.uv1.is_empty()),
            has_colors: any(&|m| !m.colors.is_empty()),
            meshes: Vec::new(),
            textures: kept.textures,
            materials,
            geometry: Geometry::default(),
            albedo: Vec::new(),
        }
    }

    fn add_front(&mut self, index: usize, mesh: &Mesh) {
        self.add_mesh(mesh, mesh.name.clone(), 1.0);
        let mut albedo = vec![[0.0; 3]; mesh.positions.len()];
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            for (&vertex, (u, v)) in triangle.iter().zip([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]) {
                albedo[vertex as usize] = self.scene.albedo(index, t, u, v).to_array();
            }
        }
        self.albedo.extend(albedo);
    }

    /// The back of a two-sided mesh: the same points seen from the other side.
    fn add_back(&mut self, index: usize, mesh: &Mesh) {
        self.add_mesh(mesh, format!("{} (back)", mesh.name), -1.0);
        let start = self.meshes[index].first_vertex as usize;
        let copied = self.albedo[start..start + mesh.positions.len()].to_vec();
        self.albedo.extend(copied);
    }

    fn add_mesh(&mut self, mesh: &Mesh, name: String, side: f32) {
        let n = mesh.positions.len();
        let g = &mut self.geometry;
        let first_vertex = g.positions.len() as u32;
        let first_triangle = g.triangles.len() as u32;
        g.positions.extend(mesh.positions.iter().map(|p| p.to_array()));
        g.normals.extend(mesh.normals.iter().map(|p| (side * *p).to_array()));
        if self.keep_tangents {
            extend_or(
                &mut g.tangents,
                mesh.tangents.iter().map(|t| (t.truncate()).extend(side * t.w).to_array()),
                n,
                [1.0, 0.0, 0.0, 1.0],
            );
        }
        if self.has_uv0 {
            extend_or(&mut g.uv0, mesh.uv0.iter().map(|t| t.to_array()), n, [0.0; 2]);
        }
        if self.has_uv1 {
            extend_or(&mut g.uv1, mesh.uv1.iter().map(|t| t.to_array()), n, [0.0; 2]);
        }
        if self.has_colors {
            extend_or(&mut g.colors, mesh.colors.iter().map(|c| c.to_array()), n, [1.0; 4]);
        }
        g.triangles.extend(mesh.triangles.iter().map(|&[a, b, c]| {
            let [b, c] = if side < 0.0 { [c, b] } else { [b, c] };
            [a, b, c].map(|v| v + first_vertex)
        }));
        self.meshes.push(coeff_io::Mesh {
            name,
            material: mesh.material,
            first_vertex,
            vertices: n as u32,
            first_triangle,
            triangles: mesh.triangles.len() as u32,
        });
    }
}

/// Appends an attribute, or a filler where the mesh lacks it.
fn extend_or<T: Copy>(list: &mut Vec<T>, values: impl ExactSizeIterator<Item = T>, n: usize, filler: T) {
    if values.len() == n {
        list.extend(values);
    } else {
        list.extend(std::iter::repeat_n(filler, n));
    }
}

/// Textures that some drawn effect needs, in order of first use.
struct KeptTextures<'a> {
    scene: &'a Scene,
    index: BTreeMap<u32, u32>,
    textures: Vec<coeff_io::Texture>,
}

impl KeptTextures<'_> {
    fn material(&mut self, index: usize, plan: &Plan) -> coeff_io::Material {
        let (m, facts) = (&self.scene.materials[index], Facts::of(self.scene, index));
        let specular = simulates(plan, Effect::Specular) && facts.shines && !m.unlit;
        let emission = simulates(plan, Effect::Emission) && facts.emission > 0.0;
        let transmission = simulates(plan, Effect::Transmission);
        let normal_maps = facts.bumpy && simulates(plan, Effect::NormalMaps);
        coeff_io::Material {
            name: m.name.clone(),
            base_color: m.base_color.to_array(),
            base_color_texture: self.slot(m.base_color_texture),
            metallic: m.metallic,
            roughness: m.roughness,
            // Metal has no diffuse albedo, so its texture is needed with or without a reflection.
            metallic_roughness_texture: self
                .slot(m.metallic_roughness_texture.filter(|_| m.metallic > 0.0 || specular)),
            normal_texture: self.slot(m.normal_texture.filter(|_| normal_maps)),
            normal_scale: m.normal_scale,
            emissive: if emission { m.emissive.to_array() } else { [0.0; 3] },
            emissive_texture: self.slot(m.emissive_texture.filter(|_| emission)),
            alpha: match m.alpha {
                AlphaMode::Opaque => coeff_io::AlphaMode::Opaque,
                AlphaMode::Mask(cutoff) if simulates(plan, Effect::Masks) && facts.holes > 0.0 => {
                    coeff_io::AlphaMode::Mask(cutoff)
                }
                AlphaMode::Mask(_) => coeff_io::AlphaMode::Opaque,
                AlphaMode::Blend if transmission => coeff_io::AlphaMode::Blend,
                AlphaMode::Blend => coeff_io::AlphaMode::Opaque,
            },
            specular,
            transmission: if transmission { m.transmission } else { 0.0 },
            unlit: m.unlit,
        }
    }

    fn slot(&mut self, slot: Option<TextureSlot>) -> Option<coeff_io::TextureSlot> {
        slot.map(|s| {
            let (m, t) = (s.transform.matrix2, s.transform.translation);
            coeff_io::TextureSlot {
                texture: self.keep(s.texture),
                uv_set: s.uv_set,
                transform: [[m.x_axis.x, m.y_axis.x, t.x], [m.x_axis.y, m.y_axis.y, t.y]],
            }
        })
    }

    fn keep(&mut self, texture: u32) -> u32 {
        let next = self.textures.len() as u32;
        let index = *self.index.entry(texture).or_insert(next);
        if index == next {
            let t = &self.scene.textures[texture as usize];
            self.textures.push(coeff_io::Texture {
                name: t.name.clone(),
                width: t.width,
                height: t.height,
                rgba: t.rgba.clone(),
                wrap: t.wrap.map(|w| match w {
                    Wrap::Repeat => coeff_io::Wrap::Repeat,
                    Wrap::Mirror => coeff_io::Wrap::Mirror,
                    Wrap::Clamp => coeff_io::Wrap::Clamp,
                }),
            });
        }
        index
    }
}

fn camera(c: &scene::Camera) -> coeff_io::Camera {
    coeff_io::Camera {
        name: c.name.clone(),
        eye: c.eye.to_array(),
        target: c.target.to_array(),
        up: c.up.to_array(),
        vertical_fov: c.vertical_fov,
    }
}

/// Reorders a field as the file has it: `[receiver][coefficient][channel]`.
fn flattened(field: &Field, receivers: usize, bands: u32, openness: Vec<f32>, albedo: Vec<[f32; 3]>) -> Transfer {
    let mut values = Vec::with_capacity(receivers * field.coefficients * field.channels);
    for receiver in 0..receivers as u32 {
        for i in 0..field.coefficients {
            values.extend((0..field.channels).map(|c| field.channel(receiver, c)[i]));
        }
    }
    Transfer { bands, channels: field.channels as u32, values, albedo, openness }
}
