//! The pavilion: a roof with an opening on four columns, a red wall, a bench and a ball of brass.

use glam::{Mat3, Quat, Vec3};
use serde_json::{Value, json};

/// Corners around a column, and rings and segments of the ball.
const COLUMN: u32 = 24;
const BALL: [u32; 2] = [16, 32];

/// A mesh under way.
#[derive(Default)]
struct Mesh {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    indices: Vec<u16>,
}

impl Mesh {
    fn vertex(&mut self, position: Vec3, normal: Vec3) -> u16 {
        self.positions.push(position);
        self.normals.push(normal);
        (self.positions.len() - 1) as u16
    }

    /// A rectangle, seen from where the cross product of its sides points.
    fn rectangle(&mut self, corner: Vec3, along: Vec3, across: Vec3) {
        let normal = along.cross(across).normalize();
        let corners = [corner, corner + along, corner + along + across, corner + across];
        let [a, b, c, d] = corners.map(|corner| self.vertex(corner, normal));
        self.indices.extend([a, b, c, a, c, d]);
    }

    fn cuboid(mut self, low: [f32; 3], high: [f32; 3]) -> Self {
        let (low, high) = (Vec3::from(low), Vec3::from(high));
        let size = high - low;
        let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
        for (corner, along, across) in
            [(low, y, x), (low, z, y), (low, x, z), (high, -x, -y), (high, -y, -z), (high, -z, -x)]
        {
            self.rectangle(corner, along, across);
        }
        self
    }

    /// An upright tube without lids.
    fn tube(mut self, foot: [f32; 3], radius: f32, height: f32) -> Self {
        let foot = Vec3::from(foot);
        let first = self.positions.len() as u16;
        for k in 0..=COLUMN {
            let (sin, cos) = turn(k, COLUMN);
            let out = Vec3::new(cos, 0.0, sin);
            for y in [0.0, height] {
                self.vertex(foot + radius * out + Vec3::Y * y, out);
            }
        }
        for k in 0..COLUMN as u16 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|n| first + 2 * k + n);
            self.indices.extend([a, b, c, c, b, d]);
        }
        self
    }

    fn ball(mut self, centre: [f32; 3], radius: f32) -> Self {
        let centre = Vec3::from(centre);
        let [rings, segments] = BALL;
        for ring in 0..=rings {
            let (sin, cos) = turn(ring, 2 * rings);
            for segment in 0..=segments {
                let (s, c) = turn(segment, segments);
                let out = Vec3::new(sin * c, cos, sin * s);
                self.vertex(centre + radius * out, out);
            }
        }
        let row = segments as u16 + 1;
        for ring in 0..rings as u16 {
            for segment in 0..segments as u16 {
                let a = ring * row + segment;
                let [b, c, d] = [a + 1, a + row, a + row + 1];
                if ring > 0 {
                    self.indices.extend([a, b, c]);
                }
                if ring + 1 < rings as u16 {
                    self.indices.extend([b, d, c]);
                }
            }
        }
        self
    }
}

/// Sine and cosine of a part of a full turn, to the same bits everywhere.
fn turn(part: u32, parts: u32) -> (f32, f32) {
    let angle = 2.0 * std::f64::consts::PI * f64::from(part) / f64::from(parts);
    (libm::sin(angle) as f32, libm::cos(angle) as f32)
}

/// Name, base colour, metallic and roughness.
const MATERIALS: [(&str, [f32; 3], f32, f32); 5] = [
    ("gravel", [0.55, 0.52, 0.46], 0.0, 1.0),
    ("stone", [0.74, 0.73, 0.7], 0.0, 1.0),
    ("red plaster", [0.66, 0.2, 0.13], 0.0, 1.0),
    ("blue paint", [0.14, 0.27, 0.42], 0.0, 1.0),
    ("brass", [0.91, 0.78, 0.42], 1.0, 0.35),
];

