//! What a plan leaves out is not missed: auto against all, and every row against a bake that skips it wrongly.

mod saving;

use coeff_io::{BandChoice, Effect, Effects, Plan, PlanRow, Prt, Settings};
use glam::{Affine2, Vec2, Vec3, Vec4};
use probe_io::Environment;
use saving::{Cost, GLOSS_MISSED, TOLERANCE, baked, cheap, difference, mean_difference, scenes, with};
use scene::{AlphaMode, Material, Scene, Texture, TextureSlot, Wrap};
use sh_math::Bands;

/// Of every known scene and six real ones: within the tolerance, and never dearer than the survey. Gloss has a worth of its own: where it is not
/// called for, the light that surfaces mirror may be missing, 2 % of an open receiver's on average at most.
#[test]
fn auto_agrees_with_all() {
    for (name, scene) in scenes() {
        let (auto, all) = (with(&scene, Effects::Auto), with(&scene, Effects::All));
        if row(&auto.plan, Effect::Glossy).simulate {
            let off = difference(&auto, &all);
            assert!(off <= TOLERANCE, "{name}: auto is {off} off");
        } else {
            let off = difference(&auto, &without(&scene, Effect::Glossy));
            assert!(off <= TOLERANCE, "{name}: auto is {off} off");
            let missed = mean_difference(&auto, &all);
            assert!(missed <= GLOSS_MISSED, "{name}: without gloss, auto is {missed} off");
        }
        let (few, many) = (Cost::of(&auto), Cost::of(&all));
        assert!(few.rays <= many.rays, "{name}: {} rays against {}", few.rays, many.rays);
        // The headers differ by the words of the plan; the arrays may only shrink.
        let header = 16 << 10;
        assert!(few.bytes <= many.bytes + header, "{name}: {} bytes against {}", few.bytes, many.bytes);
    }
}

#[test]
fn auto_agrees_with_all_can_fail() {
    let scene = known("cornell-box");
    let off = difference(&without(&scene, Effect::Interreflection), &with(&scene, Effects::All));
    assert!(off > 10.0 * TOLERANCE, "bounces that are left out must be seen: {off}");
}

/// The foot of a ball that touches the ground sees nothing but the ground, though nothing is above its tangent plane.
#[test]
fn ground_that_is_touched_is_not_overlooked() {
    let scene = known("sphere-on-plane");
    let prt = with(&scene, Effects::Auto);
    let feet = prt.geometry.positions.iter().zip(&prt.geometry.normals).zip(&prt.transfer.openness);
    let feet: Vec<f32> =
        feet.filter(|((p, n), _)| Vec3::from(**p).length() < 1e-6 && n[1] < -0.9).map(|(_, &open)| open).collect();
    assert!(!feet.is_empty() && feet.iter().all(|&open| open < 0.1), "{feet:?}");
    let alone = with(&known("sphere"), Effects::Auto);
    assert!(alone.transfer.openness.is_empty(), "can fail: a ball in the air is open everywhere");
}

/// Nothing stands above a plane or a convex body: no ray at all, not even of the survey.
#[test]
fn a_plane_and_a_convex_body_take_no_rays() {
    for name in ["plane", "sphere"] {
        let prt = with(&known(name), Effects::Auto);
        assert_eq!(Cost::of(&prt).rays, 0, "{name}");
        let cost = prt.achieved.effects.iter().find(|cost| cost.effect == Effect::Visibility).expect("accounted");
        assert_eq!(cost.saved_rays, 64 * prt.plan.receivers, "{name}: every receiver saved its rays");
        assert!(Cost::of(&with(&known(name), Effects::All)).rays > 0, "{name}: all traces (can fail)");
    }
}

/// Black surfaces send nothing on: no bounce, no closest-hit ray; a single grey one brings both back.
#[test]
fn black_surfaces_take_no_bounces() {
    let mut scene = known("cornell-box");
    for material in &mut scene.materials {
        material.base_color = Vec4::W;
    }
    let black = with(&scene, Effects::Auto);
    assert_eq!((black.achieved.bounces, black.achieved.bounce_rays, black.plan.bounces), (0, 0, 0));
    scene.materials[0].base_color = Vec4::new(0.5, 0.5, 0.5, 1.0);
    let grey = with(&scene, Effects::Auto);
    assert!(grey.achieved.bounces > 0 && grey.achieved.bounce_rays > 0, "can fail");
}

