//! Exports are read back by a reader of their own, without the crate that wrote them.

mod sample;

use coeff_io::{Transfer, export};
use sample::sample;
use std::path::Path;

/// Shape and values of a `.npy` file of version 1.0 or 2.0 with little-endian f32 in C order.
fn read_npy(path: &Path) -> (Vec<usize>, Vec<f32>) {
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(&bytes[..6], b"\x93NUMPY");
    let (length, start) = match bytes[6] {
        1 => (u16::from_le_bytes([bytes[8], bytes[9]]) as usize, 10),
        _ => (u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize, 12),
    };
    let header = std::str::from_utf8(&bytes[start..start + length]).unwrap();
    assert!(header.contains("'descr': '<f4'") && header.contains("'fortran_order': False"), "{header}");
    let shape = header.split_once("'shape': (").unwrap().1.split_once(')').unwrap().0;
    let shape = shape.split(',').filter(|n| !n.trim().is_empty()).map(|n| n.trim().parse().unwrap());
    let values = bytes[start + length..].chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap()));
    (shape.collect(), values.collect())
}

#[test]
fn three_channels_have_the_albedo_in_the_transfer() {
    let folder = tempfile::tempdir().unwrap();
    let prt = sample();
    std::fs::write(folder.path().join("albedo.npy"), "of an earlier export").unwrap();
    export::npy(&prt, folder.path()).unwrap();
    let (shape, values) = read_npy(&folder.path().join("transfer.npy"));
    assert_eq!(shape, [7, 4, 3]);
    for (i, value) in values.iter().enumerate() {
        assert_eq!(*value, prt.transfer.values[i] * prt.transfer.albedo[i / 12][i % 3], "value {i}");
    }
    assert!(!folder.path().join("albedo.npy").exists());
    let near = coeff_io::Prt { origin: [0.0; 3], ..prt.clone() };
    export::npy(&near, folder.path()).unwrap();
    assert_eq!(
        read_npy(&folder.path().join("positions.npy")),
        (vec![7, 3], prt.geometry.positions.as_flattened().to_vec())
    );
    assert_eq!(
        read_npy(&folder.path().join("normals.npy")),
        (vec![7, 3], prt.geometry.normals.as_flattened().to_vec())
    );
}

/// The mesh comes with every export, read here without the crate that wrote it; what is absent leaves no old file.
#[test]
fn every_export_has_its_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let mut prt = sample();
    export::npy(&prt, folder.path()).unwrap();
    assert_eq!(read_npy(&folder.path().join("uv0.npy")), (vec![7, 2], prt.geometry.uv0.as_flattened().to_vec()));
    let triangles = std::fs::read(folder.path().join("triangles.npy")).unwrap();
    let last = u32::from_le_bytes(triangles[triangles.len() - 4..].try_into().unwrap());
    assert_eq!(last, prt.geometry.triangles.last().unwrap()[2]);
    let text = std::fs::read_to_string(folder.path().join("meshes.json")).unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(value["meshes"][1]["name"], "wall é");
    assert_eq!(value["materials"][0]["metallic"].as_f64().map(|m| m as f32), Some(prt.materials[0].metallic));
    assert_eq!(value["unlit"], serde_json::json!([1]));
    prt.geometry.uv0.clear();
    prt.materials.iter_mut().for_each(|m| m.base_color_texture = None);
    export::npy(&prt, folder.path()).unwrap();
    assert!(!folder.path().join("uv0.npy").exists());
}

/// Where the file has an origin, positions are those of the world, in f64: f32 has steps of half a metre there.
#[test]
fn positions_far_from_the_origin_are_of_the_world() {
    let folder = tempfile::tempdir().unwrap();
    let prt = sample();
    assert!(prt.origin[2] < -5e6);
    export::npy(&prt, folder.path()).unwrap();
    let bytes = std::fs::read(folder.path().join("positions.npy")).unwrap();
    let text = String::from_utf8_lossy(&bytes[10..100]).into_owned();
    assert!(text.contains("'descr': '<f8'") && text.contains("(7, 3"), "{text}");
    let values = bytes[bytes.len() - 8 * 21..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap()));
    for (i, value) in values.enumerate() {
        let expected = prt.origin[i % 3] + f64::from(prt.geometry.positions[i / 3][i % 3]);
        assert_eq!(value, expected, "value {i}");
    }
}

/// The albedo of the sample is not 1, so that its product differs from the bare transfer.
#[test]
fn three_channels_have_the_albedo_in_the_transfer_can_fail() {
    let folder = tempfile::tempdir().unwrap();
    export::npy(&sample(), folder.path()).unwrap();
    assert_ne!(read_npy(&folder.path().join("transfer.npy")).1, sample().transfer.values);
}

