//! The tangent frame of a texel, and coefficients in it.

use crate::arrival::Shape;
use glam::{Mat3, Vec3, Vec4};
use sampling::frame::Frame;
use scene::Mesh;
use sh_math::Bands;
use sh_math::hemisphere::{Basis, HARMONICS};
use sh_math::rotate::Rotation;

/// Axes of normal maps at a point, orthonormal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TangentFrame {
    /// Columns: tangent, normal x tangent, normal.
    axes: Mat3,
    /// Whether y of the normal map runs against the second axis.
    mirrored: bool,
}

impl TangentFrame {
    /// At a point of a triangle with the shading normal `normal`, as renderers have it: from the tangents of the vertices. Where the mesh
    /// has none no normal map is drawn, and any frame serves.
    pub(crate) fn at(mesh: &Mesh, triangle: usize, [u, v]: [f32; 2], normal: Vec3) -> Self {
        let any = Frame::from_normal(normal);
        let any = Self { axes: Mat3::from_cols(any.tangent, any.bitangent, normal), mirrored: false };
        if mesh.tangents.is_empty() {
            return any;
        }
        let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.tangents[vertex as usize]);
        let tangent: Vec4 = a * (1.0 - u - v) + b * u + c * v;
        let along = tangent.truncate();
        match (along - along.dot(normal) * normal).try_normalize() {
            Some(x) => Self { axes: Mat3::from_cols(x, normal.cross(x), normal), mirrored: tangent.w < 0.0 },
            None => any,
        }
    }

    /// Turns coefficients over world normals into those over normals of the frame, `[function][column]` with `columns` numbers each.
    pub(crate) fn turn(&self, functions: Bands, values: &mut [f32], columns: usize) {
        Rotation::from_matrix(functions, self.axes.transpose().as_dmat3()).apply_interleaved(values, columns);
        if self.mirrored {
            for (k, row) in values.chunks_exact_mut(columns).enumerate() {
                let l = k.isqrt();
                // The functions with a sine of the longitude change sign with y.
                if k < l * (l + 1) {
                    row.iter_mut().for_each(|value| *value = -*value);
                }
            }
        }
    }
}

/// From spherical harmonics over normals to the functions of a basis.
pub(crate) struct Converter {
    functions: Bands,
    basis: Basis,
    /// `[function of the basis][harmonic]`.
    rows: Vec<Vec<f32>>,
}

impl Converter {
    /// # Panics
    /// With more than 5 bands.
    pub(crate) fn new(basis: Basis, functions: Bands) -> Self {
        let row = |row: [f64; HARMONICS]| row[..functions.coefficients()].iter().map(|&x| x as f32).collect();
        let rows = basis.of_harmonics(functions).into_iter().map(row).collect();
        Self { functions, basis, rows }
    }

    /// Functions of the basis.
    pub(crate) fn count(&self) -> usize {
        self.basis.count()
    }

    /// The coefficients in a frame, `[function of the basis][depth][channel]`, of irradiance over world normals.
    pub(crate) fn convert(&self, frame: &TangentFrame, shape: Shape, world: &[f32]) -> Vec<f32> {
        let columns = shape.depth * shape.channels;
        let mut local = world.to_vec();
        frame.turn(self.functions, &mut local, columns);
        let mut out = vec![0.0; self.basis.count() * columns];
        for (out, row) in out.chunks_exact_mut(columns).zip(&self.rows) {
            for (factor, values) in row.iter().zip(local.chunks_exact(columns)) {
                out.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(tangent: Vec4) -> Mesh {
        Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, -Vec3::Z],
            normals: vec![Vec3::Y; 3],
            tangents: vec![tangent; 3],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        }
    }

    /// A signal given over world normals, read by a normal of the map, is the signal at the normal that a renderer makes of it.
    fn worst(handedness: f32, flip: f32) -> f32 {
        let normal = Vec3::new(1.0, 2.0, 2.0) / 3.0;
        let tangent = Vec3::new(2.0, 1.0, -2.0) / 3.0;
        let frame = TangentFrame::at(&mesh(tangent.extend(handedness)), 0, [0.2, 0.3], normal);
        let bands = Bands::new(3).unwrap();
        let world: Vec<f32> = (0..9).map(|k| 1.0 / (1.0 + k as f32) - 0.3).collect();
        let shape = Shape { functions: 9, depth: 1, channels: 1 };
        let local = Converter::new(Basis::Sh9, bands).convert(&frame, shape, &world);
        let value = |coefficients: &[f32], n: Vec3| {
            let mut functions = [0.0; 9];
            sh_math::evaluate(bands, n, &mut functions);
            coefficients.iter().zip(functions).map(|(c, f)| c * f).sum::<f32>()
        };
        let mut worst = 0.0f32;
        for k in 0..40 {
            let a = k as f32;
            let map = Vec3::new(0.6 * a.cos(), 0.6 * (a * 0.7).sin(), 1.0).normalize();
            // docs/shading.md: tangent x + handedness (normal x tangent) y + normal z
            let bent = tangent * map.x + flip * handedness * normal.cross(tangent) * map.y + normal * map.z;
            worst = worst.max((value(&local, map) - value(&world, bent)).abs());
        }
        worst
    }

    #[test]
    fn normals_of_the_map_need_no_frame() {
        assert!(worst(1.0, 1.0) < 1e-5 && worst(-1.0, 1.0) < 1e-5, "{} {}", worst(1.0, 1.0), worst(-1.0, 1.0));
        assert!(worst(-1.0, -1.0) > 0.1, "a mirrored frame that is taken for another must show");
    }

    #[test]
    fn a_light_map_is_exact_at_the_normal() {
        let bands = Bands::new(5).unwrap();
        let world: Vec<f32> = (0..25).map(|k| ((k * 7) % 5) as f32 - 1.0).collect();
        let frame = TangentFrame::at(&Mesh { triangles: vec![[0; 3]], ..Mesh::default() }, 0, [0.0; 2], Vec3::Z);
        let shape = Shape { functions: 25, depth: 1, channels: 1 };
        let one = Converter::new(Basis::ModifiedH1, bands).convert(&frame, shape, &world)[0];
        let mut functions = [0.0; 25];
        sh_math::evaluate(bands, Vec3::Z, &mut functions);
        let exact: f32 = world.iter().zip(functions).map(|(c, f)| c * f).sum();
        let mut constant = [0.0];
        Basis::ModifiedH1.evaluate(Vec3::Z, &mut constant);
        assert!((one * constant[0] - exact).abs() < 1e-4, "{} {exact}", one * constant[0]);
    }
}
