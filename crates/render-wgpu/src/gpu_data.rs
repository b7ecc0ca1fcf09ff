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
    pub(crate) pad0: f32,
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
}
