//! Damaged, awkward and crafted files end in one sentence, never in a panic or a large allocation.

use probe_io::{Environment, Error, Layout, LoadOptions, read_picture, write_exr, write_hdr};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Longest time for one file, and largest growth of the whole test's memory.
const LONGEST: Duration = Duration::from_secs(10);
const MOST_MEMORY: usize = 1 << 30;

/// Largest resident size of this process so far, bytes; 0 where the system does not say.
fn peak_memory() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().nth(1)?.parse().ok());
    kib.unwrap_or(0) * 1024
}

fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// A file of our own in the system's folder for such files.
fn scratch(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("relume-probe-io-{}-{name}", std::process::id()))
}

/// Loads bytes as a file.
fn load_bytes(name: &str, bytes: &[u8], options: &LoadOptions) -> Result<(Environment, Vec<String>), Error> {
    let path = scratch(name);
    std::fs::write(&path, bytes).unwrap();
    let loaded = Environment::load(&path, options);
    std::fs::remove_file(&path).unwrap();
    loaded
}

fn error_of(name: &str, bytes: &[u8]) -> String {
    match load_bytes(name, bytes, &LoadOptions::strict()) {
        Ok(_) => panic!("{name} was read"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_damaged_file_ends_in_a_clear_error() {
    let Some(data) = testkit::data_dir() else {
        testkit::skip("damaged probes");
        return;
    };
    for file in files_in(&data.join("bad/exr")).iter().chain(&files_in(&data.join("bad/hdr"))) {
        let start = Instant::now();
        let error = Environment::load(file, &LoadOptions::lenient()).map(|_| ()).unwrap_err().to_string();
        assert!(start.elapsed() < LONGEST, "{} took too long", file.display());
        assert!(error.starts_with(&file.display().to_string()) && !error.contains('\n'), "{error}");
    }
    assert!(peak_memory() < MOST_MEMORY);
}

#[test]
fn negative_radiance_is_refused_or_clamped_by_choice() {
    let Some(data) = testkit::data_dir() else {
        testkit::skip("a probe with negative pixels");
        return;
    };
    let file = data.join("bad/awkward-esplanade_negative_dwab.exr");
    let refused = Environment::load(&file, &LoadOptions::strict()).unwrap_err().to_string();
    assert!(refused.contains("2866 pixels have negative radiance") && refused.contains("-3894"), "{refused}");
    let (environment, warnings) = Environment::load(&file, &LoadOptions::lenient()).unwrap();
    assert!(warnings.iter().any(|w| w.contains("2866 pixels")), "{warnings:?}");
    let values = || environment.image.pixels.iter().flatten();
    assert!(values().all(|v| *v >= 0.0));
    // The maximum that the file is known to hold.
    assert_eq!(values().fold(0.0f32, |a, b| a.max(*b)), 29_856.0);
}

#[test]
fn old_run_lengths_decode_as_another_decoder_does() {
    let Some(data) = testkit::data_dir() else {
        testkit::skip("old run lengths");
        return;
    };
    let file = data.join("bad/hdr/old-rle.hdr");
    let (width, height, pixels) = read_picture(&file).unwrap();
    let theirs = image::open(&file).unwrap().into_rgb32f();
    assert_eq!((width, height), (theirs.width() as usize, theirs.height() as usize));
    for (ours, theirs) in pixels.iter().zip(theirs.pixels()) {
        assert_eq!(*ours, theirs.0);
    }
    // Its shape is no layout's, so it is only a probe where the user says so.
    let refused = Environment::load(&file, &LoadOptions::strict()).unwrap_err().to_string();
    assert!(refused.contains("551 x 276") && refused.contains("--layout"), "{refused}");
    let mut stated = LoadOptions::strict();
    stated.layout = Some(Layout::Equirect);
    assert!(Environment::load(&file, &stated).is_ok());
}

#[test]
fn suns_above_the_half_float_limit_stay() {
    let Some(data) = testkit::data_dir() else {
        testkit::skip("a probe with a bright sun");
        return;
    };
    let file = data.join("probes/equirect/quarry_02_1k.hdr");
    let (environment, warnings) = Environment::load(&file, &LoadOptions::strict()).unwrap();
    let values = environment.image.pixels.iter().flatten();
    assert_eq!(values.fold(0.0f32, |a, b| a.max(*b)), 153_600.0);
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn crafted_headers_allocate_nothing() {
    let huge = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\n";
    let error = error_of("huge.hdr", huge);
    assert!(error.contains("2000000000 x 2000000000"), "{error}");
    let overflow = b"#?RADIANCE\n\n-Y 99999999999999999999 +X 8\n";
    assert!(error_of("overflow.hdr", overflow).contains("size line"));
    let run = b"#?RADIANCE\n\n-Y 1 +X 4\n\x40\x40\x40\x80\x01\x01\x01\xff\x01\x01\x01\xff\x01\x01\x01\xff";
    assert!(error_of("run.hdr", run).contains("run past its end"));
    assert!(error_of("first.hdr", b"#?RADIANCE\n\n-Y 1 +X 2\n\x01\x01\x01\x02").contains("no pixel to repeat"));
    assert!(error_of("cut.hdr", b"#?RADIANCE\n\n-Y 2 +X 4\n\x01").contains("cut off"));
    assert!(error_of("ycc.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_ycce\n\n-Y 1 +X 2\n").contains("ycce"));
    assert!(error_of("endless.hdr", &[b"#?".as_slice(), &[b'a'; 1 << 20]].concat()).contains("does not end"));
    assert!(peak_memory() < MOST_MEMORY);
}

/// A small float file of our own, whose size and blocks lie at known places.
fn small_exr() -> Vec<u8> {
    let path = scratch("small.exr");
    let pixels: Vec<[f32; 3]> = (0..32).map(|i| [i as f32, 1.0, 0.5]).collect();
    write_exr(&path, 8, 4, &pixels).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    bytes
}

#[test]
fn every_flipped_byte_and_every_cut_is_an_error_or_a_picture() {
    let exr = small_exr();
    let hdr =
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n\x02\x02\x00\x08\x88\x40\x88\x41\x88\x42\x88\x81".to_vec();
    for (name, whole) in [("flip.exr", exr), ("flip.hdr", hdr)] {
        assert!(load_bytes(name, &whole, &lenient_equirect()).is_ok(), "{name}");
        for at in 0..whole.len() {
            for value in [0, 0x7f, 0xff, whole[at] ^ 0x55] {
                let mut bytes = whole.clone();
                bytes[at] = value;
                // Either is right; a panic or an abort is not.
                let _ = load_bytes(name, &bytes, &lenient_equirect());
            }
            assert!(load_bytes(name, &whole[..at], &lenient_equirect()).is_err(), "{name} cut at {at}");
        }
    }
    assert!(peak_memory() < MOST_MEMORY);
}

fn lenient_equirect() -> LoadOptions {
    let mut options = LoadOptions::lenient();
    options.layout = Some(Layout::Equirect);
    options
}

#[test]
fn sizes_inside_dwa_blocks_are_checked() {
    let Some(data) = testkit::data_dir() else {
        testkit::skip("a DWAB file");
        return;
    };
    let whole = std::fs::read(data.join("bad/awkward-esplanade_negative_dwab.exr")).unwrap();
    assert!(load_bytes("dwa.exr", &whole, &LoadOptions::lenient()).is_ok());
    // The header ends in the table of two blocks (256 lines each would be one), whose first entry points at the
    // first block: line number, length, then the eleven sizes.
    let table = (0..4096).find(|at| {
        let place = u64::from_le_bytes(whole[*at..at + 8].try_into().unwrap());
        place == (*at as u64) + 8
    });
    let sizes = table.unwrap() + 8 + 8;
    for number in [1, 6, 7, 8, 9] {
        let mut bytes = whole.clone();
        bytes[sizes + 8 * number + 5] = 0x7f;
        let error = load_bytes("dwa.exr", &bytes, &LoadOptions::lenient()).unwrap_err().to_string();
        assert!(error.contains("DWA"), "{error}");
    }
}

#[test]
fn impossible_radiance_is_refused_with_its_place() {
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let path = scratch("nan.exr");
        let mut pixels = vec![[1.0; 3]; 32];
        pixels[19][1] = value;
        write_exr(&path, 8, 4, &pixels).unwrap();
        let error = Environment::load(&path, &LoadOptions::lenient()).unwrap_err().to_string();
        std::fs::remove_file(&path).unwrap();
        assert!(error.contains("pixel (3, 2)"), "{error}");
    }
}

#[test]
fn pictures_survive_a_round_trip() {
    let pixels: Vec<[f32; 3]> = (0..64 * 32)
        .map(|i| [(i % 64) as f32 * 0.01, if i > 900 { 5.0 } else { 1e-3 }, 153_600.0 / (1 + i) as f32])
        .collect();
    let exr = scratch("round.exr");
    write_exr(&exr, 64, 32, &pixels).unwrap();
    assert_eq!(read_picture(&exr).unwrap(), (64, 32, pixels.clone()));
    let hdr = scratch("round.hdr");
    write_hdr(&hdr, 64, 32, &pixels).unwrap();
    let (_, _, back) = read_picture(&hdr).unwrap();
    for (a, b) in pixels.iter().zip(&back) {
        let largest = a.iter().fold(0.0f32, |m, v| m.max(*v));
        for c in 0..3 {
            // Half a step of eight bits below the largest channel's power of two.
            assert!((a[c] - b[c]).abs() <= largest / 256.0 + 1e-30, "{a:?} became {b:?}");
        }
    }
    let theirs = image::open(&hdr).unwrap().into_rgb32f();
    assert!(back.iter().zip(theirs.pixels()).all(|(a, b)| *a == b.0));
    for path in [exr, hdr] {
        std::fs::remove_file(path).unwrap();
    }
    assert!(write_hdr(&scratch("x.hdr"), 4, 4, &pixels).is_err());
}
