//! Bakes through the front door against bakes by hand, within a time, and cancelled.

use relume::prelude::*;
use relume::{Error, bake};
use std::ops::ControlFlow;
use std::time::Duration;

fn settings() -> BakeSettings {
    BakeSettings { quality: Quality::Rays(32), bounces: Bounces::Fixed(1), ..Preset::Draft.into() }
}

#[test]
fn bake_is_that_of_the_crate_behind() {
    let scene = load_scene("builtin:facing-planes").expect("a builtin");
    let door = Bake::new(&scene).settings(settings()).run().expect("a bake");
    let direct = bake::bake(&scene, &settings(), &|_| ControlFlow::Continue(())).expect("a bake");
    assert_eq!(door.transfer, direct.transfer);
    let other = BakeSettings { seed: 1, ..settings() };
    let other = Bake::new(&scene).settings(other).run().expect("a bake");
    assert_ne!(door.transfer, other.transfer, "can fail: another seed takes other rays");
}

#[test]
fn bake_within_a_time_returns_a_result() {
    let scene = load_scene("builtin:facing-planes").expect("a builtin");
    let prt = Bake::new(&scene).within(Duration::from_millis(300)).run().expect("a first result in any case");
    assert_eq!(prt.settings.time, Some(0.3));
    assert!(prt.transfer.values.iter().any(|value| *value > 0.1));
}

#[test]
fn bake_is_cancelled_by_its_progress() {
    let scene = load_scene("builtin:facing-planes").expect("a builtin");
    let cancelled = Bake::new(&scene).settings(settings()).progress(&|_| ControlFlow::Break(())).run();
    assert!(matches!(cancelled, Err(Error::Bake(bake::Error::Cancelled))), "{cancelled:?}");
}

/// Light maps and transfer textures exclude each other; the error says so without options of a command line.
#[test]
fn light_maps_exclude_transfer_textures() {
    let scene = load_scene("builtin:facing-planes").expect("a builtin");
    let bake = Bake::new(&scene).settings(settings()).light_maps(LightMapOptions::new(32));
    let refused = bake.transfer_textures(TransferTextureOptions::new(32)).run();
    assert!(matches!(refused, Err(Error::Bake(bake::Error::Setting { .. }))), "{refused:?}");
}
