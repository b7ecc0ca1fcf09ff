//! Headers of Radiance pictures: which lines count, and in which colours their numbers are.

use probe_io::{Environment, LoadOptions};
use std::sync::atomic::{AtomicU32, Ordering};

fn close(found: [f32; 3], expected: [f64; 3], bound: f64) -> bool {
    found.iter().zip(expected).all(|(found, expected)| (f64::from(*found) - expected).abs() <= bound)
}

/// A Radiance picture of two equal pixels (1/4, 1/2, 1) with these header lines.
fn radiance(header: &str) -> Result<([f32; 3], Vec<String>), String> {
    let bytes =
        [format!("#?RADIANCE\n{header}\n\n-Y 1 +X 2\n").as_bytes(), &[32, 64, 128, 129, 32, 64, 128, 129]].concat();
    // Tests of a file run at the same time: each call has a file of its own.
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("relume-radiance-{}-{number}.hdr", std::process::id()));
    std::fs::write(&path, bytes).map_err(|error| error.to_string())?;
    let loaded = Environment::load(&path, &LoadOptions::strict()).map_err(|error| error.to_string());
    std::fs::remove_file(&path).map_err(|error| error.to_string())?;
    let loaded = loaded?;
    Ok((loaded.0.image.pixels[1], loaded.1))
}

#[test]
fn only_header_lines_at_the_margin_count() {
    let plain = [0.25, 0.5, 1.0];
    for (header, times) in [
        ("FORMAT=32-bit_rle_rgbe", 1.0),
        ("\tEXPOSURE=4\n  FORMAT=32-bit_rle_xyze\npcomb a b", 1.0),
        ("EXPOSURE=2.0\n\tEXPOSURE=4", 0.5),
        ("EXPOSURE=2.0\nEXPOSURE= 4", 0.125),
        ("EXPOSURE=0.5\r\n EXPOSURE=no number\r", 2.0),
        ("COLORCORR=2 2 2\n\tCOLORCORR=3 3 3", 0.5),
        ("PRIMARIES=0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290", 1.0),
    ] {
        let (found, _) = radiance(header).unwrap_or_else(|error| panic!("{header}: {error}"));
        assert!(close(found, plain.map(|v| v * times), 1e-6), "{header:?}: {found:?}");
    }
    assert!(radiance("EXPOSURE=no number").is_err());
}

#[test]
fn primaries_of_radiance_are_converted() {
    // P3 with the white D65: printed matrix of DCI-P3 D65 to sRGB, rows; there is no adaptation.
    let p3 = [[1.2249, -0.2247, 0.0], [-0.0420, 1.0419, 0.0], [-0.0197, -0.0786, 1.0979]];
    let (found, warnings) =
        radiance("PRIMARIES= 0.680 0.320 0.265 0.690 0.150 0.060 0.3127 0.3290").expect("a picture");
    let expected = p3.map(|row: [f64; 3]| row[0] * 0.25 + row[1] * 0.5 + row[2] * 1.0);
    assert!(close(found, expected, 5e-4), "{found:?} is not {expected:?}");
    assert!(warnings[0].contains("converted to Rec. 709"), "{warnings:?}");
    // X, Y and Z of the light itself.
    let (found, _) = radiance("FORMAT=32-bit_rle_xyze").expect("a picture");
    let inverse = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
    let expected = inverse.map(|row: [f64; 3]| (row[0] * 0.25 + row[1] * 0.5 + row[2] * 1.0).max(0.0));
    assert!(close(found, expected, 1e-3), "{found:?} is not {expected:?}");
    let (found, warnings) = radiance("PRIMARIES=0.64 0.33").expect("a picture");
    assert!(found == [0.25, 0.5, 1.0] && warnings[0].contains("not eight numbers"), "{warnings:?}");
}
