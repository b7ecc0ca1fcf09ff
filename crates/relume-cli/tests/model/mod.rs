//! Small glTF scenes that tests write.

#![allow(dead_code, reason = "each test file uses its own part of this module")]

use serde_json::{Value, json};
use std::f32::consts::PI;
use std::fs;
use std::path::Path;

/// Corners and triangles, counter-clockwise from outside.
#[derive(Debug, Clone, Default)]
pub(crate) struct Shape {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// A box between two corners.
    pub(crate) fn cuboid(low: [f32; 3], high: [f32; 3]) -> Self {
        let corner = |k: usize| std::array::from_fn(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
        let mut shape = Self { positions: (0..8).map(corner).collect(), triangles: Vec::new() };
        for [a, b, c, d] in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            shape.triangles.extend([[a, b, c], [a, c, d]]);
        }
        shape
    }

    /// A rectangle on the ground, its front up.
    pub(crate) fn ground(half: f32) -> Self {
        let positions = vec![[-half, 0.0, -half], [half, 0.0, -half], [half, 0.0, half], [-half, 0.0, half]];
        Self { positions, triangles: vec![[0, 2, 1], [0, 3, 2]] }
    }

    /// The part of a sphere between two angles from its top.
    pub(crate) fn sphere(radius: f32, from: f32, to: f32) -> Self {
        const RINGS: u32 = 8;
        const SPOKES: u32 = 16;
        let mut shape = Self::default();
        for ring in 0..=RINGS {
            let theta = from + (to - from) * ring as f32 / RINGS as f32;
            for spoke in 0..=SPOKES {
                let phi = 2.0 * PI * (spoke % SPOKES) as f32 / SPOKES as f32;
                let [x, y, z] = [theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos()];
                shape.positions.push([radius * x, radius * y, radius * z]);
            }
        }
        for ring in 0..RINGS {
            for spoke in 0..SPOKES {
                let [a, b] = [ring, ring + 1].map(|ring| ring * (SPOKES + 1) + spoke);
                shape.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
            }
        }
        shape
    }

    /// The same seen from the other side.
    pub(crate) fn turned(mut self) -> Self {
        self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        self
    }

    /// Two of its triangles as a shape of their own.
    pub(crate) fn side(&self, number: usize) -> Self {
        Self { triangles: self.triangles[2 * number..2 * number + 2].to_vec(), ..self.clone() }
    }
}

/// Writes `name` and a buffer beside it; each mesh has a name, a shape and a material as glTF writes it. A material that
/// has the member `picture` gets that file as its base colour.
pub(crate) fn write(folder: &Path, name: &str, meshes: &[(&str, Shape, Value)]) {
    let mut bytes: Vec<u8> = Vec::new();
    let (mut views, mut accessors, mut primitives) = (Vec::new(), Vec::new(), Vec::new());
    let (mut materials, mut images) = (Vec::new(), Vec::new());
    for (number, (mesh, shape, material)) in meshes.iter().enumerate() {
        let points: Vec<u8> = shape.positions.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        let places: Vec<u8> = shape.positions.iter().flat_map(|p| [p[0], p[2]]).flat_map(f32::to_le_bytes).collect();
        let indices: Vec<u8> = shape.triangles.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        let counts = [shape.positions.len(), shape.positions.len(), 3 * shape.triangles.len()];
        let kinds = [(5126, "VEC3"), (5126, "VEC2"), (5125, "SCALAR")];
        for ((part, count), (component, kind)) in [points, places, indices].iter().zip(counts).zip(kinds) {
            views.push(json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": part.len() }));
            accessors.push(
                json!({ "bufferView": views.len() - 1, "componentType": component, "count": count, "type": kind }),
            );
            bytes.extend(part);
        }
        let low = |axis: usize| shape.positions.iter().map(|p| p[axis]).fold(f32::INFINITY, f32::min);
        let high = |axis: usize| shape.positions.iter().map(|p| p[axis]).fold(f32::NEG_INFINITY, f32::max);
        accessors[3 * number]["min"] = json!([low(0), low(1), low(2)]);
        accessors[3 * number]["max"] = json!([high(0), high(1), high(2)]);
        let mut material = material.clone();
        if let Some(picture) = material.as_object_mut().and_then(|members| members.remove("picture")) {
            images.push(json!({ "uri": picture }));
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": images.len() - 1 });
        }
        materials.push(material);
        let attributes = json!({ "POSITION": 3 * number, "TEXCOORD_0": 3 * number + 1 });
        let primitive = json!({ "attributes": attributes, "indices": 3 * number + 2, "material": number });
        primitives.push(json!({ "name": mesh, "primitives": [primitive] }));
    }
    let nodes: Vec<Value> = (0..meshes.len()).map(|n| json!({ "mesh": n, "name": meshes[n].0 })).collect();
    let textures: Vec<Value> = (0..images.len()).map(|n| json!({ "source": n })).collect();
    let buffer = Path::new(name).with_extension("bin");
    let mut scene = json!({
        "asset": { "version": "2.0" }, "extensionsUsed": ["KHR_materials_unlit"], "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }], "nodes": nodes, "meshes": primitives,
        "materials": materials, "accessors": accessors, "bufferViews": views,
        "buffers": [{ "uri": buffer, "byteLength": bytes.len() }],
    });
    if !images.is_empty() {
        (scene["images"], scene["textures"]) = (json!(images), json!(textures));
    }
    fs::write(folder.join(buffer), bytes).unwrap();
    fs::write(folder.join(name), scene.to_string()).unwrap();
}

/// A matte material of one colour, with further members.
pub(crate) fn material(color: [f32; 3], more: Value) -> Value {
    let [r, g, b] = color;
    let mut material = json!({ "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0 } });
    for (key, value) in more.as_object().into_iter().flatten() {
        material[key] = value.clone();
    }
    material
}

/// What makes a material unlit.
pub(crate) fn unlit() -> Value {
    json!({ "KHR_materials_unlit": {} })
}

/// Writes a picture of four texels.
pub(crate) fn picture(path: &Path) {
    image::RgbImage::from_fn(2, 2, |x, y| image::Rgb([90 + 80 * x as u8, 120, 90 + 80 * y as u8])).save(path).unwrap();
}
