//! Directional light maps: look-up, normal maps, bases, light, refusals.

mod handmade;

use coeff_io::{Layers, MapLight, Maps, Prt, Sheet, Texture, TextureSlot, Wrap};
use glam::{DVec3, Quat, Vec3};
use handmade::{Y0, camera, open_transfer, wall, white};
use probe_io::Environment;
use render_cpu::{Error, Frame, Renderer, render};
use sh_math::hemisphere::Basis;
use sh_math::{Bands, Rgb};

/// What breaks a sound file.
type Edit = fn(&mut Prt, &mut Maps);

const SIZE: u32 = 24;
/// Columns and rows of the handmade maps.
const TEXELS: [u32; 2] = [5, 3];

/// The wall of four by four units fills this view exactly; u runs to the right, v down.
fn frame() -> Frame {
    let mut frame = Frame::plain(camera([0.0, 0.0, 2.0], [0.0; 3]), SIZE, SIZE);
    frame.camera.vertical_fov = std::f32::consts::FRAC_PI_2;
    frame
}

fn sky() -> Environment {
    Environment::constant([1.0; 3])
}

/// A wall with tangents along +x, coordinates for a map and a normal map that asks for (about) one normal everywhere.
fn bumpy_wall(normal: Option<[u8; 3]>) -> Prt {
    let mut prt = wall(white());
    let positions = &prt.geometry.positions;
    prt.geometry.uv1 = positions.iter().map(|p| [p[0] / 4.0 + 0.5, 0.5 - p[1] / 4.0]).collect();
    prt.geometry.tangents = vec![[1.0, 0.0, 0.0, 1.0]; positions.len()];
    prt.geometry.uv0 = prt.geometry.uv1.clone();
    if let Some([r, g, b]) = normal {
        let rgba = vec![[r, g, b, 255]];
        prt.textures.push(Texture { name: "bumps".into(), width: 1, height: 1, rgba, wrap: [Wrap::Clamp; 2] });
        let transform = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        prt.materials[0].normal_texture = Some(TextureSlot { texture: 0, uv_set: 0, transform });
    }
    prt
}

/// The unit normal of three bytes of a normal map, its x and y scaled.
fn unit([r, g, b]: [u8; 3], scale: f64) -> DVec3 {
    let number = |byte: u8| 2.0 * f64::from(byte) / 255.0 - 1.0;
    DVec3::new(scale * number(r), scale * number(g), number(b)).normalize()
}

fn maps(basis: Basis, light: MapLight, [width, height]: [u32; 2], values: &[f32]) -> Maps {
    let count = (basis.count() * light.depth()) as u32;
    let layers = Layers::exact([width, height, count, 3], values);
    Maps { basis, light, sheets: vec![Sheet { layers }], sheet_of_mesh: vec![Some(0)] }
}

fn fixed() -> MapLight {
    MapLight::Fixed { probe: "test".into(), bands: 2 }
}

/// Coefficients without a pattern, of which the first is large enough to keep the sum positive.
fn noise(basis: Basis) -> Vec<f32> {
    let plane = (TEXELS[0] * TEXELS[1] * 3) as usize;
    let value = |i: usize| 0.3 * (1.0 + 7.3 * i as f32).sin() + if i < plane { 6.0 } else { 0.0 };
    (0..plane * basis.count()).map(value).collect()
}

/// What a pixel of the wall must show: every texel by its tent, in f64; `shift` moves the texels' centres.
fn expected(basis: Basis, values: &[f32], normal: DVec3, pixel: usize, shift: f64) -> [f64; 3] {
    let [width, height] = TEXELS.map(|n| n as i64);
    let place = [pixel % SIZE as usize, pixel / SIZE as usize].map(|x| (x as f64 + 0.5) / f64::from(SIZE));
    let (x, y) = (place[0] * width as f64 - shift, place[1] * height as f64 - shift);
    let tent = |d: f64| (1.0 - d.abs()).max(0.0);
    let mut functions = [0.0; Basis::MAX_COUNT];
    basis.evaluate_f64(normal, &mut functions);
    let mut sum = [0.0; 3];
    // One texel more on each side than there are: copies of the border.
    for row in -1..=height {
        for column in -1..=width {
            let weight = tent(x - column as f64) * tent(y - row as f64);
            let texel = row.clamp(0, height - 1) * width + column.clamp(0, width - 1);
            for (k, function) in functions[..basis.count()].iter().enumerate() {
                for (c, sum) in sum.iter_mut().enumerate() {
                    let value = values[(k * (width * height) as usize + texel as usize) * 3 + c];
                    *sum += weight * function * f64::from(value);
                }
            }
        }
    }
    sum.map(|value| value.max(0.0))
}

