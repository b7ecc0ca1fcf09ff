//! Where each point of a surface lies in the pictures that hold its light: the second texture coordinates of meshes.
//!
//! A *sheet* is one such picture; the meshes on it share the unit square. A *chart* is a piece of a mesh whose triangles
//! hang together in the sheet.

mod chart;
mod cover;
mod crowd;
mod fault;
mod layouts;
mod objects;
mod resolve;
mod resolved;
mod seam;
mod texel;
mod unwrap;

pub use chart::Charts;
pub use crowd::crowding;
pub use fault::{Fault, FaultKind, faults, share};
pub use layouts::{Layouts, layouts};
pub use objects::{ObjectOptions, ObjectSheet, objects};
pub use resolve::growth;
pub use resolved::unwrap_resolved;
pub use seam::{Seam, SeamSide, seams};
pub use texel::{Texel, texels};
pub use unwrap::{Atlas, Density, Unwrap, UnwrapError, unwrap};
