//! From world space to the samples of a picture, and back.

use crate::Frame;
use glam::{DVec2, DVec3, Vec3};

/// Ratio of the near distance to the diagonal of the scene.
const NEAR_SHARE: f64 = 1e-4;

/// A camera with the sample grid of one frame.
///
/// *Projective space* is (x, y, w): offsets to the right and up, divided by their tangents of half the angle of view, and the depth
/// along the view. A point is at (x/w, y/w) in [-1, 1] on the picture, y up.
#[derive(Debug, Clone)]
pub(crate) struct View {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    tangent: DVec2,
    /// Distance of neighbouring samples on the picture, and the place of the first one.
    step: DVec2,
    first: DVec2,
    /// Samples per row and column.
    pub(crate) samples: [u32; 2],
    /// Nothing nearer is drawn.
    pub(crate) near: f64,
}

impl View {
    /// The view of a frame that passed [`Frame::check`], of a scene with this diagonal.
    pub(crate) fn new(frame: &Frame, diagonal: f64) -> Self {
        let camera = &frame.camera;
        let [right, up, back] = camera.axes().map(|axis| axis.as_dvec3());
        let tangent = libm::tan(f64::from(camera.vertical_fov) / 2.0);
        let aspect = f64::from(frame.width) / f64::from(frame.height);
        let extent = if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 };
        let samples = [frame.width * frame.supersample, frame.height * frame.supersample];
        let step = DVec2::new(2.0, -2.0) / DVec2::from(samples.map(f64::from));
        Self {
            step,
            first: DVec2::new(-1.0, 1.0) + 0.5 * step,
            eye: vector(camera.eye),
            right,
            up,
            forward: -back,
            tangent: DVec2::new(tangent * aspect, tangent),
            samples,
            near: NEAR_SHARE * extent,
        }
    }

    /// Height of a sample at depth 1.
    pub(crate) fn spread(&self) -> f32 {
        (2.0 * self.tangent.y / f64::from(self.samples[1])) as f32
    }

    /// A world point in projective space.
    pub(crate) fn project(&self, position: [f32; 3]) -> DVec3 {
        let p = vector(position) - self.eye;
        DVec3::new(p.dot(self.right) / self.tangent.x, p.dot(self.up) / self.tangent.y, p.dot(self.forward))
    }

    /// Where the centre of sample (column, row) lies on the picture: [-1, 1], y up.
    pub(crate) fn centre(&self, column: u32, row: u32) -> DVec2 {
        self.first + self.step * DVec2::new(f64::from(column), f64::from(row))
    }

    /// Column and row, with fractions, of a point in projective space before the eye.
    pub(crate) fn sample(&self, point: DVec3) -> DVec2 {
        let [width, height] = self.samples.map(f64::from);
        DVec2::new((point.x / point.z * 0.5 + 0.5) * width, (0.5 - point.y / point.z * 0.5) * height)
    }

    /// The world direction, not unit, seen at a place on the picture.
    pub(crate) fn direction(&self, centre: DVec2) -> Vec3 {
        (self.forward + self.right * (centre.x * self.tangent.x) + self.up * (centre.y * self.tangent.y)).as_vec3()
    }
}

fn vector(v: [f32; 3]) -> DVec3 {
    Vec3::from(v).as_dvec3()
}
