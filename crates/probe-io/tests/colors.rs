//! Probes in other colours than Rec. 709, in parts and layers, in windows, and with pixels that are no light.

mod made;

use std::path::{Path, PathBuf};

use exr::compression::Compression;
use exr::prelude::{Blocks, Encoding, FlatImage, Image, Layer, LayerAttributes, LineOrder, Vec2, WritableImage};
use made::{Channel, Lines, load};
use probe_io::{Environment, LoadOptions, Negatives, NonFinite, read_picture};
use sh_math::Bands;

fn case(name: &str) -> Option<PathBuf> {
    let path = testkit::data_dir().map(|data| data.join("cases").join(name)).filter(|path| path.exists());
    if path.is_none() {
        testkit::skip(name);
    }
    path
}

fn loaded(path: &Path, options: &LoadOptions) -> (Environment, Vec<String>) {
    Environment::load(path, options).unwrap_or_else(|error| panic!("{error}"))
}

/// Coefficients of five bands, `[coefficient][channel]`.
fn coefficients(environment: &Environment) -> Vec<[f64; 3]> {
    let light = sh_math::project(Bands::new(5).expect("five bands"), environment.samples());
    (0..25).map(|i| std::array::from_fn(|c| f64::from(light.values[i][c]))).collect()
}

/// Length of the difference over the length.
fn distance(a: &Environment, b: &Environment) -> f64 {
    let (a, b) = (coefficients(a), coefficients(b));
    let norm = |values: Vec<f64>| values.iter().map(|v| v * v).sum::<f64>().sqrt();
    let all = b.iter().flatten().copied().collect();
    norm(a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a - b).collect()) / norm(all)
}

#[test]
fn the_references_have_the_coefficients_of_another_program() {
    for (name, first) in [("probe.exr", [2.3630, 2.6585, 1.8314]), ("probe.hdr", [2.3547, 2.6505, 1.8232])] {
        let Some(path) = case(&format!("reference/{name}")) else { return };
        let (environment, warnings) = loaded(&path, &LoadOptions::strict());
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
        for (found, expected) in coefficients(&environment)[0].iter().zip(first) {
            assert!((found - expected).abs() < 1e-4, "{name}: {found} is not {expected}");
        }
    }
}

#[test]
fn cases_of_primaries_are_the_light_of_the_reference() {
    let Some(reference) = case("reference/probe.exr") else { return };
    let (reference, _) = loaded(&reference, &LoadOptions::strict());
    for name in ["ap0", "acescg", "p3", "xyz"] {
        let Some(path) = case(&format!("exr-primaries/{name}.exr")) else { return };
        let (environment, warnings) = loaded(&path, &LoadOptions::strict());
        let off = distance(&environment, &reference);
        assert!(off < 1e-3, "{name}: {off}");
        assert!(warnings.iter().any(|w| w.contains("converted to Rec. 709")), "{name}: {warnings:?}");
    }
}

#[test]
fn cases_of_indented_header_lines_have_the_outer_light() {
    let Some(reference) = case("reference/probe.hdr") else { return };
    let (reference, _) = loaded(&reference, &LoadOptions::strict());
    for (name, times) in [("exposure-of-an-input", 1.0), ("exposure-of-both", 0.5), ("format-of-an-input", 1.0)] {
        let Some(path) = case(&format!("hdr-indented-lines/{name}.hdr")) else { return };
        let (environment, _) = loaded(&path, &LoadOptions::strict());
        for (found, expected) in
            coefficients(&environment).iter().flatten().zip(coefficients(&reference).iter().flatten())
        {
            assert!((found - times * expected).abs() < 1e-6, "{name}: {found} is not {times} times {expected}");
        }
    }
}

#[test]
fn cases_of_infinite_suns_are_refused_or_clamped() {
    let clamp = LoadOptions { non_finite: NonFinite::Clamp, ..LoadOptions::strict() };
    for name in ["inf", "nan"] {
        let Some(path) = case(&format!("exr-infinite-sun/{name}.exr")) else { return };
        let refused = Environment::load(&path, &LoadOptions::strict()).expect_err("no light").to_string();
        assert!(refused.contains("clamped") && refused.contains("pixel ("), "{refused}");
        let (clamped, warnings) = loaded(&path, &clamp);
        assert!(warnings.iter().any(|w| w.contains("1 pixels were not finite")), "{warnings:?}");
        let (width, _, mut pixels) = read_picture(&path).expect("a picture");
        let at = pixels.iter().position(|p| p.iter().any(|v| !v.is_finite())).expect("a broken pixel");
        let near = [-1 - width as isize, -(width as isize), 1 - width as isize, -1]
            .into_iter()
            .flat_map(|step| [at.wrapping_add_signed(step), at.wrapping_add_signed(-step)]);
        let sum = near.fold([0.0f64; 3], |sum, i| std::array::from_fn(|c| sum[c] + f64::from(pixels[i][c])));
        for (value, sum) in pixels[at].iter_mut().zip(sum) {
            *value = if value.is_nan() { (sum / 8.0) as f32 } else { value.min(65_504.0) };
        }
        for (found, expected) in clamped.image.pixels.iter().flatten().zip(pixels.iter().flatten()) {
            assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{name}: {found} is not {expected}");
        }
    }
}

