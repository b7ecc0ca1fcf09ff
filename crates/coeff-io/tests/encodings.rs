//! Encodings give back what they were given within what their bits allow, and errors are told where they are seen.

use coeff_io::{
    Coding, Curve, Effort, Encoding, Layers, Lit, MapLight, Maps, Ranges, Sheet, curves, linear_of_srgb, normals,
    srgb_of_linear,
};
use sh_math::hemisphere::Basis;
use std::f64::consts::PI;

/// Numbers in [0, 1) from a counter.
fn noise(i: u32) -> f32 {
    let mut x = i.wrapping_mul(0x9E37_79B1) ^ 0x5bd1_e995;
    x = (x ^ x >> 15).wrapping_mul(0x2c1b_3c6d);
    x = (x ^ x >> 12).wrapping_mul(0x297a_2d39);
    (x >> 8) as f32 / (1 << 24) as f32
}

/// The projection of a lamp of unit irradiance onto the modified H-basis, at `angle` from the normal: what the paper's listing 2.1 gives.
fn lamp(angle: f64) -> [f64; 6] {
    let direction = glam::DVec3::new(angle.sin(), 0.0, angle.cos());
    let mut light = [0.0; 9];
    sh_math::evaluate_f64(sh_math::Bands::new(3).unwrap(), direction, &mut light);
    let bands = [1.0, 2.0 / 3.0, 0.25];
    let irradiance: Vec<f64> = (0..9).map(|i| light[i] * bands[(i as f64).sqrt() as usize]).collect();
    // Least squares on the hemisphere against the functions, by a rule of its own: a fine grid.
    let (mut gram, mut right) = ([[0.0; 6]; 6], [0.0; 6]);
    for i in 0..120 {
        for j in 0..240 {
            let (z, phi) = ((i as f64 + 0.5) / 120.0, (j as f64 + 0.5) * PI / 120.0);
            let normal = glam::DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
            let (mut functions, mut world) = ([0.0; 6], [0.0; 9]);
            Basis::ModifiedH6.evaluate_f64(normal, &mut functions);
            sh_math::evaluate_f64(sh_math::Bands::new(3).unwrap(), normal, &mut world);
            let value: f64 = (0..9).map(|k| irradiance[k] * world[k]).sum();
            for a in 0..6 {
                right[a] += functions[a] * value;
                for b in 0..6 {
                    gram[a][b] += functions[a] * functions[b];
                }
            }
        }
    }
    solve(gram, right)
}

