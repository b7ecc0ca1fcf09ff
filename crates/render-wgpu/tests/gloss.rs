//! Pictures of surfaces with gloss and transfer textures, on the GPU and on the CPU.

mod compare;
mod handmade;

use coeff_io::{
    Arriving, Bounced, Codebook, Gloss, GlossView, GlossWay, Prt, Table, TransferLevel, TransferSheet,
    TransferTextures, VertexGloss,
};
use compare::{Distance, cpu_frame, distance, gpu};
use glam::{Quat, Vec3};
use handmade::{camera, environment, rotation, sphere_on_plane};
use probe_io::Environment;
use render_wgpu::{Error, Frame, Gpu, Renderer};
use sh_math::{Bands, lobe::Lobe, zonal};

/// Where receivers lie.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Storage {
    Vertices,
    Texels,
}

/// What surfaces send, and how rows are held.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Held {
    /// Exact rows, no bounces.
    Bare,
    /// Exact rows of bounces that can be relit.
    Exact,
    /// All in clusters.
    Clustered,
    /// Two bounces under one light.
    Fixed,
}

fn frame() -> Frame {
    Frame::plain(camera(), 160, 112)
}

/// Numbers between -1 and 1 that are no pattern.
fn noise(i: usize, seed: usize) -> f32 {
    (1.7 * i as f32 + 0.013 * (i * i) as f32 + 2.9 * seed as f32).sin()
}

/// Visibility about a normal with something beside it.
fn visibility(bands: Bands, normal: Vec3, seed: usize) -> Vec<f32> {
    let mut row = vec![0.0; bands.coefficients()];
    zonal::hemisphere_mean(bands, normal, &mut row);
    let dim = 0.7 + 0.25 * noise(seed, 1);
    row.iter_mut().enumerate().for_each(|(k, v)| *v = *v * dim * std::f32::consts::TAU + 0.02 * noise(k, seed));
    row
}

/// Rows of bounces, small.
fn sent(columns: usize, seed: usize) -> Vec<f32> {
    (0..columns).map(|k| (0.3 + 0.2 * noise(seed, 3)) * noise(k, 5) / (1.0 + k as f32)).collect()
}

/// Rows as a table, in three clusters of which each has two vectors.
fn clustered(columns: u32, rows: usize, seed: usize, around: &dyn Fn(usize) -> Vec<f32>) -> (Codebook, Table) {
    let vectors = (0..9).flat_map(|v| match v % 3 {
        0 => around(v),
        _ => (0..columns as usize).map(|k| 0.05 * noise(k, v + seed)).collect(),
    });
    let book = Codebook::new([columns, 3, 2], &vectors.collect::<Vec<f32>>());
    let clusters: Vec<u16> = (0..rows).map(|r| (r % 3) as u16).collect();
    let weights: Vec<f32> = (0..2 * rows).map(|r| noise(r, seed)).collect();
    (book.clone(), Table::clustered(&book, &clusters, &weights))
}

/// Tables of receivers with these normals; the codebooks are put into the file.
fn arriving(prt: &mut Prt, bands: Bands, held: Held, normals: &[Vec3]) -> Arriving {
    let (k, rows) = (bands.coefficients(), normals.len());
    let light = Bands::new(2).unwrap();
    let long = k * light.coefficients() * 3;
    let exact = |columns: usize, row: &dyn Fn(usize) -> Vec<f32>| {
        Table::exact(columns as u32, &(0..rows).flat_map(row).collect::<Vec<f32>>())
    };
    let open = |r: usize| visibility(bands, normals[r % rows], r);
    match held {
        Held::Clustered => {
            let (book, visibility) = clustered(k as u32, rows, 1, &|v| visibility(bands, Vec3::Y, v));
            prt.codebooks.visibility.get_or_insert(book);
            let (book, bounce) = clustered(long as u32, rows, 2, &|v| sent(long, v));
            prt.codebooks.bounce.get_or_insert(book);
            Arriving { visibility, bounces: vec![bounce] }
        }
        Held::Bare => Arriving { visibility: exact(k, &open), bounces: Vec::new() },
        Held::Exact => Arriving { visibility: exact(k, &open), bounces: vec![exact(long, &|r| sent(long, r))] },
        Held::Fixed => {
            let bounces = (0..2).map(|t| exact(3 * k, &|r| sent(3 * k, r + t))).collect();
            Arriving { visibility: exact(k, &open), bounces }
        }
    }
}

