//! Light maps against closed forms, sums over directions and the vertices of the same bake.

mod support;

use bake::{Extras, FixedLight, MapSettings, SheetSettings};
use coeff_io::{MapLight, Maps, Prt, Sampler, Settings};
use glam::{DVec3, Vec3};
use scene::Scene;
use scene::lightmap::{Density, Unwrap, seams, texels, unwrap};
use sh_math::hemisphere::Basis;
use sh_math::{Bands, zonal};
use std::ops::ControlFlow;
use support::{fixed, grey};

/// Gives all meshes coordinates in one sheet of `side` columns.
fn unwrapped(mut scene: Scene, side: u32) -> (Scene, SheetSettings) {
    let meshes: Vec<usize> = (0..scene.meshes.len()).collect();
    let atlas = unwrap(&mut scene, &meshes, &Unwrap { density: Density::Side(side), padding: 2 }, &|_, _, _| {})
        .expect("it can be unwrapped");
    (scene, SheetSettings { meshes, width: atlas.width, height: atlas.height, directional: true })
}

fn settings(basis: Basis, sheet: &SheetSettings) -> MapSettings {
    MapSettings { basis, sheets: vec![sheet.clone()], stitch: true, dilation: 2, encoding: coeff_io::Encoding::F32 }
}

fn baked(scene: &Scene, settings: &Settings, maps: MapSettings, light: Option<FixedLight>) -> Prt {
    let extras = Extras { maps: Some(maps), light, ..Extras::default() };
    bake::bake_with(scene, settings, &extras, &|_| ControlFlow::Continue(())).expect("it bakes")
}

fn maps(prt: &Prt) -> &Maps {
    prt.maps.as_ref().expect("maps were asked for")
}

/// A light with something in every coefficient.
fn uneven(bands: u32) -> Vec<[f32; 3]> {
    (0..bands * bands)
        .map(|i| if i == 0 { [3.0, 2.5, 2.0] } else { [1, 2, 3].map(|c| ((i * 7 + c * 5) % 11) as f32 / 11.0 - 0.5) })
        .collect()
}

fn white(bands: u32) -> Vec<[f32; 3]> {
    let mut light = vec![[0.0; 3]; (bands * bands) as usize];
    light[0] = [(4.0 * std::f32::consts::PI).sqrt(); 3];
    light
}

fn fixed_light(coefficients: Vec<[f32; 3]>) -> FixedLight {
    FixedLight { name: "test".into(), coefficients }
}

/// The signal of each covered texel at a normal of the map.
fn at(prt: &Prt, scene: &Scene, sheet: &SheetSettings, light: &[[f32; 3]], normal: Vec3) -> Vec<[f32; 3]> {
    let maps = maps(prt);
    let lit = maps.sheets[0].lit(maps, light);
    let touched = texels(scene, &sheet.meshes, sheet.width, sheet.height);
    let value = |texel: &scene::lightmap::Texel| {
        let place = (texel.row * sheet.width + texel.column) as usize;
        let coefficients: Vec<[f32; 3]> = lit.functions.iter().map(|function| function[place]).collect();
        maps.basis.reconstruct(&coefficients, normal)
    };
    touched.iter().map(value).collect()
}

fn largest(values: &[[f32; 3]], expected: f32) -> f32 {
    values.iter().flatten().fold(0.0, |worst: f32, value| worst.max((value - expected).abs()))
}

/// Albedo 1, light for ever: 1 at every texel, whether the light is baked in or put on later. The gap under the columns is not reached.
#[test]
fn nothing_is_lost() {
    let (scene, sheet) = unwrapped(grey("bowl", 1.0), 48);
    let asked = fixed(3, Sampler::OwenSobol, 256, 90);
    for light in [None, Some(fixed_light(white(3)))] {
        let prt = baked(&scene, &asked, settings(Basis::ModifiedH1, &sheet), light.clone());
        let worst = largest(&at(&prt, &scene, &sheet, &white(3), Vec3::Z), 1.0);
        assert!(worst < 3e-3, "fixed {}: {worst}", light.is_some());
        let few = Settings { bounces: coeff_io::Bounces::Fixed(1), ..asked.clone() };
        let prt = baked(&scene, &few, settings(Basis::ModifiedH1, &sheet), light);
        let worst = largest(&at(&prt, &scene, &sheet, &white(3), Vec3::Z), 1.0);
        assert!(worst > 0.05, "one bounce must be seen to lose light: {worst}");
    }
}

