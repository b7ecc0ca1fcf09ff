//! Texels under shells that are drawn from outside alone, and in gaps lower than themselves: their dark is not seen, and does not reach what is.

mod support;

use bake::{Extras, MapSettings, SheetSettings, TextureSettings};
use coeff_io::{Encoding, Prt, Sampler};
use glam::{Vec2, Vec3};
use scene::{AlphaMode, Material, Mesh, Scene};
use sh_math::hemisphere::Basis;
use std::ops::ControlFlow;
use support::fixed;

fn baked(scene: &Scene, sheet: SheetSettings) -> Prt {
    let basis = Basis::ModifiedH1;
    let maps = MapSettings { basis, sheets: vec![sheet], stitch: true, dilation: 2, encoding: Encoding::F32 };
    let extras = Extras { maps: Some(maps), ..Extras::default() };
    let settings = fixed(2, Sampler::OwenSobol, 1024, 0);
    bake::bake_with(scene, &settings, &extras, &|_| ControlFlow::Continue(())).expect("it bakes")
}

fn quad(corner: Vec3, along: Vec3, up: Vec3) -> Mesh {
    let normal = along.cross(up).normalize();
    Mesh {
        positions: vec![corner, corner + along, corner + along + up, corner + up],
        normals: vec![normal; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A square of ground of 2 m, with texels of 10 cm.
fn ground() -> (Mesh, SheetSettings) {
    let uv1 = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array).to_vec();
    let ground = Mesh { uv1, ..quad(Vec3::new(-1.0, 0.0, 1.0), Vec3::X * 2.0, Vec3::NEG_Z * 2.0) };
    (ground, SheetSettings { meshes: vec![0], width: 20, height: 20, directional: false })
}

/// A square of ground of 20 by 20 texels, with a box without bottom over a part of it whose wall stands between the middles of two texels.
fn shell_on_ground(double_sided: bool) -> (Scene, SheetSettings) {
    let (ground, sheet) = ground();
    let quad = |corner: [f32; 3], along: Vec3, up: Vec3| quad(Vec3::from_array(corner), along, up);
    let (x, y, z) = (Vec3::X * 0.87, Vec3::Y, Vec3::Z * 1.8);
    let mut meshes = vec![
        ground,
        quad([0.03, 0.0, -0.9], z, y),
        quad([0.9, 0.0, -0.9], y, z),
        quad([0.03, 0.0, 0.9], x, y),
        quad([0.03, 0.0, -0.9], y, x),
        quad([0.03, 1.0, -0.9], z, x),
    ];
    meshes[1..].iter_mut().for_each(|mesh| mesh.material = 1);
    let shell = Material { alpha: AlphaMode::Mask(0.5), double_sided, ..Material::default() };
    let scene = Scene { meshes, materials: vec![Material::default(), shell], ..Scene::default() };
    (scene, sheet)
}

/// Light on the ground before the wall, as a filter between texels finds it, at 1 cm and at 4 cm from the wall.
fn before_the_wall(double_sided: bool) -> [f32; 2] {
    let (scene, sheet) = shell_on_ground(double_sided);
    at_the_wall(&row_of_map(&scene, sheet))
}

/// What white light brings to the middle row of texels of a light map.
fn row_of_map(scene: &Scene, sheet: SheetSettings) -> Vec<f32> {
    let side = sheet.width as usize;
    let prt = baked(scene, sheet);
    let maps = prt.maps.as_ref().expect("maps were asked for");
    let mut white = vec![[0.0; 3]; 4];
    white[0] = [(4.0 * std::f32::consts::PI).sqrt(); 3];
    let values = maps.sheets[0].lit(maps, &white).functions.remove(0);
    let texel = |column: usize| maps.basis.reconstruct(&[values[side / 2 * side + column]], Vec3::Z)[0];
    (0..side).map(texel).collect()
}

/// What a filter between texels finds at 1 cm and at 4 cm before a wall at 3 cm, by the texels of a row.
fn at_the_wall(row: &[f32]) -> [f32; 2] {
    // The middles of columns 9 and 10 lie at -0.05 and 0.05.
    [0.02f32, -0.01].map(|x| {
        let share = (x + 0.05) / 0.1;
        (1.0 - share) * row[9] + share * row[10]
    })
}

/// Ground before a wall sees half of the sky and, so near a wall of 1 m, hardly more (Howell B-4); the dark under a shell that is drawn
/// from outside alone stays there.
#[test]
fn the_dark_under_a_shell_stays_there() {
    for light in before_the_wall(false) {
        assert!((0.48..0.58).contains(&light), "{light}");
    }
}

/// The inside of a shell with two sides is seen, and is dark.
#[test]
fn the_dark_under_a_shell_stays_there_can_fail() {
    assert!(before_the_wall(true)[0] < 0.3, "{:?}", before_the_wall(true));
}

/// The ground, of so many texels along a side, with a block of 1 m over a part of it that leaves a gap of some height; its side stands like the
/// shell's.
fn gap_over_ground(height: f32, side: u32) -> (Scene, SheetSettings) {
    let (ground, sheet) = ground();
    let (low, x, y, z) = (Vec3::new(0.03, height, -0.9), Vec3::X * 0.87, Vec3::Y, Vec3::Z * 1.8);
    let (high, far) = (low + y, low + x);
    let sides =
        [quad(low, z, y), quad(far, y, z), quad(low + z, x, y), quad(low, y, x), quad(high, z, x), quad(low, x, z)];
    let mut meshes = Vec::from_iter(std::iter::once(ground).chain(sides));
    meshes[1..].iter_mut().for_each(|mesh| mesh.material = 1);
    let block = Material::default();
    let scene = Scene { meshes, materials: vec![Material::default(), block], ..Scene::default() };
    (scene, SheetSettings { width: side, height: side, ..sheet })
}

/// The open share along a row of texels of the light map and of the transfer texture.
fn beside_the_block(height: f32, side: u32) -> [Vec<f32>; 2] {
    let (scene, sheet) = gap_over_ground(height, side);
    [row_of_map(&scene, sheet.clone()), row_of_texture(&scene, sheet)]
}

/// The same of the middle row of texels of a transfer texture.
fn row_of_texture(scene: &Scene, sheet: SheetSettings) -> Vec<f32> {
    let side = sheet.width;
    let textures = TextureSettings { sheets: vec![sheet], dilation: 2, levels: false, bent: false, stitch: true };
    let extras = Extras { textures: Some(textures), ..Extras::default() };
    let settings = fixed(2, Sampler::OwenSobol, 1024, 0);
    let prt = bake::bake_with(scene, &settings, &extras, &|_| ControlFlow::Continue(())).expect("it bakes");
    let held = prt.transfer_textures.as_ref().expect("transfer textures were asked for");
    let level = &held.sheets[0].levels[0];
    let values = level.diffuse.decode(prt.codebooks.diffuse.as_ref());
    let texel = |column: u32| {
        let place = side / 2 * side + column;
        let slot = level.places.iter().position(|&p| p == place).expect("the ground fills its sheet");
        // White light of radiance 1 has one coefficient.
        values[slot * 4 * held.channels as usize] * (4.0 * std::f32::consts::PI).sqrt()
    };
    (0..side).map(texel).collect()
}

/// A gap of 2.5 cm under a block is dark from some centimetres on, but texels of 10 cm cannot tell how far that is: before the block they
/// have the half of the sky that is open there, as before a wall.
#[test]
fn the_dark_of_a_gap_lower_than_a_texel_stays_there() {
    for row in beside_the_block(0.025, 20) {
        for light in at_the_wall(&row) {
            assert!((0.48..0.58).contains(&light), "{light}");
        }
    }
}

/// Of the sky a point under the edge of a long plate sees `(1 - sin(atan(d / h))) / 2`, at the depth d under the height h: texels that are
/// small enough tell it.
#[test]
fn gaps_as_high_as_a_texel_keep_their_dark() {
    let seen = |d: f64, h: f64| 0.5 * (1.0 - libm::sin(libm::atan2(d, h)));
    for row in beside_the_block(0.15, 20) {
        let exact = seen(0.12, 0.15) + seen(0.75, 0.15);
        assert!((f64::from(row[11]) - exact).abs() < 0.02, "{} instead of {exact}", row[11]);
    }
}

/// What stands at the point of the texel under the low gap would not pass for the light before a wall.
#[test]
fn the_dark_of_a_gap_lower_than_a_texel_stays_there_can_fail() {
    for row in beside_the_block(0.025, 100) {
        // The middle of column 52 lies at 0.05, as that of column 10 of 20.
        assert!((0.14..0.24).contains(&row[52]), "{}", row[52]);
        assert!(0.3 * 0.5 + 0.7 * row[52] < 0.4);
    }
}

/// A wall of 2 m that leans over ground by 30 degrees, with texels of 10 cm, and a kerb of 10 cm before it, 20 cm from its foot.
fn wall_behind_kerb() -> (Scene, SheetSettings) {
    let (_, sheet) = ground();
    let uv1 = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array).to_vec();
    let slope = 2.0 * Vec3::new(0.5, 0.75f32.sqrt(), 0.0);
    let wall = Mesh { uv1, ..quad(Vec3::Z, Vec3::NEG_Z * 2.0, slope) };
    let along = Vec3::Z * 80.0;
    let low = Vec3::new(0.2, 0.0, -40.0);
    let kerb = quad(low, along, Vec3::Y * 0.1);
    let top = quad(low + Vec3::Y * 0.1, along, Vec3::X * 40.0);
    let ground = quad(Vec3::new(-40.0, 0.0, -40.0), along, Vec3::X * 40.2);
    let mut meshes = vec![wall, kerb, top, ground];
    meshes.iter_mut().for_each(|mesh| mesh.material = 0);
    let material = Material { double_sided: true, ..Material::default() };
    (Scene { meshes, materials: vec![material], ..Scene::default() }, sheet)
}

/// The foot of a wall that leans over ground is seen, so its texels keep their own light: of the sky `(1 - sin(30 degrees + e)) / 2`, e the elevation
/// of what stands before them. What most texels above have would pass for it otherwise.
#[test]
fn the_foot_of_a_leaning_wall_keeps_its_light() {
    let (scene, sheet) = wall_behind_kerb();
    let prt = baked(&scene, sheet);
    let maps = prt.maps.as_ref().expect("maps were asked for");
    let mut white = vec![[0.0; 3]; 4];
    white[0] = [(4.0 * std::f32::consts::PI).sqrt(); 3];
    let values = maps.sheets[0].lit(maps, &white).functions.remove(0);
    let lean = std::f64::consts::FRAC_PI_6;
    let exact = |row: usize| {
        let up = (row as f64 + 0.5) * 0.1;
        let (x, y) = (up * libm::sin(lean), up * libm::cos(lean));
        let elevation = libm::atan2(0.1 - y, 0.2 - x).max(0.0);
        0.5 * (1.0 - libm::sin(lean + elevation))
    };
    for row in 0..2 {
        let found = f64::from(maps.basis.reconstruct(&[values[row * 20 + 10]], Vec3::Z)[0]);
        assert!((found - exact(row)).abs() < 0.02, "row {row}: {found} instead of {}", exact(row));
    }
    assert!(exact(1) - exact(0) > 0.1, "can fail: the light of the row above would be seen to be wrong");
}

/// Of the sky, weighed by a function of the cosine, what a point of the ground at z = 0.05 sees beside the plate of [`gap_over_ground`]: a sum over
/// the hemisphere.
fn beside_a_plate(x: f64, height: f64, weight: &dyn Fn(f64) -> f64) -> f64 {
    const N: usize = 600;
    let mut sum = 0.0;
    for k in 0..N * N {
        let cosine = ((k / N) as f64 + 0.5) / N as f64;
        let angle = std::f64::consts::TAU * ((k % N) as f64 + 0.5) / N as f64;
        let reach = height * (1.0 - cosine * cosine).sqrt() / cosine;
        let (at, along) = (x + reach * libm::cos(angle), 0.05 + reach * libm::sin(angle));
        let blocked = (0.03..0.9).contains(&at) && (-0.9..0.9).contains(&along);
        sum += if blocked { 0.0 } else { weight(cosine) };
    }
    2.0 * sum / (N * N) as f64
}

/// Under a plate little but slanting light comes in. Texels without normal maps take the cosine as it is.
#[test]
fn slanting_light_is_weighed_by_the_cosine() {
    for row in beside_the_block(0.15, 20) {
        for (column, light) in row.iter().enumerate().take(16).skip(11) {
            let exact = beside_a_plate(column as f64 * 0.1 - 0.95, 0.15, &|cosine| cosine);
            assert!((f64::from(*light) - exact).abs() < 0.01, "{column}: {light} instead of {exact}");
        }
    }
}

/// What three bands hold of the cosine does not pass for it there.
#[test]
fn slanting_light_is_weighed_by_the_cosine_can_fail() {
    let bands = |cosine: f64| 0.25 + 0.5 * cosine + 5.0 / 32.0 * (3.0 * cosine * cosine - 1.0);
    let off = |x: f64| beside_a_plate(x, 0.15, &bands) - beside_a_plate(x, 0.15, &|cosine| cosine);
    assert!(off(0.35).abs() > 0.012, "{}", off(0.35));
}

/// Places of the columns of vertices of a ground of which a strip of 2 cm shows before a block that leaves a gap of 2.5 mm.
const COLUMNS: [f32; 4] = [-1.0, -0.985, -0.94, 1.0];

/// That ground, of texels of 10 cm: the middle of none of them shows.
fn strip_before_a_block() -> (Scene, SheetSettings) {
    let (_, sheet) = ground();
    let rows = COLUMNS.iter().flat_map(|&x| [Vec3::new(x, 0.0, 1.0), Vec3::new(x, 0.0, -1.0)]);
    let positions = Vec::from_iter(rows);
    let uv1 = positions.iter().map(|p| 0.5 * Vec2::new(p.x + 1.0, 1.0 - p.z)).collect();
    let triangles = [0, 2, 4].into_iter().flat_map(|k| [[k, k + 2, k + 1], [k + 1, k + 2, k + 3]]).collect();
    let ground = Mesh { normals: vec![Vec3::Y; positions.len()], positions, triangles, uv1, ..Mesh::default() };
    let (low, x, y, z) = (Vec3::new(-0.98, 0.0025, -1.2), Vec3::X * 2.2, Vec3::Y, Vec3::Z * 2.4);
    let (high, far) = (low + y, low + x);
    let sides =
        [quad(low, z, y), quad(far, y, z), quad(low + z, x, y), quad(low, y, x), quad(high, z, x), quad(low, x, z)];
    let meshes = Vec::from_iter(std::iter::once(ground).chain(sides));
    (Scene { meshes, materials: vec![Material::default()], ..Scene::default() }, sheet)
}

/// A strip narrower than a texel has the half of the sky that is open there, not the dark that its texels lie in.
#[test]
fn a_strip_narrower_than_a_texel_keeps_its_light() {
    let (scene, sheet) = strip_before_a_block();
    for row in [row_of_map(&scene, sheet.clone()), row_of_texture(&scene, sheet)] {
        assert!((0.45..0.58).contains(&row[0]), "{}", row[0]);
    }
}

/// What the vertices around the middle of the texel take, each by its share.
#[test]
fn a_strip_narrower_than_a_texel_keeps_its_light_can_fail() {
    let (scene, sheet) = strip_before_a_block();
    let prt = baked(&scene, sheet);
    let row = |vertex: usize| prt.transfer.values[vertex * 4 * prt.transfer.channels as usize];
    let open = |vertex: usize| row(vertex) * (4.0 * std::f32::consts::PI).sqrt();
    let share = (-0.95 - COLUMNS[1]) / (COLUMNS[2] - COLUMNS[1]);
    let light = (1.0 - share) * open(2) + share * open(4);
    assert!(light < 0.3 && open(2) > 0.45, "{light}, {}", open(2));
}