#[test]
fn distances_of_light_can_fail() {
    let grey = Environment::constant([1.0; 3]);
    assert!(distance(&Environment::constant([1.0, 1.0, 1.002]), &grey) > 1e-3);
    assert!(distance(&grey, &grey) == 0.0);
}

const DISPLAY: [i32; 4] = [0, 0, 16, 8];

fn halves<'a>(name: &'a str, value: &'a dyn Fn(i32, i32) -> f32) -> Channel<'a> {
    Channel { name, is_half: true, sampling: [1, 1], value }
}

fn lines<'a>(channels: Vec<Channel<'a>>) -> Lines<'a> {
    let compression = Compression::Uncompressed;
    Lines { channels, data: DISPLAY, display: DISPLAY, chromaticities: None, adopted: None, compression }
}

fn pixels(file: &Lines<'_>) -> (Vec<[f32; 3]>, Vec<String>) {
    let (environment, warnings) =
        load("made.exr", &file.bytes(), &LoadOptions::strict()).unwrap_or_else(|e| panic!("{e}"));
    (environment.image.pixels, warnings)
}

fn close(found: [f32; 3], expected: [f64; 3], bound: f64) -> bool {
    found.iter().zip(expected).all(|(f, e)| (f64::from(*f) - e).abs() <= bound)
}

#[test]
fn primaries_white_and_adopted_neutral_are_obeyed() {
    // ACEScg in linear sRGB, by Bradford, as colour-science prints the matrix: the columns are what its primaries become.
    let ap1 = Some([0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767]);
    let column = |r: f32, g: f32, b: f32, adopted: Option<[f32; 2]>| {
        // White is added, so that no channel is negative, and taken off again.
        let (fr, fg, fb) = (move |_, _| 4.0 + r, move |_, _| 4.0 + g, move |_, _| 4.0 + b);
        let a = |_: i32, _: i32| 0.5;
        let mut file = lines(vec![halves("A", &a), halves("B", &fb), halves("G", &fg), halves("R", &fr)]);
        file.channels.iter_mut().for_each(|c| c.is_half = false);
        (file.chromaticities, file.adopted) = (ap1, adopted);
        pixels(&file).0[0].map(|v| v - 4.0)
    };
    let printed = [[1.70505, -0.13026, -0.02400], [-0.62179, 1.14080, -0.12897], [-0.08326, -0.01055, 1.15297]];
    for (axis, expected) in printed.iter().enumerate() {
        let unit = |k: usize| if axis == k { 1.0 } else { 0.0 };
        let found = column(unit(0), unit(1), unit(2), None);
        assert!(close(found, *expected, 5e-4), "{found:?} is not {expected:?}");
    }
    // Adapted to D65 the white of ACES stays a little yellow.
    let white = column(0.0, 0.0, 0.0, Some([0.3127, 0.3290])).map(|v| v + 4.0);
    assert!(white[0] > 4.05 && white[2] < 3.9, "{white:?}");
    let same = column(0.0, 0.0, 0.0, Some([0.32168, 0.33767])).map(|v| v + 4.0);
    assert!(close(same, [4.0; 3], 1e-5), "{same:?}");
}