/// An open plane under an uneven light: what it takes for any normal is the sum over the sky of radiance's coefficients, each times the
/// factor of the cosine, by a rule that shares nothing with triple products or rays.
#[test]
fn an_open_plane_takes_the_sky() {
    let (scene, sheet) = unwrapped(grey("plane", 0.5), 16);
    let (light, bands) = (uneven(4), Bands::new(3).unwrap());
    let prt = baked(&scene, &fixed(4, Sampler::OwenSobol, 64, 0), settings(Basis::Sh9, &sheet), None);
    assert_eq!(prt.achieved.visibility_rays, 0, "nothing stands above a plane");
    let frame = sampling::frame::Frame::from_normal(Vec3::Y);
    let sky = |direction: DVec3| -> [f64; 3] {
        let mut functions = [0.0; 16];
        sh_math::evaluate_f64(Bands::new(4).unwrap(), direction, &mut functions);
        [0, 1, 2].map(|c| light.iter().zip(functions).map(|(l, f)| f64::from(l[c]) * f).sum())
    };
    let points = testkit::quadrature::band_quadrature(0.0, 1.0, 12);
    let samples = points.into_iter().map(|(d, weight)| {
        let local = DVec3::from(d);
        (local, sky(frame.to_world(local.as_vec3()).as_dvec3()).map(|value| value * weight))
    });
    let radiance = sh_math::project(bands, samples);
    let irradiance = radiance.windowed(&[0, 1, 2].map(zonal::clamped_cosine));
    for normal in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.48, 0.6, 0.64)] {
        let expected = irradiance.reconstruct(normal);
        let got = at(&prt, &scene, &sheet, &light, normal);
        let worst = |expected: [f32; 3]| {
            got.iter().flat_map(|value| value.iter().zip(expected).map(|(a, b)| (a - b).abs())).fold(0.0, f32::max)
        };
        assert!(worst(expected) < 1e-4, "{normal}: {} against {expected:?}", worst(expected));
        let whole = sh_math::Rgb { bands, values: light[..9].to_vec() }.windowed(&[0, 1, 2].map(zonal::clamped_cosine));
        assert!(worst(whole.reconstruct(normal)) > 0.02, "the light from below must be missing");
    }
}

/// Under a wall that hides half of the sky, texels take what the vertices of the same surface take.
#[test]
fn texels_agree_with_vertices() {
    let (scene, sheet) = unwrapped(grey("atrium", 0.6), 256);
    let light = uneven(3);
    let asked = Settings { quality: coeff_io::Quality::Error(0.01), ..fixed(3, Sampler::OwenSobol, 1, 2) };
    let prt = baked(&scene, &asked, settings(Basis::ModifiedH1, &sheet), Some(fixed_light(light.clone())));
    let values = at(&prt, &scene, &sheet, &light, Vec3::Z);
    let mut differences: Vec<f32> = Vec::new();
    let row = 9 * prt.transfer.channels as usize;
    for (texel, value) in texels(&scene, &sheet.meshes, sheet.width, sheet.height).iter().zip(values) {
        // Close to a vertex, or interpolation would be judged.
        let [u, v] = texel.barycentrics;
        let Some(corner) = [1.0 - u - v, u, v].iter().position(|&share| share > 0.93) else { continue };
        let mesh = &prt.meshes[texel.mesh as usize];
        let vertex = mesh.first_vertex + scene.meshes[texel.mesh as usize].triangles[texel.triangle as usize][corner];
        let transfer = &prt.transfer.values[vertex as usize * row..][..row];
        let c = prt.transfer.channels as usize;
        let radiance =
            |channel: usize| -> f32 { (0..9).map(|i| transfer[i * c + channel.min(c - 1)] * light[i][channel]).sum() };
        differences.push((value[1] - radiance(1)).abs());
    }
    differences.sort_by(f32::total_cmp);
    let middle = differences[differences.len() / 2];
    assert!(differences.len() > 50, "{} texels at vertices", differences.len());
    assert!(middle < 0.02, "median difference {middle}");
}

