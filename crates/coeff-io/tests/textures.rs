//! Exports are opened by readers of their own, and imported again as the same numbers.

mod sample;

use coeff_io::{Container, Encoding, Error, Lookup, MapLight, Maps, Node, Volume, export, import};
use ddsfile::{D3D10ResourceDimension, Dds, DxgiFormat};
use glam::Vec3;
use half::f16;
use sample::sample;
use std::fs;
use std::path::Path;

const CONTAINERS: [Container; 2] = [Container::Ktx2, Container::Dds];

fn maps() -> Maps {
    sample().maps.unwrap()
}

/// A volume of 2x3x1 cells, the first split, whose numbers halves hold exactly.
fn volume() -> Volume {
    let mut volume = sample().volume.unwrap();
    (volume.cells, volume.origin, volume.spacing) = ([2, 3, 1], [-1.0, 2.0, 0.5], [1.0, 0.5, 2.0]);
    volume.positions.clear();
    let mut leaf = |corner: [f32; 3], edges: [f32; 3]| {
        Node::Leaf(std::array::from_fn(|i| {
            let at = std::array::from_fn(|c| corner[c] + edges[c] * (i >> c & 1) as f32);
            volume.positions.iter().position(|p| *p == at).unwrap_or_else(|| {
                volume.positions.push(at);
                volume.positions.len() - 1
            }) as u32
        }))
    };
    let at = |x: f32, y: f32, z: f32| [-1.0 + x, 2.0 + 0.5 * y, 0.5 + 2.0 * z];
    let coarse = (0..6).map(|i| leaf(at((i % 2) as f32, (i / 2) as f32, 0.0), [1.0, 0.5, 2.0]));
    let mut nodes: Vec<Node> = coarse.collect();
    nodes[0] = Node::Split(6);
    for i in 0..8 {
        let half = |axis: i32| (i >> axis & 1) as f32 * 0.5;
        nodes.push(leaf(at(half(0), half(1), half(2)), [0.5, 0.25, 1.0]));
    }
    volume.nodes = nodes;
    let probes = volume.positions.len();
    volume.validity = vec![1.0; probes];
    volume.values = (0..probes * 9).map(|i| ((i * 29 % 64) as f32 - 32.0) / 16.0).collect();
    (volume.resolution, volume.distances) = (0, vec![]);
    volume
}

#[test]
fn maps_come_back() {
    for container in CONTAINERS {
        let folder = tempfile::tempdir().unwrap();
        export::maps(&maps(), container, &folder.path().join("new")).unwrap();
        let (ours, back) = (maps(), import::maps(&folder.path().join("new")).unwrap());
        assert_eq!((back.basis, &back.light, &back.sheet_of_mesh), (ours.basis, &ours.light, &ours.sheet_of_mesh));
        for (a, b) in ours.sheets.iter().zip(&back.sheets) {
            if a.layers.encoding != Encoding::U8 {
                assert_eq!(a, b, "{container:?}");
                continue;
            }
            // Eight bits become halves.
            let halves: Vec<f32> = a.layers.decode().iter().map(|v| f16::from_f32(*v).to_f32()).collect();
            assert_eq!((b.layers.encoding, b.layers.decode()), (Encoding::F16, halves));
        }
    }
}

#[test]
fn maps_come_back_can_fail() {
    let folder = tempfile::tempdir().unwrap();
    export::maps(&maps(), Container::Dds, folder.path()).unwrap();
    let path = folder.path().join("sheet_0.dds");
    let mut bytes = fs::read(&path).unwrap();
    bytes[148 + 6] ^= 1;
    fs::write(&path, bytes).unwrap();
    assert_ne!(import::maps(folder.path()).unwrap().sheets[0], maps().sheets[0]);
}

