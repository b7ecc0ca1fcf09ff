//! What a volume says between its probes: closed forms, and walls that light does not pass.

use coeff_io::{BEHIND, LEAST_DEVIATION, Lookup, MapLight, Node, Volume, irradiance_at, octahedral};
use glam::{DVec3, Vec2, Vec3};

const WHITE: [[f32; 3]; 1] = [[1.0; 3]];

/// A volume with a probe at every corner of every leaf; the first coarse cell is split. The first coefficient of a probe is `value` where it
/// stands, so that irradiance is `value / sqrt(4 pi)`.
fn volume(cells: [u32; 3], spacing: [f32; 3], split: bool, value: impl Fn(Vec3) -> f32) -> Volume {
    let origin = Vec3::new(-1.0, 2.0, 0.5);
    let edges = Vec3::from_array(spacing);
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let mut leaf = |corner: Vec3, edges: Vec3| {
        Node::Leaf(std::array::from_fn(|i| {
            let at = corner + edges * Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
            let at = at.to_array();
            positions.iter().position(|p| *p == at).unwrap_or_else(|| {
                positions.push(at);
                positions.len() - 1
            }) as u32
        }))
    };
    let corners = (0..cells[2]).flat_map(|z| (0..cells[1]).flat_map(move |y| (0..cells[0]).map(move |x| [x, y, z])));
    let corners: Vec<Vec3> = corners.map(|c| origin + edges * Vec3::from_array(c.map(|n| n as f32))).collect();
    let mut nodes: Vec<Node> = corners.iter().map(|corner| leaf(*corner, edges)).collect();
    if split {
        nodes[0] = Node::Split(nodes.len() as u32);
        for i in 0..8_u32 {
            let part = Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
            nodes.push(leaf(origin + edges * 0.5 * part, edges * 0.5));
        }
    }
    let mut values = vec![0.0; positions.len() * 9];
    for (i, position) in positions.iter().enumerate() {
        values[9 * i] = value(Vec3::from_array(*position));
    }
    Volume {
        origin: origin.to_array(),
        spacing,
        cells,
        nodes,
        light: MapLight::Relightable { bands: 1 },
        channels: 1,
        values,
        validity: vec![1.0; positions.len()],
        positions,
        distances: vec![],
        resolution: 0,
        reach: 10.0,
    }
}

/// Fills the maps of distances by a function of the probe's place and a direction.
fn with_distances(mut volume: Volume, side: u32, distance: impl Fn(Vec3, Vec3) -> f32) -> Volume {
    volume.resolution = side;
    for position in &volume.positions {
        for texel in 0..side * side {
            let direction = octahedral::direction(side, texel / side, texel % side);
            let told = distance(Vec3::from_array(*position), direction).min(volume.reach);
            volume.distances.extend([told, told * told]);
        }
    }
    volume
}

fn red(volume: &Volume, lookup: Lookup, point: Vec3, normal: Vec3) -> f64 {
    f64::from(volume.irradiance_by(lookup, point, normal, &WHITE)[0]) * (4.0 * std::f64::consts::PI).sqrt()
}

/// Points of a low-discrepancy sequence over a box somewhat larger than the volume.
fn points(volume: &Volume) -> impl Iterator<Item = Vec3> {
    let (origin, cells) = (Vec3::from_array(volume.origin), Vec3::from_array(volume.cells.map(|n| n as f32)));
    let size = cells * Vec3::from_array(volume.spacing);
    let part = |i: u32, step: f64| ((f64::from(i) * step).fract() * 1.4 - 0.2) as f32;
    (1..500).map(move |i| origin + size * Vec3::new(part(i, 0.819_172_5), part(i, 0.671_043_6), part(i, 0.549_700_5)))
}

/// A field that is linear in space is given back exactly inside, in cells of both levels, and as on the border outside.
#[test]
fn a_linear_field_is_given_back() {
    let field = |p: Vec3| 0.5 + 0.25 * p.x - 0.125 * p.y + 0.0625 * p.z;
    let volume = volume([2, 3, 2], [1.0, 0.5, 2.0], true, field);
    let (low, high) = (Vec3::new(-1.0, 2.0, 0.5), Vec3::new(1.0, 3.5, 4.5));
    let mut levels = [0; 2];
    for point in points(&volume) {
        let expected = field(point.clamp(low, high));
        let found = red(&volume, Lookup::Trilinear, point, Vec3::Y);
        assert!((found - f64::from(expected)).abs() < 2e-6, "{point}: {found}, not {expected}");
        levels[volume.cell(point).level as usize] += 1;
    }
    assert!(levels.iter().all(|n| *n > 10), "{levels:?}");
}

