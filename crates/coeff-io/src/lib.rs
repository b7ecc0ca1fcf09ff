//! The `.prt` file: data model, header, chunks, checksums, exports.
//!
//! A `.prt` is self-contained: geometry as baked, materials, textures, transfer, the plan, the settings, the achieved
//! error and the id of the spherical harmonics convention. `docs/format.md` describes the file byte by byte.

mod array;
mod arriving_light;
mod bc1;
mod bc6h;
mod bc6h_mode;
mod block;
mod camera;
mod coding;
mod dds;
mod eight_bits;
mod error;
pub mod export;
mod export_gloss;
mod export_textures;
mod gloss;
mod gloss_header;
mod gloss_view;
mod grid;
mod header;
pub mod import;
mod inspect;
mod ktx;
mod layers;
mod lit;
mod map;
mod map_error;
mod map_header;
mod model;
pub mod octahedral;
mod plan;
mod read;
mod record;
mod replace;
mod rows;
mod sidecar;
mod supplement;
mod table;
mod texels;
mod transfer_textures;
mod validate;
mod validate_gloss;
mod validate_maps;
mod validate_volume;
mod visitor;
mod volume;
mod volume_header;
mod volume_lookup;
mod write;

pub use arriving_light::{ArrivingLight, DiffuseLight};
pub use block::Blocks;
pub use coding::{Coding, Curve, Effort, Encoded, Ranges, curves, linear_of_srgb, srgb_of_linear};
pub use error::Error;
pub use gloss::{Arriving, Bounced, Codebooks, Gloss, VertexGloss};
pub use gloss_header::{
    ArrivingHeader, CodebookHeader, GlossHeader, SurfacesHeader, TableHeader, TransferLevelHeader,
    TransferTexturesHeader,
};
pub use gloss_view::{GlossView, GlossWay};
pub use grid::Grid;
pub use header::{Header, TextureHeader};
pub use inspect::{Inspection, check, inspect};
pub use layers::{Encoding, Layers};
pub use map::{Lit, MapLight, Maps, Sheet};
pub use map_error::{MapError, normals};
pub use map_header::{MapsHeader, SheetHeader, basis_id, basis_of};
pub use model::{AlphaMode, Camera, Geometry, Material, Mesh, Prt, Texture, TextureSlot, Transfer, Wrap};
pub use plan::{Effect, EffectCost, MeshPlan, Plan, PlanRow, Survey};
pub use record::{
    Achieved, BandChoice, Bounces, Effects, GlossRecord, MapRecord, Quality, Refine, RepairCounts, Sampler, Settings,
};
pub use replace::{abandon, make_folder, replace};
pub use rows::{Codebook, Form, Table};
pub use supplement::Supplement;
pub use table::{ALIGNMENT, Chunk, Kind, MAGIC, VERSION};
pub use texels::Container;
pub use transfer_textures::{TransferLevel, TransferSheet, TransferTextures};
pub use visitor::VisitorError;
pub use volume::{Node, Volume};
pub use volume_header::VolumeHeader;
pub use volume_lookup::{BEHIND, Cell, LEAST_DEVIATION, Lookup, Weights, irradiance_at};