/// DDS is written by hand; the reader of the crate `ddsfile` and the offsets of its description say the same.
#[test]
fn dds_is_what_others_read() {
    let folder = tempfile::tempdir().unwrap();
    export::maps(&maps(), Container::Dds, folder.path()).unwrap();
    let formats = [
        DxgiFormat::R32G32B32A32_Float,
        DxgiFormat::R16_Float,
        DxgiFormat::R16_Float,
        DxgiFormat::BC1_UNorm,
        DxgiFormat::BC6H_UF16,
    ];
    for (i, format) in formats.into_iter().enumerate() {
        let bytes = fs::read(folder.path().join(format!("sheet_{i}.dds"))).unwrap();
        let dds = Dds::read(&bytes[..]).unwrap();
        let layers = &maps().sheets[i].layers;
        assert_eq!(dds.get_dxgi_format(), Some(format));
        assert_eq!((dds.get_width(), dds.get_height(), dds.get_num_array_layers()), (layers.width, layers.height, 3));
        assert_eq!(dds.data.len() as u32, 3 * dds.get_array_stride().unwrap(), "sheet {i}");
        assert_eq!(dds.header10.as_ref().unwrap().resource_dimension, D3D10ResourceDimension::Texture2D);
        assert_eq!(
            dds.header.pitch.or(dds.header.linear_size),
            dds.get_pitch().filter(|_| i < 3).or(dds.get_main_texture_size())
        );
    }
    // The green number of the second texel of the second layer of sheet 0, whose texels are four f32.
    let bytes = fs::read(folder.path().join("sheet_0.dds")).unwrap();
    let at = 148 + (2 + 1) * 16 + 4;
    let expected = maps().sheets[0].layers.decode()[(2 + 1) * 3 + 1];
    assert_eq!((&bytes[..4], f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())), (&b"DDS "[..], expected));
    export::volume(&volume(), &[[1.0; 3]], Container::Dds, folder.path()).unwrap();
    let dds = Dds::read(&fs::read(folder.path().join("volume_8.dds")).unwrap()[..]).unwrap();
    assert_eq!([dds.get_width(), dds.get_height(), dds.get_depth()], [5, 7, 3]);
    assert_eq!(dds.header10.as_ref().unwrap().resource_dimension, D3D10ResourceDimension::Texture3D);
    assert_eq!(dds.data.len(), 5 * 7 * 3 * 8);
}

/// KTX2 is made of the records of the crate `ktx2`; here its offsets are followed by hand, and its reader validates it.
#[test]
fn ktx2_is_what_others_read() {
    let folder = tempfile::tempdir().unwrap();
    export::maps(&maps(), Container::Ktx2, folder.path()).unwrap();
    export::volume(&volume(), &[[1.0; 3]], Container::Ktx2, folder.path()).unwrap();
    // Numbers of VkFormat: R32G32B32A32_SFLOAT, R16_SFLOAT, BC1_RGB_UNORM_BLOCK, BC6H_UFLOAT_BLOCK.
    for (i, (format, block)) in [(109, 16), (76, 2), (76, 2), (131, 8), (143, 16)].into_iter().enumerate() {
        let bytes = fs::read(folder.path().join(format!("sheet_{i}.ktx2"))).unwrap();
        let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let u64_at = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
        let layers = &maps().sheets[i].layers;
        assert_eq!(&bytes[..12], b"\xABKTX 20\xBB\r\n\x1a\n");
        assert_eq!((u32_at(12), u32_at(20), u32_at(24), u32_at(28)), (format, layers.width, layers.height, 0));
        assert_eq!((u32_at(32), u32_at(36), u32_at(40), u32_at(44)), (3, 1, 1, 0));
        assert_eq!((u64_at(80) + u64_at(88), u64_at(88)), (bytes.len(), u64_at(96)));
        assert_eq!(u64_at(80) % block, 0, "texels begin at a multiple of their block");
        assert_eq!(u32_at(48) % 4 + u32_at(56) % 4, 0);
        let reader = ktx2::Reader::new(&bytes[..]).unwrap();
        assert_eq!((reader.writer(), reader.basic_dfd().is_some()), (Some("relume\0"), true));
        let texels = reader.levels().next().unwrap().data.len();
        // Three layers of 2x1, 1x3, 1x1 texels; of one by two blocks.
        assert_eq!(texels, 3 * [2 * 16, 3 * 2, 2, 2 * 8, 2 * 16][i], "sheet {i}");
    }
    let bytes = fs::read(folder.path().join("volume_4.ktx2")).unwrap();
    let header = ktx2::Reader::new(&bytes[..]).unwrap().header();
    assert_eq!((header.pixel_width, header.pixel_height, header.pixel_depth, header.layer_count), (5, 7, 3, 0));
}