/// As many bounces as were asked for: in a bowl of albedo 0.9 each is told from the next, texel by texel near vertices.
#[test]
fn bounces_are_counted() {
    let (scene, sheet) = unwrapped(grey("bowl", 0.9), 48);
    let radiance = |bounces: u32| {
        let asked = Settings { quality: coeff_io::Quality::Error(0.01), ..fixed(3, Sampler::OwenSobol, 1, bounces) };
        let prt = baked(&scene, &asked, settings(Basis::ModifiedH1, &sheet), None);
        let of_texels = at(&prt, &scene, &sheet, &white(3), Vec3::Z);
        let mean = of_texels.iter().map(|value| f64::from(value[0])).sum::<f64>() / of_texels.len() as f64;
        // Without the albedo of the surface itself, as maps are.
        let vertices = support::under_white(&prt);
        (mean, vertices.iter().sum::<f64>() / vertices.len() as f64 / 0.9)
    };
    for bounces in [0, 1, 2] {
        let ((texels, vertices), (_, more)) = (radiance(bounces), radiance(bounces + 1));
        assert!((texels - vertices).abs() < 0.012, "{bounces}: texels {texels}, vertices {vertices}");
        assert!((texels - more).abs() > 0.03, "{bounces}: another bounce, {more}, must show");
    }
}

/// Step of the signal across the seam of a cylinder against steps inside, with few rays: stitched it is none; left alone it shows.
#[test]
fn seams_do_not_show() {
    let step = |stitched: bool| {
        let (scene, sheet) = cylinder();
        let maps_settings = MapSettings { stitch: stitched, ..settings(Basis::ModifiedH1, &sheet) };
        let light = uneven(3);
        let prt = baked(&scene, &fixed(3, Sampler::OwenSobol, 32, 0), maps_settings, Some(fixed_light(light.clone())));
        let maps = maps(&prt);
        let lit = maps.sheets[0].lit(maps, &light);
        let read = |u: f32, v: f32| bilinear(&lit.functions[0], sheet.width, sheet.height, u, v);
        let found = seams(&scene, &[0]);
        let across = found.iter().map(|seam| {
            let [a, b] = seam.sides.map(|side| side.ends[0].midpoint(side.ends[1]));
            (read(a.x, a.y) - read(b.x, b.y)).abs()
        });
        let across = across.fold(0.0, f32::max);
        let texel = 1.0 / sheet.width as f32;
        let inside = (4..sheet.width - 4).map(|k| {
            let u = k as f32 * texel;
            (read(u, 0.5) - read(u + texel, 0.5)).abs()
        });
        (across, inside.fold(0.0, f32::max), found.len())
    };
    let (across, inside, seams) = step(true);
    assert!(seams > 0 && across < 1.5 * inside, "{across} across {seams} seams, {inside} inside");
    let (apart, _, _) = step(false);
    assert!(apart > 4.0 * across, "left alone {apart}, stitched {across}");
}

/// An upright tube that stands in a box without a lid, cut at one angle: its sides see the walls.
fn cylinder() -> (Scene, SheetSettings) {
    let mut scene = grey("atrium", 0.5);
    let mut mesh = scene::Mesh::default();
    let quads = 24;
    for k in 0..=quads {
        let angle = std::f32::consts::TAU * (k % quads) as f32 / quads as f32;
        for y in [0.0f32, 1.0] {
            mesh.positions.push(Vec3::new(0.5 * angle.cos(), 1.0 + y, -0.5 * angle.sin()));
            mesh.normals.push(Vec3::new(angle.cos(), 0.0, -angle.sin()));
            mesh.uv1.push(glam::Vec2::new(0.08 + 0.84 * k as f32 / quads as f32, 0.2 + 0.6 * y));
        }
    }
    mesh.triangles =
        (0..quads).flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 1], [2 * k + 1, 2 * k + 2, 2 * k + 3]]).collect();
    scene.meshes.insert(0, mesh);
    (scene, SheetSettings { meshes: vec![0], width: 48, height: 16, directional: true })
}

