//! Transfer textures: look-up between texels and levels, holes, light, what vertices hold beside them.

mod handmade;

use coeff_io::{Arriving, Gloss, GlossView, Prt, Table, TransferLevel};
use glam::Quat;
use handmade::gloss::{BANDS, FUNCTIONS, SIZE, apart, bare, front, lay_on, metal, noise, share};
use handmade::{Y0, Y1, quad, wall, white};
use probe_io::Environment;
use render_cpu::{Error, Frame, Renderer, render};
use sh_math::lobe::Lobe;

fn sky() -> Environment {
    Environment::constant([1.0; 3])
}

fn draw(prt: &Prt, frame: &Frame) -> Vec<[f32; 3]> {
    render(prt, &sky(), frame).expect("a sound scene and frame").linear
}

/// A level of texels that show `values` under a white sky.
fn level([width, height]: [u32; 2], places: Vec<u32>, values: &[f32]) -> TransferLevel {
    let rows: Vec<f32> = values.iter().flat_map(|value| [value * Y0, 0.0, 0.0, 0.0]).collect();
    TransferLevel { width, height, places, diffuse: Table::exact(4, &rows), arriving: None }
}

/// A level that shows one value everywhere.
fn plain(side: u32, value: f32) -> TransferLevel {
    level([side, side], (0..side * side).collect(), &vec![value; (side * side) as usize])
}

/// Levels of 8, 4 and 2 texels over four metres that show 1, 2 and 3.
fn pyramid() -> Prt {
    let mut prt = wall(white());
    lay_on(&mut prt, vec![plain(8, 1.0), plain(4, 2.0), plain(2, 3.0)]);
    prt
}

/// The wall's samples span 4 / size metres and its texels half a metre: lambda = log2(8 / size).
#[test]
fn the_level_follows_the_size_of_a_sample() {
    let prt = pyramid();
    let shown = |size: u32, level: u32, supersample: u32| {
        let gloss = GlossView { level, ..GlossView::default() };
        let picture = draw(&prt, &Frame { gloss, supersample, ..front(size) });
        let error = apart(&picture, &vec![picture[0]; picture.len()]);
        assert!(error < 1e-5, "the wall is at one depth: {error}");
        picture[0][1]
    };
    for size in [1, 2, 3, 4, 5, 6, 8, 16] {
        let lambda = (8.0 / size as f32).log2().clamp(0.0, 2.0);
        assert!((shown(size, 0, 1) - (1.0 + lambda)).abs() < 1e-4, "{size}: {}", shown(size, 0, 1));
    }
    assert!((shown(3, 0, 1) - shown(4, 0, 1)).abs() > 0.3, "another size must show");
    assert!((shown(3, 0, 2) - shown(6, 0, 1)).abs() < 1e-4, "samples count, not pixels");
    assert!(
        (shown(16, 1, 1) - 2.0).abs() < 1e-4 && (shown(16, 2, 1) - 3.0).abs() < 1e-4,
        "the level that is asked for"
    );
    let beyond = Frame { gloss: GlossView { level: 3, ..GlossView::default() }, ..front(SIZE) };
    let error = render(&prt, &sky(), &beyond).expect_err("there are three");
    assert!(matches!(&error, Error::Frame(what) if what.contains("level 3")), "{error}");
}

/// A wall that recedes: every pixel has its own depth.
#[test]
fn the_level_follows_the_depth() {
    let mut prt = wall(white());
    lay_on(&mut prt, vec![plain(32, 1.0), plain(16, 2.0), plain(8, 3.0)]);
    let mut frame = front(24);
    frame.camera.eye = [3.0, 0.0, 1.5];
    frame.camera.target = [0.0; 3];
    frame.sky = false;
    let picture = draw(&prt, &frame);
    let [right, up, back] = frame.camera.axes().map(|axis| axis.as_dvec3());
    let eye = glam::DVec3::new(3.0, 0.0, 1.5);
    let (mut checked, mut worst, mut range) = (0, 0.0_f64, [2.0_f64, 0.0]);
    for (pixel, shown) in picture.iter().enumerate() {
        let at = |index: usize| 2.0 * (index as f64 + 0.5) / 24.0 - 1.0;
        let direction = right * at(pixel % 24) - up * at(pixel / 24) - back;
        let depth = -eye.z / direction.z;
        let place = eye + direction * depth;
        if depth > 0.0 && place.x.abs() < 1.9 && place.y.abs() < 1.9 {
            let lambda = (depth * 2.0 / 24.0 * 8.0).log2().clamp(0.0, 2.0);
            worst = worst.max((f64::from(shown[0]) - 1.0 - lambda).abs());
            range = [range[0].min(lambda), range[1].max(lambda)];
            checked += 1;
        }
    }
    assert!(checked > 40 && worst < 1e-4, "{checked} pixels: {worst}");
    assert!(range[1] - range[0] > 1.0, "one level everywhere shows nothing: {range:?}");
}

/// What a pixel of the wall must show: every texel that is there by its tent, in f64; `shift` moves the texels' centres.
fn expected([width, height]: [u32; 2], places: &[u32], values: &[f32], pixel: usize, shift: f64) -> f64 {
    let at = |index: usize, texels: u32| {
        let last = f64::from(texels) - 1.0;
        ((index as f64 + 0.5) / f64::from(SIZE) * f64::from(texels) - shift).clamp(0.0, last)
    };
    let (x, y) = (at(pixel % SIZE as usize, width), at(pixel / SIZE as usize, height));
    let tent = |d: f64| (1.0 - d.abs()).max(0.0);
    let texel = |(&place, &value): (&u32, &f32)| {
        tent(x - f64::from(place % width)) * tent(y - f64::from(place / width)) * f64::from(value)
    };
    places.iter().zip(values).map(texel).sum()
}

