//! A pine of blended cards on bare ground, as a file.

use glam::{Quat, Vec3};
use scene::Scene;
use std::fmt::Write;

/// A twig of 8 x 8 texels: green, dense in the middle, clear at the rims.
const TWIG: &str = "iVBORw0KGgoAAAANSUhEUgAAAAgAAAAICAYAAADED76LAAAALklEQVR42mNwyzOyBuIGIN4OxC+geDtUzJoBSCgDsS8Q5wFxNxTnQcWUGYaFCQCe61eZcE2n9AAAAABJRU5ErkJggg==";

/// Positions, coordinates and triangles of a mesh under way.
#[derive(Default)]
struct Quads {
    positions: Vec<Vec3>,
    uvs: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl Quads {
    fn add(&mut self, corner: Vec3, right: Vec3, up: Vec3) {
        let first = self.positions.len() as u32;
        self.positions.extend([corner, corner + right, corner + right + up, corner + up]);
        self.uvs.extend([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
        self.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    }

    fn bytes(&self) -> Vec<u8> {
        let floats = self.positions.iter().flat_map(|p| p.to_array()).chain(self.uvs.iter().flatten().copied());
        let words = floats.map(f32::to_le_bytes).chain(self.indices.iter().map(|i| i.to_le_bytes()));
        words.flatten().collect()
    }
}

/// A crown of 60 crossing cards that narrows upwards, as exporters write pines.
fn crown() -> Quads {
    let mut quads = Quads::default();
    for k in 0..60u32 {
        let height = 0.3 + k as f32 / 33.0;
        let turn = Quat::from_rotation_y(2.4 * k as f32) * Quat::from_rotation_x(0.9 - (k % 3) as f32 * 0.5);
        let size = 0.9 - 0.4 * height / 2.1;
        quads.add(
            Vec3::Y * height + turn * Vec3::new(-0.3, 0.0, 0.05) * size,
            turn * Vec3::X * 0.6 * size,
            turn * Vec3::Z * size,
        );
    }
    quads
}

/// The file of a pine on bare ground: every card blends by its texture.
pub(crate) fn pine(folder: &std::path::Path) -> Scene {
    let mut ground = Quads::default();
    for (i, j) in (0..64).map(|k| ((k % 8) as f32, (k / 8) as f32)) {
        ground.add(Vec3::new(i * 0.6 - 2.4, 0.0, j * 0.6 - 1.8), Vec3::X * 0.6, Vec3::NEG_Z * 0.6);
    }
    let (mut buffer, mut views, mut accessors, mut meshes) = (Vec::new(), String::new(), String::new(), String::new());
    for (material, quads) in [crown(), ground].iter().enumerate() {
        let (vertices, indices) = (quads.positions.len(), quads.indices.len());
        let [low, high] =
            [Vec3::min, Vec3::max].map(|pick| quads.positions.iter().copied().reduce(pick).expect("some"));
        let mut start = buffer.len();
        for (bytes, kind) in [(12 * vertices, 0), (8 * vertices, 1), (4 * indices, 2)] {
            let shape = match kind {
                0 => format!(
                    r#""componentType":5126,"type":"VEC3","count":{vertices},"min":{low:?},"max":{high:?}"#,
                    low = low.to_array(),
                    high = high.to_array()
                ),
                1 => format!(r#""componentType":5126,"type":"VEC2","count":{vertices}"#),
                _ => format!(r#""componentType":5125,"type":"SCALAR","count":{indices}"#),
            };
            let comma = if start == 0 { "" } else { "," };
            write!(views, r#"{comma}{{"buffer":0,"byteOffset":{start},"byteLength":{bytes}}}"#).expect("a string");
            write!(accessors, r#"{comma}{{"bufferView":{},{shape}}}"#, 3 * material + kind).expect("a string");
            start += bytes;
        }
        buffer.extend(quads.bytes());
        let [p, t, i] = [0, 1, 2].map(|kind| 3 * material + kind);
        let comma = if material == 0 { "" } else { "," };
        write!(meshes, r#"{comma}{{"primitives":[{{"attributes":{{"POSITION":{p},"TEXCOORD_0":{t}}},"indices":{i},"material":{material}}}]}}"#)
            .expect("a string");
    }
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],"nodes":[{{"mesh":0}},{{"mesh":1}}],
        "meshes":[{meshes}],"accessors":[{accessors}],"bufferViews":[{views}],
        "buffers":[{{"uri":"pine.bin","byteLength":{bytes}}}],
        "materials":[{{"name":"twigs","alphaMode":"BLEND","doubleSided":true,
            "pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}},"metallicFactor":0}}}},
            {{"name":"ground","pbrMetallicRoughness":{{"baseColorFactor":[0.5,0.4,0.3,1],"metallicFactor":0}}}}],
        "textures":[{{"source":0}}],"images":[{{"uri":"data:image/png;base64,{TWIG}"}}]}}"#,
        bytes = buffer.len()
    );
    std::fs::write(folder.join("pine.bin"), buffer).expect("a temporary folder");
    std::fs::write(folder.join("pine.gltf"), text).expect("a temporary folder");
    scene::load(&folder.join("pine.gltf")).expect("a good file")
}
