//! The law of the house where the baker must keep it: same bits for any number of threads, quick cancels, nothing for nothing.

mod support;

use bake::{Error, Stage, settings};
use coeff_io::{Bounces, Effect, Effects, Quality, Sampler, Settings};
use glam::Vec3;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use support::{fixed, grey, quiet};

#[test]
fn same_bits_for_any_number_of_threads() {
    let scene = scene::builtin("teacup").expect("builtin");
    let settings = Settings { quality: Quality::Error(0.05), ..settings::standard() };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| quiet(&scene, &settings))
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one, three, "the number of threads must not show");
    let other = quiet(&scene, &Settings { seed: 1, ..settings });
    assert_ne!(one.transfer.values, other.transfer.values, "same_bits_can_fail: another seed must show");
}

/// Too little memory to keep what receivers see: it is found again for each bounce, with the same result.
#[test]
fn little_memory_changes_nothing_but_time() {
    let scene = scene::builtin("cornell-box").expect("builtin");
    let plenty = Settings { bounces: Bounces::Fixed(2), ..fixed(3, Sampler::OwenSobol, 64, 2) };
    let rich = quiet(&scene, &plenty);
    let within = |memory| bake::bake(&scene, &Settings { memory, ..plenty.clone() }, &|_| ControlFlow::Continue(()));
    // What the fields of the receivers take, then with those that are found on the way; next to nothing is left for senders.
    let mut memory = 3 * rich.transfer.values.len() as u64 / 9 * 12 * 4;
    let poor = loop {
        match within(memory + 1000) {
            Err(Error::Memory { needed, .. }) if needed > memory + 1000 => memory = needed,
            poor => break poor.expect("enough for the fields"),
        }
    };
    assert_eq!(rich.transfer.values, poor.transfer.values, "keeping or finding again must agree");
    let starved = bake::bake(&scene, &Settings { memory: 1000, ..fixed(3, Sampler::OwenSobol, 64, 2) }, &|_| {
        ControlFlow::Continue(())
    });
    assert!(matches!(starved, Err(Error::Memory { .. })), "too little for the coefficients must be refused");
}

