//! Materials on the GPU: numbers, textures, and which pipeline they call for.

use crate::gloss::GlossKind;
use crate::texture::{Encoding, Textures};
use crate::{Error, Gpu, geometry, gpu_data};
use coeff_io::GlossWay;
use coeff_io::{AlphaMode, Material, Prt, TextureSlot};
use sh_math::hemisphere::Basis;

/// What a pipeline is specialised for: materials with the same variant share it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Variant {
    /// Mirrors the light probe.
    pub(crate) shiny: bool,
    /// Alpha below the cutoff is a hole.
    pub(crate) masked: bool,
    /// Alpha is coverage.
    pub(crate) fades: bool,
    /// Drawn over what lies behind.
    pub(crate) blended: bool,
    /// The base colour is shown as it is.
    pub(crate) unlit: bool,
    pub(crate) base_textured: bool,
    pub(crate) metallic_roughness_textured: bool,
    pub(crate) normal_textured: bool,
    /// A normal map bends the light of the vertices.
    pub(crate) bends_light: bool,
    pub(crate) glow_textured: bool,
    /// Lit by a light map in this basis, else by the vertices.
    pub(crate) basis: Option<Basis>,
    /// Gloss or a transfer texture.
    pub(crate) gloss: Option<GlossKind>,
    /// Whether surfaces send light to those that shine.
    pub(crate) bounced: bool,
    /// Whether depth was drawn before.
    pub(crate) early: bool,
}

impl Variant {
    /// What a material of a file with or without tangents calls for where no light map lies upon it.
    pub(crate) fn of(material: &Material, has_tangents: bool) -> Self {
        let fades = material.alpha == AlphaMode::Blend;
        let bends = has_tangents && material.normal_texture.is_some() && !material.unlit;
        Self {
            shiny: material.specular && !material.unlit,
            masked: matches!(material.alpha, AlphaMode::Mask(_)),
            fades,
            blended: fades || material.transmission > 0.0,
            unlit: material.unlit,
            base_textured: material.base_color_texture.is_some(),
            metallic_roughness_textured: material.metallic_roughness_texture.is_some(),
            normal_textured: bends,
            bends_light: bends,
            glow_textured: material.emissive_texture.is_some(),
            basis: None,
            gloss: None,
            bounced: false,
            early: false,
        }
    }

    /// Whether the normals of vertices are read.
    pub(crate) fn is_shaped(self) -> bool {
        self.shiny || self.bends_light
    }

    /// The pipeline constants of surface.wgsl, bend.wgsl and sheet.wgsl.
    pub(crate) fn constants(self) -> Vec<(&'static str, f64)> {
        let functions = self.basis.map(|basis| ("functions", basis.count() as f64));
        let switches = [
            ("base_textured", self.base_textured),
            ("metallic_roughness_textured", self.metallic_roughness_textured),
            ("normal_textured", self.normal_textured),
            ("glow_textured", self.glow_textured),
            ("masked", self.masked),
            ("blended", self.blended),
            ("fades", self.fades),
            ("unlit", self.unlit),
        ]
        .map(|(name, on)| (name, f64::from(u8::from(on))));
        // Only surfaces with normals know it.
        let bends = (self.is_shaped()).then_some(("bends_light", f64::from(u8::from(self.bends_light))));
        let product = |way| way != GlossWay::Cache;
        let products = matches!(self.gloss, Some(GlossKind::Texels(way) | GlossKind::Vertices(way)) if product(way));
        let bounced = products.then_some(("bounced", f64::from(u8::from(self.bounced))));
        switches.into_iter().chain(bends).chain(functions).chain(bounced).collect()
    }
}

/// One material, ready to be bound.
#[derive(Debug)]
pub(crate) struct BoundMaterial {
    variant: Variant,
    pub(crate) bindings: wgpu::BindGroup,
}

impl BoundMaterial {
    /// The variant of a surface with this material, lit by a map in `basis`, by a transfer texture (`texels`) or by its vertices.
    pub(crate) fn variant(&self, basis: Option<Basis>, texels: bool) -> Variant {
        let bends_light = self.variant.bends_light && basis.is_none() && !texels;
        // A transfer texture is bent already.
        let normal_textured = self.variant.normal_textured && (self.variant.shiny || !texels);
        Variant { basis, bends_light, normal_textured, ..self.variant }
    }

    /// Whether it mirrors the light probe.
    pub(crate) fn is_shiny(&self) -> bool {
        self.variant.shiny
    }

    /// Whether it is drawn over what lies behind.
    pub(crate) fn is_blended(&self) -> bool {
        self.variant.blended
    }
}

/// Uploads the materials and those textures that they show.
pub(crate) fn upload(gpu: &Gpu, prt: &Prt, layout: &wgpu::BindGroupLayout) -> Result<Vec<BoundMaterial>, Error> {
    let mut textures = Textures::new(gpu)?;
    prt.materials.iter().map(|material| bind(gpu, prt, layout, &mut textures, material)).collect()
}