/// The bound before any ray holds for what is measured: each bounce, and their number.
#[test]
fn bounces_stay_below_their_bound() {
    for (albedo, most) in [(0.2f32, 3), (0.5, 9)] {
        let mut scene = known("bowl");
        scene.materials.iter_mut().for_each(|m| m.base_color = Vec4::new(albedo, albedo, albedo, 1.0));
        scene.meshes.iter_mut().for_each(|m| m.colors.clear());
        let prt = with(&scene, Effects::Auto);
        assert_eq!(prt.plan.bounces, most, "a^(n+1)/(1-a) <= 0.0025 by hand for a = {albedo}");
        assert!(prt.achieved.bounces <= prt.plan.bounces, "{albedo}: {}", prt.achieved.bounces);
        for (k, change) in prt.achieved.bounce_changes.iter().enumerate() {
            let bound = albedo.powi(k as i32 + 1);
            assert!(*change <= 1.01 * bound, "{albedo}: bounce {} changes {change}, bound {bound}", k + 1);
        }
        assert!(prt.achieved.bounce_changes[0] > 0.1 * albedo, "can fail: there is something to bound");
    }
}

#[test]
fn shadows_are_not_skipped_wrongly() {
    skipping_is_seen(&known("cornell-box"), Effect::Visibility, "rays for");
}

#[test]
fn bounces_are_not_skipped_wrongly() {
    skipping_is_seen(&known("bowl"), Effect::Interreflection, "bounces");
}

#[test]
fn color_is_not_skipped_wrongly() {
    skipping_is_seen(&known("cornell-box"), Effect::Color, "3 channels");
}

/// A sheet with holes above a plane lets light through; one whose mask has no holes is opaque and costs no test.
#[test]
fn masks_are_not_skipped_wrongly() {
    skipping_is_seen(&under_a_sheet(&[[200, 200, 200, 255], [0, 0, 0, 0]]), Effect::Masks, "test the mask");
    let whole = under_a_sheet(&[[200, 200, 200, 255], [0, 0, 0, 128]]);
    let auto = with(&whole, Effects::Auto);
    assert!(!row(&auto.plan, Effect::Masks).simulate, "no texel is below the cutoff");
    assert!(auto.materials.iter().all(|m| m.alpha == coeff_io::AlphaMode::Opaque), "no mask is drawn");
    let off = difference(&auto, &with(&whole, Effects::All));
    assert!(off < 1e-6, "and none is missed: {off}");
}

#[test]
fn transmission_is_not_skipped_wrongly() {
    let mut scene = under_a_sheet(&[[255; 4]]);
    scene.materials[1].alpha = AlphaMode::Blend;
    scene.materials[1].base_color.w = 0.25;
    skipping_is_seen(&scene, Effect::Transmission, "rays pass");
}

#[test]
fn reflections_are_not_skipped_wrongly() {
    let mut scene = known("sphere-on-plane");
    scene.materials.iter_mut().for_each(|m| (m.metallic, m.roughness) = (1.0, 0.2));
    skipping_is_drawn(&scene, Effect::Specular);
    // Rough and dielectric: nothing to mirror, no texture, no flag for the renderers.
    let matt = with(&known("sphere-on-plane"), Effects::Auto);
    assert!(!row(&matt.plan, Effect::Specular).simulate && matt.materials.iter().all(|m| !m.specular));
}

/// The smooth part of a material is in its texture, not in its factor.
#[test]
fn a_smooth_texture_calls_for_reflections() {
    let mut scene = known("plane");
    textured(&mut scene, &[[0, 255, 0, 255], [0, 10, 0, 255]]);
    scene.materials[0].metallic_roughness_texture = slot();
    assert!(with(&scene, Effects::Auto).materials[0].specular);
    scene.textures[0].rgba[1] = [0, 255, 0, 255];
    assert!(!with(&scene, Effects::Auto).materials[0].specular, "can fail: all of it is rough");
}

