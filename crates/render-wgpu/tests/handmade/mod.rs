//! A scene made by hand that holds every kind of material: a sphere on a plane, leaves, glass and a lamp shade.
//!
//! Its transfer is the unshadowed closed form, tinted and darkened by formula, so that nothing has to be traced.
#![allow(dead_code, reason = "each test uses its part")]

use coeff_io::{
    Achieved, AlphaMode, BandChoice, Bounces, Camera, Codebooks, Effects, Layers, MapLight, Maps, Material, Mesh, Plan,
    Prt, Quality, Refine, Sampler, Settings, Sheet, Texture, TextureSlot, Transfer, Wrap,
};
use glam::{Quat, Vec3};
use probe_io::{Environment, Lamp};
use sh_math::{Bands, hemisphere::Basis, zonal};

/// Bands of every handmade transfer.
const BANDS: u32 = 4;

/// A white diffuse material.
pub(crate) fn white() -> Material {
    Material {
        name: "white".into(),
        base_color: [1.0; 4],
        base_color_texture: None,
        metallic: 0.0,
        roughness: 1.0,
        metallic_roughness_texture: None,
        normal_texture: None,
        normal_scale: 1.0,
        emissive: [0.0; 3],
        emissive_texture: None,
        alpha: AlphaMode::Opaque,
        specular: false,
        transmission: 0.0,
        unlit: false,
    }
}

/// A view from above the plane.
pub(crate) fn camera() -> Camera {
    Camera {
        name: "test".into(),
        eye: [2.2, 1.7, 3.4],
        target: [0.1, 0.2, 0.0],
        up: [0.0, 1.0, 0.0],
        vertical_fov: 50f32.to_radians(),
    }
}

/// A noisy panorama with a strong contrast and one lamp.
pub(crate) fn environment() -> Environment {
    let mut environment = Environment::from_function("noise", 24, |d| {
        let wave = (7.0 * d.x).sin() * (5.0 * d.y + 1.0).cos() * (6.0 * d.z).sin();
        [1.0 + d.y + 0.7 * wave, 1.0 + 0.8 * wave, 0.7 - 0.4 * d.y + 0.3 * d.x].map(|x| x.max(0.0))
    });
    environment.lamps.push(Lamp {
        direction: Vec3::new(-0.55, 0.25, -0.8).normalize(),
        half_angle: 0.12,
        irradiance: [2.0, 1.5, 1.0],
    });
    environment
}

/// A scene without anything in it.
fn empty(channels: u32) -> Prt {
    Prt {
        generator: "test".into(),
        convention: sh_math::CONVENTION.into(),
        scene: "test".into(),
        origin: [0.0; 3],
        settings: Settings {
            bands: BANDS,
            band_choice: BandChoice::Exactly,
            light: Vec::new(),
            quality: Quality::Rays(1),
            time: None,
            bounces: Bounces::Fixed(0),
            effects: Effects::Auto,
            sampler: Sampler::OwenSobol,
            seed: 0,
            refine: Refine::Off,
            memory: 1 << 20,
        },
        plan: Plan::default(),
        achieved: Achieved::default(),
        meshes: Vec::new(),
        materials: Vec::new(),
        cameras: vec![camera()],
        geometry: coeff_io::Geometry::default(),
        transfer: Transfer { bands: BANDS, channels, ..Transfer::default() },
        textures: Vec::new(),
        maps: None,
        volume: None,
        gloss: None,
        transfer_textures: None,
        codebooks: Codebooks::default(),
        compressed: None,
    }
}

/// A point of a parametric surface: position, normal, tangent.
type Point = (Vec3, Vec3, Vec3);

/// Adds a grid of `columns * rows` cells over `surface(u, v)`; the front is where the normals point if u x v does too.
fn add_grid(prt: &mut Prt, material: Material, [columns, rows]: [u32; 2], surface: impl Fn(f32, f32) -> Point) {
    let first_vertex = prt.geometry.positions.len() as u32;
    let first_triangle = prt.geometry.triangles.len() as u32;
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (column as f32 / columns as f32, row as f32 / rows as f32);
            add_vertex(prt, surface(u, v), [u, v]);
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let a = first_vertex + row * (columns + 1) + column;
            let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
            prt.geometry.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    prt.meshes.push(Mesh {
        name: material.name.clone(),
        material: prt.materials.len() as u32,
        first_vertex,
        vertices: (columns + 1) * (rows + 1),
        first_triangle,
        triangles: 2 * columns * rows,
    });
    prt.materials.push(material);
}