fn worst(picture: &[[f32; 3]], expected: impl Fn(usize) -> [f64; 3]) -> f64 {
    let error = |(i, pixel): (usize, &[f32; 3])| {
        pixel.iter().zip(expected(i)).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
    };
    picture.iter().enumerate().map(error).fold(0.0, f64::max)
}

fn draw(prt: &Prt, frame: &Frame) -> Vec<[f32; 3]> {
    render(prt, &sky(), frame).expect("a sound scene and frame").linear
}

const NORMAL: [u8; 3] = [190, 90, 210];

#[test]
fn every_basis_is_looked_up_between_texels_at_the_normal_of_the_map() {
    for basis in Basis::ALL {
        let values = noise(basis);
        let mut prt = bumpy_wall(Some(NORMAL));
        prt.materials[0].normal_scale = 0.7;
        prt.maps = Some(maps(basis, fixed(), TEXELS, &values));
        let picture = draw(&prt, &frame());
        let normal = unit(NORMAL, 0.7);
        let error = worst(&picture, |i| expected(basis, &values, normal, i, 0.5));
        // Numbers up to 10 in f32, places on the map to 1e-7 of 5 texels.
        assert!(error < 2e-5, "{}: {error}", basis.name());
        let shifted = worst(&picture, |i| expected(basis, &values, normal, i, 0.0));
        assert!(shifted > 1e-2, "{}: half a texel must be noticed: {shifted}", basis.name());
        let unscaled = worst(&picture, |i| expected(basis, &values, unit(NORMAL, 1.0), i, 0.5));
        assert!(unscaled > 1e-2 || basis == Basis::ModifiedH1, "{}: another normal: {unscaled}", basis.name());
    }
}

#[test]
fn without_a_normal_map_or_tangents_the_own_normal_counts() {
    let (basis, values) = (Basis::H6, noise(Basis::H6));
    let mut plain = bumpy_wall(None);
    plain.maps = Some(maps(basis, fixed(), TEXELS, &values));
    let mut untangled = bumpy_wall(Some(NORMAL));
    untangled.maps = plain.maps.clone();
    let bent = draw(&untangled, &frame());
    untangled.geometry.tangents.clear();
    for prt in [plain, untangled] {
        let error = worst(&draw(&prt, &frame()), |i| expected(basis, &values, DVec3::Z, i, 0.5));
        assert!(error < 2e-5, "{error}");
    }
    assert!(worst(&bent, |i| expected(basis, &values, DVec3::Z, i, 0.5)) > 1e-2, "a normal map must be noticed");
}

/// Light of two bands without a symmetry.
fn light() -> Rgb {
    let values = vec![[4.0, 3.0, 2.0], [0.3, -0.2, 0.5], [0.7, 0.4, -0.3], [-0.6, 0.5, 0.2]];
    Rgb { bands: Bands::new(2).expect("two bands"), values }
}

/// Per function and light coefficient: what an open surface that faces +z answers, one texel. World and tangent frame are one.
fn open_answers(basis: Basis) -> Vec<f32> {
    let factors = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
    let rows = basis.conversion().rows;
    rows.iter().flat_map(|row| (0..4).flat_map(|i| [(factors[i] * row[i]) as f32; 3])).collect()
}

/// A map with a normal map against a wall that has that normal: exact in every basis that holds linear functions.
fn against_a_tilted_wall(basis: Basis, rotation: Quat) -> f64 {
    let mut mapped = bumpy_wall(Some(NORMAL));
    mapped.maps = Some(maps(basis, MapLight::Relightable { bands: 2 }, [1, 1], &open_answers(basis)));
    // What the vertices would say is wrong, so that it is noticed.
    mapped.transfer.values.fill(9.0);
    let mut tilted = bumpy_wall(None);
    tilted.transfer.values =
        (0..tilted.geometry.positions.len()).flat_map(|_| open_transfer(unit(NORMAL, 1.0).as_vec3())).collect();
    let environment = sky();
    let [ours, theirs] = [&mapped, &tilted].map(|prt| {
        let mut renderer = Renderer::without_window(prt, &environment).expect("a sound scene");
        renderer.set_light(light());
        renderer.draw(&Frame { rotation, ..frame() }).expect("a sound frame").linear
    });
    worst(&ours, |i| theirs[i].map(f64::from))
}