fn solve(mut matrix: [[f64; 6]; 6], mut right: [f64; 6]) -> [f64; 6] {
    for i in 0..6 {
        for row in i + 1..6 {
            let factor = matrix[row][i] / matrix[i][i];
            let pivot = matrix[i];
            matrix[row].iter_mut().zip(pivot).for_each(|(value, above)| *value -= factor * above);
            right[row] -= factor * right[i];
        }
    }
    for i in (0..6).rev() {
        let known: f64 = (i + 1..6).map(|k| matrix[i][k] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}

/// How strong the lamp of a sheet is along u.
#[derive(Clone, Copy, PartialEq)]
enum Lamp {
    /// Equally: the constant falls.
    Even,
    /// So that the constant is 1 everywhere, as where several lamps stand.
    Level,
}

/// A sheet of `width x height` texels under a lamp that sinks from the normal to the horizon along u, in three colours, scaled so that the
/// constant stays below 1.
fn sunset(width: u32, height: u32, strength: Lamp) -> Vec<f32> {
    let columns: Vec<[f64; 6]> = (0..width).map(|x| lamp(PI / 2.0 * f64::from(x) / f64::from(width - 1))).collect();
    let largest = columns.iter().map(|c| c[0]).fold(0.0, f64::max);
    let mut values = Vec::new();
    for function in 0..6 {
        for row in 0..height {
            for column in &columns {
                let fade = 1.0 - 0.5 * f64::from(row) / f64::from(height);
                let scale = if strength == Lamp::Even { largest } else { column[0] };
                // Nothing depends on y; what the grid leaves there is rounding.
                let scale = if function == 1 || function == 4 { f64::INFINITY } else { scale };
                values.extend([1.0, 0.75, 0.5].map(|c| (column[function] / scale * fade * c) as f32));
            }
        }
    }
    values
}

fn maps(light: MapLight) -> Maps {
    Maps { basis: Basis::ModifiedH6, light, sheets: vec![], sheet_of_mesh: vec![] }
}

fn fixed() -> MapLight {
    MapLight::Fixed { probe: "lamp".into(), bands: 3 }
}

fn lit(layers: Layers) -> Lit {
    Sheet { layers }.lit(&maps(fixed()), &[])
}

#[test]
fn eight_bits_hold_both_ends_and_half_a_step() {
    let values = sunset(33, 9, Lamp::Even);
    // Charts: two halves of the sheet, of which the second is far dimmer, and a column of none.
    let charts: Vec<u32> =
        (0..33 * 9).map(|i| [7, 9, u32::MAX][usize::from(i % 33 > 15) + usize::from(i % 33 == 32)]).collect();
    let curves = curves(Basis::ModifiedH6, &fixed());
    assert_eq!(curves[..2], [Curve::Srgb, Curve::Linear]);
    let coding = Coding { charts: &charts, curves: &curves, ..Coding::plain(Encoding::U8) };
    let encoded = Layers::encode([33, 9, 6, 3], &values, &coding);
    assert_eq!((encoded.clipped, encoded.negative), (0, 0));
    // 4, a curve per layer, a range per chart and layer, a byte per texel, a code per number.
    assert_eq!(encoded.layers.bytes.len(), 4 + 6 + 2 * 6 * 8 + 33 * 9 + 33 * 9 * 18);
    let decoded = encoded.layers.decode();
    for (layer, curve) in curves.iter().enumerate() {
        for chart in [7, 9] {
            let of = |i: &usize| i / (33 * 9 * 3) == layer && charts[i / 3 % (33 * 9)] == chart;
            let numbers: Vec<usize> = (0..values.len()).filter(of).collect();
            let low = numbers.iter().map(|i| values[*i]).fold(f32::INFINITY, f32::min);
            let high = numbers.iter().map(|i| values[*i]).fold(f32::NEG_INFINITY, f32::max);
            // Half a step of a line; under the curve of sRGB, whose slope is at most 2.4 / 1.055 of a line's, half of that.
            let bound = match curve {
                Curve::Linear => (high - low) / 510.0,
                Curve::Srgb => high / 510.0 * 2.4 / 1.055,
            };
            for i in numbers {
                assert!((decoded[i] - values[i]).abs() <= bound * 1.001 + 1e-7, "layer {layer}, chart {chart}: {i}");
                let end = values[i] == high || (values[i] == low && *curve == Curve::Linear);
                assert!(!end || decoded[i] == values[i], "layer {layer}, chart {chart}: the end {} is lost", values[i]);
            }
        }
    }
    assert!((0..9).all(|row| decoded[(row * 33 + 32) * 3] == 0.0), "texels of no chart are dark");
}

/// N-E3: the fixed range of 0.75 clips where light grazes, data-chosen ranges do not; and one range for all is coarser.
#[test]
fn a_fixed_range_clips_grazing_light() {
    let values = sunset(65, 2, Lamp::Level);
    let curves = curves(Basis::ModifiedH6, &fixed());
    let ranges = Ranges::Fixed { constant: 1.0, rest: 0.75 };
    let error = |ranges| {
        let coding = Coding { curves: &curves, ranges, ..Coding::plain(Encoding::U8) };
        let encoded = Layers::encode([65, 2, 6, 3], &values, &coding);
        let exact = lit(Layers::exact([65, 2, 6, 3], &values));
        (encoded.clipped, lit(encoded.layers).error(&exact, Basis::ModifiedH6, &[], &normals(64)))
    };
    let ((clipped, fixed), (none, chosen)) = (error(ranges), error(Ranges::Charts));
    // The ratio of a coefficient to the constant is 0.57 with the lamp at the normal and above 1 from 75 degrees on.
    let beyond = values[65 * 2 * 3..].iter().filter(|v| v.abs() > 0.75).count() as u64;
    assert_eq!((clipped, none), (beyond, 0));
    assert!(beyond > 0, "the fixed range would hold all");
    assert!(fixed.worst > 10.0 * chosen.worst && fixed.rms > 3.0 * chosen.rms, "{fixed:?} {chosen:?}");
    // Six functions of size about 0.4, in steps of at most 4/255 with a mean error of 1/sqrt(12) of that: 0.0044 of a mean of 0.21.
    assert!(chosen.rms_relative() < 0.021, "{chosen:?}");
}

/// The paper's own figure: a lamp at 85 degrees has coefficients of 1.7 times the constant (N-E3).
#[test]
fn grazing_light_exceeds_the_rule_of_thumb() {
    let ratio = |degrees: f64| {
        let c = lamp(degrees.to_radians());
        c[1..].iter().map(|v| v.abs()).fold(0.0, f64::max) / c[0]
    };
    for (degrees, expected) in [(0.0, 0.57), (60.0, 0.72), (75.0, 1.15), (85.0, 1.70), (90.0, 2.17)] {
        assert!((ratio(degrees) - expected).abs() < 0.01, "{degrees}: {}", ratio(degrees));
    }
}

/// N-E2: what the paper prints adds a half instead of stretching the range; its shader then reads 1.5 times the coefficient.
#[test]
fn the_printed_range_is_wrong() {
    let printed = |c: f32| 2.0 * 0.75 * (c + 0.75 / (2.0 * 0.75)).clamp(0.0, 1.0) - 0.75;
    let coding = Coding { ranges: Ranges::Fixed { constant: 1.0, rest: 0.75 }, ..Coding::plain(Encoding::U8) };
    for c in [-0.6, -0.4, -0.1, 0.2, 0.5, 0.6_f32] {
        let ours = Layers::encode([1, 1, 1, 1], &[c], &coding).layers.decode()[0];
        assert!((ours - c).abs() <= 0.75 / 255.0 + 1e-6, "{c} became {ours}");
        assert!((printed(c) - c).abs() >= 0.049, "{c} became {}", printed(c));
    }
}

/// N-E5, N-E6: negative irradiance is clamped before the curve and counted; the curve is the piecewise one.
#[test]
fn the_constant_is_clamped_before_the_curve() {
    let coding = Coding { curves: &[Curve::Srgb], ..Coding::plain(Encoding::U8) };
    let encoded = Layers::encode([4, 1, 1, 1], &[-0.01, 0.0, 0.2, 0.5], &coding);
    assert_eq!((encoded.negative, encoded.clipped), (1, 0));
    let decoded = encoded.layers.decode();
    assert_eq!((decoded[0], decoded[1], decoded[3]), (0.0, 0.0, 0.5));
    // Of 0.4 of the range: the printed code of sRGB, 255 * (1.055 * 0.4^(1/2.4) - 0.055) = 169.6; its colour table says 170 is 0.40198.
    assert!((decoded[2] - 0.5 * 0.401_978).abs() < 1e-5, "{decoded:?}");
    // Published pairs of 8-bit sRGB and linear light; the power of 2.2 misses them.
    for (code, linear) in
        [(0, 0.0), (10, 0.003_035_3), (55, 0.038_204_4), (128, 0.215_860_5), (188, 0.502_886_5), (255, 1.0)]
    {
        let share = code as f32 / 255.0;
        assert!((linear_of_srgb(share) - linear).abs() < 1e-6, "{code}");
        assert!((srgb_of_linear(linear) - share).abs() < 1e-5, "{code}");
    }
    assert!(((10.0_f32 / 255.0).powf(2.2) - 0.003_035_3).abs() > 1e-3);
}

#[test]
fn halves_hold_eleven_bits() {
    let values: Vec<f32> = (0..96).map(|i| (noise(i) - 0.5) * 4.0).collect();
    let encoded = Layers::encode([4, 4, 2, 3], &values, &Coding::plain(Encoding::F16));
    assert_eq!((encoded.layers.bytes.len(), encoded.clipped), (192, 0));
    for (a, b) in encoded.layers.decode().iter().zip(&values) {
        assert!((a - b).abs() <= b.abs() / 2048.0 + 3e-8, "{b} became {a}");
    }
    let huge = Layers::encode([1, 1, 1, 1], &[1e6], &Coding::plain(Encoding::F16));
    assert_eq!((huge.clipped, huge.layers.decode()[0]), (1, 65504.0));
}

/// The least and the greatest.
fn range(numbers: impl Iterator<Item = f32>) -> [f32; 2] {
    numbers.fold([f32::MAX, f32::MIN], |[a, b], v| [a.min(v), b.max(v)])
}

/// Smooth coefficients through both block formats, against bounds from their steps. Ends of BC1 stand in steps of 1/31 of the range, and
/// a texel is within a sixth of what its block spans. Ends of BC6H have ten bits for 31 octaves, so 32 steps in the highest octave, which
/// is half of the range; a texel is within a fourteenth of the span.
#[test]
fn blocks_stay_within_their_steps() {
    let (width, height) = (64, 16);
    let values = sunset(width, height, Lamp::Even);
    let shape = [width, height, 6, 3];
    let exact = lit(Layers::exact(shape, &values));
    let mut table = Vec::new();
    for (encoding, effort) in [
        (Encoding::Bc1, Effort::Basic),
        (Encoding::Bc6h, Effort::Fast),
        (Encoding::Bc6h, Effort::Basic),
        (Encoding::Bc6h, Effort::Slow),
    ] {
        let encoded = Layers::encode(shape, &values, &Coding { effort, ..Coding::plain(encoding) });
        let decoded = encoded.layers.decode();
        let plane = (width * height * 3) as usize;
        for layer in 0..6 {
            let numbers = &values[layer * plane..][..plane];
            let all = range(numbers.iter().copied());
            let [blocks, row] = [width as usize / 4, width as usize * 3];
            let texels = |block: usize| {
                (0..48).map(move |i| block / blocks * 4 * row + i / 12 * row + block % blocks * 12 + i % 12)
            };
            for block in 0..blocks * height as usize / 4 {
                let [low, high] = range(texels(block).map(|i| numbers[i]));
                let worst = texels(block).map(|i| (decoded[layer * plane + i] - numbers[i]).abs()).fold(0.0, f32::max);
                let bound = match encoding {
                    Encoding::Bc1 => (all[1] - all[0]) / 31.0 + (high - low) / 6.0,
                    _ => (all[1] - all[0]) / 64.0 + (high - low) / 14.0,
                };
                assert!(
                    worst <= bound + 1e-6,
                    "{encoding:?} {effort:?} layer {layer} block {block}: {worst}, not {bound}"
                );
            }
        }
        let error = lit(encoded.layers.clone()).error(&exact, Basis::ModifiedH6, &[], &normals(64));
        table.push((encoded.layers.bytes.len(), error.rms_relative()));
    }
    let blocks = (width / 4 * height / 4) as usize * 6;
    assert_eq!((table[0].0, table[2].0), (6 + 6 * 3 * 8 + blocks * 8, 6 + 6 * 8 + blocks * 16));
    let eight = Layers::encode(shape, &values, &Coding::plain(Encoding::U8)).layers;
    let eight = lit(eight).error(&exact, Basis::ModifiedH6, &[], &normals(64)).rms_relative();
    assert!(eight < table[2].1 && 2.0 * table[2].1 < table[0].1, "more bytes, more error: {eight}, {table:?}");
    assert!(table[3].1 <= table[1].1, "more effort, more error: {table:?}");
}

/// The check sees blocks that were put in the wrong place.
#[test]
fn blocks_stay_within_their_steps_can_fail() {
    let values = sunset(64, 16, Lamp::Even);
    let exact = lit(Layers::exact([64, 16, 6, 3], &values));
    let mut layers = Layers::encode([64, 16, 6, 3], &values, &Coding::plain(Encoding::Bc6h)).layers;
    let end = layers.bytes.len();
    layers.bytes[end - 64 * 16..].rotate_left(16);
    assert!(lit(layers).error(&exact, Basis::ModifiedH6, &[], &normals(64)).worst_relative() > 0.05);
}

/// Sides that are no multiple of 4 and texels of no chart change nothing of the others.
#[test]
fn odd_sides_are_padded_and_gaps_follow_their_block() {
    for encoding in [Encoding::Bc1, Encoding::Bc6h] {
        for channels in [1, 3] {
            let constant: Vec<f32> =
                (0..5 * 7 * 2 * channels).map(|i| if i < 35 * channels { 0.5 } else { -0.25 }).collect();
            let layers = Layers::encode([5, 7, 2, channels], &constant, &Coding::plain(encoding)).layers;
            assert_eq!(layers.decode(), constant, "{encoding:?}: a flat layer is exact");
        }
        // A gap of wild numbers within a flat sheet.
        let charts: Vec<u32> = (0..35).map(|i| if i % 5 == 2 { u32::MAX } else { 1 }).collect();
        let values: Vec<f32> =
            (0..35).flat_map(|i| [if i % 5 == 2 { 1e9 } else { 0.5 + 0.001 * (i % 5) as f32 }; 3]).collect();
        let coding = Coding { charts: &charts, ..Coding::plain(encoding) };
        let decoded = Layers::encode([5, 7, 1, 3], &values, &coding).layers.decode();
        for i in (0..35).filter(|i| i % 5 != 2) {
            assert!(
                (decoded[3 * i] - values[3 * i]).abs() < 0.001,
                "{encoding:?}: {} became {}",
                values[3 * i],
                decoded[3 * i]
            );
        }
    }
}

/// A layer alone is what it is among all, in every encoding and with odd sides.
#[test]
fn layers_are_decoded_alone() {
    let values: Vec<f32> = (0..7 * 5 * 4 * 3).map(|i| noise(i) * 3.0 - 1.0).collect();
    for encoding in Encoding::ALL {
        let layers = Layers::encode([7, 5, 4, 3], &values, &Coding::plain(encoding)).layers;
        let all = layers.decode();
        assert_eq!(all.len(), values.len());
        for layer in 0..4 {
            assert_eq!(layers.decode_layer(layer), all[layer as usize * 105..][..105], "{encoding:?}");
        }
        let worst = all.iter().zip(&values).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        // Noise is the worst that blocks can meet; but for them the numbers stand where they were.
        assert!(matches!(encoding, Encoding::Bc1 | Encoding::Bc6h) || worst < 0.01, "{encoding:?}: {worst}");
    }
}

/// Errors are those of irradiance: reckoned here from the coefficients by hand.
#[test]
fn errors_are_told_in_irradiance() {
    let lit = |first: f32| Lit { width: 2, height: 1, functions: vec![vec![[1.0; 3], [first, 1.0, 1.0]]] };
    // The only function of this basis is sqrt(1/2pi): a difference of 0.1 in one channel of one of two texels.
    let error = lit(1.1).error(&lit(1.0), Basis::ModifiedH1, &[], &normals(10));
    let function = (0.5 / PI).sqrt();
    assert!((error.worst - 0.1 * function).abs() < 1e-7 && (error.mean - function).abs() < 1e-7, "{error:?}");
    assert!((error.rms - 0.1 * function / 6.0_f64.sqrt()).abs() < 1e-7, "{error:?}");
    assert!((error.worst_relative() - 0.1).abs() < 1e-6 && error.worst_texel == [0, 1] && error.texels == 2);
    let masked = lit(1.1).error(&lit(1.0), Basis::ModifiedH1, &[0, u32::MAX], &normals(10));
    assert_eq!((masked.worst, masked.rms_relative(), masked.texels), (0.0, 0.0, 1));
    let (count, mean) = (1000, normals(1000).iter().map(|n| f64::from(n.z)).sum::<f64>());
    assert!((mean / f64::from(count) - 0.5).abs() < 1e-6, "half the height of a hemisphere on average");
}

/// Relightable maps are lit by the sum over the light, in one channel and in three.
#[test]
fn maps_are_lit() {
    let light = [[1.0, 2.0, 3.0], [0.5, 0.0, -1.0], [0.25; 3], [-2.0, 1.0, 0.0]];
    let relightable = MapLight::Relightable { bands: 2 };
    let maps = Maps { basis: Basis::Hl2, ..maps(relightable) };
    for channels in [1, 3_usize] {
        let values: Vec<f32> = (0..3 * 4 * 2 * channels as u32).map(|i| noise(i) - 0.5).collect();
        let sheet = Sheet { layers: Layers::exact([2, 1, 12, channels as u32], &values) };
        let lit = sheet.lit(&maps, &light);
        for function in 0..3 {
            for texel in 0..2 {
                for channel in 0..3 {
                    let at = |i: usize| ((function * 4 + i) * 2 + texel) * channels + channel.min(channels - 1);
                    let expected: f64 =
                        light.iter().enumerate().map(|(i, l)| f64::from(values[at(i)]) * f64::from(l[channel])).sum();
                    let found = f64::from(lit.functions[function][texel][channel]);
                    assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
                }
            }
        }
    }
}

/// Transfer keeps its sign in every layer: none is brought onto the curve of sRGB.
#[test]
fn transfer_is_linear() {
    let light = MapLight::Relightable { bands: 2 };
    assert!(curves(Basis::Sh4, &light).iter().all(|curve| *curve == Curve::Linear));
    assert_eq!(curves(Basis::Sh4, &light).len(), 16);
    assert_eq!(curves(Basis::Hl2, &fixed()), [Curve::Linear; 3]);
}