/// A transfer texture for the plane, with holes and two levels.
fn textures(prt: &mut Prt, bands: Bands, held: Held, shines: bool) -> TransferTextures {
    let coefficients = (prt.transfer.bands * prt.transfer.bands) as usize;
    let mut levels = Vec::new();
    for (side, number) in [(16u32, 0usize), (8, 1)] {
        let places: Vec<u32> = (0..side * side).filter(|place| place % 37 != 5).collect();
        let row = |r: usize| {
            let mut row = vec![0.0; coefficients];
            let dim = 0.8 + 0.2 * noise(r, number);
            zonal::cosine_transfer(Bands::new(prt.transfer.bands).unwrap(), Vec3::Y, &mut row);
            row.into_iter().map(move |t| dim * t).collect::<Vec<f32>>()
        };
        let diffuse = match held {
            Held::Clustered => {
                let (book, table) = clustered(coefficients as u32, places.len(), 7, &|v| row(v));
                prt.codebooks.diffuse.get_or_insert(book);
                table
            }
            _ => Table::half(coefficients as u32, &(0..places.len()).flat_map(row).collect::<Vec<f32>>()),
        };
        let normals = vec![Vec3::Y; places.len()];
        let arriving = shines.then(|| arriving(prt, bands, held, &normals));
        levels.push(TransferLevel { width: side, height: side, places, diffuse, arriving });
    }
    let sheet_of_mesh = (0..prt.meshes.len()).map(|mesh| (mesh == plane(prt)).then_some(0)).collect();
    TransferTextures { channels: 1, bent: false, sheets: vec![TransferSheet { levels }], sheet_of_mesh }
}

/// The largest flat mesh.
fn plane(prt: &Prt) -> usize {
    let flat = |mesh: &coeff_io::Mesh| {
        let own = mesh.first_vertex as usize..(mesh.first_vertex + mesh.vertices) as usize;
        prt.geometry.normals[own].iter().all(|n| n[1] > 0.999)
    };
    prt.meshes.iter().position(flat).expect("a plane")
}

/// Ball and plane with materials that shine, and gloss.
fn glossy(bands: u32, storage: Storage, held: Held) -> Prt {
    let bands = Bands::new(bands).unwrap();
    let mut prt = sphere_on_plane(1, 12);
    for material in &mut prt.materials {
        (material.specular, material.metallic, material.roughness) = (true, 0.8, 0.55);
    }
    let bounced = match held {
        Held::Bare => None,
        Held::Exact | Held::Clustered => Some(Bounced::Relightable { bands: 2, channels: 3 }),
        Held::Fixed => {
            let light = sh_math::project(Bands::new(2).unwrap(), environment().samples()).values;
            Some(Bounced::Fixed { probe: "test".into(), light, materials: 0, bounces: 2 })
        }
    };
    let normals: Vec<Vec3> = prt.geometry.normals.iter().map(|&n| Vec3::from(n)).collect();
    let vertices = match storage {
        Storage::Vertices => {
            let first_row = prt.meshes.iter().map(|mesh| Some(mesh.first_vertex)).collect();
            Some(VertexGloss { first_row, arriving: arriving(&mut prt, bands, held, &normals) })
        }
        Storage::Texels => None,
    };
    if storage == Storage::Texels {
        prt.geometry.uv1 = prt.geometry.positions.iter().map(|p| [p[0] * 0.1 + 0.5, p[2] * 0.1 + 0.5]).collect();
        prt.transfer_textures = Some(textures(&mut prt, bands, held, true));
    }
    prt.gloss = Some(Gloss { bands: bands.count() as u32, bounced, vertices });
    let mark = prt.materials_mark();
    if let Some(Bounced::Fixed { materials, .. }) = prt.gloss.as_mut().and_then(|gloss| gloss.bounced.as_mut()) {
        *materials = mark;
    }
    prt
}

fn in_way(way: GlossWay) -> Frame {
    Frame { gloss: GlossView { way: Some(way), ..GlossView::default() }, ..frame() }
}

