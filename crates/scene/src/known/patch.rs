//! Building meshes of known scenes from curved patches.

use glam::{Vec3, Vec4};

use crate::{Camera, Material, Mesh, Scene};

/// A mesh under construction.
#[derive(Default)]
pub(super) struct Patches {
    pub(super) mesh: Mesh,
}

impl Patches {
    /// Adds a grid of `columns` x `rows` quads over [0, 1] squared.
    ///
    /// `point` gives position and normal at (s, t); counter-clockwise seen from the side to which
    /// (d/ds) x (d/dt) points. Zero-area triangles (poles) are left out.
    pub(super) fn grid(&mut self, columns: u32, rows: u32, point: impl Fn(f32, f32) -> (Vec3, Vec3)) -> &mut Self {
        let base = self.mesh.positions.len() as u32;
        for j in 0..=rows {
            for i in 0..=columns {
                let (position, normal) = point(i as f32 / columns as f32, j as f32 / rows as f32);
                self.mesh.positions.push(position);
                self.mesh.normals.push(normal);
            }
        }
        for j in 0..rows {
            for i in 0..columns {
                let a = base + j * (columns + 1) + i;
                let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
                self.triangle([a, b, c]);
                self.triangle([a, c, d]);
            }
        }
        self
    }

    /// Adds a flat grid that starts at `corner` and spans the edges `s` and `t`; its normal is s x t.
    pub(super) fn flat(&mut self, corner: Vec3, s: Vec3, t: Vec3, columns: u32, rows: u32) -> &mut Self {
        let normal = s.cross(t).normalize();
        self.grid(columns, rows, |u, v| (corner + s * u + t * v, normal))
    }

    /// Adds a surface of revolution about the y axis through `center`.
    ///
    /// `profile` gives (radius, height) and the outward normal (radial, up) at t in [0, 1]; the
    /// surface faces the normal if t runs upwards where the normal points outwards.
    pub(super) fn lathe(&mut self, center: Vec3, around: u32, profile: &[(f32, f32, f32, f32)]) -> &mut Self {
        let rows = profile.len() as u32 - 1;
        self.grid(around, rows, |s, t| {
            let (radius, height, radial, up) = profile[(t * rows as f32).round() as usize];
            let (sin, cos) = turn(s);
            // x = sin, z = cos: s grows counter-clockwise seen from above, so d/ds x d/dt points out.
            (center + Vec3::new(radius * sin, height, radius * cos), Vec3::new(radial * sin, up, radial * cos))
        })
    }

    /// Gives all vertices so far that have no colour yet the linear colour `rgb`.
    pub(super) fn paint(&mut self, rgb: Vec3) -> &mut Self {
        self.mesh.colors.resize(self.mesh.positions.len(), rgb.extend(1.0));
        self
    }

    /// The finished mesh with its unused vertices (at poles) dropped and normals unit.
    pub(super) fn finish(&mut self, name: &str, material: u32) -> Mesh {
        let mut mesh = std::mem::take(&mut self.mesh);
        mesh.name = name.into();
        mesh.material = material;
        for normal in &mut mesh.normals {
            *normal = normal.normalize();
        }
        if !mesh.colors.is_empty() {
            mesh.colors.resize(mesh.positions.len(), Vec4::ONE);
        }
        crate::vertices::drop_unused(&mut mesh);
        mesh
    }

    /// Adds a triangle unless it has no area.
    pub(super) fn triangle(&mut self, triangle: [u32; 3]) {
        let [a, b, c] = triangle.map(|i| self.mesh.positions[i as usize]);
        if (b - a).cross(c - a).length() > 0.0 {
            self.mesh.triangles.push(triangle);
        }
    }
}

/// Sine and cosine of a share of a full turn, exact at the quarters so that surfaces close bit for bit.
pub(super) fn turn(share: f32) -> (f32, f32) {
    let quarter = share * 4.0;
    if quarter == quarter.floor() {
        return match quarter as i32 % 4 {
            0 => (0.0, 1.0),
            1 => (1.0, 0.0),
            2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        };
    }
    let angle = std::f64::consts::TAU * f64::from(share);
    (libm::sin(angle) as f32, libm::cos(angle) as f32)
}

/// A dielectric, fully rough material of one linear colour.
pub(super) fn matte(name: &str, rgb: Vec3) -> Material {
    Material { name: name.into(), base_color: rgb.extend(1.0), ..Material::default() }
}

/// A camera with the vertical angle of view in degrees.
pub(super) fn camera(eye: Vec3, target: Vec3, fov_degrees: f32) -> Camera {
    Camera { name: "main".into(), eye, target, up: Vec3::Y, vertical_fov: fov_degrees.to_radians() }
}

/// A scene of one camera.
pub(super) fn scene(name: &str, materials: Vec<Material>, meshes: Vec<Mesh>, camera: Camera) -> Scene {
    Scene { name: format!("builtin:{name}"), meshes, materials, cameras: vec![camera], ..Scene::default() }
}