/// The textures hold what the volume says at the points of the grid: a probe's own coefficients where one stands, and its trilinear rule
/// between; hardware that filters at the stated place gives the rule back in cells of the finest level.
#[test]
fn volumes_become_textures() {
    let (volume, light) = (volume(), [[0.5, 1.0, 2.0]]);
    for container in CONTAINERS {
        let folder = tempfile::tempdir().unwrap();
        export::volume(&volume, &light, container, folder.path()).unwrap();
        let grid = import::grid(folder.path()).unwrap();
        assert_eq!((grid.points, grid.step, grid.origin), ([5, 7, 3], [0.5, 0.25, 1.0], volume.origin));
        let lit = volume.lit(&light);
        for (probe, position) in volume.positions.iter().enumerate() {
            let place: [usize; 3] = std::array::from_fn(|c| ((position[c] - grid.origin[c]) / grid.step[c]) as usize);
            let at = (place[2] * 7 + place[1]) * 5 + place[0];
            // Where cells of two levels meet the finer one stands in a point of the coarser; the grid reads the cell that owns the point.
            let owns = volume.cell(Vec3::from_array(*position)).probes.contains(&(probe as u32));
            for k in (0..9).filter(|_| owns) {
                assert_eq!(grid.functions[k][at], lit[probe][k], "{container:?}: probe {probe}, function {k}");
            }
        }
        let normal = Vec3::new(0.6, 0.0, 0.8);
        let mut functions = [0.0; 9];
        sh_math::evaluate(sh_math::Bands::new(3).unwrap(), normal, &mut functions);
        for i in 0..200 {
            let part = |step: f64| (f64::from(i) * step).fract() as f32;
            // Inside of the split cell and off its far faces, where the finer level meets the coarser.
            let point = Vec3::new(-1.0 + 0.49 * part(0.819), 2.0 + 0.24 * part(0.671), 0.5 + 0.99 * part(0.549));
            let place = (point - Vec3::from_array(grid.origin)) / Vec3::from_array(grid.step);
            let (corner, share) = (place.floor(), place - place.floor());
            let mut sum = [0.0; 3];
            for corner_bit in 0..8_usize {
                let bit = |c: usize| corner_bit >> c & 1;
                let weight: f32 = (0..3).map(|c| if bit(c) == 1 { share[c] } else { 1.0 - share[c] }).product();
                let index = |c: usize| corner[c] as usize + bit(c);
                for (k, function) in functions.iter().enumerate() {
                    let texel = grid.functions[k][(index(2) * 7 + index(1)) * 5 + index(0)];
                    sum = std::array::from_fn(|c| sum[c] + weight * function * texel[c]);
                }
            }
            let found = volume.irradiance_by(Lookup::Trilinear, point, normal, &light);
            for c in 0..3 {
                assert!((found[c] - sum[c]).abs() < 1e-4, "{point}: {found:?}, not {sum:?}");
            }
        }
    }
}

#[test]
fn volumes_become_text_and_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("volume.json");
    let mut odd = sample().volume.unwrap();
    let mut state = 7_u32;
    for value in &mut odd.values {
        // Any finite f32.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *value = f32::from_bits(state & !0x4000_0000);
    }
    odd.values[..3].copy_from_slice(&[f32::MIN_POSITIVE, 1e-45, f32::MAX]);
    for volume in [odd, volume()] {
        export::volume_json(&volume, &path).unwrap();
        assert_eq!(import::volume_json(&path).unwrap(), volume);
    }
    let text: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    assert_eq!((&text["cells"][1], &text["light"]["relightable"]["bands"]), (&3.into(), &1.into()));
    assert_eq!(text["nodes"][0]["split"], 6);
    assert_eq!(text["probes"][2]["coefficients"].as_array().unwrap().len(), 9);
    let changed = fs::read_to_string(&path).unwrap().replacen("\"validity\": 1.0", "\"validity\": 0.5", 1);
    fs::write(&path, changed).unwrap();
    assert_ne!(import::volume_json(&path).unwrap(), volume());
}

fn refuse<T>(result: Result<T, Error>, reason: &str) {
    let Err(error) = result else { panic!("'{reason}' was no reason to refuse") };
    let text = error.to_string();
    assert!(text.contains(reason), "'{text}' says nothing of '{reason}'");
}

