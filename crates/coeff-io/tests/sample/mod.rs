//! A small baked scene in which every optional part is present.

use coeff_io::*;
use sh_math::hemisphere::Basis;

/// Two meshes, two textures, three channels, two bands: every chunk kind and every record occurs.
pub(crate) fn sample() -> Prt {
    Prt {
        generator: "relume 0.1.0".into(),
        convention: sh_math::CONVENTION.into(),
        scene: "builtin:sample".into(),
        origin: [500_000.1, 0.0, -5_300_000.3],
        settings: settings(),
        plan: plan(),
        achieved: Achieved {
            error: [0.005, 0.009, 0.01],
            worst_receiver: 4,
            visibility_rays: 1_234_567_890_123,
            bounce_rays: 42,
            bounces: 2,
            bounce_changes: vec![0.25, 0.0625],
            repairs: RepairCounts { inside: 1, bad_normals: 2, unrepaired: 0 },
            effects: vec![EffectCost {
                effect: Effect::Visibility,
                rays: 1_234_567_890_123,
                saved_rays: 12,
                bytes: 28,
                saved_bytes: 0,
            }],
            maps: Some(MapRecord {
                texels: 9,
                inside: 2,
                unfilled: 1,
                error: [0.001, 0.002, 0.003],
                rays: [70_000_000_000, 5],
                clipped: 3,
                negative: 4,
            }),
            gloss: Some(GlossRecord {
                vertices: 4,
                texels: 3,
                inside: 1,
                unfilled: 0,
                rays: [80_000_000_000, 6],
                error: [0.001, 0.002, 0.003],
                compression: [0.01, 0.02, 0.03],
                bytes: [1000, 100],
            }),
            interpolation: Some([0.001, 0.1, 0.75]),
            remainder: Some(0.002),
            worst_between: Some(3),
        },
        meshes: vec![mesh("floor", 0, [0, 4], [0, 2]), mesh("wall é", 1, [4, 3], [2, 1])],
        materials: vec![material("stone"), plain_material("glass")],
        cameras: vec![camera()],
        geometry: geometry(),
        transfer: transfer(),
        textures: vec![texture("a.png", 3, 1), texture("b.png", 2, 2)],
        maps: Some(maps()),
        volume: Some(volume()),
        gloss: Some(gloss()),
        transfer_textures: Some(transfer_textures()),
        codebooks: codebooks(),
        compressed: None,
    }
}

fn settings() -> Settings {
    Settings {
        bands: 3,
        band_choice: BandChoice::Needed,
        light: vec![1.5, 0.25],
        quality: Quality::Error(0.01),
        time: Some(90.0),
        bounces: Bounces::Fixed(2),
        effects: Effects::Only(vec![Effect::Visibility, Effect::Interreflection, Effect::Color]),
        sampler: Sampler::OwenSobol,
        seed: 7,
        refine: Refine::Auto,
        memory: 1 << 30,
    }
}

fn plan() -> Plan {
    let row = PlanRow {
        effect: Effect::Color,
        simulate: true,
        decision: "3 channels".into(),
        reason: "the floor is red".into(),
        called_for_by: vec!["floor".into(), "wall é".into()],
        callers: 9,
        rays: 0,
        bytes: 336,
        stake: 0.5,
        at_stake: "bounced light would be grey".into(),
    };
    let masks = PlanRow {
        effect: Effect::Masks,
        simulate: false,
        decision: "opaque".into(),
        reason: "no mask".into(),
        called_for_by: vec![],
        callers: 0,
        rays: 0,
        bytes: 0,
        stake: 0.0,
        at_stake: "nothing".into(),
    };
    Plan {
        rows: vec![row, masks],
        meshes: vec![MeshPlan { mesh: 1, receivers: 3, shadowed: 2, effects: vec![Effect::Motion, Effect::Bands] }],
        survey: Survey { receivers: 2, rays: 256, coverage: [0.25, 0.5], band_norms: vec![0.25, 0.125] },
        receivers: 7,
        shadowed_receivers: 3,
        dark_receivers: 1,
        bands: 2,
        channels: 3,
        bounces: 2,
        expected_bounces: 1,
    }
}