#[test]
fn one_channel_has_the_albedo_beside() {
    let folder = tempfile::tempdir().unwrap();
    let mut prt = sample();
    let values = prt.transfer.values.iter().step_by(3).copied().collect();
    prt.transfer = Transfer { channels: 1, values, ..prt.transfer };
    export::npy(&prt, &folder.path().join("new/folder")).unwrap();
    let file = |name: &str| read_npy(&folder.path().join("new/folder").join(name));
    assert_eq!(file("transfer.npy"), (vec![7, 4, 1], prt.transfer.values.clone()));
    assert_eq!(file("albedo.npy"), (vec![7, 3], prt.transfer.albedo.as_flattened().to_vec()));
}

#[test]
fn light_is_exported() {
    let folder = tempfile::tempdir().unwrap();
    let bands = sh_math::Bands::new(2).unwrap();
    let light = sh_math::Rgb { bands, values: vec![[1.0, 2.0, 3.0], [0.5, 0.25, 0.125], [-1.0; 3], [0.0; 3]] };
    let npy = folder.path().join("l.npy");
    export::light_npy(&light, &npy).unwrap();
    assert_eq!(read_npy(&npy), (vec![4, 3], light.values.as_flattened().to_vec()));
    let path = folder.path().join("l.json");
    export::light_json(&light, &path).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(json["bands"], 2);
    assert_eq!(json["convention"], sh_math::CONVENTION);
    assert_eq!(json["coefficients"][1], serde_json::json!([0.5, 0.25, 0.125]));
}

/// Rows of gloss and of texels, and bounces as mean and vectors by the words of docs/format.md.
#[test]
fn gloss_and_texels_are_exported() {
    let folder = tempfile::tempdir().unwrap();
    let mut prt = sample();
    let gloss = prt.gloss.as_mut().unwrap();
    let vertices = gloss.vertices.as_mut().unwrap();
    let columns = vertices.arriving.bounces[0].columns;
    let values: Vec<f32> = (0..2 * 3 * columns).map(|k| (k % 13) as f32 / 8.0 - 0.5).collect();
    let book = coeff_io::Codebook::new([columns, 2, 2], &values);
    let table = coeff_io::Table::clustered(&book, &[1, 0, 1], &[0.5, -1.0, 0.25, 2.0, 0.0, 1.0]);
    vertices.arriving.bounces[0] = table.clone();
    prt.codebooks.bounce = Some(book.clone());
    export::npy(&prt, folder.path()).unwrap();
    let file = |name: &str| read_npy(&folder.path().join(name));
    let (shape, book_values) = file("bounce_book.npy");
    assert_eq!(shape[..2], [2, 3]);
    assert_eq!(shape[2..].iter().product::<usize>(), columns as usize);
    let (shape, weights) = file("gloss_weights.npy");
    assert_eq!(shape, [3, 2]);
    let clusters = read_indices(&folder.path().join("gloss_clusters.npy"));
    assert_eq!(clusters, [1, 0, 1]);
    let expected = table.decode(Some(&book));
    let n = columns as usize;
    for row in 0..3 {
        let vector = |k: usize, c: usize| book_values[(clusters[row] as usize * 3 + k) * n + c];
        for c in 0..n {
            let found = vector(0, c) + weights[2 * row] * vector(1, c) + weights[2 * row + 1] * vector(2, c);
            assert!((found - expected[row * n + c]).abs() < 1e-5, "row {row}, number {c}");
        }
    }
    let visibility = &prt.gloss.as_ref().unwrap().vertices.as_ref().unwrap().arriving.visibility;
    assert_eq!(file("gloss_visibility.npy").1, visibility.decode(prt.codebooks.visibility.as_ref()));
    let level = &prt.transfer_textures.as_ref().unwrap().sheets[0].levels[0];
    assert_eq!(read_indices(&folder.path().join("sheet_0_0_places.npy")), level.places);
    let (shape, transfer) = file("sheet_0_0_transfer.npy");
    assert_eq!(shape[0], level.places.len());
    assert_eq!(transfer, level.diffuse.decode(prt.codebooks.diffuse.as_ref()));
    assert_eq!(read_indices(&folder.path().join("gloss_vertices.npy")).len(), 3);
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("sheets.json")).unwrap()).unwrap();
    assert_eq!(json["sheets"][0][0], serde_json::json!([level.width, level.height]));
}

/// The numbers of a `.npy` file of little-endian u32.
fn read_indices(path: &Path) -> Vec<u32> {
    let bytes = std::fs::read(path).unwrap();
    let start = 10 + u16::from_le_bytes([bytes[8], bytes[9]]) as usize;
    assert!(std::str::from_utf8(&bytes[10..start]).unwrap().contains("'descr': '<u4'"));
    bytes[start..].chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
}