/// The layout of a material's bindings (group 1 of surface.wgsl).
pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    // Gloss at vertices asks for the roughness there.
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    let numbers = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: wgpu::BufferSize::new(size_of::<gpu_data::Material>() as u64),
    };
    let picture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let pictures = (1..5).map(|binding| entry(binding, picture));
    let samplers = (5..9).map(|binding| entry(binding, sampler));
    let entries = std::iter::once(entry(0, numbers)).chain(pictures).chain(samplers).collect::<Vec<_>>();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("material"), entries: &entries })
}

fn bind(
    gpu: &Gpu,
    prt: &Prt,
    layout: &wgpu::BindGroupLayout,
    textures: &mut Textures,
    material: &Material,
) -> Result<BoundMaterial, Error> {
    let has_tangents = !prt.geometry.tangents.is_empty();
    let variant = Variant::of(material, has_tangents);
    let slots = [
        (material.base_color_texture, Encoding::Srgb),
        (material.metallic_roughness_texture, Encoding::Linear),
        (material.normal_texture.filter(|_| variant.normal_textured), Encoding::Linear),
        (material.emissive_texture, Encoding::Srgb),
    ]
    .map(|(slot, encoding)| (slot.map(|slot| slot.texture), encoding));
    for (index, encoding) in slots {
        index.map_or(Ok(()), |index| textures.require(gpu, prt, index, encoding))?;
    }
    let bytes = numbers(material);
    let numbers = geometry::buffer(gpu, "material", bytemuck::bytes_of(&bytes), wgpu::BufferUsages::UNIFORM)?;
    let pictures = slots.map(|(index, encoding)| textures.get(index, encoding));
    let views = pictures.iter().map(|(view, _)| wgpu::BindingResource::TextureView(view));
    let samplers = pictures.iter().map(|(_, sampler)| wgpu::BindingResource::Sampler(sampler));
    let resources = std::iter::once(numbers.as_entire_binding()).chain(views).chain(samplers);
    let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
    let bindings = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(&material.name),
        layout,
        entries: &entries.collect::<Vec<_>>(),
    });
    Ok(BoundMaterial { variant, bindings })
}

fn numbers(material: &Material) -> gpu_data::Material {
    gpu_data::Material {
        base_color: material.base_color,
        emissive: material.emissive,
        metallic: material.metallic,
        roughness: material.roughness,
        normal_scale: material.normal_scale,
        cutoff: if let AlphaMode::Mask(cutoff) = material.alpha { cutoff } else { 0.0 },
        transmission: material.transmission.clamp(0.0, 1.0),
        base: slot(material.base_color_texture),
        metallic_roughness: slot(material.metallic_roughness_texture),
        normal: slot(material.normal_texture),
        glow: slot(material.emissive_texture),
    }
}

fn slot(slot: Option<TextureSlot>) -> gpu_data::Slot {
    slot.map_or_else(gpu_data::Slot::default, |slot| {
        let [[a, b, c], [d, e, f]] = slot.transform;
        gpu_data::Slot { u: [a, b, c, f32::from(slot.uv_set)], v: [d, e, f, 0.0] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matt() -> Material {
        Material {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 0.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emissive: [1.0; 3],
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            specular: false,
            transmission: 0.0,
            unlit: false,
        }
    }

    fn parts(material: &Material, has_tangents: bool) -> Vec<&'static str> {
        let variant = Variant::of(material, has_tangents);
        let own = [("shiny", variant.shiny), ("sorted", variant.blended)];
        let names = own.into_iter().filter(|(_, on)| *on).map(|(name, _)| name);
        names.chain(variant.constants().into_iter().filter(|(_, on)| *on != 0.0).map(|(name, _)| name)).collect()
    }

    /// What the file does not call for is in no pipeline: no reflection, no mask, no blending, no texture look-up.
    #[test]
    fn a_plain_material_has_the_plain_pipeline() {
        assert!(parts(&matt(), true).is_empty(), "{:?}", parts(&matt(), true));
    }

    /// Each effect brings its own part and no other.
    #[test]
    fn each_effect_brings_its_part_alone() {
        let slot = Some(TextureSlot { texture: 0, uv_set: 0, transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] });
        let shiny = Material { specular: true, ..matt() };
        let bumpy = Material { normal_texture: slot, ..matt() };
        assert_eq!(parts(&shiny, true), ["shiny"]);
        assert_eq!(parts(&Material { alpha: AlphaMode::Mask(0.5), ..matt() }, true), ["masked"]);
        assert_eq!(parts(&Material { alpha: AlphaMode::Blend, ..matt() }, true), ["sorted", "blended", "fades"]);
        assert_eq!(parts(&Material { transmission: 0.5, ..matt() }, true), ["sorted", "blended"]);
        assert_eq!(parts(&Material { emissive_texture: slot, ..matt() }, true), ["glow_textured"]);
        assert_eq!(parts(&Material { unlit: true, specular: true, ..matt() }, true), ["unlit"]);
        assert_eq!(parts(&bumpy, true), ["normal_textured", "bends_light"]);
        assert!(parts(&bumpy, false).is_empty(), "a normal map bends nothing without tangents");
        let both = Material { normal_texture: slot, ..shiny.clone() };
        assert_eq!(parts(&both, true), ["shiny", "normal_textured", "bends_light"]);
        assert_eq!(parts(&Material { normal_texture: slot, ..shiny }, false), ["shiny"], "nor without tangents");
    }
}