fn mesh(name: &str, material: u32, vertices: [u32; 2], triangles: [u32; 2]) -> Mesh {
    Mesh {
        name: name.into(),
        material,
        first_vertex: vertices[0],
        vertices: vertices[1],
        first_triangle: triangles[0],
        triangles: triangles[1],
    }
}

fn slot(texture: u32, uv_set: u8) -> Option<TextureSlot> {
    Some(TextureSlot { texture, uv_set, transform: [[1.0, 0.0, 0.5], [0.0, -1.0, 1.0]] })
}

fn plain_material(name: &str) -> Material {
    Material {
        name: name.into(),
        base_color: [1.0; 4],
        base_color_texture: None,
        metallic: 0.0,
        roughness: 1.0,
        metallic_roughness_texture: None,
        normal_texture: None,
        normal_scale: 1.0,
        emissive: [0.0; 3],
        emissive_texture: None,
        alpha: AlphaMode::Blend,
        specular: false,
        transmission: 0.5,
        unlit: true,
    }
}

fn material(name: &str) -> Material {
    Material {
        base_color: [0.8, 0.1, 0.1, 1.0],
        base_color_texture: slot(0, 0),
        metallic_roughness_texture: slot(1, 1),
        normal_texture: slot(1, 0),
        emissive: [0.0, 3.0, 0.0],
        emissive_texture: slot(0, 1),
        alpha: AlphaMode::Mask(0.5),
        specular: true,
        transmission: 0.0,
        unlit: false,
        ..plain_material(name)
    }
}

fn camera() -> Camera {
    Camera {
        name: "front".into(),
        eye: [0.0, 1.0, 5.0],
        target: [0.0, 1.0, 0.0],
        up: [0.0, 1.0, 0.0],
        vertical_fov: 0.75,
    }
}

fn geometry() -> Geometry {
    let number = |v: usize, i: usize| (v * 3 + i) as f32 * 0.125;
    Geometry {
        positions: (0..7).map(|v| std::array::from_fn(|i| number(v, i) - 1.0)).collect(),
        normals: (0..7).map(|v| if v < 4 { [0.0, 1.0, 0.0] } else { [0.6, 0.0, -0.8] }).collect(),
        tangents: vec![[1.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, -1.0]].into_iter().cycle().take(7).collect(),
        uv0: (0..7).map(|v| std::array::from_fn(|i| number(v, i))).collect(),
        uv1: (0..7).map(|v| std::array::from_fn(|i| number(v, i) * 0.5)).collect(),
        colors: (0..7).map(|v| [1.0, number(v, 0), 0.5, 1.0]).collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6]],
    }
}

fn transfer() -> Transfer {
    Transfer {
        bands: 2,
        channels: 3,
        values: (0..7 * 4 * 3).map(|i| i as f32 * 0.25 - 3.0).collect(),
        albedo: (0..7).map(|v| [0.125 * v as f32, 0.5, 1.0]).collect(),
        openness: (0..7).map(|v| 0.125 * v as f32).collect(),
    }
}

fn texture(name: &str, width: u32, height: u32) -> Texture {
    let rgba = (0..width * height).map(|i| [i as u8, 128, 255 - i as u8, 255]).collect();
    Texture { name: name.into(), width, height, rgba, wrap: [Wrap::Repeat, Wrap::Mirror] }
}

/// A sheet in every encoding.
fn maps() -> Maps {
    let shape = |width, height, channels| [width, height, 3, channels];
    let values = |n: u32| -> Vec<f32> { (0..n).map(|i| 0.75 - 0.125 * i as f32).collect() };
    let exact = Layers::exact(shape(2, 1, 3), &values(18));
    let charts = [4, u32::MAX, 2];
    let curves = [Curve::Srgb, Curve::Linear, Curve::Linear];
    let coding = Coding { charts: &charts, curves: &curves, ..Coding::plain(Encoding::U8) };
    let eight = Layers::encode(shape(1, 3, 1), &values(9), &coding).layers;
    let half = Layers::encode(shape(1, 1, 1), &values(3), &Coding::plain(Encoding::F16)).layers;
    Maps {
        basis: Basis::Hl2,
        light: MapLight::Fixed { probe: "builtin:sky".into(), bands: 5 },
        sheets: [exact, eight, half, blocks(Encoding::Bc1), blocks(Encoding::Bc6h)]
            .map(|layers| Sheet { layers })
            .into(),
        sheet_of_mesh: vec![Some(1), None],
    }
}

