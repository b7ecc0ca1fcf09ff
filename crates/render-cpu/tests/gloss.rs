//! Gloss: white furnaces, the integral that it stands for, vertices and texels, clustered tables, refusals.

mod handmade;

use coeff_io::{Bounced, Codebook, Gloss, GlossView, Prt, Table, TransferLevel};
use glam::{DVec3, Quat, Vec3};
use handmade::gloss::{
    BANDS, FUNCTIONS, SIZE, STORAGES, Storage, apart, bands, bare, belt, bounced, fine_wall, front, lay_on, metal,
    metal_wall, noise, same_everywhere, share, to_eye,
};
use handmade::wall;
use probe_io::Environment;
use probe_io::reflection::Reflection;
use render_cpu::{Error, Frame, REFLECTION_LEVELS, REFLECTION_WIDTH, Renderer, render};
use sh_math::lobe::{self, Lobe};
use sh_math::{Bands, Rgb};
use testkit::quadrature::{band_quadrature, sphere_quadrature};

fn sky() -> Environment {
    Environment::constant([1.0; 3])
}

fn draw(prt: &Prt, frame: &Frame) -> Vec<[f32; 3]> {
    render(prt, &sky(), frame).expect("a sound scene and frame").linear
}

fn furnace(roughness: f32) -> Vec<[f32; 3]> {
    (0..(SIZE * SIZE) as usize).map(|pixel| share(roughness, pixel, SIZE)).collect()
}

/// The worst error of a furnace of a roughness.
fn furnace_error(renderer: &Renderer<'_>, lobe: Lobe, roughness: f32, tail: bool) -> f32 {
    let mut frame = bare(lobe);
    frame.gloss = GlossView { tail, roughness: Some(roughness), ..frame.gloss };
    apart(&renderer.draw(&frame).expect("a picture").linear, &furnace(roughness))
}

const ROUGHNESSES: [f32; 4] = [0.1, 0.35, 0.6, 1.0];

#[test]
fn a_white_furnace_mirrors_exactly_its_share() {
    let sky = sky();
    for storage in STORAGES {
        let prt = metal_wall(storage, 0.5, &belt(0.0, 1.0), None);
        let renderer = Renderer::without_window(&prt, &sky).expect("a sound scene");
        let all = Lobe::ALL.into_iter().flat_map(|lobe| ROUGHNESSES.map(|roughness| (lobe, roughness)));
        for (lobe, roughness) in all {
            for tail in [false, true] {
                let error = furnace_error(&renderer, lobe, roughness, tail);
                assert!(error < 1e-3, "{storage:?} {lobe:?} {roughness} {tail}: {error}");
            }
        }
        let own = apart(&draw(&prt, &front(SIZE)), &furnace(0.5));
        let other = apart(&draw(&prt, &front(SIZE)), &furnace(1.0));
        assert!(own < 1e-3 && other > 0.05, "the material's own roughness: {own} {other}");
    }
}

#[test]
fn a_furnace_half_blocked_by_white_surfaces_is_still_one() {
    let (sky, open) = (sky(), belt(0.6, 1.0));
    for storage in STORAGES {
        let closed = metal_wall(storage, 0.5, &open, Some(bounced(&belt(0.0, 0.6))));
        let leaking = metal_wall(storage, 0.5, &open, None);
        let [closed, leaking] =
            [&closed, &leaking].map(|prt| Renderer::without_window(prt, &sky).expect("a sound scene"));
        let all = Lobe::ALL.into_iter().flat_map(|lobe| ROUGHNESSES.map(|roughness| (lobe, roughness)));
        for (lobe, roughness) in all {
            for tail in [false, true] {
                let error = furnace_error(&closed, lobe, roughness, tail);
                let lost = furnace_error(&leaking, lobe, roughness, tail);
                assert!(error < 1e-3, "{storage:?} {lobe:?} {roughness} {tail}: {error}");
                assert!(lost > 0.05, "what is blocked must be missed: {lost}");
            }
        }
    }
}

