//! Draws the axes in every layout: `cargo run -p probe-io --example axes -- docs/axes.png`.

use glam::DVec3;
use image::{Rgb, RgbImage};
use probe_io::{Layout, Probe};

/// Pixels along a side of the angular map; faces and panorama follow.
const SIDE: usize = 144;

/// Ground, and one colour per axis: x red, y green, z blue; a full disc is the positive end, a ring the negative.
fn colour(d: DVec3) -> [f32; 3] {
    let axes = [(DVec3::X, [0.9, 0.15, 0.1]), (DVec3::Y, [0.1, 0.65, 0.15]), (DVec3::Z, [0.15, 0.3, 0.95])];
    for (axis, colour) in axes {
        let angle = d.dot(axis).clamp(-1.0, 1.0).acos().to_degrees();
        if angle < 22.0 || (angle > 158.0 && angle < 168.0) {
            return colour;
        }
    }
    // The horizon is a line, below it is darker.
    if d.y.abs() < 0.02 {
        return [0.35; 3];
    }
    if d.y > 0.0 { [0.93, 0.95, 0.97] } else { [0.78, 0.76, 0.73] }
}

/// A probe of the axes; what is not on the sphere stays black.
fn chart(layout: Layout, unit: usize) -> Probe {
    let (columns, rows) = layout.tiles().unwrap_or((2, 1));
    let (width, height) = (columns * unit, rows * unit);
    let numbers = (0..width * height).map(|i| [i as f32, 0.0, 0.0]).collect();
    let mut probe = Probe { layout, width, height, pixels: numbers };
    let texels: Vec<_> = probe.texels().collect();
    probe.pixels.fill([0.0; 3]);
    for texel in texels {
        probe.pixels[texel.radiance[0] as usize] = colour(texel.direction);
    }
    probe
}

fn main() {
    let path = std::env::args().nth(1).unwrap_or_else(|| "axes.png".to_owned());
    // Panorama and angular map on top; below the crosses, and at the right both strips.
    let face = SIDE / 2;
    let places = [
        (Layout::Equirect, SIDE, 0, 0),
        (Layout::Angular, SIDE, 2 * SIDE + 12, 0),
        (Layout::HorizontalCross, face, 0, SIDE + 12),
        (Layout::VerticalCross, face, 2 * SIDE + 12, SIDE + 12),
        (Layout::Faces, face, 4 * SIDE + 24 - face, 0),
        (Layout::ExrCube, face, 4 * SIDE + 36, 0),
    ];
    let (width, height) = (4 * SIDE + 36 + face, SIDE + 12 + 4 * face);
    let mut picture = RgbImage::from_pixel(width as u32, height as u32, Rgb([255; 3]));
    for (layout, unit, left, top) in places {
        let probe = chart(layout, unit);
        for (i, pixel) in probe.pixels.iter().enumerate() {
            let (x, y) = (left + i % probe.width, top + i / probe.width);
            picture.put_pixel(x as u32, y as u32, Rgb(pixel.map(|v| (v * 255.0) as u8)));
        }
    }
    picture.save(&path).expect("the folder of the picture can be written");
}
