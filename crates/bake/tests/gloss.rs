//! Gloss and transfer textures against closed forms, sums over directions, and each other.

mod support;

use bake::{Compression, Extras, FixedLight, SheetSettings, TextureSettings};
use coeff_io::{ArrivingLight, Bounced, Effect, Effects, Prt, Sampler, Settings};
use glam::{DVec3, Vec2, Vec3, Vec4};
use scene::lightmap::{Density, Unwrap, unwrap};
use scene::{Material, Mesh, Scene};
use sh_math::light_matrix::LightProduct;
use sh_math::{Bands, Rgb, zonal};
use std::ops::ControlFlow;
use support::{fixed, grey};
use testkit::quadrature::sphere_quadrature;

/// All that light does here but masks and the like.
fn with_gloss(settings: Settings) -> Settings {
    let effects = [
        Effect::Visibility,
        Effect::Interreflection,
        Effect::Color,
        Effect::Specular,
        Effect::Glossy,
        Effect::NormalMaps,
    ];
    Settings { effects: Effects::Only(effects.to_vec()), ..settings }
}

fn baked(scene: &Scene, settings: &Settings, extras: &Extras) -> Prt {
    bake::bake_with(scene, settings, extras, &|_| ControlFlow::Continue(())).expect("it bakes")
}

fn metal() -> Material {
    Material { name: "metal".into(), metallic: 1.0, roughness: 0.4, ..Material::default() }
}