/// The two halves of the tube as meshes in sheets of their own, of other sizes: the light goes on from one to the other.
#[test]
fn seams_between_sheets_do_not_show() {
    let (mut scene, whole) = cylinder();
    let tube = scene.meshes.remove(0);
    let half = tube.triangles.len() / 2;
    for (k, triangles) in [&tube.triangles[half..], &tube.triangles[..half]].into_iter().enumerate() {
        scene
            .meshes
            .insert(0, scene::Mesh { name: format!("half {k}"), triangles: triangles.to_vec(), ..tube.clone() });
    }
    let sheet = |mesh: usize, scale: u32| SheetSettings {
        meshes: vec![mesh],
        width: whole.width * scale,
        height: whole.height * scale,
        directional: true,
    };
    let sheets = vec![sheet(0, 1), sheet(1, 2)];
    let light = uneven(3);
    let largest = |stitch: bool| {
        let asked = MapSettings { sheets: sheets.clone(), stitch, ..settings(Basis::ModifiedH1, &whole) };
        let prt = baked(&scene, &fixed(3, Sampler::OwenSobol, 32, 0), asked, Some(fixed_light(light.clone())));
        let maps = maps(&prt);
        let lit: Vec<coeff_io::Lit> = maps.sheets.iter().map(|sheet| sheet.lit(maps, &light)).collect();
        let read = |side: &scene::lightmap::SeamSide| {
            let (lit, at) = (&lit[side.mesh as usize], side.ends[0].midpoint(side.ends[1]));
            bilinear(&lit.functions[0], lit.width, lit.height, at.x, at.y)
        };
        let between: Vec<f32> = seams(&scene, &[0, 1])
            .iter()
            .filter(|seam| seam.sides[0].mesh != seam.sides[1].mesh)
            .map(|seam| (read(&seam.sides[0]) - read(&seam.sides[1])).abs())
            .collect();
        assert!(between.len() >= 2, "{between:?}");
        between.into_iter().fold(0.0, f32::max)
    };
    let (stitched, apart) = (largest(true), largest(false));
    assert!(apart > 4.0 * stitched, "left alone {apart}, stitched {stitched}");
}

fn bilinear(texels: &[[f32; 3]], width: u32, height: u32, u: f32, v: f32) -> f32 {
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let get = |dx: u32, dy: u32| texels[((y0 as u32 + dy) * width + x0 as u32 + dx) as usize][1];
    let (fx, fy) = (x - x0, y - y0);
    (get(0, 0) * (1.0 - fx) + get(1, 0) * fx) * (1.0 - fy) + (get(0, 1) * (1.0 - fx) + get(1, 1) * fx) * fy
}

/// Transfer that is put under a light is the map that was baked for it.
#[test]
fn relit_equals_baked_in() {
    let (scene, sheet) = unwrapped(grey("cornell-box", 0.6), 48);
    let light = uneven(3);
    let asked = fixed(3, Sampler::OwenSobol, 256, 2);
    let relit = baked(&scene, &asked, settings(Basis::Hl2, &sheet), None);
    let lit = baked(&scene, &asked, settings(Basis::Hl2, &sheet), Some(fixed_light(light.clone())));
    assert!(matches!(maps(&relit).light, MapLight::Relightable { bands: 3 }));
    let normal = Vec3::new(0.36, -0.48, 0.8);
    let (a, b) = (at(&relit, &scene, &sheet, &light, normal), at(&lit, &scene, &sheet, &light, normal));
    let mean = a.iter().flatten().sum::<f32>() / (3 * a.len()) as f32;
    let difference = |b: &[[f32; 3]]| {
        let squares: f32 = a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| (x - y) * (x - y)).sum();
        (squares / (3 * a.len()) as f32).sqrt() / mean
    };
    // Three bands over normals against five.
    assert!(difference(&b) < 0.02, "{}", difference(&b));
    let other = at(&relit, &scene, &sheet, &white(3), normal);
    assert!(difference(&other) > 0.1, "another light must show: {}", difference(&other));
}

