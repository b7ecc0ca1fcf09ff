//! How the pixels of a probe lie on the sphere.

use std::fmt;
use std::str::FromStr;

/// The ways a light probe is unrolled into a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// Longitude by latitude, twice as wide as high; +z at the centre, +x to the left of it.
    Equirect,
    /// Debevec's angular map; the centre looks along +z, the rim back.
    Angular,
    /// OpenEXR's vertical strip of six faces, border texels on the cube's edges.
    ExrCube,
    /// 3 by 4 tiles.
    VerticalCross,
    /// 4 by 3 tiles.
    HorizontalCross,
    /// Six square faces in the order px, nx, py, ny, pz, nz, stacked top to bottom.
    Faces,
}

impl Layout {
    /// Every layout with the name that `--layout` takes.
    pub const NAMES: [(&'static str, Layout); 6] = [
        ("equirect", Layout::Equirect),
        ("angular", Layout::Angular),
        ("exr-cube", Layout::ExrCube),
        ("vertical-cross", Layout::VerticalCross),
        ("horizontal-cross", Layout::HorizontalCross),
        ("faces", Layout::Faces),
    ];

    /// The name that `--layout` takes.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, layout)| *layout == self).map_or("", |(name, _)| name)
    }

    /// Width and height of the picture in tiles, where the layout is made of square tiles.
    pub fn tiles(self) -> Option<(usize, usize)> {
        match self {
            Layout::Equirect => None,
            Layout::Angular => Some((1, 1)),
            Layout::ExrCube | Layout::Faces => Some((1, 6)),
            Layout::VerticalCross => Some((3, 4)),
            Layout::HorizontalCross => Some((4, 3)),
        }
    }

    /// Says what is wrong with a picture of this size, if anything; any size above 0 is a panorama.
    pub fn check_size(self, width: usize, height: usize) -> Result<(), String> {
        if width == 0 || height == 0 {
            return Err(format!("the picture is empty ({width} x {height})"));
        }
        let Some((columns, rows)) = self.tiles() else {
            return Ok(());
        };
        let tile = width / columns;
        if tile > 0 && tile * columns == width && tile * rows == height {
            return Ok(());
        }
        Err(format!("{width} x {height} pixels are not {columns} x {rows} square tiles as layout {self} needs"))
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Layout {
    type Err = String;

    fn from_str(text: &str) -> Result<Layout, String> {
        let known = Self::NAMES.iter().find(|(name, _)| *name == text);
        known.map(|(_, layout)| *layout).ok_or_else(|| {
            let names: Vec<&str> = Self::NAMES.iter().map(|(name, _)| *name).collect();
            format!("unknown layout '{text}'; choose one of {}", names.join(", "))
        })
    }
}
