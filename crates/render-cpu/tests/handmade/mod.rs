//! Baked scenes made by hand: the transfer is written out, nothing is traced.
#![allow(dead_code, reason = "each test uses its part")]

pub(crate) mod gloss;

use coeff_io::{
    Achieved, AlphaMode, BandChoice, Bounces, Camera, Codebooks, Effects, Geometry, Material, Mesh, Plan, Prt, Quality,
    Refine, Sampler, Settings, Transfer,
};
use glam::Vec3;

/// Y00.
pub(crate) const Y0: f32 = 0.282_094_8;
/// Y1m / coordinate.
pub(crate) const Y1: f32 = 0.488_602_5;

/// Two bands of the unshadowed transfer at a normal: factors 1 and 2/3 of the clamped cosine over pi.
pub(crate) fn open_transfer(normal: Vec3) -> [f32; 4] {
    let first = Y1 * 2.0 / 3.0;
    [Y0, first * normal.y, first * normal.z, first * normal.x]
}

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

/// A view from `eye` to `target` of 60 degrees.
pub(crate) fn camera(eye: [f32; 3], target: [f32; 3]) -> Camera {
    Camera { name: "test".into(), eye, target, up: [0.0, 1.0, 0.0], vertical_fov: 60.0_f32.to_radians() }
}

/// A scene without anything in it.
pub(crate) fn empty() -> Prt {
    Prt {
        generator: "test".into(),
        convention: sh_math::CONVENTION.into(),
        scene: "test".into(),
        origin: [0.0; 3],
        settings: Settings {
            bands: 2,
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
        cameras: vec![camera([0.0, 0.0, 4.0], [0.0; 3])],
        geometry: Geometry::default(),
        transfer: Transfer { bands: 2, channels: 1, ..Transfer::default() },
        textures: Vec::new(),
        maps: None,
        volume: None,
        gloss: None,
        transfer_textures: None,
        codebooks: Codebooks::default(),
        compressed: None,
    }
}

/// Adds triangles of three vertices each with one material; the transfer is unshadowed, the normals those of the triangles.
pub(crate) fn add_triangles(prt: &mut Prt, material: Material, triangles: &[[Vec3; 3]]) {
    let (first_vertex, first_triangle) = (prt.geometry.positions.len() as u32, prt.geometry.triangles.len() as u32);
    for corners in triangles {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        let first = prt.geometry.positions.len() as u32;
        prt.geometry.triangles.push([first, first + 1, first + 2]);
        for corner in corners {
            prt.geometry.positions.push(corner.to_array());
            prt.geometry.normals.push(normal.to_array());
            prt.transfer.values.extend(open_transfer(normal));
            prt.transfer.albedo.push([1.0; 3]);
        }
    }
    prt.meshes.push(Mesh {
        name: format!("mesh {}", prt.meshes.len()),
        material: prt.materials.len() as u32,
        first_vertex,
        vertices: 3 * triangles.len() as u32,
        first_triangle,
        triangles: triangles.len() as u32,
    });
    prt.materials.push(material);
}

/// Two triangles that make the parallelogram centre ± right ± up; the front is where right × up points.
pub(crate) fn quad(centre: Vec3, right: Vec3, up: Vec3) -> [[Vec3; 3]; 2] {
    let [a, b, c, d] = [centre - right - up, centre + right - up, centre + right + up, centre - right + up];
    [[a, b, c], [a, c, d]]
}

/// A scene of one white quad that faces +z, 4 units wide, through the origin.
pub(crate) fn wall(material: Material) -> Prt {
    let mut prt = empty();
    add_triangles(&mut prt, material, &quad(Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0));
    prt
}

/// The same colour for all three vertices of each triangle.
pub(crate) fn paint(prt: &mut Prt, color_of_vertex: impl Fn(usize, Vec3) -> [f32; 4]) {
    let positions = &prt.geometry.positions;
    prt.geometry.colors = positions.iter().enumerate().map(|(i, &p)| color_of_vertex(i, Vec3::from(p))).collect();
}

/// Largest difference between a pixel and a colour.
pub(crate) fn distance(pixel: [f32; 3], expected: [f32; 3]) -> f32 {
    (0..3).map(|c| (pixel[c] - expected[c]).abs()).fold(0.0, f32::max)
}