fn add_vertex(prt: &mut Prt, (position, normal, tangent): Point, [u, v]: [f32; 2]) {
    let bands = Bands::new(BANDS).expect("few bands");
    let mut open = vec![0.0; bands.coefficients()];
    zonal::cosine_transfer(bands, normal, &mut open);
    let shade = 0.75 + 0.25 * (3.0 * position.x).sin() * (2.0 * position.z).cos();
    let tint = [shade, 0.9 * shade, 0.8 * shade];
    let channels = prt.transfer.channels as usize;
    prt.transfer.values.extend(open.iter().flat_map(|&t| tint.map(|tint| t * tint).into_iter().take(channels)));
    prt.transfer.openness.push(shade);
    prt.transfer.albedo.push([1.0; 3]);
    let geometry = &mut prt.geometry;
    geometry.positions.push(position.into());
    geometry.normals.push(normal.into());
    geometry.tangents.push(tangent.extend(1.0).into());
    geometry.uv0.push([u, v]);
    geometry.uv1.push([2.0 * v, 1.0 - u]);
    geometry.colors.push([1.0 - 0.3 * u, 1.0, 1.0 - 0.3 * v, 1.0]);
}

/// The unit sphere about the origin.
fn sphere(u: f32, v: f32) -> Point {
    let (sin, cos) = (std::f32::consts::TAU * u).sin_cos();
    let (ring, height) = (std::f32::consts::PI * (v - 0.5)).sin_cos();
    let normal = Vec3::new(height * sin, ring, height * cos);
    (normal, normal, Vec3::new(cos, 0.0, -sin))
}

/// A parallelogram with sides `right` and `up` about `centre`.
fn quad(centre: Vec3, right: Vec3, up: Vec3) -> impl Fn(f32, f32) -> Point {
    let normal = right.cross(up).normalize();
    move |u, v| (centre + right * (u - 0.5) + up * (v - 0.5), normal, right.normalize())
}

/// An 8-bit picture by formula.
fn texture(name: &str, [width, height]: [u32; 2], wrap: [Wrap; 2], texel: impl Fn(f32, f32) -> [f32; 4]) -> Texture {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let at = |x: u32, side: u32| (x as f32 + 0.5) / side as f32;
    let rgba = places.map(|(x, y)| texel(at(x, width), at(y, height)).map(|value| (value * 255.0).round() as u8));
    Texture { name: name.into(), width, height, rgba: rgba.collect(), wrap }
}

fn slot(texture: u32, uv_set: u8, transform: [[f32; 3]; 2]) -> Option<TextureSlot> {
    Some(TextureSlot { texture, uv_set, transform })
}

const PLAIN: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
const TURNED: [[f32; 3]; 2] = [[2.4, 1.8, 0.3], [-1.8, 2.4, -0.7]];

fn textures() -> Vec<Texture> {
    let wave = |x: f32| 0.5 + 0.4 * x.sin();
    vec![
        texture("base", [16, 12], [Wrap::Repeat, Wrap::Mirror], move |u, v| {
            [wave(9.0 * u), wave(7.0 * v), wave(5.0 * u + 6.0 * v), 1.0]
        }),
        texture("metal", [8, 8], [Wrap::Clamp, Wrap::Repeat], move |u, v| [0.0, wave(6.0 * u), wave(9.0 * v), 1.0]),
        texture("bumps", [16, 16], [Wrap::Repeat; 2], move |u, v| [wave(6.0 * u), wave(12.0 * v), 1.0, 1.0]),
        texture("leaf", [8, 8], [Wrap::Mirror, Wrap::Clamp], move |u, v| {
            [0.3, 0.8, 0.2, wave(9.0 * u) * wave(8.0 * v)]
        }),
        texture("glow", [4, 4], [Wrap::Clamp; 2], |u, v| [u, v, 0.5, 1.0]),
    ]
}