/// A bent field is not: the check sees a wrong interpolation.
#[test]
fn a_linear_field_is_given_back_can_fail() {
    let volume = volume([2, 3, 2], [1.0, 0.5, 2.0], true, |p| p.x * p.x);
    let worst = points(&volume).map(|p| (red(&volume, Lookup::Trilinear, p, Vec3::Y) - f64::from(p.x * p.x)).abs());
    assert!(worst.fold(0.0, f64::max) > 0.1);
}

#[test]
fn weights_sum_to_one_and_points_that_are_none_find_a_cell() {
    let volume = with_distances(volume([2, 2, 2], [1.0; 3], true, |_| 1.0), 8, |p, d| 0.1 + p.y.abs() + d.x.abs());
    for point in points(&volume) {
        for normal in [None, Some(Vec3::Y), Some(Vec3::new(0.6, 0.0, -0.8))] {
            let weights = volume.weights(point, normal, Lookup::Visible).weights;
            assert!(
                (weights.iter().sum::<f32>() - 1.0).abs() < 1e-5 && weights.iter().all(|w| *w >= 0.0),
                "{weights:?}"
            );
        }
        assert!((red(&volume, Lookup::Visible, point, Vec3::X) - 1.0).abs() < 1e-5, "a constant field is given back");
    }
    for point in [Vec3::NAN, Vec3::INFINITY, Vec3::NEG_INFINITY] {
        let place = volume.cell(point).place;
        assert!(place.cmpge(Vec3::ZERO).all() && place.cmple(Vec3::ONE).all(), "{point}: {place}");
    }
}

/// A wall at x = 0 between probes at -1 and 1: the left room is lit. Plain weights leak half the light to the foot of the wall; with
/// distances the dark side is dark and the lit side is lit, from 3 % of the step on: between the middles of texels distances to a wall,
/// which go as 1 / cos, are told up to 2 % too long.
#[test]
fn light_does_not_pass_a_wall() {
    let lit = |p: Vec3| if p.x < 0.0 { 1.0 } else { 0.0 };
    let wall = |p: Vec3, d: Vec3| if p.x * d.x < 0.0 { p.x.abs() / d.x.abs() } else { 10.0 };
    let volume = with_distances(volume([1, 2, 2], [2.0, 1.0, 1.0], false, lit), 32, wall);
    let mut worst = [0.0_f64; 3];
    for i in 0..40 {
        let [y, z] = [0.1 + 0.045 * i as f32, 1.9 - 0.045 * i as f32];
        for x in [0.06, 0.1, 0.3, 0.6_f32] {
            let point = |x: f32| Vec3::new(x, 2.0 + y, 0.5 + z);
            let dark = red(&volume, Lookup::Visible, point(x), Vec3::X);
            let bright = red(&volume, Lookup::Visible, point(-x), Vec3::NEG_X);
            let plain = red(&volume, Lookup::Trilinear, point(x), Vec3::X);
            assert!((plain - f64::from(1.0 - x) / 2.0).abs() < 1e-5, "the plain rule has a closed form");
            worst = [worst[0].max(dark), worst[1].max(1.0 - bright), worst[2].max(plain)];
        }
    }
    assert!(worst[0] < 0.03 && worst[1] < 0.03, "leaks of {worst:?}");
    assert!(worst[2] > 0.46, "the plain rule leaks: {worst:?}");
}

