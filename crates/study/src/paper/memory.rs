//! Table 2 of \[T\]: bytes of glossy transfer at vertices and at texels, by formula, and what files hold.

use super::Baked;

/// Bytes of one number in the paper's table.
const WORD: u64 = 4;

/// Bytes of glossy transfer of one scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Memory {
    /// Name of the scene.
    pub name: String,
    /// Triangles.
    pub triangles: u64,
    /// Vertices, which the paper mixes up with triangles in one place.
    pub vertices: u64,
    /// A matrix per vertex (Sloan et al. 2002): `k^2` numbers, k = `bands^2`.
    pub matrices_at_vertices: u64,
    /// A vector per vertex (Ng et al. 2004): k numbers.
    pub vectors_at_vertices: u64,
    /// A matrix per texel (McKenzie Chapter 2010).
    pub matrices_at_texels: u64,
    /// A vector per texel, the paper's.
    pub vectors_at_texels: u64,
    /// What this program's files hold for gloss and transfer: at vertices, and at texels with all levels of detail.
    pub held: [u64; 2],
}

impl Memory {
    /// By the formulas of the paper, for a texture of `texels` along a side.
    #[must_use]
    pub fn of(name: &str, [triangles, vertices]: [u64; 2], bands: u32, texels: u32) -> Self {
        let k = u64::from(bands * bands);
        let area = u64::from(texels) * u64::from(texels);
        Self {
            name: name.into(),
            triangles,
            vertices,
            matrices_at_vertices: vertices * k * k * WORD,
            vectors_at_vertices: vertices * k * WORD,
            matrices_at_texels: area * k * k * WORD,
            vectors_at_texels: area * k * WORD,
            held: [0; 2],
        }
    }

    /// The same for a baked scene, with what its files hold.
    #[must_use]
    pub fn of_baked(baked: &Baked, bands: u32, texels: u32) -> Self {
        let held = [&baked.at_vertices, &baked.at_texels].map(|prt| prt.achieved.gloss.map_or(0, |g| g.bytes[1]));
        Self { held, ..Self::of(&baked.name, [baked.triangles, baked.vertices], bands, texels) }
    }
}

/// The table in Markdown.
#[must_use]
pub fn memory_table(rows: &[Memory]) -> String {
    let mut text = String::from(
        "| scene | triangles | vertices | vertices: matrices (Sloan) | vectors (Ng) | texels: matrices (McKenzie) | vectors (the paper) | our file, vertices | texels |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let cells = [
            row.matrices_at_vertices,
            row.vectors_at_vertices,
            row.matrices_at_texels,
            row.vectors_at_texels,
            row.held[0],
            row.held[1],
        ]
        .map(megabytes);
        text.push_str(&format!("| {} | {} | {} | {} |\n", row.name, row.triangles, row.vertices, cells.join(" | ")));
    }
    text
}

/// As the paper prints them: powers of ten.
fn megabytes(bytes: u64) -> String {
    let mega = bytes as f64 * 1e-6;
    if mega >= 1000.0 { format!("{:.1} GB", mega * 1e-3) } else { format!("{mega:.1} MB") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The printed columns of Room, Dragon and Plants, each from the vertices that the column of vectors implies; TRM contradicts itself
    /// (139.3 MB of vectors are 3,483 MB of matrices, printed are 2.3 GB).
    #[test]
    fn the_printed_table_follows_from_the_formulas() {
        for (name, vertices, matrices) in
            [("Room", 25_600, 64.0), ("Dragon", 2_158_000, 5_400.0), ("Plants", 25_600, 64.0)]
        {
            let row = Memory::of(name, [0, vertices], 5, 1024);
            let mega = |bytes: u64| bytes as f64 * 1e-6;
            assert!(
                (mega(row.matrices_at_vertices) / matrices - 1.0).abs() < 0.05,
                "{name} {}",
                mega(row.matrices_at_vertices)
            );
            assert!((mega(row.vectors_at_texels) / 100.0 - 1.0).abs() < 0.05, "{}", mega(row.vectors_at_texels));
            assert!((mega(row.matrices_at_texels) / 2_500.0 - 1.0).abs() < 0.05);
        }
        let trm = Memory::of("TRM", [0, 1_393_000], 5, 1024);
        let mega = trm.matrices_at_vertices as f64 * 1e-6;
        assert!((mega / 3_483.0 - 1.0).abs() < 0.01 && (mega / 2_300.0 - 1.0).abs() > 0.3, "can fail: {mega}");
    }
}