#[test]
fn normal_maps_are_not_skipped_wrongly() {
    let mut scene = known("plane");
    textured(&mut scene, &[[255, 128, 128, 255], [0, 128, 128, 255]]);
    scene.materials[0].normal_texture = slot();
    let matt = with(&scene, Effects::Auto);
    assert!(!matt.geometry.tangents.is_empty() && matt.textures.len() == 1, "the light of a matt surface is bent");
    let mut flat = scene.clone();
    flat.textures[0].rgba.fill([128, 128, 255, 255]);
    let flat = with(&flat, Effects::Auto);
    assert!(flat.geometry.tangents.is_empty() && flat.textures.is_empty(), "a flat map bends nothing");
    assert!(row(&flat.plan, Effect::NormalMaps).reason.contains("no material has a normal map that shows"));
    (scene.materials[0].metallic, scene.materials[0].roughness) = (1.0, 0.1);
    skipping_is_drawn(&scene, Effect::NormalMaps);
}

/// With light maps a normal map bends diffuse light, also on a matt surface; without a normal map one function is kept.
#[test]
fn directions_are_kept_where_a_normal_map_is() {
    let baked = |bumpy: bool| {
        let mut scene = scene::builtin("bumps").expect("builtin");
        if !bumpy {
            scene.materials.iter_mut().for_each(|m| m.normal_texture = None);
        }
        let meshes = vec![0, 1];
        let maps = bake::MapSettings {
            basis: sh_math::hemisphere::Basis::ModifiedH6,
            sheets: vec![bake::SheetSettings { meshes, width: 32, height: 32, directional: bumpy }],
            stitch: true,
            dilation: 1,
            encoding: coeff_io::Encoding::F16,
        };
        let extras = bake::Extras { maps: Some(maps), ..bake::Extras::default() };
        bake::bake_with(&scene, &cheap(), &extras, &|_| std::ops::ControlFlow::Continue(())).expect("it bakes")
    };
    let (bent, plain) = (baked(true), baked(false));
    let row_of = |prt: &Prt| row(&prt.plan, Effect::NormalMaps).clone();
    assert!(row_of(&bent).simulate && row_of(&bent).decision.contains("directional"), "{:?}", row_of(&bent));
    assert!(!row_of(&plain).simulate, "{:?}", row_of(&plain));
    let layers = |prt: &Prt| prt.maps.as_ref().expect("maps").sheets[0].layers.count;
    assert_eq!(layers(&bent), 6 * layers(&plain), "one function of six is enough where no normal is bent");
    assert!(!bent.geometry.tangents.is_empty() && bent.textures.len() == 1, "the map and its tangents are kept");
    assert!(plain.geometry.tangents.is_empty() && plain.textures.is_empty(), "and no more");
}

#[test]
fn emission_is_not_skipped_wrongly() {
    let mut scene = known("plane");
    scene.materials[0].emissive = Vec3::new(2.0, 0.0, 0.0);
    skipping_is_drawn(&scene, Effect::Emission);
    assert!(!row(&with(&known("plane"), Effects::Auto).plan, Effect::Emission).simulate);
}

/// Under a light that is known, the bands left out do not show; under another they would.
#[test]
fn bands_are_not_skipped_wrongly() {
    let scene = known("cornell-box");
    let sky = probe_io::builtin("sky").expect("built in");
    let white = Environment::constant([1.0; 3]);
    let settings =
        |light: &Environment, band_choice| Settings { band_choice, light: norms(light), bands: 5, ..cheap() };
    let full = baked(&scene, &settings(&white, BandChoice::Exactly));
    let few = baked(&scene, &settings(&white, BandChoice::Needed));
    assert_eq!((full.transfer.bands, few.transfer.bands), (5, 1), "a white light reaches one band");
    assert!(unlike(&full, &few, &white) <= TOLERANCE, "and nothing is missed: {}", unlike(&full, &few, &white));
    assert!(unlike(&full, &few, &sky) > 10.0 * TOLERANCE, "under a sky it would be: {}", unlike(&full, &few, &sky));
    let lit = baked(&scene, &settings(&sky, BandChoice::Needed));
    assert!(lit.transfer.bands > 1 && unlike(&full, &lit, &sky) <= TOLERANCE, "{} bands", lit.transfer.bands);
    let saved = few.achieved.effects.iter().find(|cost| cost.effect == Effect::Bands).expect("accounted").saved_bytes;
    assert_eq!(saved, 3 * 24 * 4 * few.plan.receivers, "25 coefficients became one, in three channels");
}