/// A scene with a small square that shines, about `at` and facing up.
fn with_patch(mut scene: Scene, at: Vec3, half: f32) -> (Scene, usize) {
    let corner = |x: f32, z: f32| at + half * Vec3::new(x, 0.0, z);
    let mesh = Mesh {
        name: "patch".into(),
        material: scene.materials.len() as u32,
        positions: vec![corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)],
        normals: vec![Vec3::Y; 4],
        uv1: vec![Vec2::new(0.1, 0.9), Vec2::new(0.9, 0.9), Vec2::new(0.9, 0.1), Vec2::new(0.1, 0.1)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    scene.materials.push(metal());
    scene.meshes.push(mesh);
    (scene.clone(), scene.meshes.len() - 1)
}

fn light(values: Vec<[f32; 3]>) -> Rgb {
    let bands = Bands::new((values.len() as f64).sqrt() as u32).unwrap();
    Rgb { bands, values }
}

fn white(bands: u32) -> Rgb {
    let mut values = vec![[0.0; 3]; (bands * bands) as usize];
    values[0] = [(4.0 * std::f32::consts::PI).sqrt(); 3];
    light(values)
}

/// A light with something in every coefficient.
fn uneven(bands: u32) -> Rgb {
    let value = |i: u32| match i {
        0 => [3.0, 2.5, 2.0],
        i => [1, 2, 3].map(|c| ((i * 7 + c * 5) % 11) as f32 / 11.0 - 0.5),
    };
    light((0..bands * bands).map(value).collect())
}

/// What arrives at the first vertex of a mesh: RGB and visibility per coefficient.
fn arriving(prt: &Prt, mesh: usize, light: &Rgb) -> Vec<[f32; 4]> {
    let gloss = prt.gloss.as_ref().expect("gloss was asked for");
    let product = LightProduct::new(Bands::new(gloss.bands).unwrap());
    let lit = ArrivingLight::new(prt, &product, light).unwrap();
    let vertices = gloss.vertices.as_ref().expect("at vertices");
    let mut out = vec![[0.0; 4]; (gloss.bands * gloss.bands) as usize];
    lit.read(prt, &vertices.arriving, vertices.first_row[mesh].expect("the mesh shines"), &mut out);
    out
}

/// Coefficients of a function of direction, by a sum over the sphere.
fn projected(bands: u32, function: impl Fn(DVec3) -> f64) -> Vec<f64> {
    let bands = Bands::new(bands).unwrap();
    let (mut sums, mut values) = (vec![0.0; bands.coefficients()], vec![0.0; bands.coefficients()]);
    for (direction, weight) in sphere_quadrature(500) {
        let direction = DVec3::from(direction);
        sh_math::evaluate_f64(bands, direction, &mut values);
        let value = weight * function(direction);
        sums.iter_mut().zip(&values).for_each(|(sum, y)| *sum += value * y);
    }
    sums
}

fn difference(found: impl Iterator<Item = f32>, exact: &[f64]) -> f64 {
    found.zip(exact).map(|(a, b)| (f64::from(a) - b).powi(2)).sum::<f64>().sqrt()
}

/// Nothing in the way: the hemisphere, exactly; and no rays.
#[test]
fn an_open_mirror_sees_its_hemisphere() {
    let (scene, mesh) = with_patch(grey("sphere", 0.5), Vec3::new(0.0, 5.0, 0.0), 0.5);
    let prt = baked(&scene, &with_gloss(fixed(5, Sampler::OwenSobol, 64, 1)), &Extras::default());
    let seen = arriving(&prt, mesh, &white(9));
    let mut exact = vec![0.0f32; 25];
    zonal::hemisphere_mean(Bands::new(5).unwrap(), Vec3::Y, &mut exact);
    let exact: Vec<f64> = exact.iter().map(|x| f64::from(*x) * 2.0 * std::f64::consts::PI).collect();
    assert!(difference(seen.iter().map(|u| u[3]), &exact) < 2e-3, "half precision");
    assert!(difference(seen.iter().map(|u| u[0]), &exact) < 2e-3, "a white light changes nothing");
    let other: Vec<f64> = exact.iter().rev().copied().collect();
    assert!(difference(seen.iter().map(|u| u[3]), &other) > 0.5, "can fail");
}

/// A wall of 40 m fills all directions to one side of a point beside it, but for the strip above it: visibility against a sum over the wedge.
#[test]
fn a_wall_hides_the_directions_that_it_fills() {
    let at = Vec3::new(1.0, 0.0, 0.0);
    let (scene, mesh) = with_patch(grey("half-blocked-plane", 0.0), at + 0.01 * Vec3::Y, 0.02);
    let prt = baked(&scene, &with_gloss(fixed(5, Sampler::OwenSobol, 4096, 1)), &Extras::default());
    let seen = arriving(&prt, mesh, &white(9));
    // From the first corner of the patch, (0.98, 0.01, 0.02); the wall spans 60 m to both sides.
    let open = |d: DVec3| {
        let t = -0.98 / d.x;
        let blocked = d.x < 0.0 && d.y * t + 0.01 < 40.0 && (d.z * t).abs() < 60.0;
        if d.y > 0.0 && !blocked { 1.0 } else { 0.0 }
    };
    let exact = projected(5, open);
    let error = difference(seen.iter().map(|u| u[3]), &exact);
    assert!(error < 0.02, "{error}");
    let all = projected(5, |d| if d.y > 0.0 { 1.0 } else { 0.0 });
    assert!(difference(seen.iter().map(|u| u[3]), &all) > 0.5, "can fail");
}

/// In a bowl that is half an integrating sphere all of it has one radiance, so what it sends to a mirror inside is that radiance times what
/// is not open: for every coefficient.
#[test]
fn what_hides_the_sky_sends_its_own_light() {
    // Small, and off the middle of the bottom, so that the bowl hardly notices.
    let (scene, mesh) = with_patch(scene::builtin("bowl").unwrap(), Vec3::new(0.1, -0.8, 0.0), 0.002);
    let bounces = 12;
    let prt = baked(&scene, &with_gloss(fixed(5, Sampler::OwenSobol, 4096, bounces)), &Extras::default());
    let seen = arriving(&prt, mesh, &white(9));
    let mut hemisphere = vec![0.0f32; 25];
    zonal::hemisphere_mean(Bands::new(5).unwrap(), Vec3::Y, &mut hemisphere);
    let radiance = scene::known::bowl_radiance(bounces - 1);
    let exact: Vec<f64> = hemisphere
        .iter()
        .zip(&seen)
        .map(|(h, u)| {
            let (all, open) = (f64::from(*h) * 2.0 * std::f64::consts::PI, f64::from(u[3]));
            open + radiance * (all - open)
        })
        .collect();
    let error = difference(seen.iter().map(|u| u[0]), &exact);
    assert!(error < 0.02, "{error}");
    assert!(difference(seen.iter().map(|u| u[3]), &exact) > 0.3, "without what the bowl sends it would show");
}

/// The paper's tables, one per bounce under one light, sum to what can be relit under that light: two paths through the code.
#[test]
fn fixed_bounces_sum_to_the_relightable_ones() {
    let (scene, mesh) = with_patch(scene::builtin("bowl").unwrap(), Vec3::new(0.1, -0.8, 0.0), 0.05);
    let settings = with_gloss(fixed(4, Sampler::OwenSobol, 512, 6));
    let light = uneven(7);
    let relit = arriving(&baked(&scene, &settings, &Extras::default()), mesh, &light);
    let fixed_light = FixedLight { name: "test".into(), coefficients: light.values.clone() };
    let extras = Extras { light: Some(fixed_light), ..Extras::default() };
    let prt = baked(&scene, &settings, &extras);
    let Some(Bounced::Fixed { materials, bounces, .. }) = prt.gloss.as_ref().unwrap().bounced.clone() else {
        panic!("bounces are fixed")
    };
    assert_eq!((materials, bounces), (prt.materials_mark(), 4), "six bounces, the last table holds the rest");
    let held = arriving(&prt, mesh, &light);
    let worst = relit.iter().zip(&held).flat_map(|(a, b)| (0..4).map(|c| (a[c] - b[c]).abs())).fold(0.0, f32::max);
    let largest = relit.iter().flatten().fold(0.0f32, |most, x| most.max(x.abs()));
    assert!(worst < 0.02 * largest, "{worst} of {largest}");
    let mut first = prt.clone();
    let rows = &mut first.gloss.as_mut().unwrap().vertices.as_mut().unwrap().arriving.bounces;
    rows.truncate(1);
    let first = arriving(&first, mesh, &light);
    let gap = relit.iter().zip(&first).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f32::max);
    assert!(gap > 0.03 * largest, "the further bounces must show: {gap} of {largest}");
}

