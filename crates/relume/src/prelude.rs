//! What most programs need: `use relume::prelude::*;`.

pub use coeff_io::{Bounces, Prt, Quality, Refine, Settings};
pub use probe_io::Environment;
pub use render_cpu::{Frame, Image, Tonemap};
pub use scene::Scene;