/// How far the two renderers are apart in each frame.
fn compare(gpu: &Gpu, prt: &Prt, environment: &Environment, frames: &[Frame]) -> Vec<Distance> {
    let twin = render_cpu::Renderer::without_window(prt, environment).expect("a sound scene");
    let mut renderer = Renderer::without_window(gpu, prt, environment).expect("a sound scene");
    let pair = |frame: &Frame| {
        let picture = renderer.draw(frame).expect("a sound frame");
        distance(&picture, &twin.draw(&cpu_frame(frame)).expect("a sound frame"))
    };
    frames.iter().map(pair).collect()
}

/// Every way, at vertices and at texels, however rows are held, under a light that turns where it may.
#[test]
fn pictures_of_every_way_agree_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    for storage in [Storage::Vertices, Storage::Texels] {
        for held in [Held::Bare, Held::Exact, Held::Clustered, Held::Fixed] {
            let prt = glossy(4, storage, held);
            let turned = |frame: Frame| Frame { rotation: rotation(), ..frame };
            let mut frames = GlossWay::ALL.map(in_way).to_vec();
            if held != Held::Fixed {
                frames.extend(GlossWay::ALL.map(in_way).map(turned));
            }
            for (frame, distance) in frames.iter().zip(compare(&gpu, &prt, &environment(), &frames)) {
                assert!(distance.is_small(), "{storage:?} {held:?} {:?}: {distance:?}", frame.gloss.way);
            }
        }
    }
}

#[test]
fn any_number_of_bands_lobes_and_levels_agree_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    for bands in [1, 3, 5, 6] {
        for storage in [Storage::Vertices, Storage::Texels] {
            let prt = glossy(bands, storage, Held::Clustered);
            let plain = GlossView::default();
            let phong = GlossView { lobe: Lobe::Phong, roughness: Some(0.3), ..plain };
            let views = [phong, GlossView { tail: false, ..plain }];
            let mut frames: Vec<Frame> = views.map(|gloss| Frame { gloss, ..frame() }).to_vec();
            if storage == Storage::Texels {
                frames.push(Frame { gloss: GlossView { level: 1, ..plain }, ..frame() });
            }
            for (frame, distance) in frames.iter().zip(compare(&gpu, &prt, &environment(), &frames)) {
                assert!(distance.is_small(), "{bands} {storage:?} {:?}: {distance:?}", frame.gloss);
            }
        }
    }
}

/// Another roughness, another way of holding, no bounces: all of it must show.
#[test]
fn pictures_of_gloss_can_fail() {
    let Some(gpu) = gpu() else { return };
    let environment = environment();
    for storage in [Storage::Vertices, Storage::Texels] {
        let prt = glossy(4, storage, Held::Exact);
        let picture = Renderer::without_window(&gpu, &prt, &environment).unwrap().draw(&frame()).unwrap();
        let other = |prt: &Prt, frame: &Frame| {
            render_cpu::Renderer::without_window(prt, &environment).unwrap().draw(&cpu_frame(frame)).unwrap()
        };
        let rough = Frame { gloss: GlossView { roughness: Some(0.9), ..GlossView::default() }, ..frame() };
        assert!(!distance(&picture, &other(&prt, &rough)).is_small(), "{storage:?}");
        let bare = glossy(4, storage, Held::Bare);
        assert!(!distance(&picture, &other(&bare, &frame())).is_small(), "{storage:?}");
    }
}

/// Depth drawn before changes no pixel.
#[test]
fn early_depth_is_the_same_picture() {
    let Some(gpu) = gpu() else { return };
    let prt = glossy(4, Storage::Texels, Held::Bare);
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment()).unwrap();
    let early = renderer.draw(&frame()).unwrap();
    let late = renderer.draw(&Frame { early_depth: false, ..frame() }).unwrap();
    assert!(early.linear == late.linear);
    let other = renderer.draw(&Frame { rotation: rotation(), ..frame() }).unwrap();
    assert!(early.linear != other.linear, "can fail");
}

/// A light that stays is kept; one that turns with every frame is multiplied where few fragments are drawn.
#[test]
fn the_way_follows_what_changes() {
    let Some(gpu) = gpu() else { return };
    let prt = glossy(5, Storage::Texels, Held::Bare);
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment()).unwrap();
    let small = Frame { width: 8, height: 8, ..frame() };
    assert_eq!(renderer.gloss_way(), Some(GlossWay::Cache));
    for n in 0..3 {
        renderer.time(&Frame { rotation: Quat::from_rotation_y(n as f32), ..small.clone() }).unwrap();
    }
    assert_eq!(renderer.gloss_way(), Some(GlossWay::Tpfl));
    for _ in 0..40 {
        renderer.time(&small).unwrap();
    }
    assert_eq!(renderer.gloss_way(), Some(GlossWay::Cache));
    let matt = Renderer::without_window(&gpu, &sphere_on_plane(1, 12), &environment()).unwrap();
    assert_eq!(matt.gloss_way(), None);
}