/// What bases are judged by, at the surface's own normal, is the ordinary light map of the same bake.
#[test]
fn harmonics_hold_the_light_map() {
    let (scene, sheet) = unwrapped(grey("cornell-box", 0.6), 40);
    let (asked, light) = (fixed(3, Sampler::OwenSobol, 128, 1), fixed_light(uneven(3)));
    let quiet = |_: &bake::Progress| ControlFlow::Continue(());
    let found = bake::directional(&scene, &asked, std::slice::from_ref(&sheet), &light, &quiet).expect("it bakes");
    let plain = MapSettings { stitch: false, ..settings(Basis::ModifiedH1, &sheet) };
    let prt = baked(&scene, &asked, plain, Some(light));
    let lit = maps(&prt).sheets[0].lit(maps(&prt), &[]);
    let worst = |normal: Vec3| {
        let mut harmonics = [0.0; 25];
        sh_math::evaluate(Bands::new(5).unwrap(), normal, &mut harmonics);
        let difference = |texel: &bake::DirectionalTexel| {
            let value: f32 = texel.coefficients.iter().zip(harmonics).map(|(c, y)| c[1] * y).sum();
            let map = lit.functions[0][(texel.place[0] * sheet.width + texel.place[1]) as usize];
            (value - Basis::ModifiedH1.reconstruct(&[map], Vec3::Z)[1]).abs()
        };
        found.texels.iter().map(difference).fold(0.0, f32::max)
    };
    assert!(found.texels.len() > 400 && found.rays > 10_000, "{} texels, {} rays", found.texels.len(), found.rays);
    assert!(worst(Vec3::Z) < 1e-4, "{}", worst(Vec3::Z));
    assert!(worst(Vec3::new(0.6, 0.0, 0.8)) > 0.1, "another normal must show");
}

#[test]
fn threads_do_not_matter() {
    let (scene, sheet) = unwrapped(grey("cornell-box", 0.6), 40);
    let asked = fixed(3, Sampler::OwenSobol, 64, 1);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| baked(&scene, &asked, settings(Basis::ModifiedH6, &sheet), None))
    };
    assert_eq!(on(1).maps, on(2).maps);
    let other = baked(&scene, &Settings { seed: 1, ..asked.clone() }, settings(Basis::ModifiedH6, &sheet), None);
    assert_ne!(on(1).maps, other.maps, "another seed must show");
}

/// What is foretold of the size is what the file takes, in three channels.
#[test]
fn sizes_are_foretold() {
    let (scene, sheet) = unwrapped(grey("cornell-box", 0.6), 48);
    let light = fixed_light(uneven(3));
    for encoding in [coeff_io::Encoding::F32, coeff_io::Encoding::F16, coeff_io::Encoding::Bc6h] {
        let asked = MapSettings { encoding, ..settings(Basis::H6, &sheet) };
        let foretold = asked.most_bytes(None);
        let prt = baked(&scene, &fixed(3, Sampler::OwenSobol, 16, 0), asked.clone(), Some(light.clone()));
        let taken = maps(&prt).sheets[0].layers.bytes.len() as u64;
        assert!(taken >= foretold && taken < foretold + foretold / 8, "{encoding:?}: {taken}, foretold {foretold}");
        assert_eq!(asked.most_bytes(Some(3)), 9 * foretold, "transfer has 9 numbers for each");
    }
}

#[test]
fn wrong_sheets_are_refused() {
    let (scene, sheet) = unwrapped(grey("plane", 0.5), 16);
    let refused = |sheet: SheetSettings, memory: u64| {
        let extras = Extras { maps: Some(settings(Basis::H4, &sheet)), ..Extras::default() };
        let asked = Settings { memory, ..fixed(3, Sampler::OwenSobol, 64, 0) };
        bake::bake_with(&scene, &asked, &extras, &|_| ControlFlow::Continue(())).expect_err("refused").to_string()
    };
    assert!(refused(SheetSettings { width: 0, ..sheet.clone() }, 1 << 30).contains("texels"));
    assert!(refused(SheetSettings { meshes: vec![0, 0], ..sheet.clone() }, 1 << 30).contains("one sheet"));
    assert!(refused(SheetSettings { meshes: vec![9], ..sheet.clone() }, 1 << 30).contains("mesh 9"));
    assert!(refused(sheet, 20_000).contains("memory"));
}
