//! Version 5 of the format, and version 4 before it, byte for byte: a committed file that every later program must read.

mod sample;

use coeff_io::{Error, Prt};

const VERSION_1: &[u8] = include_bytes!("golden/version1.prt");
const VERSION_4: &[u8] = include_bytes!("golden/version4.prt");
const VERSION_5: &[u8] = include_bytes!("golden/version5.prt");

/// Files of the first version lack what this program needs to know about a bake: they are refused with what to do.
#[test]
fn version_1_is_refused_by_name() {
    let error = Prt::from_bytes(VERSION_1).unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, Error::Unsupported(_)), "{text}");
    assert!(
        text.contains("version 1") && text.contains("versions 4 to 5") && text.contains("bake the scene again"),
        "{text}"
    );
}

/// Files of the second and third version lack what is said of maps and volumes, and of gloss: they are refused alike.
#[test]
fn versions_2_and_3_are_refused_by_name() {
    for version in [2, 3] {
        let mut bytes = VERSION_4.to_vec();
        bytes[8] = version;
        let text = Prt::from_bytes(&bytes).unwrap_err().to_string();
        assert!(text.contains(&format!("version {version}")) && text.contains("versions 4 to 5"), "{text}");
    }
}

/// What version 4 says, as this program holds it: what came later has its default.
fn sample_of_version_4() -> Prt {
    let mut prt = sample::sample();
    prt.origin = [0.0; 3];
    prt.achieved.interpolation = None;
    prt.achieved.remainder = None;
    prt.achieved.worst_between = None;
    prt.materials.iter_mut().for_each(|material| material.unlit = false);
    prt
}

#[test]
fn version_4_is_still_read() {
    assert_eq!(Prt::from_bytes(VERSION_4).unwrap(), sample_of_version_4());
}

#[test]
fn version_4_is_still_read_can_fail() {
    assert_ne!(Prt::from_bytes(VERSION_4).unwrap(), sample::sample());
}

/// A change here is a change of the format: it needs a new version number, not new bytes.
#[test]
fn version_5_is_read() {
    assert_eq!(Prt::from_bytes(VERSION_5).unwrap(), sample::sample());
}

/// A file that says nothing new has no supplement: but for its number it is one of version 4.
#[test]
fn a_supplement_that_says_nothing_takes_no_bytes() {
    let bytes = sample_of_version_4().to_bytes().unwrap();
    assert_eq!(bytes.len(), VERSION_4.len());
    assert_eq!(bytes[32..], VERSION_4[32..]);
}

/// A supplement may hold fields of later programs; what this one knows is read.
#[test]
fn a_supplement_of_a_later_program_is_read() {
    let text = r#"{"origin":[1.0,2.0,3.0],"later":{"field":[1]}}"#;
    let supplement: coeff_io::Supplement = serde_json::from_str(text).unwrap();
    assert_eq!(supplement, coeff_io::Supplement { origin: [1.0, 2.0, 3.0], ..Default::default() });
}

#[test]
fn numbers_that_are_none_are_refused_in_the_supplement() {
    let mut prt = sample::sample();
    prt.origin[1] = f64::NAN;
    assert!(prt.to_bytes().unwrap_err().to_string().contains("origin"));
}

#[test]
fn version_5_is_written() {
    let bytes = sample::sample().to_bytes().unwrap();
    if bytes != VERSION_5 {
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("version5.prt");
        std::fs::write(&path, &bytes).unwrap();
        let first = bytes.iter().zip(VERSION_5).position(|(a, b)| a != b).unwrap_or(bytes.len().min(VERSION_5.len()));
        panic!("the bytes differ from the golden ones from byte {first} on; they were left in {}", path.display());
    }
    assert!(VERSION_5.len() < 8192);
}

#[test]
fn version_5_is_written_can_fail() {
    let mut prt = sample::sample();
    prt.settings.seed += 1;
    assert_ne!(prt.to_bytes().unwrap(), VERSION_5);
}

/// The places that `docs/format.md` names, read without the crate.
#[test]
fn version_5_lies_where_the_description_says() {
    let u32_at = |at: usize| u32::from_le_bytes(VERSION_5[at..at + 4].try_into().unwrap());
    let u64_at = |at: usize| u64::from_le_bytes(VERSION_5[at..at + 8].try_into().unwrap());
    assert_eq!(&VERSION_5[..8], b"\x89PRT\r\n\x1a\n");
    assert_eq!((u32_at(8), u64_at(16)), (5, VERSION_5.len() as u64));
    let rows = (0..u32_at(12) as usize).map(|i| 32 + 32 * i);
    let find = |tag: &[u8]| rows.clone().find(|row| &VERSION_5[*row..*row + 4] == tag).unwrap();
    let positions = u64_at(find(b"POSN") + 8) as usize;
    assert_eq!(f32::from_bits(u32_at(positions)), -1.0);
    assert_eq!(f32::from_bits(u32_at(positions + 12)), -0.625);
    let nodes = u64_at(find(b"VNOD") + 8) as usize;
    assert_eq!((u32_at(nodes), u32_at(nodes + 4), u32_at(nodes + 8), u32_at(nodes + 32)), (u32::MAX, 2, 0, 0));
    let second = find(b"MAPS") + 32;
    assert_eq!((&VERSION_5[second..second + 4], u32_at(second + 4), u64_at(second + 16)), (&b"MAPS"[..], 1, 67));
    let codes = u64_at(second + 8) as usize;
    assert_eq!((u32_at(codes), &VERSION_5[codes + 4..codes + 7]), (2, &[1, 0, 0][..]));
    let header = u64_at(find(b"HEAD") + 8) as usize;
    assert_eq!(u64_at(header), "relume 0.1.0".len() as u64);
    assert_eq!(&VERSION_5[header + 8..header + 20], b"relume 0.1.0");
}