/// Vertices whose transfer is in clusters are lit by short sums: the same picture as with what the clusters say.
#[test]
fn clustered_vertices_are_lit_as_exact_ones() {
    let Some(gpu) = gpu() else { return };
    let mut prt = sphere_on_plane(1, 12);
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    let (columns, rows) = (prt.transfer.bands.pow(2), prt.geometry.positions.len());
    let (book, table) =
        clustered(columns, rows, 3, &|v| prt.transfer.values[v * columns as usize..][..columns as usize].to_vec());
    prt.transfer.values = table.decode(Some(&book));
    let exact = prt.clone();
    (prt.codebooks.diffuse, prt.compressed) = (Some(book), Some(table));
    let turned = Frame { rotation: rotation(), ..frame() };
    for frame in [frame(), turned.clone()] {
        let distance = &compare(&gpu, &prt, &environment(), &[frame])[0];
        assert!(distance.is_small(), "{distance:?}");
    }
    let picture = Renderer::without_window(&gpu, &prt, &environment()).unwrap().draw(&turned).unwrap();
    let other =
        render_cpu::Renderer::without_window(&exact, &environment()).unwrap().draw(&cpu_frame(&frame())).unwrap();
    assert!(!compare::distance(&picture, &other).is_small(), "can fail");
}

/// What a file does not hold has no pipeline, and a transfer texture on its own brings no reflection.
#[test]
fn what_is_not_there_costs_nothing() {
    let Some(gpu) = gpu() else { return };
    let mut prt = sphere_on_plane(1, 12);
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    let mut plain = Renderer::without_window(&gpu, &prt, &environment()).unwrap();
    plain.time(&frame()).unwrap();
    prt.geometry.uv1 = prt.geometry.positions.iter().map(|p| [p[0] * 0.1 + 0.5, p[2] * 0.1 + 0.5]).collect();
    prt.transfer_textures = Some(textures(&mut prt, Bands::new(3).unwrap(), Held::Bare, false));
    let mut textured = Renderer::without_window(&gpu, &prt, &environment()).unwrap();
    textured.time(&frame()).unwrap();
    assert!(textured.pipelines() <= plain.pipelines() + 1, "{} {}", textured.pipelines(), plain.pipelines());
    let distance = &compare(&gpu, &prt, &environment(), &[frame()])[0];
    assert!(distance.is_small(), "{distance:?}");
    let untextured = Prt { transfer_textures: None, ..prt.clone() };
    let picture = textured.draw(&frame()).unwrap();
    let other =
        render_cpu::Renderer::without_window(&untextured, &environment()).unwrap().draw(&cpu_frame(&frame())).unwrap();
    assert!(!compare::distance(&picture, &other).is_small(), "can fail: the texture must show");
}

/// Bounces under one light refuse another, turned, or other materials.
#[test]
fn fixed_bounces_refuse_what_they_do_not_hold() {
    let Some(gpu) = gpu() else { return };
    let prt = glossy(3, Storage::Texels, Held::Fixed);
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment()).unwrap();
    assert!(renderer.draw(&frame()).is_ok());
    let said =
        |result: Result<render_wgpu::Image, Error>| result.err().map_or(String::new(), |error| error.to_string());
    let turned = said(renderer.draw(&Frame { rotation: rotation(), ..frame() }));
    assert!(turned.contains("turned") && turned.contains("`test`"), "{turned}");
    let rough = Frame { gloss: GlossView { roughness: Some(0.2), ..GlossView::default() }, ..frame() };
    assert!(said(renderer.draw(&rough)).contains("materials"));
    let mut other = prt.clone();
    other.materials[0].roughness = 0.1;
    assert!(said(Renderer::without_window(&gpu, &other, &environment()).unwrap().draw(&frame())).contains("materials"));
    let sky = Environment::constant([1.0, 2.0, 3.0]);
    assert!(said(Renderer::without_window(&gpu, &prt, &sky).unwrap().draw(&frame())).contains("another light"));
}
