//! The colours that the numbers of a picture stand for, and the way to Rec. 709.

use glam::{DMat3, DVec3};

/// Chromaticities (CIE x, y) of the three primaries and of white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Primaries {
    pub(crate) red: [f64; 2],
    pub(crate) green: [f64; 2],
    pub(crate) blue: [f64; 2],
    pub(crate) white: [f64; 2],
}

/// ITU-R BT.709-6, with the white D65; sRGB has the same.
pub(crate) const REC_709: Primaries =
    Primaries { red: [0.64, 0.33], green: [0.30, 0.60], blue: [0.15, 0.06], white: [0.3127, 0.3290] };

/// CIE XYZ as a space of colours: its white of equal energy is no light that an eye has adapted to.
pub(crate) const XYZ: Primaries =
    Primaries { red: [1.0, 0.0], green: [0.0, 1.0], blue: [0.0, 0.0], white: [1.0 / 3.0, 1.0 / 3.0] };

/// Chromaticities closer than this are the same: they are written with three or four digits.
const SAME: f64 = 5e-4;

/// From XYZ to the responses of Bradford's cones (Lam 1985).
const BRADFORD: DMat3 = DMat3::from_cols_array(&[
    0.8951, -0.7502, 0.0389, //
    0.2664, 1.7135, -0.0685, //
    -0.1614, 0.0367, 1.0296,
]);

impl Primaries {
    /// From eight numbers: x and y of red, green, blue and white.
    pub(crate) fn from_numbers(numbers: [f64; 8]) -> Primaries {
        let [a, b, c, d, e, f, g, h] = numbers;
        Primaries { red: [a, b], green: [c, d], blue: [e, f], white: [g, h] }
    }

    /// Whether these are those of `other` up to rounding.
    pub(crate) fn is(&self, other: &Primaries) -> bool {
        let pairs = |p: &Primaries| [p.red, p.green, p.blue, p.white];
        let (ours, theirs) = (pairs(self), pairs(other));
        ours.iter().flatten().zip(theirs.iter().flatten()).all(|(a, b)| (a - b).abs() <= SAME)
    }

    /// XYZ of a colour, its Y the weighted sum of the channels; `None` where the primaries span no space.
    ///
    /// The columns are the primaries scaled so that (1, 1, 1) has the white's chromaticity and Y = 1 (SMPTE RP 177).
    pub(crate) fn xyz_from_rgb(&self) -> Option<DMat3> {
        let point = |[x, y]: [f64; 2]| DVec3::new(x, y, 1.0 - x - y);
        let columns = DMat3::from_cols(point(self.red), point(self.green), point(self.blue));
        let white = xyz_of_white(self.white)?;
        let scale = (columns.determinant().abs() > 1e-9).then(|| columns.inverse() * white)?;
        let matrix = columns * DMat3::from_diagonal(scale);
        (matrix.is_finite() && matrix.determinant().abs() > 1e-9).then_some(matrix)
    }

    /// Share of each channel in the luminance; that of Rec. 709 where the primaries span no space.
    pub(crate) fn luminance(&self) -> [f64; 3] {
        let matrix = self.xyz_from_rgb().or_else(|| REC_709.xyz_from_rgb()).unwrap_or(DMat3::IDENTITY);
        [matrix.x_axis.y, matrix.y_axis.y, matrix.z_axis.y]
    }

    /// Linear Rec. 709 of a colour. Its white, or the one that the file says was adapted to, becomes D65 by Bradford's
    /// method; numbers that are X, Y and Z of the light are taken as they are, unless the file says.
    ///
    /// `None` where the primaries span no space.
    pub(crate) fn rec_709(&self, adapted: Option<[f64; 2]>) -> Option<DMat3> {
        let xyz = self.xyz_from_rgb()?;
        let adapted = adapted.filter(|white| xyz_of_white(*white).is_some());
        let white = adapted.unwrap_or(if self.is(&XYZ) { REC_709.white } else { self.white });
        let cones = |white: [f64; 2]| Some(BRADFORD * xyz_of_white(white)?);
        let gain = cones(REC_709.white)? / cones(white)?;
        let adaptation = BRADFORD.inverse() * DMat3::from_diagonal(gain) * BRADFORD;
        let matrix = REC_709.xyz_from_rgb()?.inverse() * adaptation * xyz;
        matrix.is_finite().then_some(matrix)
    }
}

/// XYZ of a white of luminance 1.
fn xyz_of_white([x, y]: [f64; 2]) -> Option<DVec3> {
    let white = DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    (y > 0.0 && white.is_finite() && white.min_element() >= 0.0).then_some(white)
}

/// What the three numbers of a pixel are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ColorSpace {
    pub(crate) primaries: Primaries,
    /// The white that the eye is taken to have adapted to, where the file says.
    pub(crate) adapted: Option<[f64; 2]>,
    /// Whether the pixels are Y, (R - Y) / Y and (B - Y) / Y instead of R, G and B.
    pub(crate) is_luminance_chroma: bool,
}

impl ColorSpace {
    /// Plain linear Rec. 709.
    pub(crate) fn rec_709() -> ColorSpace {
        ColorSpace { primaries: REC_709, adapted: None, is_luminance_chroma: false }
    }

