//! What most programs need: `use relume::prelude::*;`.

pub use crate::{
    AtlasOptions, Backend, Bake, BakeSettings, Device, ImageFormat, LightMapOptions, LightProbe, LightSpectrum, Preset,
    Renderer, RendererOptions, TransferTextureOptions, Window, fixed_light, load_light_probe, load_prt, load_scene,
    save_image, save_prt,
};
pub use bake::VolumeSettings;
pub use coeff_io::{Bounces, Camera, Prt, Quality, Refine};
pub use glam::{Quat, Vec3};
pub use render_cpu::{Frame, Image, Tonemap};
pub use scene::Scene;
