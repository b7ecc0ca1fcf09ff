//! Damaged and malicious files end in an error: never a panic, never an allocation that the file does not justify.

mod sample;

use coeff_io::{Error, Prt};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Counts the live and the most live bytes of each thread.
struct Counting;

thread_local! {
    static LIVE: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

fn count(bytes: isize) {
    let live = LIVE.get() + bytes;
    LIVE.set(live);
    PEAK.set(PEAK.get().max(live));
}

#[expect(unsafe_code, reason = "the allocator interface is unsafe; calls are passed on unchanged")]
// SAFETY: every call goes to the system allocator with the caller's arguments.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Memory for buffers and messages, whatever the file.
const SMALL: usize = 64 << 10;

/// Memory that a header with right checksums may take beyond the file: serde reserves at most 1 MiB for a claimed
/// list, on three levels.
const SLACK: usize = 3 << 20;

/// Reads `bytes`, tells the most memory taken meanwhile.
fn read(bytes: &[u8]) -> (Result<Prt, Error>, usize) {
    let before = LIVE.get();
    PEAK.set(before);
    let result = Prt::from_bytes(bytes);
    (result, (PEAK.get() - before) as usize)
}

/// Reads a bad file and checks error and memory.
fn refuse(bytes: &[u8], what: &str) -> Error {
    let (result, peak) = read(bytes);
    assert!(peak <= 16 * bytes.len() + SMALL, "{what}: {peak} bytes of memory for a file of {}", bytes.len());
    result.err().unwrap_or_else(|| panic!("{what} was read without an error"))
}

/// Makes checksums right again after a change: what a careful attacker does.
fn sign(bytes: &mut [u8]) {
    let number = |bytes: &[u8], at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let count = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    for row in (0..count).map(|i| 32 + 32 * i) {
        let (offset, length) = (number(bytes, row + 8), number(bytes, row + 16));
        if let Some(payload) = offset.checked_add(length).and_then(|end| bytes.get(offset..end)) {
            let sum = crc32fast::hash(payload);
            bytes[row + 24..row + 28].copy_from_slice(&sum.to_le_bytes());
        }
    }
    bytes[28..32].fill(0);
    let sum = crc32fast::hash(&bytes[..32 + 32 * count]);
    bytes[28..32].copy_from_slice(&sum.to_le_bytes());
}

/// Number of chunks.
fn chunks_of(bytes: &[u8]) -> usize {
    u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize
}

/// Offset and length of the header chunk.
fn header_of(bytes: &[u8]) -> std::ops::Range<usize> {
    let number = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    number(40)..number(40) + number(48)
}

#[test]
fn every_flipped_bit_is_an_error() {
    let bytes = sample::sample().to_bytes().unwrap();
    for at in 0..bytes.len() {
        for bit in 0..8 {
            let mut flipped = bytes.clone();
            flipped[at] ^= 1 << bit;
            refuse(&flipped, &format!("bit {bit} of byte {at} flipped"));
        }
    }
}

#[test]
fn every_truncation_is_an_error() {
    let bytes = sample::sample().to_bytes().unwrap();
    let table = 32 + 32 * chunks_of(&bytes);
    for length in 0..bytes.len() {
        let what = format!("cut to {length} bytes");
        refuse(&bytes[..length], &what);
        // The same with a length field that was made to fit.
        let mut cut = bytes[..length].to_vec();
        if length >= table {
            cut[16..24].copy_from_slice(&(length as u64).to_le_bytes());
            sign(&mut cut);
            refuse(&cut, &what);
        }
    }
    let mut longer = bytes;
    longer.push(0);
    refuse(&longer, "one byte more");
}

#[test]
fn the_sound_file_is_read_within_its_means() {
    let bytes = sample::sample().to_bytes().unwrap();
    let (result, peak) = read(&bytes);
    assert!(result.is_ok());
    assert!(peak <= 16 * bytes.len() + SMALL, "{peak}");
}

/// The flips reach the checks behind the checksums too: with right checksums a change is read or refused, never a panic.
#[test]
fn signed_changes_never_panic() {
    let sound = sample::sample().to_bytes().unwrap();
    let header = header_of(&sound);
    let mut refused = 0;
    for at in (32..sound.len()).filter(|at| !header.contains(at) || at % 3 == 0) {
        for value in [0x00, 0x7f, 0x80, 0xff] {
            let mut bytes = sound.clone();
            bytes[at] = value;
            sign(&mut bytes);
            let (result, peak) = read(&bytes);
            assert!(peak <= 16 * bytes.len() + SLACK, "byte {at} = {value:#x}: {peak} bytes of memory");
            refused += usize::from(result.is_err());
            let Ok(prt) = result else { continue };
            if let Some(volume) = prt.volume {
                _ = volume.irradiance(glam::Vec3::new(-0.7, 1.2, 2.1), glam::Vec3::Y, &[[1.0; 3]; 64]);
            }
            for sheet in prt.maps.into_iter().flat_map(|maps| maps.sheets) {
                assert!(sheet.layers.decode().iter().all(|v| v.is_finite()), "byte {at} = {value:#x}");
            }
        }
    }
    assert!(refused > 1000, "only {refused} changes were refused");
}

/// Every eight bytes of the header in turn claim to be a huge length.
#[test]
fn huge_lengths_in_the_header_take_no_memory() {
    let sound = sample::sample().to_bytes().unwrap();
    for at in header_of(&sound) {
        for claim in [u64::MAX, 1 << 40, 1 << 31, 1 << 24] {
            let mut bytes = sound.clone();
            let Some(field) = bytes.get_mut(at..at + 8) else {
                continue;
            };
            field.copy_from_slice(&claim.to_le_bytes());
            sign(&mut bytes);
            let (_, peak) = read(&bytes);
            assert!(peak <= 16 * bytes.len() + SLACK, "length {claim} at byte {at}: {peak} bytes of memory");
        }
    }
}

#[test]
fn huge_tables_and_chunks_take_no_memory() {
    let sound = sample::sample().to_bytes().unwrap();
    let mut bytes = sound.clone();
    bytes[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(matches!(refuse(&bytes, "a huge table"), Error::Invalid { at: 12, .. }));
    for row in (0..chunks_of(&sound)).map(|i| 32 + 32 * i) {
        for length in [u64::MAX, u64::MAX - 15, 1 << 40, 0] {
            let mut bytes = sound.clone();
            bytes[row + 16..row + 24].copy_from_slice(&length.to_le_bytes());
            sign(&mut bytes);
            refuse(&bytes, &format!("row at {row} with length {length}"));
        }
    }
}

/// The counter of this test sees an allocation where there is one.
#[test]
fn memory_is_counted_can_fail() {
    let before = LIVE.get();
    PEAK.set(before);
    drop(std::hint::black_box(vec![1_u8; 100 << 20]));
    assert!((PEAK.get() - before) as usize > 16 * 4096 + SLACK);
}

#[test]
fn other_versions_and_conventions_are_unsupported() {
    let mut bytes = sample::sample().to_bytes().unwrap();
    bytes[8] = 6;
    sign(&mut bytes);
    assert!(matches!(refuse(&bytes, "version 6"), Error::Unsupported(_)));
    let mut prt = sample::sample();
    prt.convention = "condon-shortley".into();
    assert!(matches!(refuse(&prt.to_bytes().unwrap(), "another convention"), Error::Unsupported(_)));
}

#[test]
fn other_files_are_refused() {
    for bytes in [
        &b""[..],
        b"#?RADIANCE\n",
        &[0; 4096],
        &[0xff; 4096],
        b"\x89PNG\r\n\x1a\nrest of a picture, long enough for a prelude",
    ] {
        refuse(bytes, "no .prt");
    }
}