/// After the callback asks to stop, no thread begins another receiver: what remains is one receiver each.
#[test]
fn cancel_is_quick() {
    let scene = scene::builtin("atrium").expect("builtin");
    let threads = 2;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    for stage_of_cancel in [Stage::Visibility, Stage::Bounce(1)] {
        let (asked_at, last) = (AtomicU64::new(u64::MAX), AtomicU64::new(0));
        let progress = |p: &bake::Progress| {
            last.store(p.done, Ordering::Relaxed);
            if p.stage == stage_of_cancel && p.done >= 100 {
                asked_at.fetch_min(p.done, Ordering::Relaxed);
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        };
        let result = pool.install(|| bake::bake(&scene, &fixed(3, Sampler::OwenSobol, 64, 3), &progress));
        assert_eq!(result, Err(Error::Cancelled), "a cancelled bake returns no file");
        let more = last.load(Ordering::Relaxed) - asked_at.load(Ordering::Relaxed);
        assert!(more <= 8 * threads as u64, "{more} receivers were begun after the cancel");
    }
}

#[test]
fn nothing_is_paid_for_what_is_not_there() {
    let convex = quiet(&grey("sphere", 0.5), &settings::standard());
    assert_eq!((convex.achieved.visibility_rays, convex.achieved.bounce_rays), (0, 0), "a convex body needs no rays");
    let black = quiet(&grey("cornell-box", 0.0), &settings::standard());
    assert_eq!(black.achieved.bounces, 0, "black surfaces send nothing on");
    let grey_box = quiet(&grey("cornell-box", 0.5), &settings::preview());
    assert_eq!(grey_box.transfer.channels, 1, "grey bounces need one channel");
    let colored = quiet(&scene::builtin("cornell-box").expect("builtin"), &settings::preview());
    assert_eq!(colored.transfer.channels, 3, "coloured walls need three");
    assert!(colored.achieved.bounces >= 2, "light bounces in a room");
}

/// Each effect that a list leaves out is left out, and says so.
#[test]
fn effects_obey_the_list() {
    let scene = scene::builtin("cornell-box").expect("builtin");
    let only = |list: &[Effect]| Settings { effects: Effects::Only(list.to_vec()), ..settings::preview() };
    let open = quiet(&scene, &only(&[]));
    assert_eq!(open.achieved.visibility_rays, 0, "without visibility there are no rays");
    let shadowed = quiet(&scene, &only(&[Effect::Visibility]));
    assert_eq!((shadowed.achieved.bounces, shadowed.transfer.channels), (0, 1), "shadows alone have one channel");
    assert!(shadowed.achieved.visibility_rays > 0, "shadows need rays");
}

#[test]
fn bad_settings_name_themselves() {
    let scene = grey("plane", 0.5);
    let refused =
        |s: Settings| bake::bake(&scene, &s, &|_| ControlFlow::Continue(())).expect_err("refused").to_string();
    assert!(refused(Settings { bands: 0, ..settings::standard() }).contains("'bands'"), "bands");
    assert!(refused(Settings { quality: Quality::Rays(0), ..settings::standard() }).contains("'rays'"), "rays");
    assert!(
        refused(Settings { quality: Quality::Error(f32::NAN), ..settings::standard() }).contains("'error'"),
        "error"
    );
    let empty = scene::Scene::default();
    let none = bake::bake(&empty, &settings::standard(), &|_| ControlFlow::Continue(()));
    assert!(matches!(none, Err(Error::EmptyScene { .. })), "an empty scene is refused");
}

/// A ground that runs through a closed box: vertices inside the box are found and take their neighbours' values.
#[test]
fn receivers_inside_bodies_are_repaired() {
    let mut scene = grey("plane", 0.5);
    let mut block = scene::builtin("furnace-box").expect("builtin");
    for p in &mut block.meshes[0].positions {
        *p *= Vec3::new(0.4, 0.4, 0.4);
    }
    scene.meshes.append(&mut block.meshes);
    let prt = quiet(&scene, &fixed(3, Sampler::OwenSobol, 256, 0));
    let repairs = prt.achieved.repairs;
    assert!(repairs.inside > 0, "some vertices of the ground are inside the block");
    let inside = prt
        .geometry
        .positions
        .iter()
        .zip(&prt.transfer.openness)
        .filter(|(p, _)| p[1] == 0.0 && p[0].abs() < 0.35 && p[2].abs() < 0.35);
    for (p, openness) in inside {
        assert!(*openness > 0.3, "the ground inside the block at {p:?} stays dark: {openness}");
    }
    let ring =
        prt.geometry.positions.iter().zip(&prt.transfer.openness).filter(|(p, _)| p[1] == 0.0 && p[0].abs() > 1.5);
    ring.for_each(|(p, o)| assert!(*o > 0.8, "the open ground at {p:?} was touched: {o}"));
}

/// A normal that is no direction is replaced by that of the faces, and counted.
#[test]
fn bad_normals_are_found() {
    let mut scene = grey("plane", 0.5);
    scene.meshes[0].normals[5] = Vec3::NAN;
    scene.meshes[0].normals[7] = Vec3::ZERO;
    scene.meshes[0].normals[9] = Vec3::NEG_Y;
    let prt = quiet(&scene, &settings::preview());
    assert_eq!(prt.achieved.repairs.bad_normals, 3, "three normals were bad");
    assert!(prt.transfer.values.iter().all(|v| v.is_finite()), "no number may be lost");
    assert_eq!(prt.transfer.values[..9], prt.transfer.values[5 * 9..6 * 9], "the mended vertex is like the others");
}

/// A scene's origin and its unlit materials are in the file; the coefficients are those of the scene without.
#[test]
fn origins_and_unlit_materials_are_kept() {
    let near = scene::builtin("sphere-on-plane").expect("builtin");
    let mut far = scene::Scene { origin: [500_000.25, 0.0, -5_300_000.0], ..near.clone() };
    far.materials[0].unlit = true;
    let settings = fixed(3, Sampler::OwenSobol, 16, 1);
    let (near, far) = (quiet(&near, &settings), quiet(&far, &settings));
    assert_eq!(far.origin, [500_000.25, 0.0, -5_300_000.0]);
    assert!(far.materials[0].unlit && !near.materials[0].unlit);
    assert_eq!((&near.transfer, &near.geometry), (&far.transfer, &far.geometry));
}