    /// Red, green and blue of luminance and chroma: R = (RY + 1) Y, B = (BY + 1) Y, and G what Y leaves.
    pub(crate) fn undo_chroma(&mut self, pixels: &mut [[f32; 3]]) {
        if !std::mem::take(&mut self.is_luminance_chroma) {
            return;
        }
        let [red, green, blue] = self.primaries.luminance();
        for pixel in pixels {
            let [y, ry, by] = pixel.map(f64::from);
            let (r, b) = ((ry + 1.0) * y, (by + 1.0) * y);
            *pixel = [r, (y - red * r - blue * b) / green, b].map(|v| v as f32);
        }
    }

    /// Brings red, green and blue to Rec. 709; pixels that are Rec. 709 keep every bit. The string is a warning.
    pub(crate) fn convert(&self, pixels: &mut [[f32; 3]]) -> Option<String> {
        let adapts = self.adapted.is_some_and(|[x, y]| {
            let [wx, wy] = REC_709.white;
            (x - wx).abs() > SAME || (y - wy).abs() > SAME
        });
        // Some programs write zeros where they do not know.
        let is_unsaid = self.primaries == Primaries::from_numbers([0.0; 8]);
        if is_unsaid || self.primaries.is(&REC_709) && !adapts {
            return None;
        }
        let Primaries { red, green, blue, white } = self.primaries;
        let place = |[x, y]: [f64; 2]| format!("({x:.4}, {y:.4})");
        let [red, green, blue, white] = [red, green, blue, white].map(place);
        let stated = format!("red {red}, green {green}, blue {blue}, white {white}");
        let Some(matrix) = self.primaries.rec_709(self.adapted) else {
            return Some(format!("the primaries ({stated}) span no space of colours: read as Rec. 709"));
        };
        for pixel in pixels {
            *pixel = (matrix * DVec3::from(pixel.map(f64::from))).to_array().map(|v| v as f32);
        }
        Some(format!("the colours were converted to Rec. 709 from {stated}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AP0: Primaries =
        Primaries { red: [0.7347, 0.2653], green: [0.0, 1.0], blue: [0.0001, -0.077], white: [0.32168, 0.33767] };

    /// Largest difference of a matrix from one printed row by row.
    fn difference(matrix: DMat3, rows: [[f64; 3]; 3]) -> f64 {
        let printed = DMat3::from_cols_array_2d(&rows).transpose();
        let both = matrix.to_cols_array().into_iter().zip(printed.to_cols_array());
        both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn matrices_are_the_printed_ones() {
        // IEC 61966-2-1 prints four digits.
        let srgb = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        assert!(difference(REC_709.xyz_from_rgb().unwrap(), srgb) < 6e-5);
        // ACES2065-1 to linear sRGB with Bradford's adaptation, as colour-science and OpenColorIO print it.
        let aces = [[2.52169, -1.13413, -0.38756], [-0.27648, 1.37272, -0.09624], [-0.01538, -0.15298, 1.16835]];
        assert!(difference(AP0.rec_709(None).unwrap(), aces) < 2e-4, "{:?}", AP0.rec_709(None));
        // XYZ without adaptation: the inverse of the first.
        let inverse = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        assert!(difference(XYZ.rec_709(None).unwrap(), inverse) < 5e-4, "{:?}", XYZ.rec_709(None));
    }

    #[test]
    fn printed_matrices_can_fail() {
        let without_adaptation = REC_709.xyz_from_rgb().unwrap().inverse() * AP0.xyz_from_rgb().unwrap();
        assert!((without_adaptation - AP0.rec_709(None).unwrap()).abs().to_cols_array().iter().any(|d| *d > 0.02));
    }

    #[test]
    fn white_becomes_white() {
        for primaries in [REC_709, AP0] {
            let white = primaries.rec_709(None).unwrap() * DVec3::ONE;
            assert!(white.abs_diff_eq(DVec3::ONE, 1e-9), "{white}");
        }
        // Numbers of D50 in XYZ, told to be what the eye adapted to.
        let d50 = [0.34567, 0.35850];
        let white = XYZ.rec_709(Some(d50)).unwrap() * xyz_of_white(d50).unwrap();
        assert!(white.abs_diff_eq(DVec3::ONE, 1e-9), "{white}");
    }

    #[test]
    fn what_spans_no_space_is_told_and_left() {
        let line = Primaries { red: [0.1, 0.1], green: [0.2, 0.2], blue: [0.3, 0.3], white: [0.3, 0.3] };
        for primaries in [line, Primaries { white: [0.3, f64::NAN], ..REC_709 }] {
            let mut pixels = [[0.5, 0.25, 1.0]];
            let space = ColorSpace { primaries, ..ColorSpace::rec_709() };
            assert!(space.convert(&mut pixels).is_some_and(|told| told.contains("no space")), "{primaries:?}");
            assert_eq!(pixels, [[0.5, 0.25, 1.0]]);
        }
        let unsaid = ColorSpace { primaries: Primaries::from_numbers([0.0; 8]), ..ColorSpace::rec_709() };
        assert_eq!(unsaid.convert(&mut [[0.5, 0.25, 1.0]]), None);
    }

    #[test]
    fn chroma_is_undone() {
        let rgb = [0.25f64, 2.0, 7.0];
        let y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        let mut pixels = [[y, (rgb[0] - y) / y, (rgb[2] - y) / y].map(|v| v as f32)];
        let mut space = ColorSpace { is_luminance_chroma: true, ..ColorSpace::rec_709() };
        space.undo_chroma(&mut pixels);
        for (found, expected) in pixels[0].iter().zip(rgb) {
            assert!((f64::from(*found) - expected).abs() < 2e-4 * 7.0, "{pixels:?}");
        }
    }
}