fn worst(picture: &[[f32; 3]], expected: impl Fn(usize) -> [f64; 3]) -> f64 {
    let error = |(i, pixel): (usize, &[f32; 3])| {
        pixel.iter().zip(expected(i)).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
    };
    picture.iter().enumerate().map(error).fold(0.0, f64::max)
}

#[test]
fn a_chart_with_holes_is_looked_up_between_its_texels() {
    let size = [5, 3];
    let places = vec![0, 1, 3, 6, 7, 8, 12, 14];
    let values: Vec<f32> = noise(places.len(), 0.3).iter().map(|v| 1.5 + v).collect();
    let mut prt = wall(white());
    lay_on(&mut prt, vec![level(size, places.clone(), &values)]);
    let picture = draw(&prt, &front(SIZE));
    let error = worst(&picture, |pixel| [expected(size, &places, &values, pixel, 0.5); 3]);
    assert!(error < 1e-5, "{error}");
    let shifted = worst(&picture, |pixel| [expected(size, &places, &values, pixel, 0.0); 3]);
    assert!(shifted > 0.1, "half a texel must show: {shifted}");
}

/// The open hemisphere at some texels, what arrives times `values`: a furnace that is as bright as they say.
#[test]
fn gloss_is_looked_up_as_diffuse_light_is() {
    let (size, places) = ([5, 3], vec![0, 1, 3, 6, 7, 8, 12, 14]);
    let values: Vec<f32> = noise(places.len(), 0.6).iter().map(|v| 1.5 + v).collect();
    let hemisphere = handmade::gloss::belt(0.0, 1.0);
    let rows: Vec<f32> = values.iter().flat_map(|value| hemisphere.iter().map(move |v| v * value)).collect();
    let arriving = Arriving { visibility: Table::exact(FUNCTIONS as u32, &rows), bounces: Vec::new() };
    let mut prt = wall(metal(0.5));
    lay_on(&mut prt, vec![TransferLevel { arriving: Some(arriving), ..level(size, places.clone(), &values) }]);
    prt.gloss = Some(Gloss { bands: BANDS, bounced: None, vertices: None });
    let picture = draw(&prt, &bare(Lobe::Ggx));
    let of = |shift| {
        let (places, values) = (&places, &values);
        move |pixel: usize| share(0.5, pixel, SIZE).map(|f| f64::from(f) * expected(size, places, values, pixel, shift))
    };
    let error = worst(&picture, of(0.5));
    assert!(error < 1e-4, "{error}");
    assert!(worst(&picture, of(0.0)) > 0.1, "half a texel must show");
}

/// Texels that answer to light from +x, and a wall of vertices beside them.
#[test]
fn texels_follow_the_light_and_leave_other_meshes_alone() {
    let environment = Environment::from_function("test", 64, |d| [1.0 + d.x, 1.0, 1.0]);
    let mut prt = wall(white());
    let row = [Y0, 0.0, 0.0, Y1];
    lay_on(&mut prt, vec![TransferLevel { diffuse: Table::exact(4, &row), ..level([1, 1], vec![0], &[1.0]) }]);
    let half = quad(glam::Vec3::new(-1.0, 0.0, 0.01), glam::Vec3::X, glam::Vec3::Y * 2.0);
    handmade::add_triangles(&mut prt, white(), &half);
    prt.geometry.uv1.resize(prt.geometry.positions.len(), [0.0; 2]);
    prt.transfer_textures.as_mut().expect("textures").sheet_of_mesh.push(None);
    let mut renderer = Renderer::without_window(&prt, &environment).expect("a sound scene");
    let mut red = |rotation| {
        let picture = renderer.draw(&Frame { rotation, ..front(SIZE) }).expect("a picture").linear;
        renderer.set_light(renderer.light().clone());
        [picture[SIZE as usize - 1][0], picture[0][0]]
    };
    // The integral of (1 + x) (Y0 Y0 + Y1 Y1 x) is 1 + 1; of 1 + x over the clamped cosine over pi about +z it is 1.
    let [texels, vertices] = red(Quat::IDENTITY);
    assert!((texels - 2.0).abs() < 1e-3 && (vertices - 1.0).abs() < 1e-3, "{texels} {vertices}");
    let [texels, vertices] = red(Quat::from_rotation_y(-std::f32::consts::FRAC_PI_2));
    assert!((texels - 1.0).abs() < 1e-3 && (vertices - 1.0 - 2.0 / 3.0).abs() < 1e-3, "{texels} {vertices}");
}

#[test]
fn textures_that_do_not_fit_are_refused() {
    type Edit = fn(&mut Prt);
    let edits: [(&str, Edit); 4] = [
        ("do not ascend within", |prt| prt.transfer_textures.as_mut().unwrap().sheets[0].levels[0].places[0] = 64),
        ("no level", |prt| prt.transfer_textures.as_mut().unwrap().sheets[0].levels.clear()),
        ("does not exist", |prt| prt.transfer_textures.as_mut().unwrap().sheet_of_mesh[0] = Some(1)),
        ("0 bytes are not 16 rows", |prt| {
            prt.transfer_textures.as_mut().unwrap().sheets[0].levels[1].diffuse.bytes.clear()
        }),
    ];
    draw(&pyramid(), &front(SIZE));
    for (word, edit) in edits {
        let mut prt = pyramid();
        edit(&mut prt);
        let error = render(&prt, &sky(), &front(SIZE)).expect_err("nothing to draw");
        assert!(matches!(&error, Error::Prt(what) if what.contains(word)), "{word}: {error}");
    }
}