/// The fourth band of an unshadowed diffuse receiver is zero, the fifth is not: whatever the light.
#[test]
fn an_empty_band_is_left_out() {
    let settings = |bands| Settings { bands, band_choice: BandChoice::Needed, ..cheap() };
    assert_eq!(baked(&known("sphere"), &settings(4)).transfer.bands, 3);
    assert_eq!(baked(&known("sphere"), &settings(5)).transfer.bands, 5, "can fail");
    let four = baked(&known("sphere"), &Settings { bands: 4, ..cheap() });
    assert!(difference(&four, &baked(&known("sphere"), &settings(4))) < 1e-6);
}

/// What moves is named and not simulated; what stands still is not named.
#[test]
fn moving_objects_are_named() {
    let mut scene = known("plane");
    scene.moving = vec!["door".into()];
    let moving = row(&with(&scene, Effects::All).plan, Effect::Motion);
    assert!(!moving.simulate && moving.called_for_by == ["door"] && moving.decision.contains("at rest"), "{moving:?}");
    assert!(row(&with(&known("plane"), Effects::Auto).plan, Effect::Motion).called_for_by.is_empty());
}

/// Every row says why, what is at stake, and, where the scene calls for it, who does.
#[test]
fn rows_tell_who_and_why() {
    for (name, scene) in scenes().into_iter().take(scene::BUILTINS.len()) {
        let plan = bake::plan(&scene, &cheap()).expect("a good scene");
        assert_eq!(plan.rows.iter().map(|row| row.effect).collect::<Vec<_>>(), Effect::ALL, "{name}");
        for row in &plan.rows {
            assert!(!row.decision.is_empty() && !row.reason.is_empty() && !row.at_stake.is_empty(), "{name}: {row:?}");
            let named = row.effect == Effect::Bands || !row.simulate || row.callers > 0;
            assert!(named && row.called_for_by.len() as u64 <= row.callers, "{name}: {row:?}");
        }
        let count = |of: fn(&coeff_io::MeshPlan) -> u64| plan.meshes.iter().map(of).sum::<u64>();
        assert_eq!(count(|m| m.receivers), plan.receivers, "{name}: every receiver is of one mesh");
        assert_eq!(count(|m| m.shadowed), plan.shadowed_receivers, "{name}");
    }
}

/// A scene that calls for an effect gets it, within the tolerance of all; a list without it is seen to differ.
fn skipping_is_seen(scene: &Scene, effect: Effect, decision: &str) {
    let auto = with(scene, Effects::Auto);
    let decided = row(&auto.plan, effect);
    assert!(decided.simulate && decided.decision.contains(decision), "{decided:?}");
    let off = difference(&auto, &with(scene, Effects::All));
    assert!(off <= TOLERANCE, "{effect:?}: auto is {off} off");
    let skipped = without(scene, effect);
    assert!(!row(&skipped.plan, effect).simulate && row(&skipped.plan, effect).reason.contains("--effects"));
    let missed = difference(&skipped, &auto);
    assert!(missed > 4.0 * TOLERANCE, "{effect:?}: skipped wrongly, yet only {missed} is missed");
}

/// The same for what is drawn: pictures under a sky. Where nothing calls for gloss by direction, it is in neither.
fn skipping_is_drawn(scene: &Scene, effect: Effect) {
    let auto = with(scene, Effects::Auto);
    assert!(row(&auto.plan, effect).simulate, "{:?}", row(&auto.plan, effect));
    let glossy = row(&auto.plan, Effect::Glossy).simulate;
    let all = if glossy { with(scene, Effects::All) } else { without(scene, Effect::Glossy) };
    let off = unlike_pictures(&auto, &all);
    assert!(off <= TOLERANCE, "{effect:?}: auto is {off} off");
    let missed = unlike_pictures(&auto, &without(scene, effect));
    assert!(missed > 4.0 * TOLERANCE, "{effect:?}: skipped wrongly, yet only {missed} is missed");
}

fn unlike_pictures(a: &Prt, b: &Prt) -> f64 {
    let sky = probe_io::builtin("sky").expect("built in");
    let [a, b] = [a, b].map(|prt| {
        let frame = render_cpu::Frame::plain(prt.cameras[0].clone(), 48, 32);
        render_cpu::render(prt, &sky, &frame).expect("a picture").linear
    });
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    let mean = a.as_flattened().iter().map(|&v| f64::from(v)).sum::<f64>() / (3.0 * a.len() as f64);
    pairs.map(|(x, y)| f64::from((x - y).abs())).fold(0.0, f64::max) / mean
}