/// The whole scene; the sphere has about `rings * rings * 2` cells.
pub(crate) fn sphere_on_plane(channels: u32, rings: u32) -> Prt {
    let mut prt = empty(channels);
    prt.textures = textures();
    let floor = Material {
        name: "floor".into(),
        base_color_texture: slot(0, 0, TURNED),
        roughness: 0.4,
        specular: true,
        ..white()
    };
    add_grid(&mut prt, floor, [6, 6], quad(Vec3::NEG_Y, Vec3::Z * 6.0, Vec3::X * 6.0));
    let ball = Material {
        name: "ball".into(),
        base_color: [0.9, 0.7, 0.5, 1.0],
        metallic: 0.9,
        roughness: 0.8,
        metallic_roughness_texture: slot(1, 0, [[3.0, 0.0, 0.0], [0.0, 2.0, 0.0]]),
        normal_texture: slot(2, 0, [[4.0, 0.0, 0.0], [0.0, 2.0, 0.0]]),
        normal_scale: 0.4,
        specular: true,
        ..white()
    };
    add_grid(&mut prt, ball, [2 * rings, rings], sphere);
    let leaf = Material {
        name: "leaf".into(),
        base_color_texture: slot(3, 0, [[2.0, 0.0, -0.4], [0.0, 1.5, -0.2]]),
        alpha: AlphaMode::Mask(0.3),
        ..white()
    };
    add_grid(&mut prt, leaf, [2, 2], quad(Vec3::new(-1.6, 0.0, 0.6), Vec3::new(1.2, 0.0, 0.3), Vec3::Y * 1.6));
    let shade = Material {
        name: "lamp shade".into(),
        emissive: [1.5, 1.0, 0.5],
        emissive_texture: slot(4, 1, PLAIN),
        ..white()
    };
    add_grid(&mut prt, shade, [1, 1], quad(Vec3::new(1.5, -0.2, -1.2), Vec3::X, Vec3::new(0.0, 1.0, -0.3)));
    add_panes(&mut prt);
    prt
}

/// Two coloured panes that cross, one of them of glass.
fn add_panes(prt: &mut Prt) {
    let pane = Material { name: "pane".into(), base_color: [0.9, 0.2, 0.2, 0.4], alpha: AlphaMode::Blend, ..white() };
    let glass = Material {
        name: "glass".into(),
        base_color: [0.2, 0.3, 0.9, 1.0],
        roughness: 0.1,
        specular: true,
        transmission: 0.7,
        unlit: false,
        ..white()
    };
    let up = Vec3::Y * 1.4;
    add_grid(prt, pane, [3, 1], quad(Vec3::new(1.2, -0.2, 1.0), Vec3::new(1.0, 0.0, -0.6), up));
    add_grid(prt, glass, [3, 1], quad(Vec3::new(1.2, -0.1, 1.0), Vec3::new(0.9, 0.0, 0.5), up));
}

/// The rotation of the light in tests.
pub(crate) fn rotation() -> Quat {
    Quat::from_rotation_y(0.8) * Quat::from_rotation_x(-0.3)
}

/// The whole scene with light maps on floor, ball, leaf and the blended pane; the rest is lit at its vertices. Ball and leaf have a normal
/// map, the leaf without shine. The coordinates of the maps run beyond [0, 1].
pub(crate) fn mapped(basis: Basis, light: &MapLight, rings: u32) -> Prt {
    let mut prt = sphere_on_plane(1, rings);
    prt.materials[2].normal_texture = slot(2, 0, TURNED);
    let sheets = [[13, 9, 3], [6, 17, 1]].map(|size| sheet(basis, light, size));
    let sheet_of_mesh = vec![Some(0), Some(1), Some(1), None, Some(0), None];
    prt.maps = Some(Maps { basis, light: light.clone(), sheets: sheets.into(), sheet_of_mesh });
    prt
}

/// Coefficients by formula: the first function is bright, all others vary as much as it does; the more bands the less.
fn sheet(basis: Basis, light: &MapLight, [width, height, channels]: [u32; 3]) -> Sheet {
    let count = (basis.count() * light.depth()) as u32;
    let value = |layer: u32, x: u32, y: u32, channel: u32| {
        let (function, i) = (layer / light.depth() as u32, layer % light.depth() as u32);
        let wave = (1.3 * x as f32 + 0.7 * layer as f32).sin() * (0.9 * y as f32 + channel as f32).cos();
        let mean = if function == 0 { 3.0 } else { 0.0 };
        (mean + wave) / (1.0 + i as f32)
    };
    let texels = (0..count).flat_map(|layer| (0..height).flat_map(move |y| (0..width).map(move |x| (layer, x, y))));
    let values = texels.flat_map(|(layer, x, y)| (0..channels).map(move |channel| value(layer, x, y, channel)));
    Sheet { layers: Layers::exact([width, height, count, channels], &values.collect::<Vec<_>>()) }
}
