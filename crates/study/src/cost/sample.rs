//! A small baked file for tests.

use coeff_io::{Prt, Quality, Settings};
use std::ops::ControlFlow;

/// The Cornell box in two bands, 32 rays per receiver.
pub(crate) fn prt() -> Prt {
    let scene = scene::builtin("cornell-box").expect("it is built in");
    let settings = Settings { bands: 2, quality: Quality::Rays(32), ..bake::settings::standard() };
    bake::bake(&scene, &settings, &|_| ControlFlow::Continue(())).expect("the Cornell box can be baked")
}