fn texture(meshes: Vec<usize>, side: u32) -> TextureSettings {
    let sheets = vec![SheetSettings { meshes, width: side, height: side, directional: false }];
    TextureSettings { sheets, dilation: 2, levels: true, bent: true, stitch: true }
}

/// Largest difference of the texels of a flat mesh that is open to the sky from the clamped cosine about a normal.
fn worst_texel(prt: &Prt, normal: Vec3) -> f32 {
    let level = &prt.transfer_textures.as_ref().unwrap().sheets[0].levels[0];
    let mut exact = vec![0.0; 25];
    zonal::cosine_transfer(Bands::new(5).unwrap(), normal, &mut exact);
    let values = level.diffuse.decode(prt.codebooks.diffuse.as_ref());
    let channels = prt.transfer_textures.as_ref().unwrap().channels as usize;
    let of_texel =
        |row: &[f32]| row.chunks_exact(channels).zip(&exact).map(|(v, e)| (v[0] - e).abs()).fold(0.0, f32::max);
    values.chunks_exact(25 * channels).map(of_texel).fold(0.0, f32::max)
}

/// A texel holds what a vertex there would, in every level, but for what five bands over normals miss of the cosine: 0.0014 of 0.33.
#[test]
fn open_texels_hold_the_clamped_cosine() {
    let (scene, mesh) = with_patch(grey("sphere", 0.5), Vec3::new(0.0, 5.0, 0.0), 0.5);
    let extras = Extras { textures: Some(texture(vec![mesh], 32)), ..Extras::default() };
    let prt = baked(&scene, &with_gloss(fixed(5, Sampler::OwenSobol, 64, 0)), &extras);
    assert!(worst_texel(&prt, Vec3::Y) < 2e-3, "{}", worst_texel(&prt, Vec3::Y));
    assert!(worst_texel(&prt, Vec3::new(0.2, 0.98, 0.0).normalize()) > 0.03, "another normal must show");
    let sheet = &prt.transfer_textures.as_ref().unwrap().sheets[0];
    let sides: Vec<u32> = sheet.levels.iter().map(|level| level.width).collect();
    assert_eq!(sides, [32, 16, 8, 4]);
    assert!(prt.gloss.as_ref().unwrap().vertices.is_none(), "the only mesh that shines lies on a sheet");
    assert!(sheet.levels[3].arriving.is_some());
}