/// One probe's weight against a calculation by hand, with a spread of distances.
#[test]
fn visibility_is_the_bound_of_chebyshev() {
    let mut volume = volume([1, 1, 1], [2.0, 2.0, 2.0], false, |_| 1.0);
    // Mean 0.5, mean square 0.5: variance 0.25 everywhere, for all probes.
    volume.resolution = 4;
    volume.distances = [0.5, 0.5].repeat(volume.positions.len() * 16);
    let point = Vec3::new(-0.5, 2.25, 0.75);
    let weights = volume.weights(point, None, Lookup::Visible);
    let hand: Vec<f64> = (0..8)
        .map(|i| {
            let at = DVec3::from(Vec3::from_array(volume.positions[weights.probes[i] as usize]));
            let away = at - DVec3::from(point);
            let trilinear: f64 = away.to_array().iter().map(|d| 1.0 - d.abs() / 2.0).product();
            let bound = 0.25 / (0.25 + (away.length() - 0.5).max(0.0).powi(2));
            trilinear * bound.powi(3)
        })
        .collect();
    let sum: f64 = hand.iter().sum();
    for (found, expected) in weights.weights.iter().zip(&hand) {
        assert!((f64::from(*found) - expected / sum).abs() < 1e-6, "{weights:?} {hand:?}");
    }
    // Without spread the least deviation holds: with edges of 2 it is 0.01.
    volume.distances = [0.5, 0.25].repeat(volume.positions.len() * 16);
    let sharp = volume.weights(point, None, Lookup::Visible).weights;
    assert!(LEAST_DEVIATION == 0.005 && sharp[0] > 0.99 && sharp[0] > weights.weights[0], "{sharp:?}");
}

/// In free space without distances a normal alone weighs by side: squared half-cosines and a fifth.
#[test]
fn probes_behind_count_less() {
    let volume = volume([1, 1, 1], [2.0; 3], false, |_| 1.0);
    let centre = Vec3::new(0.0, 3.0, 1.5);
    let weights = volume.weights(centre, Some(Vec3::Y), Lookup::Visible).weights;
    let [before, behind] = [1.0, -1.0].map(|sign| (sign / 3.0_f64.sqrt() / 2.0 + 0.5).powi(2) + 0.2);
    assert!((f64::from(weights[2] / weights[0]) - before / behind).abs() < 1e-5, "{weights:?}");
    assert_eq!(BEHIND, 0.2);
    assert_eq!(volume.weights(centre, Some(Vec3::Y), Lookup::Trilinear).weights, [0.125; 8]);
}

/// Probes inside of bodies do not count; where all are, the plain rule holds.
#[test]
fn invalid_probes_do_not_count() {
    let mut volume = volume([1, 1, 1], [2.0; 3], false, |p| p.x);
    let centre = Vec3::new(0.0, 3.0, 1.5);
    for (probe, position) in volume.positions.iter().enumerate() {
        volume.validity[probe] = if position[0] < 0.0 { 0.0 } else { 1.0 };
    }
    assert!((red(&volume, Lookup::Visible, centre, Vec3::Y) - 1.0).abs() < 1e-6);
    assert!(red(&volume, Lookup::Trilinear, centre, Vec3::Y).abs() < 1e-6);
    volume.validity.fill(0.0);
    assert!(red(&volume, Lookup::Visible, centre, Vec3::Y).abs() < 1e-6);
    // All valid, none seen: the plain rule again, not a division by nothing.
    volume.validity.fill(1.0);
    volume.reach = 100.0;
    let hidden = with_distances(Volume { spacing: [2.0, 2.0, 2.0], ..volume }, 1, |_, _| 0.0);
    let found = red(&hidden, Lookup::Visible, centre, Vec3::Y);
    assert!(found.abs() < 1e-6, "{found}");
}

/// Irradiance is the sum of coefficients and functions, and of light and transfer, reckoned here in f64 by loops of their own.
#[test]
fn irradiance_is_linear_in_the_light() {
    let mut volume = volume([1, 1, 1], [2.0; 3], false, |_| 0.0);
    (volume.light, volume.channels) = (MapLight::Relightable { bands: 2 }, 3);
    volume.values = (0..8 * 9 * 4 * 3).map(|i| ((i * 37 % 101) as f32 - 50.0) / 64.0).collect();
    let light: Vec<[f32; 3]> = (0..4).map(|i| [i as f32 - 1.0, 0.5 * i as f32, 2.0]).collect();
    let normal = Vec3::new(0.48, 0.6, -0.64);
    let point = Vec3::new(-0.75, 2.5, 1.25);
    let (mut functions, mut sum) = ([0.0; 9], [0.0_f64; 3]);
    sh_math::evaluate_f64(sh_math::Bands::new(3).unwrap(), DVec3::from(normal), &mut functions);
    for (corner, probe) in volume.cell(point).probes.into_iter().enumerate() {
        let share = |axis: usize, at: f64| if corner >> axis & 1 == 1 { at } else { 1.0 - at };
        let weight = share(0, 0.125) * share(1, 0.25) * share(2, 0.375);
        for (k, function) in functions.iter().enumerate() {
            for (i, light) in light.iter().enumerate() {
                for c in 0..3 {
                    let value = volume.values[((probe as usize * 9 + k) * 4 + i) * 3 + c];
                    sum[c] += weight * function * f64::from(value) * f64::from(light[c]);
                }
            }
        }
    }
    let found = volume.irradiance_by(Lookup::Trilinear, point, normal, &light);
    for c in 0..3 {
        assert!((f64::from(found[c]) - sum[c]).abs() < 1e-5, "{found:?}, not {sum:?}");
    }
    let blended = volume.weights(point, None, Lookup::Trilinear).blend(&volume.lit(&light));
    assert_eq!(irradiance_at(&blended, normal), found);
    assert_eq!(volume.lit(&light)[3], volume.coefficients(3, &light));
    let fixed =
        Volume { light: MapLight::Fixed { probe: "sky".into(), bands: 5 }, values: vec![0.5; 8 * 9 * 3], ..volume };
    assert_eq!(fixed.coefficients(7, &[]), [[0.5; 3]; 9]);
}