/// Name, index of the material, and the mesh.
fn meshes() -> Vec<(&'static str, usize, Mesh)> {
    let new = Mesh::default;
    let mut ground = new();
    ground.rectangle(Vec3::new(-5.0, 0.0, -5.0), Vec3::Z * 10.0, Vec3::X * 10.0);
    let mut roof = new();
    for (low, high) in [
        ([-2.1, 2.4, -2.1], [2.1, 2.65, -0.7]),
        ([-2.1, 2.4, 0.7], [2.1, 2.65, 2.1]),
        ([-2.1, 2.4, -0.7], [-0.7, 2.65, 0.7]),
        ([0.7, 2.4, -0.7], [2.1, 2.65, 0.7]),
    ] {
        roof = roof.cuboid(low, high);
    }
    let mut columns = new();
    for (x, z) in [(-1.7, -1.7), (1.7, -1.7), (-1.7, 1.7), (1.7, 1.7)] {
        columns = columns.tube([x, 0.15, z], 0.16, 2.3);
    }
    vec![
        ("ground", 0, ground),
        ("plinth", 1, new().cuboid([-2.2, 0.0, -2.2], [2.2, 0.2, 2.2])),
        ("columns", 1, columns),
        ("roof", 1, roof),
        ("wall", 2, new().cuboid([-1.5, 0.15, -1.8], [1.5, 2.45, -1.6])),
        ("bench", 3, new().cuboid([-1.4, 0.15, -0.4], [-0.9, 0.65, 1.0])),
        ("ball", 4, new().ball([0.55, 0.7, 0.2], 0.5)),
    ]
}

/// The scene as one binary glTF file.
pub(crate) fn glb() -> Vec<u8> {
    let mut bytes: Vec<u8> = Vec::new();
    let (mut views, mut accessors, mut primitives, mut nodes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut add = |data: Vec<u8>, accessor: Value, target: u32| {
        views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": data.len(), "target": target}));
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let mut accessor = accessor;
        accessor["bufferView"] = json!(views.len() - 1);
        accessors.push(accessor);
        accessors.len() - 1
    };
    for (index, (name, material, mesh)) in meshes().into_iter().enumerate() {
        let low = mesh.positions.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let high = mesh.positions.iter().copied().reduce(Vec3::max).unwrap_or_default();
        let floats = |points: &[Vec3]| points.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes).collect();
        let vector = json!({"componentType": 5126, "count": mesh.positions.len(), "type": "VEC3"});
        let mut placed = vector.clone();
        (placed["min"], placed["max"]) = (json!(low.to_array()), json!(high.to_array()));
        let positions = add(floats(&mesh.positions), placed, 34962);
        let normals = add(floats(&mesh.normals), vector, 34962);
        let numbers = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let scalar = json!({"componentType": 5123, "count": mesh.indices.len(), "type": "SCALAR"});
        let indices = add(numbers, scalar, 34963);
        let attributes = json!({"POSITION": positions, "NORMAL": normals});
        primitives.push(
            json!({"name": name, "primitives": [{"attributes": attributes, "indices": indices, "material": material}]}),
        );
        nodes.push(json!({"name": name, "mesh": index}));
    }
    nodes.push(camera());
    let materials = MATERIALS.map(|(name, [r, g, b], metallic, roughness)| {
        let surface =
            json!({"baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness});
        json!({"name": name, "pbrMetallicRoughness": surface})
    });
    let root = json!({
        "asset": {"version": "2.0", "generator": "relume: tests/examples/assets.rs"},
        "scene": 0,
        "scenes": [{"name": "pavilion", "nodes": (0..nodes.len()).collect::<Vec<_>>()}],
        "nodes": nodes,
        "cameras": [{"name": "garden", "type": "perspective", "perspective": {"yfov": 0.72, "znear": 0.1}}],
        "meshes": primitives,
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": bytes.len()}],
    });
    container(root.to_string().into_bytes(), bytes)
}

/// The node of the camera, which looks at the middle of the pavilion.
fn camera() -> Value {
    let (eye, target) = (Vec3::new(1.5, 1.75, 6.9), Vec3::new(0.0, 1.2, 0.0));
    let back = (eye - target).normalize();
    let right = Vec3::Y.cross(back).normalize();
    let rotation = Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back));
    json!({"name": "garden", "camera": 0, "translation": eye.to_array(), "rotation": rotation.to_array()})
}

/// A GLB container: header, JSON chunk and binary chunk (glTF 2.0 specification, section 4.4).
fn container(mut json: Vec<u8>, binary: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + 8 + binary.len();
    let mut out = Vec::with_capacity(total);
    out.extend(b"glTF");
    for number in [2, total as u32, json.len() as u32] {
        out.extend(number.to_le_bytes());
    }
    out.extend(b"JSON");
    out.extend(json);
    out.extend((binary.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(binary);
    out
}
