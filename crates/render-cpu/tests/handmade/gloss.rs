//! Walls that face +z and shine, from vertices or from texels, with tables that are written out.

use super::{Y0, camera, open_transfer, wall, white};
use coeff_io::{
    Arriving, Bounced, Gloss, GlossView, Material, Prt, Table, TransferLevel, TransferSheet, TransferTextures,
    VertexGloss,
};
use glam::{DVec3, Vec3};
use render_cpu::{Frame, environment_brdf};
use sh_math::{Bands, evaluate_f64, lobe::Lobe};
use testkit::quadrature::band_quadrature;

/// Bands of gloss in these tests.
pub(crate) const BANDS: u32 = 4;
/// Functions.
pub(crate) const FUNCTIONS: usize = 16;
/// Colour of the metal.
pub(crate) const METAL: [f32; 3] = [0.9, 0.6, 0.3];
/// Columns and rows of pictures.
pub(crate) const SIZE: u32 = 12;

/// Where receivers lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Storage {
    Vertices,
    Texels,
}

/// Both.
pub(crate) const STORAGES: [Storage; 2] = [Storage::Vertices, Storage::Texels];

pub(crate) fn bands() -> Bands {
    Bands::new(BANDS).expect("a number of bands")
}

/// A metal that mirrors.
pub(crate) fn metal(roughness: f32) -> Material {
    let [r, g, b] = METAL;
    Material { base_color: [r, g, b, 1.0], metallic: 1.0, specular: true, roughness, ..white() }
}

/// The wall fills this view exactly: pixel (i, j) sees (4 (i + 1/2) / SIZE - 2, 2 - 4 (j + 1/2) / SIZE, 0).
pub(crate) fn front(size: u32) -> Frame {
    let mut frame = Frame::plain(camera([0.0, 0.0, 2.0], [0.0; 3]), size, size);
    frame.camera.vertical_fov = std::f32::consts::FRAC_PI_2;
    frame
}

/// The same with a lobe, without a tail.
pub(crate) fn bare(lobe: Lobe) -> Frame {
    Frame { gloss: GlossView { lobe, tail: false, ..GlossView::default() }, ..front(SIZE) }
}

/// From the point that a pixel sees to the eye, unit.
pub(crate) fn to_eye(pixel: usize, size: u32) -> DVec3 {
    let at = |index: usize| 4.0 * (index as f64 + 0.5) / f64::from(size) - 2.0;
    let (column, row) = (pixel % size as usize, pixel / size as usize);
    (DVec3::new(0.0, 0.0, 2.0) - DVec3::new(at(column), -at(row), 0.0)).normalize()
}

/// `F0 A + B` of the metal at a pixel.
pub(crate) fn share(roughness: f32, pixel: usize, size: u32) -> [f32; 3] {
    let [scale, bias] = environment_brdf(roughness, to_eye(pixel, size).z as f32);
    METAL.map(|f0| f0 * scale + bias)
}

/// Coefficients of what is 1 where z lies in a range, else 0.
pub(crate) fn belt(low: f64, high: f64) -> Vec<f32> {
    let mut sums = vec![0.0; FUNCTIONS];
    let mut values = vec![0.0; FUNCTIONS];
    for (direction, weight) in band_quadrature(low, high, 16) {
        evaluate_f64(bands(), DVec3::from(direction), &mut values);
        sums.iter_mut().zip(&values).for_each(|(sum, y)| *sum += weight * y);
    }
    sums.into_iter().map(|sum| sum as f32).collect()
}

/// Numbers in [-1, 1] without a pattern.
pub(crate) fn noise(count: usize, seed: f32) -> Vec<f32> {
    (0..count).map(|i| (seed + 7.3 * i as f32 + 0.37 * (i * i) as f32).sin()).collect()
}

/// Bounces of one band and one channel: under a light of radiance 1, `values` arrive.
pub(crate) fn bounced(values: &[f32]) -> (Bounced, Vec<f32>) {
    (Bounced::Relightable { bands: 1, channels: 1 }, values.iter().map(|value| value * Y0).collect())
}

/// Gives all of a wall the same receivers.
pub(crate) fn same_everywhere(
    mut prt: Prt,
    storage: Storage,
    visibility: &[f32],
    bounces: Option<(Bounced, Vec<f32>)>,
) -> Prt {
    let rows = if storage == Storage::Vertices { prt.geometry.positions.len() } else { 1 };
    let table = |row: &[f32]| Table::exact(row.len() as u32, &row.repeat(rows));
    let arriving =
        Arriving { visibility: table(visibility), bounces: bounces.iter().map(|(_, values)| table(values)).collect() };
    let bounced = bounces.map(|(bounced, _)| bounced);
    let vertices = match storage {
        Storage::Vertices => Some(VertexGloss { first_row: vec![Some(0)], arriving }),
        Storage::Texels => {
            let diffuse = Table::exact(4, &open_transfer(Vec3::Z));
            lay_on(
                &mut prt,
                vec![TransferLevel { width: 1, height: 1, places: vec![0], diffuse, arriving: Some(arriving) }],
            );
            None
        }
    };
    prt.gloss = Some(Gloss { bands: BANDS, bounced, vertices });
    prt
}

/// Lays the wall upon a transfer texture of one channel; u runs to the right, v down.
pub(crate) fn lay_on(prt: &mut Prt, levels: Vec<TransferLevel>) {
    let positions = &prt.geometry.positions;
    prt.geometry.uv1 = positions.iter().map(|p| [p[0] / 4.0 + 0.5, 0.5 - p[1] / 4.0]).collect();
    let sheets = vec![TransferSheet { levels }];
    prt.transfer_textures = Some(TransferTextures { channels: 1, bent: false, sheets, sheet_of_mesh: vec![Some(0)] });
}

/// A metal wall with the same receivers everywhere.
pub(crate) fn metal_wall(
    storage: Storage,
    roughness: f32,
    visibility: &[f32],
    bounces: Option<(Bounced, Vec<f32>)>,
) -> Prt {
    same_everywhere(wall(metal(roughness)), storage, visibility, bounces)
}

/// A wall cut into `cells` by `cells` quads with vertices in common, of normal +z.
pub(crate) fn fine_wall(material: Material, cells: u32) -> Prt {
    let mut prt = wall(material);
    let side = cells + 1;
    let at = |i: u32| 4.0 * i as f32 / cells as f32 - 2.0;
    let geometry = &mut prt.geometry;
    geometry.positions = (0..side * side).map(|v| [at(v % side), at(v / side), 0.0]).collect();
    geometry.normals = vec![Vec3::Z.to_array(); (side * side) as usize];
    let corner = |cell: u32| cell / cells * side + cell % cells;
    let of_cell = |a: u32| [[a, a + 1, a + 1 + side], [a, a + 1 + side, a + side]];
    geometry.triangles = (0..cells * cells).flat_map(|cell| of_cell(corner(cell))).collect();
    prt.transfer.values = open_transfer(Vec3::Z).repeat((side * side) as usize);
    prt.transfer.albedo = vec![[1.0; 3]; (side * side) as usize];
    prt.meshes[0].vertices = side * side;
    prt.meshes[0].triangles = 2 * cells * cells;
    prt
}

/// Largest difference of two pictures.
pub(crate) fn apart(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}