/// Some light in the bands that count, as it lies.
fn light() -> Rgb {
    let bands = Bands::new(2 * BANDS - 1).expect("a number of bands");
    let values = noise(3 * bands.coefficients(), 0.4);
    let mut values: Vec<[f32; 3]> = values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    values[0] = [6.0, 5.0, 4.0];
    Rgb { bands, values }
}

/// `P_l(x)` for all bands.
fn legendre(x: f64) -> [f64; BANDS as usize] {
    [1.0, x, 1.5 * x * x - 0.5, 2.5 * x * x * x - 1.5 * x]
}

/// The kept bands of a lobe about `axis`.
fn kept(factors: &[f64], axis: DVec3, direction: DVec3) -> f64 {
    let terms = factors.iter().zip(legendre(axis.dot(direction))).enumerate();
    terms.map(|(l, (b, p))| (2 * l + 1) as f64 / (4.0 * std::f64::consts::PI) * b * p).sum()
}

/// The prefiltered light above the wall, which faces +z, and what is read below it.
fn above(reflection: &Reflection, turn: Quat, mirrored: Vec3, roughness: f32) -> [[f32; 3]; 2] {
    let share = lobe::above(roughness, mirrored.z);
    let deep = mirrored.truncate().extend(-0.15 - 1.5 * roughness * roughness).normalize();
    let [whole, below] = [mirrored, deep].map(|d| reflection.sample(turn * d, roughness));
    let below = [0, 1, 2].map(|c| below[c].min(4.0 * whole[c]));
    [[0, 1, 2].map(|c| ((whole[c] - (1.0 - share) * below[c]) / share).max(0.0)), below]
}

/// What a pixel must mirror: integrals of light, visibility and lobe as functions of the direction.
fn integral(
    lobe: Lobe,
    roughness: f32,
    visibility: &[f32],
    turn: Quat,
    tail: Option<&Reflection>,
    pixel: usize,
) -> [f64; 3] {
    let light = light();
    let view = to_eye(pixel, SIZE);
    let mirrored = DVec3::new(-view.x, -view.y, view.z);
    let factors = lobe.factors(f64::from(roughness), BANDS as usize);
    let seen = Rgb { bands: bands(), values: visibility.iter().map(|&v| [v; 3]).collect() };
    let low = light.truncated(bands());
    let (mut both, mut open, mut held) = ([0.0; 3], 0.0, [0.0; 3]);
    for (direction, weight) in sphere_quadrature(24) {
        let direction = DVec3::from(direction);
        let weight = weight * kept(&factors, mirrored, direction);
        let source = turn.inverse() * direction.as_vec3();
        let v = f64::from(seen.reconstruct(direction.as_vec3())[0]);
        open += weight * v;
        for c in 0..3 {
            both[c] += weight * v * f64::from(light.reconstruct(source)[c]);
            held[c] += weight * f64::from(low.reconstruct(source)[c]);
        }
    }
    let energy: f64 = band_quadrature(0.0, 1.0, 24)
        .into_iter()
        .map(|(direction, weight)| weight * kept(&factors, mirrored, DVec3::from(direction)))
        .sum();
    // The wall's diffuse light has two bands.
    let two = light.truncated(Bands::new(2).expect("a number of bands"));
    let mut lit = [0.0; 3];
    for (direction, weight) in band_quadrature(0.0, 1.0, 24) {
        let source = turn.inverse() * DVec3::from(direction).as_vec3();
        let weight = weight * direction[2] / std::f64::consts::PI;
        lit.iter_mut().zip(two.reconstruct(source)).for_each(|(sum, x)| *sum += weight * f64::from(x));
    }
    let blurred = tail.map(|tail| above(tail, turn.inverse(), mirrored.as_vec3(), roughness));
    let share = share(roughness, pixel, SIZE);
    std::array::from_fn(|c| {
        let (visible, bands) = ((open / energy).clamp(0.0, 1.0), (both[c] / energy).max(0.0));
        let light = blurred.map_or(bands, |[blurred, below]| {
            let closing = (4.0 * (1.0 - visible)).min(1.0);
            let beyond = bands - visible * (held[c] - (1.0 - energy) * f64::from(below[c])) / energy;
            let sent = beyond.min((1.0 - visible) * lit[c].max(0.0)).max(0.0);
            (visible * f64::from(blurred[c]) + closing * beyond + (1.0 - closing) * sent).max(0.0)
        });
        light * f64::from(share[c])
    })
}