/// What contradicts itself is refused with the reason.
#[test]
fn damaged_exports_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let edit = |file: &str, from: &str, to: &str| {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        assert!(text.contains(from), "{file} has no {from}");
        fs::write(folder.join(file), text.replacen(from, to, 1)).unwrap();
    };
    let again = || {
        export::maps(&maps(), Container::Ktx2, folder).unwrap();
        export::volume(&volume(), &[[1.0; 3]], Container::Dds, folder).unwrap();
    };
    for (from, to, reason) in [
        ("\"hl2\"", "\"hl3\"", "hl3"),
        ("real-orth", "odd-", "convention"),
        ("sheet_0.ktx2", "../sheet_0.ktx2", "beside"),
        ("sheet_0.ktx2", "sheet_0.png", "beside"),
        ("sheet_0.ktx2", "sheet_1.ktx2", "size or the texels"),
        ("\"width\": 2", "\"width\": 3", "size or the texels"),
        ("\"f32\"", "\"u8\"", "eight bits"),
        ("\"basis\"", "\"base\"", "unknown field"),
        ("\"channels\": 3", "\"channels\": 2", "channels"),
    ] {
        again();
        edit("maps.json", from, to);
        refuse(import::maps(folder), reason);
    }
    for (from, to, reason) in [
        ("volume_3.dds", "volume_9.dds", ""),
        ("    7,", "    8,", "size or the texels"),
        ("volume_3.dds", "/volume_3.dds", "beside"),
    ] {
        again();
        edit("volume.json", from, to);
        refuse(import::grid(folder), reason);
    }
    let path = folder.join("v.json");
    let spoil = |spoil: fn(&mut Volume), reason: &str| {
        let mut volume = volume();
        spoil(&mut volume);
        export::volume_json(&volume, &path).unwrap();
        refuse(import::volume_json(&path), reason);
    };
    spoil(|v| v.nodes[0] = Node::Split(0), "cell 0");
    spoil(|v| v.validity[0] = 3.0, "validity");
    spoil(|v| v.light = MapLight::Relightable { bands: 2 }, "numbers");
}

/// Cut or with a bit flipped, a texture is refused or read, never a panic.
#[test]
fn damaged_textures_never_panic() {
    for container in CONTAINERS {
        let folder = tempfile::tempdir().unwrap();
        export::maps(&maps(), container, folder.path()).unwrap();
        for sheet in 0..5 {
            let path = folder.path().join(format!("sheet_{sheet}.{}", container.extension()));
            let sound = fs::read(&path).unwrap();
            for length in (0..sound.len()).step_by(23) {
                fs::write(&path, &sound[..length]).unwrap();
                assert!(import::maps(folder.path()).is_err(), "{container:?} sheet {sheet} cut to {length}");
            }
            for at in (0..sound.len().min(320)).step_by(3) {
                let mut bytes = sound.clone();
                bytes[at] ^= 1 << (at % 8);
                fs::write(&path, &bytes).unwrap();
                _ = import::maps(folder.path());
            }
            fs::write(&path, &sound).unwrap();
        }
    }
}

/// A volume that is split seven times over would have 129^3 points, more than two million: the grid is that of six levels.
#[test]
fn a_grid_that_were_too_fine_is_coarser() {
    let mut deep = volume();
    let leaf = Node::Leaf([0; 8]);
    (deep.cells, deep.nodes) = ([1, 1, 1], vec![leaf; 1 + 7 * 8]);
    for level in 0..7 {
        deep.nodes[if level == 0 { 0 } else { 8 * level }] = Node::Split(1 + 8 * level as u32);
    }
    assert_eq!(deep.levels(), 7);
    let grid = deep.grid(&[[1.0; 3]]).unwrap();
    assert_eq!((grid.points, grid.step[0]), ([65; 3], 1.0 / 64.0));
    assert_eq!((volume().levels(), volume().grid(&[[1.0; 3]]).unwrap().points), (1, [5, 7, 3]));
}

/// More layers than hardware reads, and more points than are sensible, are refused before memory is taken.
#[test]
fn what_no_hardware_reads_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut maps = maps();
    maps.light = MapLight::Relightable { bands: 27 };
    let values = vec![0.0; 3 * 27 * 27];
    maps.sheets = vec![coeff_io::Sheet { layers: coeff_io::Layers::exact([1, 1, 3 * 27 * 27, 1], &values) }];
    refuse(export::maps(&maps, Container::Dds, folder.path()), "graphics hardware");
    let mut long = volume();
    (long.cells, long.nodes) = ([3000, 1, 1], vec![Node::Leaf([0; 8]); 3000]);
    refuse(export::volume(&long, &[[1.0; 3]], Container::Ktx2, folder.path()), "graphics hardware");
    assert!(Path::new(folder.path()).exists());
}