#[test]
fn relightable_maps_show_what_a_tilted_wall_shows_under_any_rotation() {
    let turns = [Quat::IDENTITY, Quat::from_rotation_y(1.1), Quat::from_rotation_z(-0.4) * Quat::from_rotation_x(2.0)];
    for basis in [Basis::Sh4, Basis::Sh9, Basis::H4, Basis::H6, Basis::ModifiedH4, Basis::ModifiedH6] {
        for rotation in turns {
            let error = against_a_tilted_wall(basis, rotation);
            // Nine fitted harmonics have coefficients of some tens.
            assert!(error < 1e-5, "{}: {error}", basis.name());
        }
    }
    let error = against_a_tilted_wall(Basis::Hl2, Quat::IDENTITY);
    assert!(error > 1e-2, "a basis without constants must be noticed: {error}");
}

#[test]
fn set_light_and_rotations_reach_the_maps_again_and_again() {
    let mut prt = bumpy_wall(Some(NORMAL));
    prt.maps = Some(maps(Basis::H4, MapLight::Relightable { bands: 2 }, [1, 1], &open_answers(Basis::H4)));
    let environment = sky();
    let mut renderer = Renderer::without_window(&prt, &environment).expect("a sound scene");
    let draw = |renderer: &Renderer<'_>, turn: f32| {
        let frame = Frame { rotation: Quat::from_rotation_y(turn), ..frame() };
        renderer.draw(&frame).expect("a sound frame").linear
    };
    let under_sky = draw(&renderer, 0.0);
    renderer.set_light(light());
    let (first, turned, again) = (draw(&renderer, 0.0), draw(&renderer, 1.0), draw(&renderer, 0.0));
    assert!(first == again && first != turned && first != under_sky);
    // A light with fewer bands is black above them, for maps as for vertices.
    renderer.set_light(light().truncated(Bands::new(1).expect("one band")));
    let error = worst(&draw(&renderer, 0.0), |_| [4.0, 3.0, 2.0].map(|l: f64| l * f64::from(Y0)));
    assert!(error < 1e-5, "{error}");
}

/// A wall with the normal map `NORMAL` and noise in `stored`, drawn in another basis.
fn drawn_in(stored: Basis, basis: Option<Basis>, functions: Option<u32>) -> Vec<[f32; 3]> {
    let mut prt = bumpy_wall(Some(NORMAL));
    prt.maps = Some(maps(stored, fixed(), TEXELS, &noise(stored)));
    draw(&prt, &Frame { basis, functions, ..frame() })
}

#[test]
fn one_file_is_drawn_in_every_basis() {
    let own = drawn_in(Basis::H6, None, None);
    let distance = |other: &[[f32; 3]]| worst(other, |i| own[i].map(f64::from));
    for basis in [Basis::H6, Basis::ModifiedH6, Basis::Sh9] {
        let error = distance(&drawn_in(Basis::H6, Some(basis), None));
        // Nine harmonics for six functions: coefficients of some tens, rounded to f32.
        assert!(error < 1e-4, "{}: {error}", basis.name());
    }
    for basis in [Basis::Hl2, Basis::Hsh9, Basis::Makhotkin9, Basis::Zernike6, Basis::H4] {
        let error = distance(&drawn_in(Basis::H6, Some(basis), None));
        assert!(error > 1e-3, "{} cannot hold H 6: {error}", basis.name());
    }
}

#[test]
fn fewer_functions_are_the_first_ones() {
    let same = |a: Vec<[f32; 3]>, b: Vec<[f32; 3]>| worst(&a, |i| b[i].map(f64::from));
    let error = same(drawn_in(Basis::H6, None, Some(4)), drawn_in(Basis::H6, Some(Basis::H4), None));
    assert!(error < 1e-5, "{error}");
    let error = same(drawn_in(Basis::H6, Some(Basis::Hsh9), Some(4)), drawn_in(Basis::H6, Some(Basis::Hsh4), None));
    assert!(error < 1e-5, "{error}");
    // One function of the modified basis: an ordinary light map, whatever the normal map says.
    let flat = drawn_in(Basis::ModifiedH6, None, Some(1));
    let values = noise(Basis::ModifiedH6);
    let error = worst(&flat, |i| expected(Basis::ModifiedH6, &values, DVec3::Z, i, 0.5));
    assert!(error < 2e-5, "{error}");
    assert!(same(drawn_in(Basis::ModifiedH6, None, Some(4)), flat) > 1e-2, "three functions more must be noticed");
}

