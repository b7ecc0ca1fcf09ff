//! From linear samples to bytes: supersampling, bloom, tone curves.

mod handmade;

use glam::Vec3;
use handmade::{add_triangles, camera, distance, empty, quad, white};
use probe_io::Environment;
use render_cpu::{Frame, Image, Tonemap, curve, render, srgb_decode, srgb_encode};

/// A small white square before a black sky.
fn lantern(edit: impl Fn(&mut Frame)) -> Image {
    let mut prt = empty();
    add_triangles(&mut prt, white(), &quad(Vec3::new(0.1, -0.05, 0.0), Vec3::new(0.3, 0.05, 0.0), Vec3::Y * 0.3));
    let mut frame = Frame::plain(camera([0.0, 0.0, 3.0], [0.0; 3]), 64, 48);
    frame.sky = false;
    edit(&mut frame);
    render(&prt, &Environment::constant([4.0; 3]), &frame).expect("a sound scene and frame")
}

fn largest_difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(&a, &b)| distance(a, b)).fold(0.0, f32::max)
}

/// Mean of each block of `s` by `s` pixels.
fn blocks(image: &Image, s: usize) -> Vec<[f32; 3]> {
    let (width, height) = (image.width as usize, image.height as usize);
    let mut out = Vec::new();
    for y in (0..height).step_by(s) {
        for x in (0..width).step_by(s) {
            let values = (0..s * s).map(|i| image.linear[(y + i / s) * width + x + i % s]);
            let sum = values.fold([0.0; 3], |sum: [f32; 3], v| std::array::from_fn(|c| sum[c] + v[c]));
            out.push(sum.map(|x| x / (s * s) as f32));
        }
    }
    out
}

#[test]
fn supersampling_is_the_mean_of_a_larger_picture() {
    for s in [2_u32, 3, 7] {
        let large = lantern(|frame| (frame.width, frame.height) = (64 * s, 48 * s));
        let small = lantern(|frame| frame.supersample = s);
        assert!(largest_difference(&small.linear, &blocks(&large, s as usize)) < 1e-5, "{s} samples");
        let one = lantern(|_| ());
        assert!(largest_difference(&small.linear, &one.linear) > 0.5, "one sample per pixel has another edge");
    }
}

/// The pyramid as docs/shading.md defines it, on one row or column at a time in f64.
fn pyramid(width: usize, height: usize, pixels: &[[f32; 3]], strength: f64) -> Vec<f64> {
    let levels = ((width.min(height).ilog2()) as i64 - 3).clamp(1, 8) as usize;
    let mut planes = vec![(width, height, pixels.iter().map(|p| f64::from(p[0])).collect::<Vec<f64>>())];
    for k in 0..levels {
        let (w, h, plane) = planes[k].clone();
        planes.push((w.div_ceil(2), h.div_ceil(2), resample(&plane, [w, h], [w.div_ceil(2), h.div_ceil(2)], down)));
    }
    let (mut w, mut h, mut sum) = planes[levels].clone();
    for k in (0..levels).rev() {
        let (fine_w, fine_h, plane) = &planes[k];
        sum = resample(&sum, [w, h], [*fine_w, *fine_h], up);
        if k > 0 {
            sum.iter_mut().zip(plane).for_each(|(sum, here)| *sum += here);
        }
        (w, h) = (*fine_w, *fine_h);
    }
    sum.iter().zip(&planes[0].2).map(|(glow, here)| (1.0 - strength) * here + strength * glow / levels as f64).collect()
}

type Taps = fn(i64) -> Vec<(i64, f64)>;

fn down(x: i64) -> Vec<(i64, f64)> {
    vec![(2 * x - 1, 0.125), (2 * x, 0.375), (2 * x + 1, 0.375), (2 * x + 2, 0.125)]
}

fn up(x: i64) -> Vec<(i64, f64)> {
    // A texel of twice the size: its centre is at 2i + 1/2.
    let place = (x as f64 - 0.5) / 2.0;
    let first = place.floor();
    vec![(first as i64, 1.0 - (place - first)), (first as i64 + 1, place - first)]
}

fn resample(plane: &[f64], [w, h]: [usize; 2], [to_w, to_h]: [usize; 2], taps: Taps) -> Vec<f64> {
    let at = |x: i64, y: i64| plane[y.clamp(0, h as i64 - 1) as usize * w + x.clamp(0, w as i64 - 1) as usize];
    let value = |x: i64, y: i64| {
        taps(y).iter().map(|&(j, wy)| taps(x).iter().map(|&(i, wx)| wx * wy * at(i, j)).sum::<f64>()).sum::<f64>()
    };
    (0..to_w * to_h).map(|i| value((i % to_w) as i64, (i / to_w) as i64)).collect()
}