/// Where nothing is blocked a lamp that five bands ring about is mirrored as the prefiltered probe has it; by the bands alone it is not.
#[test]
fn an_open_lobe_mirrors_the_prefiltered_light() {
    let lamp = |d: DVec3| if d.dot(DVec3::new(0.6, 0.0, -0.8)) > 0.98 { [500.0; 3] } else { [0.2; 3] };
    let environment = Environment::from_function("lamp", 64, lamp);
    let reflection = Reflection::build(&environment, REFLECTION_LEVELS, REFLECTION_WIDTH);
    let prt = metal_wall(Storage::Texels, 0.375, &belt(0.0, 1.0), None);
    let renderer = Renderer::without_window(&prt, &environment).expect("a sound scene");
    let error = |tail| {
        let mut frame = bare(Lobe::Ggx);
        frame.gloss.tail = tail;
        let picture = renderer.draw(&frame).expect("a picture").linear;
        let of_pixel = |pixel: usize| {
            let view = to_eye(pixel, SIZE).as_vec3();
            let [blurred, _] = above(&reflection, Quat::IDENTITY, Vec3::new(-view.x, -view.y, view.z), 0.375);
            let exact = blurred[0] * share(0.375, pixel, SIZE)[0];
            (picture[pixel][0] / exact - 1.0).abs()
        };
        (0..picture.len()).map(of_pixel).fold(0.0, f32::max)
    };
    assert!(error(true) < 1e-3, "{}", error(true));
    assert!(error(false) > 0.5, "can fail: the bands ring");
}

#[test]
fn a_pixel_is_the_integral_of_light_visibility_and_lobe() {
    let environment = Environment::from_function("test", 64, |d| [1.0 + d.x, 1.5 + d.y, 2.0 + d.z * d.x]);
    let reflection = Reflection::build(&environment, REFLECTION_LEVELS, REFLECTION_WIDTH);
    let mut visibility = belt(0.0, 1.0);
    visibility.iter_mut().zip(noise(FUNCTIONS, 0.9)).for_each(|(v, noise)| *v += 0.3 * noise);
    for (lobe, roughness) in [(Lobe::Ggx, 0.375), (Lobe::Phong, 0.625)] {
        for tail in [None, Some(&reflection)] {
            let prt = metal_wall(Storage::Texels, roughness, &visibility, None);
            let mut renderer = Renderer::without_window(&prt, &environment).expect("a sound scene");
            renderer.set_light(light());
            let mut frame = bare(lobe);
            frame.rotation = Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 1.1);
            frame.gloss.tail = tail.is_some();
            let picture = renderer.draw(&frame).expect("a picture").linear;
            let error = |roughness, turn| {
                let of_pixel = |pixel: usize| {
                    let exact = integral(lobe, roughness, &visibility, turn, tail, pixel);
                    (0..3).map(|c| (f64::from(picture[pixel][c]) - exact[c]).abs()).fold(0.0, f64::max)
                };
                (0..picture.len()).step_by(7).map(of_pixel).fold(0.0, f64::max)
            };
            // Values about 2, sums of 16 products in f32.
            let own = error(roughness, frame.rotation);
            assert!(own < 2e-5, "{lobe:?}, tail {}: {own}", tail.is_some());
            assert!(error(roughness + 0.125, frame.rotation) > 1e-2, "another roughness must show");
            assert!(error(roughness, Quat::IDENTITY) > 1e-2, "the turn must show");
        }
    }
}

