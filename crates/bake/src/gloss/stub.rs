//! Stand-in until clusters are there.
use coeff_io::Codebook;
pub(crate) struct Aim {
    pub error: f32,
    pub most_clusters: u32,
    pub most_rank: u32,
    pub seed: u64,
}
pub(crate) struct Compressed {
    pub book: Codebook,
    pub clusters: Vec<u16>,
    pub weights: Vec<f32>,
    pub error: f32,
}
pub(crate) fn compress(_: &[f32], _: usize, _: &Aim) -> Option<Compressed> {
    None
}
pub(crate) struct Sketch(usize);
impl Sketch {
    pub fn learn(_: &[f32], columns: usize, _: f32) -> Self {
        Self(columns)
    }
    pub fn rank(&self) -> usize {
        self.0
    }
    pub fn project(&self, row: &[f32]) -> Vec<f32> {
        row.to_vec()
    }
}
pub(crate) fn compress_sketched(rows: &[f32], s: &Sketch, aim: &Aim) -> Compressed {
    let n = s.0;
    let mut v = vec![0.0; n * (n + 1)];
    (0..n).for_each(|i| v[(i + 1) * n + i] = 1.0);
    let _ = (aim.error, aim.most_clusters, aim.most_rank, aim.seed);
    Compressed {
        book: Codebook::new([n as u32, 1, n as u32], &v),
        clusters: vec![0; rows.len() / n],
        weights: rows.to_vec(),
        error: 0.0,
    }
}
