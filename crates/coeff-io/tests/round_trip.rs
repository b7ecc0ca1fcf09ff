//! What is written is what is read, in memory and through a file.

mod sample;

use coeff_io::{ALIGNMENT, Codebook, Codebooks, Kind, Prt, Table, Transfer, check, inspect};
use sample::sample;

#[test]
fn bytes_round_trip() {
    let prt = sample();
    let bytes = prt.to_bytes().unwrap();
    assert_eq!(Prt::from_bytes(&bytes).unwrap(), prt);
    assert_eq!(Prt::from_bytes(&bytes).unwrap().to_bytes().unwrap(), bytes);
}

#[test]
fn bytes_round_trip_can_fail() {
    let prt = sample();
    let mut other = prt.clone();
    other.transfer.values[5] += 1e-6;
    assert_ne!(Prt::from_bytes(&other.to_bytes().unwrap()).unwrap(), prt);
}

#[test]
fn files_round_trip_and_are_aligned() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.prt");
    let prt = sample();
    prt.write(&path).unwrap();
    assert_eq!(Prt::read(&path).unwrap(), prt);
    let seen = inspect(&path).unwrap();
    assert_eq!(seen.file_length, std::fs::metadata(&path).unwrap().len());
    assert_eq!(seen.header.plan, prt.plan);
    assert!(seen.chunks.iter().all(|chunk| chunk.offset % ALIGNMENT == 0), "{:?}", seen.chunks);
    let sums: Vec<u32> = seen.chunks.iter().map(|chunk| chunk.crc32).collect();
    assert_eq!(check(&path, &seen.chunks).unwrap(), sums);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else may be left behind");
}

#[test]
fn check_finds_the_damaged_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.prt");
    let mut bytes = sample().to_bytes().unwrap();
    std::fs::write(&path, &bytes).unwrap();
    let chunks = inspect(&path).unwrap().chunks;
    let transfer = chunks.iter().position(|chunk| chunk.kind == Kind::Transfer).unwrap();
    bytes[chunks[transfer].offset as usize + 9] ^= 4;
    std::fs::write(&path, &bytes).unwrap();
    let sums = check(&path, &chunks).unwrap();
    let wrong: Vec<usize> = (0..chunks.len()).filter(|i| sums[*i] != chunks[*i].crc32).collect();
    assert_eq!(wrong, [transfer]);
}

/// An effect that a scene does not call for takes no bytes: a file without options has only its six chunks.
#[test]
fn absent_parts_take_no_chunk() {
    let mut prt = sample();
    prt.geometry.tangents.clear();
    prt.geometry.uv0.clear();
    prt.geometry.uv1.clear();
    prt.geometry.colors.clear();
    prt.textures.clear();
    (prt.maps, prt.volume) = (None, None);
    (prt.gloss, prt.transfer_textures, prt.codebooks) = (None, None, Codebooks::default());
    prt.materials[0] = prt.materials[1].clone();
    prt.origin = [0.0; 3];
    prt.materials.iter_mut().for_each(|material| material.unlit = false);
    (prt.achieved.interpolation, prt.achieved.remainder, prt.achieved.worst_between) = (None, None, None);
    prt.plan.channels = 1;
    let values = prt.transfer.values.iter().step_by(3).copied().collect();
    prt.transfer = Transfer { channels: 1, values, openness: Vec::new(), ..prt.transfer };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.prt");
    prt.write(&path).unwrap();
    assert_eq!(Prt::read(&path).unwrap(), prt);
    let kinds: Vec<Kind> = inspect(&path).unwrap().chunks.iter().map(|chunk| chunk.kind).collect();
    let expected = [Kind::Header, Kind::Positions, Kind::Normals, Kind::Triangles, Kind::Transfer, Kind::Albedo];
    assert_eq!(kinds, expected);
}

/// Beside the tags of two options, an absent map and volume take nothing; present ones take what their chunks hold.
#[test]
fn absent_maps_and_volumes_take_two_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let header = |prt: &Prt| {
        let path = folder.path().join("a.prt");
        prt.write(&path).unwrap();
        inspect(&path).unwrap().chunks[0].length
    };
    let with = sample();
    let maps = Prt { maps: None, ..with.clone() };
    let neither = Prt { maps: None, volume: None, ..with.clone() };
    // origin, spacing, cells, light, channels, resolution, reach; basis, light, five sheets, the sheets of two meshes.
    let (volume, map) = (12 + 12 + 12 + 8 + 4 + 4 + 4, 8 + 3 + 4 + 8 + 11 + 4 + 8 + 5 * 20 + 8 + 5 + 1);
    assert_eq!(header(&maps) - header(&neither), volume);
    assert_eq!(header(&with) - header(&maps), map);
}

#[test]
fn a_failed_write_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.prt");
    sample().write(&path).unwrap();
    let before = std::fs::read(&path).unwrap();
    let failed = coeff_io::replace(&path, |file| {
        std::io::Write::write_all(file, b"half a file")?;
        Err(std::io::Error::other("the disk is full"))
    });
    assert!(failed.is_err());
    let mut broken = sample();
    broken.transfer.values[0] = f32::NAN;
    assert!(broken.write(&path).is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// The transfer of the vertices in clusters: the chunk of exact numbers is not there, and what is read is what the clusters say.
#[test]
fn clustered_transfer_takes_the_place_of_the_exact_one() {
    let mut prt = sample();
    let book = Codebook::new([12, 2, 1], &(0..48).map(|i| (i % 13) as f32 / 8.0 - 0.5).collect::<Vec<_>>());
    let rows = prt.geometry.positions.len();
    let weights: Vec<f32> = (0..rows).map(|i| i as f32 / 4.0 - 1.0).collect();
    let table = Table::clustered(&book, &(0..rows).map(|i| (i % 2) as u16).collect::<Vec<_>>(), &weights);
    prt.transfer.values = table.decode(Some(&book));
    prt.codebooks.diffuse = Some(book);
    prt.compressed = Some(table);
    let bytes = prt.to_bytes().unwrap();
    assert_eq!(Prt::from_bytes(&bytes).unwrap(), prt);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.prt");
    prt.write(&path).unwrap();
    assert!(inspect(&path).unwrap().chunks.iter().all(|chunk| chunk.kind != Kind::Transfer));
    prt.transfer.values[3] += 1.0;
    assert!(
        prt.to_bytes().unwrap_err().to_string().contains("clustered"),
        "another transfer than that of the clusters"
    );
}