#[test]
fn colours_outside_rec_709_are_told_and_rounding_is_not() {
    let ap0 = Some([0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767]);
    let (zero, one) = (|_: i32, _: i32| 0.0, |_: i32, _: i32| 1.0);
    let mut file = lines(vec![halves("B", &zero), halves("G", &one), halves("R", &zero)]);
    file.chromaticities = ap0;
    let (found, warnings) = pixels(&file);
    assert!(warnings.iter().any(|w| w.starts_with("128 pixels have colours outside Rec. 709")), "{warnings:?}");
    assert!(found.iter().flatten().all(|v| *v >= 0.0));
    let mut file = lines(vec![halves("B", &one), halves("G", &one), halves("R", &one)]);
    file.chromaticities = Some([0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329]);
    let (found, warnings) = pixels(&file);
    assert!(warnings.is_empty() && found == [[1.0; 3]; 128], "Rec. 709 stays to the bit: {warnings:?}");
    let mut file = lines(vec![halves("X", &one), halves("Y", &one), halves("Z", &one)]);
    file.display = DISPLAY;
    // (1, 1, 1) in XYZ of the light itself: the row sums of the inverse of IEC 61966-2-1's matrix.
    let found = pixels(&file).0[0];
    assert!(close(found, [1.2048, 0.9484, 0.9089], 1e-3), "{found:?}");
}