/// Directions go to the square and back; the axes lie where the description says; texels tile the sphere.
#[test]
fn the_octahedron_unfolds() {
    for i in 0..1000 {
        let (z, phi) = (1.0 - (i as f32 + 0.5) / 500.0, i as f32 * 2.4);
        let direction = Vec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
        let back = octahedral::of_square(octahedral::to_square(direction));
        assert!((back - direction).length() < 1e-5, "{direction} became {back}");
    }
    assert_eq!(octahedral::to_square(Vec3::Z), Vec2::ZERO);
    assert_eq!(octahedral::to_square(Vec3::X), Vec2::X);
    assert_eq!(octahedral::to_square(Vec3::NEG_Y), Vec2::NEG_Y);
    assert_eq!(octahedral::to_square(Vec3::NEG_Z).abs(), Vec2::ONE);
    let mean = |axis: fn(Vec3) -> f32| (0..64).map(|i| axis(octahedral::direction(8, i / 8, i % 8))).sum::<f32>();
    assert!(mean(|d| d.x).abs() < 1e-5 && mean(|d| d.y).abs() < 1e-5 && mean(|d| d.z).abs() < 1e-5);
}

/// The largest error of maps that hold a linear function between their texels.
fn worst_of_map(side: u32) -> f32 {
    let linear = |d: Vec3| d.x + 2.0 * d.y + 3.0 * d.z;
    let texels = (0..side * side).flat_map(|i| [linear(octahedral::direction(side, i / side, i % side)), 1.0]);
    let map: Vec<f32> = texels.collect();
    let mut worst = 0.0_f32;
    for i in 0..4000 {
        let (z, phi) = (1.0 - (i as f32 + 0.5) / 2000.0, i as f32 * 2.4);
        let d = Vec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
        let [found, one] = octahedral::look_up(&map, side, d);
        assert!((one - 1.0).abs() < 1e-5);
        worst = worst.max((found - linear(d)).abs());
    }
    worst
}

/// Between texels a map errs most where the octahedron is folded: by a quarter of a step times the change of the slope there, which is at most
/// twice the function's, 3.75, times 2, as a step on the square turns a direction by at most 2 steps at a fold. Half the step, half the error.
/// Both sides of an edge are the same place.
#[test]
fn maps_are_whole_across_folds_and_edges() {
    let [coarse, fine] = [worst_of_map(32), worst_of_map(64)];
    assert!(coarse < 2.0 / 32.0 / 4.0 * (2.0 * 3.75 * 2.0) && fine < 0.6 * coarse, "{coarse}, {fine}");
    for v in [0.0, 0.3, 0.9] {
        assert!((octahedral::of_square(Vec2::new(1.0, v)) - octahedral::of_square(Vec2::new(1.0, -v))).length() < 1e-6);
        let map: Vec<f32> = (0..64).flat_map(|i| [i as f32, 0.0]).collect();
        let seen = |x, y| octahedral::look_up(&map, 8, octahedral::of_square(Vec2::new(x, y)))[0];
        assert!((seen(0.9999, v) - seen(0.9999, -v)).abs() < 0.05, "{v}: an edge has two values");
    }
}