/// A sheet of one function is an ordinary light map in every basis: no normal map lies upon it.
#[test]
fn an_ordinary_light_map_stays_what_it_is() {
    let values = noise(Basis::ModifiedH6);
    let plane = (TEXELS[0] * TEXELS[1] * 3) as usize;
    let mut prt = bumpy_wall(None);
    let layers = Layers::exact([TEXELS[0], TEXELS[1], 1, 3], &values[..plane]);
    let sheets = vec![Sheet { layers }];
    prt.maps = Some(Maps { basis: Basis::ModifiedH6, light: fixed(), sheets, sheet_of_mesh: vec![Some(0)] });
    for basis in [None, Some(Basis::Hl2), Some(Basis::Makhotkin9), Some(Basis::ModifiedH4)] {
        let picture = draw(&prt, &Frame { basis, ..frame() });
        let error = worst(&picture, |i| expected(Basis::ModifiedH1, &values, DVec3::Z, i, 0.5));
        assert!(error < 2e-5, "{basis:?}: {error}");
    }
    // With all six functions the same light is another one in a basis without constants.
    prt.maps = Some(maps(Basis::ModifiedH6, fixed(), TEXELS, &values));
    let picture = draw(&prt, &Frame { basis: Some(Basis::Hl2), ..frame() });
    assert!(worst(&picture, |i| expected(Basis::ModifiedH1, &values, DVec3::Z, i, 0.5)) > 0.1);
}

#[test]
fn what_maps_cannot_show_is_refused() {
    let mut prt = bumpy_wall(None);
    prt.maps = Some(maps(Basis::Sh9, fixed(), TEXELS, &noise(Basis::Sh9)));
    let turned = Frame { rotation: Quat::from_rotation_y(0.1), ..frame() };
    let refused = |prt: &Prt, frame: &Frame, words: &str| match render(prt, &sky(), frame) {
        Err(Error::Frame(what)) => assert!(what.contains(words), "`{what}` does not say `{words}`"),
        other => panic!("{words}: {other:?}"),
    };
    refused(&prt, &turned, "`test`");
    refused(&prt, &Frame { functions: Some(4), ..frame() }, "ask for 9");
    refused(&prt, &Frame { basis: Some(Basis::H6), functions: Some(5), ..frame() }, "ask for 4 or 6");
    refused(&wall(white()), &Frame { basis: Some(Basis::H6), ..frame() }, "no light maps");
    refused(&wall(white()), &Frame { functions: Some(4), ..frame() }, "no light maps");
    let same = Frame { rotation: -Quat::IDENTITY, ..frame() };
    assert!(render(&prt, &sky(), &same).is_ok(), "the identity by its other name");
    assert!(render(&wall(white()), &sky(), &turned).is_ok(), "vertices can be relit");
    prt.maps.as_mut().expect("maps").sheet_of_mesh = vec![None];
    assert!(render(&prt, &sky(), &turned).is_ok(), "maps that no mesh shows hinder nobody");
}

#[test]
fn maps_that_do_not_fit_the_file_are_refused() {
    let edits: [(&str, Edit); 7] = [
        ("2 meshes", |_, maps| maps.sheet_of_mesh.push(None)),
        ("light map 3 of 1", |_, maps| maps.sheet_of_mesh[0] = Some(3)),
        ("second texture coordinates", |prt, _| prt.geometry.uv1.clear()),
        ("layers", |_, maps| maps.basis = Basis::Sh9),
        ("layers", |_, maps| maps.sheets[0].layers.bytes.truncate(8)),
        ("0 x 3", |_, maps| maps.sheets[0].layers.width = 0),
        ("900 bands", |_, maps| maps.light = MapLight::Relightable { bands: 900 }),
    ];
    for (words, edit) in edits {
        let mut prt = bumpy_wall(None);
        let mut broken = maps(Basis::H6, fixed(), TEXELS, &noise(Basis::H6));
        edit(&mut prt, &mut broken);
        prt.maps = Some(broken);
        match render(&prt, &sky(), &frame()) {
            Err(Error::Prt(what)) => assert!(what.contains(words), "`{what}` does not say `{words}`"),
            other => panic!("{words}: {other:?}"),
        }
    }
}

#[test]
fn without_albedo_the_light_alone_is_seen() {
    let mut coloured = bumpy_wall(None);
    coloured.maps = Some(maps(Basis::H6, fixed(), TEXELS, &noise(Basis::H6)));
    let white = draw(&coloured, &frame());
    coloured.materials[0].base_color = [0.2, 0.5, 0.7, 1.0];
    coloured.materials[0].metallic = 0.5;
    let seen = draw(&coloured, &frame());
    let shown = draw(&coloured, &Frame { albedo: false, ..frame() });
    assert!(shown == white && seen != white);
    let half = Vec3::from(white[0]) * Vec3::new(0.2, 0.5, 0.7) * 0.5;
    assert!(half.distance(Vec3::from(seen[0])) < 1e-5, "with albedo the colour and half a metal");
}