#[test]
fn vertices_and_texels_agree_on_a_finely_cut_wall() {
    let environment = Environment::from_function("test", 64, |d| [1.5 + d.x, 1.5 + d.y, 1.5 + d.z * d.x]);
    let difference = |cells, tail| {
        let draw = |storage| {
            let prt = same_everywhere(fine_wall(metal(0.4), cells), storage, &belt(0.3, 1.0), None);
            let mut frame = front(SIZE);
            frame.gloss.tail = tail;
            render(&prt, &environment, &frame).expect("a picture").linear
        };
        apart(&draw(Storage::Vertices), &draw(Storage::Texels))
    };
    let coarse = difference(2, true);
    for tail in [false, true] {
        let fine = difference(48, tail);
        // Radiance up to 2; the error of linear interpolation falls with the square of the cells.
        assert!(fine < 2e-3, "tail {tail}: {fine}");
    }
    assert!(coarse > 3e-2, "two cells must be too few: {coarse}");
}

/// A wall of five by three texels that shine, with two means and two vectors each for all three kinds of tables.
fn clustered() -> Prt {
    let mut prt = wall(metal(0.5));
    prt.materials[0].metallic = 0.5;
    let rows = 15;
    let table = |columns: u32, seed: f32, base: &[f32]| {
        let mut values = noise(2 * 3 * columns as usize, seed);
        values.iter_mut().enumerate().for_each(|(i, v)| *v = 0.2 * *v + base[i % columns as usize]);
        let book = Codebook::new([columns, 2, 2], &values);
        let clusters: Vec<u16> = (0..rows).map(|row| row % 3 / 2).collect();
        let table = Table::clustered(&book, &clusters, &noise(2 * rows as usize, seed + 1.0));
        (Some(book), table)
    };
    let (diffuse_book, diffuse) = table(4, 0.1, &[0.3, 0.0, 0.1, 0.0]);
    let (visibility_book, visibility) = table(FUNCTIONS as u32, 0.2, &belt(0.0, 1.0));
    let (bounce_book, bounce) = table(FUNCTIONS as u32 * 4, 0.3, &[0.05; FUNCTIONS * 4]);
    let arriving = Some(coeff_io::Arriving { visibility, bounces: vec![bounce] });
    lay_on(&mut prt, vec![TransferLevel { width: 5, height: 3, places: (0..15).collect(), diffuse, arriving }]);
    prt.codebooks = coeff_io::Codebooks { diffuse: diffuse_book, visibility: visibility_book, bounce: bounce_book };
    let bounced = Some(Bounced::Relightable { bands: 2, channels: 1 });
    prt.gloss = Some(Gloss { bands: BANDS, bounced, vertices: None });
    prt
}

#[test]
fn clustered_tables_draw_as_what_they_say() {
    let prt = clustered();
    let mut plain = prt.clone();
    let books = &prt.codebooks;
    let level = &mut plain.transfer_textures.as_mut().expect("textures").sheets[0].levels[0];
    let decoded = |table: &Table, book: &Option<Codebook>| Table::exact(table.columns, &table.decode(book.as_ref()));
    level.diffuse = decoded(&level.diffuse, &books.diffuse);
    let arriving = level.arriving.as_mut().expect("gloss");
    arriving.visibility = decoded(&arriving.visibility, &books.visibility);
    arriving.bounces[0] = decoded(&arriving.bounces[0], &books.bounce);
    plain.codebooks = coeff_io::Codebooks::default();
    let own = draw(&prt, &front(SIZE));
    let error = apart(&own, &draw(&plain, &front(SIZE)));
    assert!(error < 1e-5, "{error}");
    let level = &mut plain.transfer_textures.as_mut().expect("textures").sheets[0].levels[0];
    level.arriving.as_mut().expect("gloss").bounces[0].bytes.fill(0);
    assert!(apart(&own, &draw(&plain, &front(SIZE))) > 1e-2, "bounces must show");
}

