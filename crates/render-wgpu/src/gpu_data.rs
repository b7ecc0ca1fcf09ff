//! Structures as the shaders see them: each mirrors the WGSL structure of the same name.
//!
//! A test compares offsets and sizes with what naga reads in the shaders.

use bytemuck::{Pod, Zeroable};

/// Where the eye is and how the light is turned (view.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct View {
    pub(crate) eye: [f32; 3],
    pub(crate) near: f32,
    pub(crate) forward: [f32; 3],
    pub(crate) largest: f32,
    pub(crate) right: [f32; 3],
    pub(crate) white: f32,
    pub(crate) up: [f32; 3],
    pub(crate) pad1: f32,
    pub(crate) clip_x: [f32; 3],
    pub(crate) pad2: f32,
    pub(crate) clip_y: [f32; 3],
    pub(crate) pad3: f32,
    /// Columns, each padded to four.
    pub(crate) light_from_world: [[f32; 4]; 3],
}

/// A texture's transform of coordinates (surface.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Slot {
    pub(crate) u: [f32; 4],
    pub(crate) v: [f32; 4],
}

/// One material (surface.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Material {
    pub(crate) base_color: [f32; 4],
    pub(crate) emissive: [f32; 3],
    pub(crate) metallic: f32,
    pub(crate) roughness: f32,
    pub(crate) normal_scale: f32,
    pub(crate) cutoff: f32,
    pub(crate) transmission: f32,
    pub(crate) base: Slot,
    pub(crate) metallic_roughness: Slot,
    pub(crate) normal: Slot,
    pub(crate) glow: Slot,
}

/// Sizes of a part of the transfer (relight.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Chunk {
    pub(crate) vertices: u32,
    pub(crate) coefficients: u32,
}

/// A part of a light map (sheet_fill.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Strip {
    pub(crate) width: u32,
    pub(crate) rows: u32,
    pub(crate) first_row: u32,
    pub(crate) stored: u32,
}

/// A run of receivers (gloss_rows.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Rows {
    pub(crate) count: u32,
    pub(crate) functions: u32,
    pub(crate) rank: u32,
    pub(crate) width: u32,
    pub(crate) first: u32,
}

/// What is the same for all gloss of a frame (gloss_frame.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct GlossFrame {
    pub(crate) pixel: f32,
    pub(crate) roughness: f32,
    pub(crate) level: f32,
    pub(crate) tail: f32,
}

/// Levels of a transfer texture (transfer.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Detail {
    pub(crate) density: f32,
    pub(crate) last: f32,
    pub(crate) unused: [f32; 2],
}

/// One triple product (gloss_tp.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Triple {
    pub(crate) lobe: u32,
    pub(crate) light: u32,
    pub(crate) visibility: u32,
    pub(crate) value: f32,
}

/// A disc of light in the sky (sky.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(crate) struct Lamp {
    pub(crate) direction: [f32; 3],
    pub(crate) chord_squared: f32,
    pub(crate) radiance: [f32; 3],
    pub(crate) pad: f32,
}

/// What turns samples into a picture (post.wgsl).
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Post {
    pub(crate) exposure: f32,
    pub(crate) supersample: u32,
    pub(crate) bloom: f32,
    pub(crate) levels: f32,
    pub(crate) largest: f32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gloss::GlossKind;
    use crate::shaders;
    use coeff_io::GlossWay;

    /// Names with offsets of a structure, and its size.
    type Layout = (Vec<(String, u32)>, u32);

    macro_rules! rust_layout {
        ($structure:ty, $($field:ident),+) => {(
            vec![$((stringify!($field).to_owned(), std::mem::offset_of!($structure, $field) as u32)),+],
            size_of::<$structure>() as u32,
        )};
    }

    fn wgsl_layout(shader: &shaders::Shader, name: &str) -> Layout {
        let module = naga::front::wgsl::parse_str(&shader.text).expect("valid WGSL");
        let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
        let (_, ty) = found.unwrap_or_else(|| panic!("{name} stands in {}", shader.name));
        let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is a structure") };
        let members = members.iter().map(|member| (member.name.clone().unwrap_or_default(), member.offset));
        (members.collect(), *span)
    }

    fn view_layout() -> Layout {
        rust_layout!(View, eye, near, forward, largest, right, white, up, clip_x, clip_y, light_from_world)
    }

    #[test]
    fn structures_lie_in_memory_as_the_shaders_read_them() {
        let material = rust_layout!(
            Material,
            base_color,
            emissive,
            metallic,
            roughness,
            normal_scale,
            cutoff,
            transmission,
            base,
            metallic_roughness,
            normal,
            glow
        );
        for shader in [shaders::surface(false, None), shaders::surface(true, None)] {
            assert_eq!(wgsl_layout(&shader, "View"), view_layout(), "View in {}", shader.name);
            assert_eq!(wgsl_layout(&shader, "Material"), material, "Material in {}", shader.name);
        }
        assert_eq!(wgsl_layout(&shaders::SKY, "View"), view_layout(), "View in sky");
        assert_eq!(wgsl_layout(&shaders::surface(true, None), "Slot"), rust_layout!(Slot, u, v), "Slot");
        assert_eq!(wgsl_layout(&shaders::RELIGHT, "Chunk"), rust_layout!(Chunk, vertices, coefficients), "Chunk");
        let strip = rust_layout!(Strip, width, rows, first_row, stored);
        assert_eq!(wgsl_layout(&shaders::SHEET_FILL, "Strip"), strip, "Strip");
        let lamp = rust_layout!(Lamp, direction, chord_squared, radiance);
        assert_eq!(wgsl_layout(&shaders::SKY, "Lamp"), lamp, "Lamp");
        let post = rust_layout!(Post, exposure, supersample, bloom, levels, largest);
        for shader in [shaders::RESOLVE, shaders::BLOOM] {
            assert_eq!(wgsl_layout(&shader, "Post"), post, "Post in {}", shader.name);
        }
        let rows = rust_layout!(Rows, count, functions, rank, width, first);
        assert_eq!(wgsl_layout(&shaders::GLOSS_ROWS, "Rows"), rows);
        let texels = GlossKind::Texels(GlossWay::Tp);
        let glossy = shaders::glossy(texels, true, sh_math::Bands::new(5));
        let frame = rust_layout!(GlossFrame, pixel, roughness, level, tail);
        assert_eq!(wgsl_layout(&glossy, "GlossFrame"), frame);
        assert_eq!(wgsl_layout(&glossy, "Detail"), rust_layout!(Detail, density, last, unused));
        assert_eq!(wgsl_layout(&glossy, "Triple"), rust_layout!(Triple, lobe, light, visibility, value));
    }

    #[test]
    fn layouts_can_fail() {
        #[repr(C)]
        struct Unpadded {
            eye: [f32; 3],
            near: f32,
            forward: [f32; 3],
            right: [f32; 3],
        }
        let unpadded: Layout = rust_layout!(Unpadded, eye, near, forward, right);
        assert_ne!(wgsl_layout(&shaders::SKY, "View"), unpadded, "a structure without its padding must be noticed");
    }
}
