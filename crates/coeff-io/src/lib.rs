//! The `.prt` file: data model, header, chunks, checksums, exports.

mod model;
mod record;

pub use model::{AlphaMode, Camera, Geometry, Material, Mesh, Prt, Texture, TextureSlot, Transfer, Wrap};
pub use record::{Achieved, Bounces, Effect, Effects, PlanRow, Plan, Quality, RepairCounts, Sampler, Settings};