#[test]
fn luminance_and_chroma_are_colours_at_any_resolution() {
    // Linear in x and y, so that linear chroma of half the resolution loses nothing but at the border.
    let rgb = |x: i32, y: i32| [40.0 + x as f32, 50.0 + 2.0 * y as f32, 30.0 + (x + y) as f32];
    let weights = [0.2126f32, 0.7152, 0.0722];
    let luminance = move |x: i32, y: i32| rgb(x, y).iter().zip(weights).map(|(c, w)| c * w).sum::<f32>();
    let ry = move |x: i32, y: i32| rgb(x, y)[0] / luminance(x, y) - 1.0;
    let by = move |x: i32, y: i32| rgb(x, y)[2] / luminance(x, y) - 1.0;
    let full = [-4, 2, 32, 16];
    let windows = [(full, 2), (full, 1), ([-3, 1, 31, 15], 2), ([0, 0, 32, 16], 2)];
    let packings = [Compression::Uncompressed, Compression::RLE, Compression::ZIP16, Compression::PIZ];
    for (window, step) in windows {
        for compression in packings {
            for is_half in [true, false] {
                let chroma = |name, value| Channel { name, is_half, sampling: [step, step], value };
                let y = Channel { name: "Y", is_half, sampling: [1, 1], value: &luminance };
                let mut file = lines(vec![chroma("BY", &by), chroma("RY", &ry), y]);
                (file.data, file.display, file.compression) = (window, window, compression);
                let options = LoadOptions { layout: Some(probe_io::Layout::Equirect), ..LoadOptions::strict() };
                let found = match load("yc.exr", &file.bytes(), &options) {
                    Ok((environment, _)) => environment.image.pixels,
                    // PIZ of odd sizes is no file that OpenEXR writes.
                    Err(error) => {
                        assert!(error.to_string().contains("odd sizes") && window[2] % 2 == 1, "{error}");
                        continue;
                    }
                };
                for (i, pixel) in found.iter().enumerate() {
                    let (x, y) = (window[0] + i as i32 % window[2], window[1] + i as i32 / window[2]);
                    let expected = rgb(x, y).map(f64::from);
                    // Beyond the outermost samples chroma stays as it is there.
                    let beyond = |at: i32, first: i32, count: i32| {
                        let inside = (first..first + count).filter(|k| k.rem_euclid(step) == 0);
                        !(inside.clone().min()..=inside.max()).contains(&Some(at))
                    };
                    let at_border = beyond(x, window[0], window[2]) || beyond(y, window[1], window[3]);
                    let bound = if at_border { 3.0 } else { 0.2 };
                    assert!(
                        close(*pixel, expected, bound),
                        "{compression} {window:?} ({x}, {y}): {pixel:?} {expected:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn chroma_that_is_left_out_can_fail() {
    let (one, red) = (|_: i32, _: i32| 1.0, |_: i32, _: i32| 1.0);
    let grey = pixels(&lines(vec![halves("Y", &one)])).0;
    let colour = pixels(&lines(vec![halves("BY", &|_, _| 0.0), halves("RY", &red), halves("Y", &one)])).0;
    assert_eq!(grey[0], [1.0; 3]);
    assert!(close(colour[0], [2.0, (1.0 - 2.0 * 0.2126 - 0.0722) / 0.7152, 1.0], 1e-3), "{:?}", colour[0]);
}

#[test]
fn the_display_window_is_the_picture() {
    let (r, g, b) = (|x: i32, _: i32| x as f32 + 100.0, |_: i32, y: i32| y as f32 + 100.0, |_: i32, _: i32| 1.0);
    for (data, black) in [([4, 2, 8, 3], 128 - 24), ([-5, -3, 40, 20], 0), ([-5, 2, 10, 20], 128 - 5 * 6), (DISPLAY, 0)]
    {
        let mut file = lines(vec![halves("B", &b), halves("G", &g), halves("R", &r)]);
        file.data = data;
        let (found, warnings) = pixels(&file);
        assert_eq!((found.len(), warnings.len()), (128, usize::from(data != DISPLAY)), "{warnings:?}");
        assert_eq!(found.iter().filter(|p| p[2] == 0.0).count(), black);
        for (i, pixel) in found.iter().enumerate().filter(|(_, p)| p[2] != 0.0) {
            assert_eq!(*pixel, [(i % 16) as f32 + 100.0, (i / 16) as f32 + 100.0, 1.0]);
        }
    }
    let mut apart = lines(vec![halves("B", &b), halves("G", &g), halves("R", &r)]);
    apart.data = [100, 0, 16, 8];
    let error = load("apart.exr", &apart.bytes(), &LoadOptions::strict()).expect_err("no pixel").to_string();
    assert!(error.contains("display window"), "{error}");
}

/// A file of parts with one colour each; a part named "depth" has Z alone, "grey" has Y alone.
fn parts(names: &[&str], blocks: Blocks) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let layers = names.iter().enumerate().map(|(i, name)| {
        let value = i as f32 + 1.0;
        let channel =
            |name: &str| exr::prelude::AnyChannel::new(name, exr::prelude::FlatSamples::F32(vec![value; 128]));
        let channels = match *name {
            "depth" => vec![channel("Z")],
            "grey" => vec![channel("Y")],
            _ => ["B", "G", "R"].map(channel).to_vec(),
        };
        let channels = exr::prelude::AnyChannels::sort(channels.into_iter().collect());
        let encoding = Encoding { compression: Compression::ZIP16, blocks, line_order: LineOrder::Increasing };
        Layer::new((16, 8), LayerAttributes::named(*name), encoding, channels)
    });
    let image: FlatImage = Image::from_layers(
        exr::prelude::ImageAttributes::new(exr::prelude::IntegerBounds::from_dimensions((16, 8))),
        layers.collect::<Vec<_>>(),
    );
    image.write().non_parallel().to_buffered(&mut out).expect("a file");
    out.into_inner()
}

fn layer(name: &str) -> LoadOptions {
    LoadOptions { layer: Some(name.into()), ..LoadOptions::strict() }
}

#[test]
fn parts_are_chosen_by_name() {
    for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(5, 3))] {
        let file = parts(&["depth", "grey", "left", "right"], blocks);
        let (environment, warnings) = load("parts.exr", &file, &LoadOptions::strict()).expect("colours");
        assert_eq!(environment.image.pixels[0], [3.0; 3], "colours before depth and grey");
        assert!(
            warnings[0].contains("\"left\" was read of 3") && warnings[0].contains("grey, left, right"),
            "{warnings:?}"
        );
        let (environment, warnings) = load("parts.exr", &file, &layer("right")).expect("a part");
        assert!(environment.image.pixels[127] == [4.0; 3] && warnings.is_empty(), "{warnings:?}");
        assert_eq!(load("parts.exr", &file, &layer("GREY")).expect("a part").0.image.pixels[0], [2.0; 3]);
        for name in ["depth", "middle"] {
            let error = load("parts.exr", &file, &layer(name)).expect_err("no picture").to_string();
            assert!(error.contains(name) && error.contains("grey, left, right"), "{error}");
        }
    }
    let error = load("z.exr", &parts(&["depth"], Blocks::ScanLines), &LoadOptions::strict()).expect_err("no colours");
    assert!(error.to_string().contains("found: Z"), "{error}");
}

#[test]
fn layers_of_channels_are_chosen_by_name() {
    let names: Vec<String> = (0..15).map(|i| format!("aov{i:02}")).chain(["beauty".into()]).collect();
    let values: Vec<Box<dyn Fn(i32, i32) -> f32>> =
        (0..16).map(|i| Box::new(move |_, _| i as f32 + 1.0) as Box<dyn Fn(i32, i32) -> f32>).collect();
    let named: Vec<(String, usize)> =
        names.iter().enumerate().flat_map(|(i, n)| ["B", "G", "R"].map(|c| (format!("{n}.{c}"), i))).collect();
    let file = lines(named.iter().map(|(name, i)| halves(name, &values[*i])).collect()).bytes();
    let (environment, warnings) = load("layers.exr", &file, &LoadOptions::strict()).expect("colours");
    assert_eq!(environment.image.pixels[0], [16.0; 3], "the layer that is called as the picture itself");
    assert!(
        warnings[0].contains("of 16") && names.iter().all(|name| warnings[0].contains(name.as_str())),
        "{warnings:?}"
    );
    assert_eq!(load("layers.exr", &file, &layer("aov03")).expect("a layer").0.image.pixels[0], [4.0; 3]);
    // Plain colours go before all named ones; vectors are no pictures.
    let (plain, other) = (|_: i32, _: i32| 9.0, |_: i32, _: i32| 1.0);
    let all = ["B", "G", "N.X", "N.Y", "N.Z", "R", "beauty.B", "beauty.G", "beauty.R"];
    let channels = all.map(|name| if name.len() == 1 { halves(name, &plain) } else { halves(name, &other) });
    let (found, warnings) = pixels(&lines(channels.into_iter().collect()));
    assert_eq!(found[0], [9.0; 3]);
    assert!(warnings[0].contains("of 2") && !warnings[0].contains('N'), "{warnings:?}");
    let hdr =
        load("a.hdr", b"#?RADIANCE\n\n-Y 1 +X 2\n\x40\x40\x40\x80\x40\x40\x40\x80", &layer("x")).expect_err("none");
    assert!(hdr.to_string().contains("no layer \"x\""), "{hdr}");
}

#[test]
fn what_is_not_finite_is_replaced_by_choice() {
    let value = |x: i32, y: i32| match (x, y) {
        (3, 2) => f32::INFINITY,
        (5, 5) | (6, 5) => f32::NAN,
        (9, 0) => f32::NEG_INFINITY,
        _ => (x + 16 * y) as f32 + if (x, y) == (0, 0) { 1e6 } else { 0.0 },
    };
    let mut file = lines(vec![halves("B", &value), halves("G", &value), halves("R", &value)]);
    file.channels.iter_mut().for_each(|c| c.is_half = false);
    let refused = load("nan.exr", &file.bytes(), &LoadOptions::strict()).expect_err("no light").to_string();
    assert!(refused.contains("pixel (9, 0) has radiance -inf and 3 other pixels"), "{refused}");
    let clamp = LoadOptions { non_finite: NonFinite::Clamp, negatives: Negatives::Refuse, ..LoadOptions::strict() };
    let (environment, warnings) = load("nan.exr", &file.bytes(), &clamp).expect("by choice");
    assert!(warnings[0].contains("4 pixels were not finite") && warnings[0].contains("2 NaN"), "{warnings:?}");
    let at = |x: usize, y: usize| environment.image.pixels[y * 16 + x][0];
    assert_eq!((at(3, 2), at(9, 0)), (1e6, 0.0), "the largest finite value, and black");
    // Seven of eight neighbours of (5, 5) are finite: (4..=6, 4) and (4..=6, 6) and (4, 5).
    let mean = [68, 69, 70, 84, 100, 101, 102].iter().sum::<i32>() as f32 / 7.0;
    assert!((at(5, 5) - mean).abs() < 1e-4, "{} is not {mean}", at(5, 5));
    // At least the largest half, in which a sun overflows.
    let dim = |x: i32, _: i32| if x == 1 { f32::INFINITY } else { 0.5 };
    let file = lines(vec![halves("B", &dim), halves("G", &dim), halves("R", &dim)]);
    assert_eq!(load("inf.exr", &file.bytes(), &clamp).expect("by choice").0.image.pixels[1], [65_504.0; 3]);
}

#[test]
fn no_changed_byte_of_a_subsampled_file_does_worse_than_an_error() {
    let value = |x: i32, y: i32| 1.0 + 0.01 * (x * y) as f32;
    let options = LoadOptions { layout: Some(probe_io::Layout::Equirect), ..LoadOptions::lenient() };
    for compression in [Compression::Uncompressed, Compression::ZIP16, Compression::PIZ] {
        let chroma = |name| Channel { name, is_half: true, sampling: [2, 2], value: &value };
        let mut file = lines(vec![chroma("BY"), chroma("RY"), halves("Y", &value)]);
        file.compression = compression;
        let whole = file.bytes();
        assert!(load("flip.exr", &whole, &options).is_ok(), "{compression}");
        for at in 8..whole.len() {
            for change in [0x01, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] ^= change;
                // Either outcome is right; a panic is not.
                let _outcome = load("flip.exr", &bytes, &options);
            }
            assert!(load("flip.exr", &whole[..at], &options).is_err(), "{compression} cut at {at}");
        }
    }
}