/// Half of the furnace's bounces in each of two tables of radiance, under a white light.
fn fixed(storage: Storage) -> Prt {
    let half: Vec<f32> = belt(0.0, 0.6).iter().flat_map(|v| [0.5 * v; 3]).collect();
    let light = sh_math::project(Bands::new(2 * BANDS - 1).expect("bands"), sky().samples()).values;
    let bounced = Bounced::Fixed { probe: "white".into(), light, materials: 0, bounces: 2 };
    let mut prt = metal_wall(storage, 0.5, &belt(0.6, 1.0), Some((bounced, half)));
    let mark = prt.materials_mark();
    if let Some(Bounced::Fixed { materials, .. }) = prt.gloss.as_mut().and_then(|gloss| gloss.bounced.as_mut()) {
        *materials = mark;
    }
    let arriving = match storage {
        Storage::Vertices => &mut prt.gloss.as_mut().and_then(|gloss| gloss.vertices.as_mut()).expect("rows").arriving,
        Storage::Texels => {
            let textures = prt.transfer_textures.as_mut().expect("textures");
            textures.sheets[0].levels[0].arriving.as_mut().expect("rows")
        }
    };
    arriving.bounces.push(arriving.bounces[0].clone());
    prt
}

#[test]
fn fixed_bounces_are_drawn_under_their_own_light_only() {
    for storage in STORAGES {
        let prt = fixed(storage);
        let error = apart(&draw(&prt, &bare(Lobe::Ggx)), &furnace(0.5));
        assert!(error < 1e-3, "{storage:?}: {error}");
        let turned = Frame { rotation: Quat::from_rotation_y(0.1), ..front(SIZE) };
        let rough = GlossView { roughness: Some(0.5), ..GlossView::default() };
        let refusals = [
            (render(&prt, &sky(), &turned), "turned"),
            (render(&prt, &Environment::constant([2.0; 3]), &front(SIZE)), "another light"),
            (render(&prt, &sky(), &Frame { gloss: rough, ..front(SIZE) }), "other materials"),
        ];
        for (refused, word) in refusals {
            let error = refused.expect_err("nothing to draw");
            assert!(matches!(&error, Error::Frame(what) if what.contains(word)), "{word}: {error}");
        }
    }
}

#[test]
fn one_roughness_stands_for_all_that_shines() {
    let view = |roughness| GlossView { roughness, ..GlossView::default() };
    let given = Frame { gloss: view(Some(0.75)), ..front(SIZE) };
    let environment = Environment::from_function("test", 64, |d| [1.5 + d.x, 1.5 + d.y, 1.5 + d.z * d.x]);
    for storage in STORAGES {
        let draw = |roughness, frame: &Frame| {
            let prt = metal_wall(storage, roughness, &belt(0.2, 1.0), None);
            render(&prt, &environment, frame).expect("a picture").linear
        };
        let own = draw(0.75, &front(SIZE));
        assert!(apart(&draw(0.2, &given), &own) == 0.0, "{storage:?}");
        assert!(apart(&draw(0.2, &front(SIZE)), &own) > 1e-2, "it must show");
    }
}

#[test]
fn tables_that_do_not_fit_are_refused() {
    type Edit = fn(&mut Prt);
    let edits: [(&str, Edit); 4] = [
        ("beyond the rows", |prt| prt.meshes[0].vertices += 1),
        ("are not 6 rows", |prt| {
            prt.gloss.as_mut().unwrap().vertices.as_mut().unwrap().arriving.visibility.bytes.clear();
        }),
        ("bands of gloss", |prt| prt.gloss.as_mut().unwrap().bands = 0),
        ("tables of bounces", |prt| prt.gloss.as_mut().unwrap().bounced = Some(bounced(&[]).0)),
    ];
    let sound = metal_wall(Storage::Vertices, 0.5, &belt(0.0, 1.0), None);
    for (word, edit) in edits {
        let mut prt = sound.clone();
        edit(&mut prt);
        let error = render(&prt, &sky(), &front(SIZE)).expect_err("nothing to draw");
        assert!(matches!(&error, Error::Prt(what) if what.contains(word)), "{word}: {error}");
    }
}