/// A normal map turns what texels are lit about; without it they are lit about the surface's own normal (\[T\] section 6.2).
#[test]
fn normal_maps_are_in_the_transfer() {
    let (mut scene, mesh) = with_patch(grey("sphere", 0.5), Vec3::new(0.0, 5.0, 0.0), 0.5);
    // x = 0.6, z = 0.8 everywhere.
    let texel = [204, 128, 230, 255];
    scene.textures.push(scene::Texture { rgba: vec![texel], width: 1, height: 1, ..scene::Texture::white("bent") });
    let slot =
        scene::TextureSlot { texture: scene.textures.len() as u32 - 1, uv_set: 1, transform: glam::Affine2::IDENTITY };
    let material = scene.meshes[mesh].material as usize;
    scene.materials[material].normal_texture = Some(slot);
    scene.meshes[mesh].tangents = vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4];
    let bent = scene.bent_normal(mesh, 0, 0.2, 0.2);
    assert!(bent.distance(Vec3::new(0.6, 0.8, 0.0)) < 0.01, "{bent}");
    let settings = with_gloss(fixed(5, Sampler::OwenSobol, 64, 0));
    // The part of the cosine below the plane of the surface is hidden by it.
    let with = Extras { textures: Some(texture(vec![mesh], 16)), ..Extras::default() };
    let without = TextureSettings { bent: false, ..texture(vec![mesh], 16) };
    let without = Extras { textures: Some(without), ..Extras::default() };
    let exact = projected(5, |d| if d.y > 0.0 { d.dot(bent.as_dvec3()).max(0.0) / std::f64::consts::PI } else { 0.0 });
    let row = |prt: &Prt| {
        let level = &prt.transfer_textures.as_ref().unwrap().sheets[0].levels[0];
        let mut row = vec![0.0; level.diffuse.columns as usize];
        level.diffuse.read(None, 5, &mut row);
        row
    };
    let channels = |row: &[f32]| row.len() / 25;
    let first = |row: Vec<f32>| row.iter().step_by(channels(&row)).copied().collect::<Vec<f32>>();
    let bent_row = first(row(&baked(&scene, &settings, &with)));
    let plain_row = first(row(&baked(&scene, &settings, &without)));
    // The cosine is kept in five bands over normals.
    assert!(difference(bent_row.iter().copied(), &exact) < 0.02, "{}", difference(bent_row.iter().copied(), &exact));
    assert!(difference(plain_row.iter().copied(), &exact) > 0.1, "can fail");
}

/// Texels of a curved body in a shadowed place hold what the vertices of the same bake hold there.
#[test]
fn texels_agree_with_vertices() {
    let mut scene = grey("sphere-on-plane", 0.6);
    let ball = scene.meshes.iter().position(|mesh| mesh.name.contains("ball") || mesh.name.contains("sphere")).unwrap();
    let options = Unwrap { density: Density::Side(64), padding: 2 };
    let atlas = unwrap(&mut scene, &[ball], &options, &|_, _, _| {}).unwrap();
    let sheets =
        vec![SheetSettings { meshes: vec![ball], width: atlas.width, height: atlas.height, directional: false }];
    let textures = TextureSettings { sheets, ..texture(vec![ball], 64) };
    let extras = Extras { textures: Some(textures), ..Extras::default() };
    let prt = baked(&scene, &fixed(5, Sampler::OwenSobol, 1024, 2), &extras);
    let level = &prt.transfer_textures.as_ref().unwrap().sheets[0].levels[0];
    let mesh = &prt.meshes[ball];
    let values = level.diffuse.decode(None);
    let white = (4.0 * std::f32::consts::PI).sqrt();
    let (mut sum, mut count) = (0.0f64, 0);
    for vertex in mesh.first_vertex..mesh.first_vertex + mesh.vertices {
        let uv = prt.geometry.uv1[vertex as usize];
        let place = (uv[1] * level.height as f32) as u32 * level.width + (uv[0] * level.width as f32) as u32;
        if let Ok(row) = level.places.binary_search(&place) {
            let texel = values[row * 25] * white;
            sum += f64::from((texel - prt.transfer.values[vertex as usize * 25] * white).abs());
            count += 1;
        }
    }
    let mean = sum / f64::from(count);
    assert!(count > 100 && mean < 0.02, "{count} vertices, off by {mean} on average");
    assert!(prt.gloss.is_none(), "nothing shines here");
}

/// What no scene calls for costs nothing.
#[test]
fn a_matt_scene_holds_no_gloss() {
    let prt = baked(&grey("cornell-box", 0.5), &fixed(3, Sampler::OwenSobol, 32, 1), &Extras::default());
    assert!(prt.gloss.is_none() && prt.achieved.gloss.is_none() && prt.codebooks.all().count() == 0);
    let row = prt.plan.rows.iter().find(|row| row.effect == Effect::Glossy).unwrap();
    assert!(!row.simulate && row.rays == 0);
    let shiny = baked(
        &with_patch(grey("cornell-box", 0.5), Vec3::new(0.0, 0.1, 0.0), 0.05).0,
        &fixed(3, Sampler::OwenSobol, 32, 1),
        &Extras::default(),
    );
    assert!(shiny.gloss.is_some(), "can fail: metal that is half hidden calls for it by itself");
}

/// The same bits for any number of threads.
#[test]
fn threads_change_nothing() {
    let (scene, mesh) = with_patch(scene::builtin("bowl").unwrap(), Vec3::new(0.1, -0.8, 0.0), 0.05);
    let textures = Some(texture(vec![mesh], 16));
    let extras = Extras { textures, compression: Compression { rows: Some(0.05), bounces: 0.05 }, ..Extras::default() };
    let settings = with_gloss(fixed(3, Sampler::OwenSobol, 64, 2));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| baked(&scene, &settings, &extras).to_bytes().unwrap())
    };
    assert!(on(1) == on(2) && on(2) == on(3));
}

