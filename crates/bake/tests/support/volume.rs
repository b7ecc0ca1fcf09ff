//! Light at a point of a volume, written for the tests: what is looked up in a file is written elsewhere, and differently.

use bake::{Extras, VolumePlace, VolumeSettings, VolumeSteps};
use coeff_io::{MapLight, Node, Settings, Volume};
use glam::{DVec2, DVec3, Vec3};
use scene::Scene;
use std::ops::ControlFlow;

/// Which probes around a point count, and how much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Rule {
    /// As the paper has it: by place alone.
    Trilinear,
    /// By place, validity, side, and whether the probe can see the point (Chebyshev).
    Visible,
    /// As the file has it, which renderers take.
    File,
}

/// Bakes a volume in a box with so many probes along each axis.
pub(crate) fn boxed(min: Vec3, max: Vec3, probes: [u32; 3]) -> VolumeSettings {
    VolumeSettings {
        place: VolumePlace::Box { min, max },
        steps: VolumeSteps::Probes(probes),
        ..VolumeSettings::standard()
    }
}

/// Bakes without showing progress.
pub(crate) fn bake_volume(scene: &Scene, settings: &Settings, volume: &VolumeSettings) -> Volume {
    let extras = Extras { volume: Some(volume.clone()), ..Extras::default() };
    let prt = bake::bake_with(scene, settings, &extras, &|_| ControlFlow::Continue(())).expect("the scene bakes");
    prt.volume.expect("a volume was asked for")
}

/// Coefficients of a sky of radiance 1.
pub(crate) fn white(bands: u32) -> Vec<[f32; 3]> {
    let mut light = vec![[0.0; 3]; (bands * bands) as usize];
    light[0] = [(4.0 * std::f64::consts::PI).sqrt() as f32; 3];
    light
}

/// The nine coefficients of a probe under a light, RGB.
pub(crate) fn lit(volume: &Volume, probe: usize, light: &[[f32; 3]]) -> [[f64; 3]; 9] {
    let (depth, channels) = (volume.light.depth(), volume.channels as usize);
    let values = &volume.values[probe * 9 * depth * channels..];
    let number = |k: usize, i: usize, c: usize| f64::from(values[(k * depth + i) * channels + c % channels]);
    std::array::from_fn(|k| {
        std::array::from_fn(|c| match volume.light {
            MapLight::Fixed { .. } => number(k, 0, c),
            MapLight::Relightable { .. } => (0..depth).map(|i| number(k, i, c) * f64::from(light[i][c])).sum(),
        })
    })
}

/// Sum of coefficient times function at a direction.
pub(crate) fn at_normal(coefficients: &[[f64; 3]; 9], normal: Vec3) -> [f64; 3] {
    let mut harmonics = [0.0; 9];
    sh_math::evaluate_f64(sh_math::Bands::new(3).expect("in range"), normal.as_dvec3(), &mut harmonics);
    std::array::from_fn(|c| coefficients.iter().zip(harmonics).map(|(value, y)| value[c] * y).sum())
}

/// Unit normals all around: the faces, edges and corners of a cube.
pub(crate) fn normals() -> impl Iterator<Item = Vec3> {
    let axis = |digit: usize| (digit % 3) as f32 - 1.0;
    (0..27).filter_map(move |i| Vec3::new(axis(i), axis(i / 3), axis(i / 9)).try_normalize())
}

/// Irradiance / pi at a point for a normal.
pub(crate) fn irradiance(volume: &Volume, point: Vec3, normal: Vec3, light: &[[f32; 3]], rule: Rule) -> [f64; 3] {
    if let Rule::File = rule {
        return volume.irradiance(point, normal, light).map(f64::from);
    }
    let (corners, shares) = around(volume, point);
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for (probe, share) in corners.into_iter().zip(shares) {
        let weight = match rule {
            Rule::Trilinear => share,
            Rule::Visible | Rule::File => share * visible(volume, probe as usize, point, normal),
        };
        let value = at_normal(&lit(volume, probe as usize, light), normal);
        sum = std::array::from_fn(|c| sum[c] + weight * value[c]);
        total += weight;
    }
    sum.map(|value| if total > 0.0 { value / total } else { 0.0 })
}