/// Three layers of 3x5 texels in one channel: six blocks by hand, so that no encoder decides on them.
fn blocks(encoding: Encoding) -> Layers {
    let block: Vec<u8> = match encoding {
        Encoding::Bc1 => vec![0x00, 0xF8, 0xE0, 0x07, 0xE4, 0x1B, 0xFF, 0x00],
        _ => (15_u128 | 0x15_u128 << 39 | 7 << 65).to_le_bytes().into(),
    };
    let ranges = [[-0.5_f32, 0.5], [0.0, 2.0], [0.25, 0.25]];
    let mut bytes = vec![0, u8::from(encoding == Encoding::Bc1), 0];
    bytes.extend(ranges.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend(block.repeat(6));
    Layers { width: 3, height: 5, count: 3, channels: 1, encoding, bytes }
}

/// Two coarse cells, of which the first is split.
fn volume() -> Volume {
    let leaf = |first: u32| Node::Leaf(std::array::from_fn(|i| (first + i as u32) % 8));
    Volume {
        origin: [-1.0, 0.0, 2.0],
        spacing: [1.0, 2.0, 0.5],
        cells: [1, 2, 1],
        nodes: [Node::Split(2), leaf(0)].into_iter().chain((1..9).map(leaf)).collect(),
        light: MapLight::Relightable { bands: 1 },
        channels: 1,
        values: (0..8 * 9).map(|i| i as f32 * 0.0625 - 2.0).collect(),
        positions: (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|n| n as f32)).collect(),
        validity: (0..8).map(|i| i as f32 * 0.125).collect(),
        distances: (0..8).flat_map(|i| [i as f32 * 0.5, (i * i) as f32 * 0.25 + 0.125]).collect(),
        resolution: 1,
        reach: 4.0,
    }
}

fn some(count: usize, seed: usize) -> Vec<f32> {
    (0..count).map(|i| ((i * 7 + seed * 3) % 11) as f32 / 8.0 - 0.5).collect()
}

/// Three channels of two bands; visibility of three bands; bounces of one band of light in one channel.
fn codebooks() -> Codebooks {
    Codebooks {
        diffuse: Some(Codebook::new([12, 2, 1], &some(48, 1))),
        visibility: Some(Codebook::new([9, 1, 2], &some(27, 2))),
        bounce: Some(Codebook::factored([9, 2, 0], &some(6, 3), &some(27, 8))),
    }
}

fn gloss() -> Gloss {
    let bounce = Table::clustered(codebooks().bounce.as_ref().unwrap(), &[1, 0, 1], &[]);
    Gloss {
        bands: 3,
        bounced: Some(Bounced::Relightable { bands: 1, channels: 1 }),
        vertices: Some(VertexGloss {
            first_row: vec![None, Some(0)],
            arriving: Arriving { visibility: Table::half(9, &some(27, 4)), bounces: vec![bounce] },
        }),
    }
}

fn transfer_textures() -> TransferTextures {
    let books = codebooks();
    let level = |width, height, places: Vec<u32>| {
        let n = places.len();
        let arriving = Arriving {
            visibility: Table::clustered(books.visibility.as_ref().unwrap(), &vec![0; n], &some(2 * n, 5)),
            bounces: vec![Table::exact(9, &some(9 * n, 6))],
        };
        let diffuse = Table::clustered(books.diffuse.as_ref().unwrap(), &vec![1; n], &some(n, 7));
        TransferLevel { width, height, places, diffuse, arriving: Some(arriving) }
    };
    TransferTextures {
        channels: 3,
        bent: true,
        sheets: vec![TransferSheet { levels: vec![level(3, 2, vec![0, 2, 4]), level(2, 1, vec![1])] }],
        sheet_of_mesh: vec![Some(0), None],
    }
}