#[test]
fn bloom_is_the_pyramid_of_its_definition() {
    for (width, height) in [(64, 48), (37, 29), (5, 3), (1, 1), (130, 9)] {
        let size = |frame: &mut Frame| (frame.width, frame.height) = (width, height);
        let sharp = lantern(size);
        let glowing = lantern(|frame| {
            size(frame);
            frame.bloom = 0.4;
        });
        let expected = pyramid(width as usize, height as usize, &sharp.linear, 0.4);
        for (i, (seen, expected)) in glowing.linear.iter().zip(&expected).enumerate() {
            assert!(
                (f64::from(seen[0]) - expected).abs() < 1e-5,
                "{width} x {height}, pixel {i}: {} {expected}",
                seen[0]
            );
        }
    }
}

#[test]
fn bloom_of_another_strength_can_fail() {
    let sharp = lantern(|_| ());
    let glowing = lantern(|frame| frame.bloom = 0.4);
    let other = pyramid(64, 48, &sharp.linear, 0.3);
    assert!(glowing.linear.iter().zip(&other).any(|(seen, other)| (f64::from(seen[0]) - other).abs() > 0.05));
}

#[test]
fn bloom_keeps_the_light_of_a_picture_whose_border_is_black() {
    let sum = |image: &Image| image.linear.iter().map(|p| f64::from(p[0])).sum::<f64>();
    let (sharp, glowing) = (lantern(|_| ()), lantern(|frame| frame.bloom = 1.0));
    assert!((sum(&glowing) / sum(&sharp) - 1.0).abs() < 0.05, "{} of {}", sum(&glowing), sum(&sharp));
}

#[test]
fn tone_curves_rise_from_black_to_white() {
    for tonemap in [Tonemap::None, Tonemap::Reinhard, Tonemap::Filmic] {
        let mut last = -1.0;
        for i in -200..=250 {
            let x = 10.0_f32.powf(i as f32 / 20.0);
            let y = curve(tonemap, x);
            assert!(y >= last && (0.0..=1.0).contains(&y), "{tonemap:?} at {x}: {y} after {last}");
            last = y;
        }
        assert_eq!(curve(tonemap, 0.0), 0.0);
        assert_eq!(curve(tonemap, f32::NAN), 0.0);
        assert_eq!(curve(tonemap, -1.0), 0.0);
        assert!((curve(tonemap, f32::MAX) - 1.0).abs() < 1e-6 && curve(tonemap, f32::INFINITY) == 1.0);
    }
}

#[test]
fn tone_curves_have_their_known_values() {
    assert_eq!(curve(Tonemap::None, 0.18), 0.18);
    assert_eq!(curve(Tonemap::Reinhard, 1.0), 0.5);
    assert!((curve(Tonemap::Reinhard, 0.18) - 0.152_542).abs() < 1e-6);
    // 0.18 · (2.51 · 0.18 + 0.03) = 0.086724 over 0.18 · (2.43 · 0.18 + 0.59) + 0.14 = 0.324932.
    assert!((curve(Tonemap::Filmic, 0.18) - 0.086_724 / 0.324_932).abs() < 1e-6);
    assert!((curve(Tonemap::Filmic, 1.0) - 2.54 / 3.16).abs() < 1e-6);
}

#[test]
fn srgb_encoding_has_its_known_values_and_an_inverse() {
    for (linear, byte) in [(0.0, 0.0), (0.214_041, 127.5), (1.0, 255.0), (0.002, 6.589_2)] {
        assert!((255.0 * srgb_encode(linear) - byte).abs() < 1e-3, "{linear}");
    }
    for i in 0..=255 {
        let value = f64::from(i) / 255.0;
        assert!((srgb_encode(srgb_decode(value)) - value).abs() < 1e-6);
    }
}

#[test]
fn the_display_picture_is_curve_and_encoding_of_the_linear_one() {
    for tonemap in [Tonemap::None, Tonemap::Reinhard, Tonemap::Filmic] {
        let image = lantern(|frame| (frame.tonemap, frame.supersample, frame.exposure_ev) = (tonemap, 2, -2.5));
        for (linear, display) in image.linear.iter().zip(&image.display) {
            let byte = linear.map(|x| (255.0 * srgb_encode(f64::from(curve(tonemap, x))) + 0.5).floor() as u8);
            assert_eq!(*display, [byte[0], byte[1], byte[2], 255]);
        }
    }
}