/// The probes around a point, and their trilinear shares.
fn around(volume: &Volume, point: Vec3) -> ([u32; 8], [f64; 8]) {
    let [origin, spacing] = [volume.origin, volume.spacing].map(|v| Vec3::from_array(v).as_dvec3());
    let cells = glam::UVec3::from_array(volume.cells);
    let place = ((point.as_dvec3() - origin) / spacing).clamp(DVec3::ZERO, cells.as_dvec3());
    let cell = place.as_uvec3().min(cells - 1);
    let mut within = place - cell.as_dvec3();
    let mut node = volume.nodes[(cell.x + cells.x * (cell.y + cells.y * cell.z)) as usize];
    loop {
        match node {
            Node::Leaf(corners) => {
                let share = |part: usize| {
                    let axis = |a: usize| if part >> a & 1 == 1 { within[a] } else { 1.0 - within[a] };
                    axis(0) * axis(1) * axis(2)
                };
                return (corners, std::array::from_fn(share));
            }
            Node::Split(first) => {
                let part = (within * 2.0).as_uvec3().min(glam::UVec3::ONE);
                within = within * 2.0 - part.as_dvec3();
                node = volume.nodes[(first + part.x + 2 * part.y + 4 * part.z) as usize];
            }
        }
    }
}

/// How much of a probe counts at a point.
fn visible(volume: &Volume, probe: usize, point: Vec3, normal: Vec3) -> f64 {
    let from = Vec3::from_array(volume.positions[probe]).as_dvec3();
    let way = point.as_dvec3() - from;
    let distance = way.length();
    if distance < 1e-9 {
        return f64::from(volume.validity[probe]);
    }
    let direction = way / distance;
    let wrapped = 0.5 * (1.0 - direction.dot(normal.as_dvec3()));
    let side = wrapped * wrapped + 0.2;
    let [mean, square] = told(volume, probe, direction);
    let variance = (square - mean * mean).max(1e-8);
    let excess = (distance - mean).max(0.0);
    let seen = (variance / (variance + excess * excess)).powi(3);
    f64::from(volume.validity[probe]) * side * seen
}

/// Mean and mean square distance that a probe tells of a direction: between the middles of the four nearest texels; over the border of
/// the square the map goes on where it is folded.
fn told(volume: &Volume, probe: usize, direction: DVec3) -> [f64; 2] {
    let p = direction / (direction.x.abs() + direction.y.abs() + direction.z.abs());
    let mut flat = DVec2::new(p.x, p.y);
    if p.z < 0.0 {
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        flat = DVec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y));
    }
    let side = i64::from(volume.resolution);
    let at = 0.5 * (flat + 1.0) * side as f64 - 0.5;
    let low = at.floor();
    let share = at - low;
    let mut sum = [0.0; 2];
    for (right, up) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let weight =
            DVec2::new(if right == 1 { share.x } else { 1.0 - share.x }, if up == 1 { share.y } else { 1.0 - share.y });
        let [column, row] = wrapped([low.x as i64 + right, low.y as i64 + up], side);
        let texel = 2 * ((probe as i64 * side + row) * side + column) as usize;
        for (sum, told) in sum.iter_mut().zip(&volume.distances[texel..]) {
            *sum += weight.x * weight.y * f64::from(*told);
        }
    }
    sum
}

/// The texel that one beyond the border is.
fn wrapped([mut column, mut row]: [i64; 2], side: i64) -> [i64; 2] {
    if !(0..side).contains(&column) {
        column = column.clamp(0, side - 1);
        row = side - 1 - row;
    }
    if !(0..side).contains(&row) {
        row = row.clamp(0, side - 1);
        column = side - 1 - column;
    }
    [column, row]
}
