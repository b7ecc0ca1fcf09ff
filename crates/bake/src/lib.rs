//! Precomputes how a scene carries light.
//!
//! [`plan`] decides from the scene which effects are simulated; [`bake`] obeys it and returns a [`coeff_io::Prt`]
//! that holds, per vertex, a transfer vector: its dot product with the coefficients of a light, times the albedo,
//! is the radiance that the vertex sends out. \[G\] eq. (8) to (11), with the printed errors corrected.
//!
//! Light is carried between diffuse, two-sided surfaces. What blends or transmits stops the share of light that it covers,
//! emission is drawn but not transported, and a mask's empty parts do not exist for rays.

mod account;
mod albedo;
mod arrival;
mod bake;
mod bandwidth;
mod bend;
mod between;
mod bodies;
mod bundle;
mod cells;
pub mod compress;
mod contacts;
mod cuts;
mod directions;
mod domain;
mod dot;
mod drawn;
mod error;
mod exits;
mod extras;
mod facts;
mod field;
mod foresight;
mod found;
mod gather;
mod gloss;
mod hit;
mod junctions;
mod ledge;
mod maps;
mod material;
mod mirror;
mod passes;
mod plan;
mod price;
mod progress;
mod proximity;
mod quick_look;
mod receivers;
mod refine;
mod reflected;
mod repair;
mod rows;
mod sample;
mod senders;
mod series;
mod setting_field;
pub mod settings;
mod sharing;
mod small;
mod split;
mod start;
mod storage;
mod summary;
mod survey;
mod towards;
mod transmittance;
mod volume;
mod wanted;
mod world;

pub use crate::bake::{ProgressFn, bake, bake_refined, bake_with, plan, plan_with};
pub use crate::maps::{Directional, DirectionalTexel, MapSettings, SheetSettings, directional};
pub use crate::volume::{VolumePlace, VolumeSettings, VolumeSteps};
pub use error::Error;
pub use extras::{Extras, FixedLight};
pub use gloss::{Compression, TextureSettings};
pub use price::{Look, Price, price};
pub use progress::{Progress, Stage};
pub use receivers::{Receiver, Receivers};
pub use refine::{refine, refine_watched};
pub use sample::{Sampled, sample};
pub use setting_field::SettingField;
pub use storage::{StorageChoice, storage, storage_watched};