/// Metal that has its colour from its vertices sends on each channel by itself.
#[test]
fn vertex_colors_tint_what_is_mirrored() {
    let channels = |tint: Vec3| {
        let (mut scene, mesh) = with_patch(grey("cornell-box", 0.5), Vec3::new(0.0, 0.1, 0.0), 0.05);
        scene.meshes[mesh].colors = vec![tint.extend(1.0); 4];
        baked(&scene, &with_gloss(fixed(2, Sampler::OwenSobol, 16, 1)), &Extras::default()).plan.channels
    };
    assert_eq!(channels(Vec3::new(1.0, 0.8, 0.3)), 3);
    assert_eq!(channels(Vec3::splat(0.5)), 1, "can fail: grey needs one");
}

/// A sheet of metal that runs deep into a closed block: what is buried shows what its neighbours see, not the dark inside.
#[test]
fn buried_vertices_are_mended() {
    let mut scene = Scene::default();
    let side = 9;
    let at = |k: usize| Vec3::new((k % side) as f32 / 4.0 - 1.0, 0.0, 1.0 - (k / side) as f32 / 4.0);
    let quad = |k: usize| [k, k + 1, k + side + 1, k + side].map(|v| v as u32);
    let quads = (0..side * (side - 1)).filter(|k| k % side + 1 < side).map(quad);
    scene.materials = vec![metal(), Material::default()];
    scene.meshes.push(Mesh {
        name: "sheet".into(),
        positions: (0..side * side).map(at).collect(),
        normals: vec![Vec3::Y; side * side],
        triangles: quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Mesh::default()
    });
    scene.meshes.push(block(Vec3::new(0.1, -0.5, -1.5), Vec3::new(1.5, 0.5, 1.5)));
    let prt = baked(&scene, &with_gloss(fixed(3, Sampler::OwenSobol, 128, 1)), &Extras::default());
    let vertices = prt.gloss.as_ref().unwrap().vertices.as_ref().unwrap();
    let seen = vertices.arriving.visibility.decode(None);
    let open = std::f32::consts::PI.sqrt();
    let least = seen.chunks_exact(9).take(side * side).map(|row| row[0] / open).fold(1.0, f32::min);
    assert!(prt.achieved.repairs.inside > 20, "{:?}", prt.achieved.repairs);
    assert!(least > 0.3, "{least}");
}

/// A closed box with its normals outwards.
fn block(low: Vec3, high: Vec3) -> Mesh {
    let mut mesh = Mesh { name: "block".into(), material: 1, ..Mesh::default() };
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            let first = mesh.positions.len() as u32;
            for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                let mut share = [0.0; 3];
                (share[axis], share[(axis + 1) % 3], share[(axis + 2) % 3]) = (side, u, v);
                mesh.positions.push(low + (high - low) * Vec3::from(share));
                let mut normal = [0.0; 3];
                normal[axis] = 2.0 * side - 1.0;
                mesh.normals.push(normal.into());
            }
            let corners = if side > 0.0 { [[0, 1, 2], [0, 2, 3]] } else { [[0, 2, 1], [0, 3, 2]] };
            mesh.triangles.extend(corners.map(|triangle| triangle.map(|v: u32| v + first)));
        }
    }
    mesh
}

/// What cannot be is refused before anything is baked.
#[test]
fn sheets_that_cannot_be_are_refused() {
    let (scene, mesh) = with_patch(scene::builtin("bowl").unwrap(), Vec3::new(0.1, -0.8, 0.0), 0.05);
    let settings = with_gloss(fixed(2, Sampler::OwenSobol, 16, 0));
    let bake = |edit: &dyn Fn(&mut TextureSettings)| {
        let mut textures = texture(vec![mesh], 16);
        edit(&mut textures);
        let extras = Extras { textures: Some(textures), ..Extras::default() };
        bake::bake_with(&scene, &settings, &extras, &|_| ControlFlow::Continue(()))
    };
    assert!(bake(&|_| {}).is_ok());
    let edits: [&dyn Fn(&mut TextureSettings); 4] = [
        &|textures| textures.sheets[0].meshes.push(99),
        &|textures| textures.sheets.push(textures.sheets[0].clone()),
        &|textures| textures.sheets[0].width = 40_000,
        &|textures| textures.dilation = 1000,
    ];
    for edit in edits {
        assert!(matches!(bake(edit), Err(bake::Error::Setting { .. })));
    }
}