/// Everything but one effect, and colour, which needs bounces.
fn without(scene: &Scene, effect: Effect) -> Prt {
    let gone = |e: &Effect| match effect {
        Effect::Visibility => [effect, Effect::Interreflection, Effect::Color].contains(e),
        Effect::Interreflection => [effect, Effect::Color].contains(e),
        _ => *e == effect,
    };
    with(scene, Effects::Only(Effect::ALL.into_iter().filter(|e| !gone(e)).collect()))
}

fn row(plan: &Plan, effect: Effect) -> PlanRow {
    plan.rows.iter().find(|row| row.effect == effect).expect("a row per effect").clone()
}

fn known(name: &str) -> Scene {
    scene::builtin(name).expect("a known scene")
}

fn slot() -> Option<TextureSlot> {
    Some(TextureSlot { texture: 0, uv_set: 0, transform: Affine2::IDENTITY })
}

/// Texture 0, and coordinates and tangents over the first mesh.
fn textured(scene: &mut Scene, texels: &[[u8; 4]]) {
    let wrap = [Wrap::Clamp; 2];
    scene.textures =
        vec![Texture { rgba: texels.to_vec(), width: texels.len() as u32, wrap, ..Texture::white("texels") }];
    let mesh = &mut scene.meshes[0];
    mesh.uv0 = mesh.positions.iter().map(|p| Vec2::new(p.x, p.z) / 4.0 + 0.5).collect();
    mesh.tangents = vec![Vec4::new(1.0, 0.0, 0.0, 1.0); mesh.positions.len()];
}

/// The plane of the known scene under a sheet of half its size, 1 m above, which has texture 0 and an alpha mask.
fn under_a_sheet(texels: &[[u8; 4]]) -> Scene {
    let mut scene = known("plane");
    textured(&mut scene, texels);
    let mut sheet = scene.meshes[0].clone();
    sheet.positions.iter_mut().for_each(|p| *p = Vec3::new(0.5 * p.x, 1.0, 0.5 * p.z));
    sheet.material = 1;
    sheet.name = "sheet".into();
    scene.meshes.push(sheet);
    scene.materials.push(Material {
        name: "sheet".into(),
        alpha: AlphaMode::Mask(0.5),
        base_color_texture: slot(),
        double_sided: true,
        ..Material::default()
    });
    scene
}

/// Norms of the bands of a light.
fn norms(light: &Environment) -> Vec<f32> {
    let bands = Bands::new(5).expect("in range");
    let light = sh_math::project(bands, light.samples());
    let norm = |l: usize| {
        let band = &light.values[l * l..(l + 1) * (l + 1)];
        (0..3).map(|c| band.iter().map(|v| v[c] * v[c]).sum::<f32>().sqrt()).fold(0.0, f32::max)
    };
    bands.degrees().map(norm).collect()
}

/// Largest difference of the radiance at albedo 1 over receivers, against an open receiver under the light's mean.
fn unlike(a: &Prt, b: &Prt, light: &Environment) -> f64 {
    let light = sh_math::project(Bands::new(5).expect("in range"), light.samples());
    let radiance = |prt: &Prt, vertex: usize, c: usize| {
        let (n, channels) = ((prt.transfer.bands as usize).pow(2), prt.transfer.channels as usize);
        let term = |i: usize| {
            let value = prt.transfer.values[(vertex * n + i) * channels + c.min(channels - 1)];
            f64::from(value) * f64::from(light.values[i][c])
        };
        (0..n).map(term).sum::<f64>()
    };
    // Y00 times the constant coefficient.
    let mean = (0..3).map(|c| f64::from(light.values[0][c])).fold(0.0, f64::max) * 0.282_094_791_773_878;
    let vertices = 0..a.geometry.positions.len();
    let off = vertices.flat_map(|v| (0..3).map(move |c| (v, c))).map(|(v, c)| radiance(a, v, c) - radiance(b, v, c));
    off.map(f64::abs).fold(0.0, f64::max) / mean
}
