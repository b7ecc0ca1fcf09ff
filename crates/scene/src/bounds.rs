//! Where a scene lies, and a view that shows all of it.

use glam::Vec3;

use crate::{Camera, Mesh, Scene};

/// Vertical angle of view of the automatic camera, radians (45 degrees).
const DEFAULT_FOV: f32 = std::f32::consts::FRAC_PI_4;

/// An axis-aligned box in world space, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// The box around some points; `None` without points.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        points.into_iter().fold(None, |bounds: Option<Self>, p| {
            Some(bounds.map_or(Self { min: p, max: p }, |b| Self { min: b.min.min(p), max: b.max.max(p) }))
        })
    }

    /// Middle of the box.
    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Edge lengths, metres.
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// Half the diagonal, metres: the sphere around the box.
    pub fn radius(&self) -> f32 {
        0.5 * self.size().length()
    }
}

impl Mesh {
    /// Box around the mesh; `None` where it has no vertex.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.positions.iter().copied())
    }
}

impl Scene {
    /// Box around all meshes; `None` for a scene without vertices.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.meshes.iter().filter_map(Mesh::bounds).flat_map(|b| [b.min, b.max]))
    }

    /// Number of vertices of all meshes.
    pub fn vertex_count(&self) -> usize {
        self.meshes.iter().map(|m| m.positions.len()).sum()
    }

    /// Number of triangles of all meshes.
    pub fn triangle_count(&self) -> usize {
        self.meshes.iter().map(|m| m.triangles.len()).sum()
    }
}

/// The scene's first camera, else one that stands in front, to the right and above, and sees the whole box.
pub fn default_camera(scene: &Scene) -> Camera {
    if let Some(camera) = scene.cameras.first() {
        return camera.clone();
    }
    let bounds = scene.bounds().unwrap_or(Bounds { min: -Vec3::ONE, max: Vec3::ONE });
    let target = bounds.center();
    // The sphere around the box fills the angle of view: distance = radius / sin(half angle).
    let distance = bounds.radius().max(1e-6) / libm::sinf(0.5 * DEFAULT_FOV);
    let direction = Vec3::new(0.5, 0.4, 1.0).normalize();
    Camera {
        name: "default".into(),
        eye: target + direction * distance,
        target,
        up: Vec3::Y,
        vertical_fov: DEFAULT_FOV,
    }
}
