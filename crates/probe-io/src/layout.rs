//! How the pixels of a probe lie on the sphere.

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
