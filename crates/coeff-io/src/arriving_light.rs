//! Receivers under a light: the products that are made once per light, and the short sums per receiver.

use crate::{Arriving, Bounced, Codebook, Form, Prt, Table};
use sh_math::light_matrix::{LightProduct, apply};
use sh_math::{Bands, Rgb};

/// One light, ready for every receiver of a file that shines.
///
/// Clustered tables are multiplied by their means and vectors here, so a receiver costs one short sum.
#[derive(Debug, Clone)]
pub struct ArrivingLight<'a> {
    functions: usize,
    bounced: Option<&'a Bounced>,
    /// `[row][column]` of `n^2` each.
    matrix: Vec<[f32; 3]>,
    /// The light in the bands of the bounces.
    light: Vec<[f32; 3]>,
    /// `[cluster][mean, then vectors][n^2]`: the product with the light, and the visibility itself.
    visibility: Option<(u32, Vec<[f32; 4]>)>,
    /// `[cluster][mean, then vectors][n^2]`.
    bounce: Option<(u32, Vec<[f32; 3]>)>,
}

impl<'a> ArrivingLight<'a> {
    /// Multiplies the light, in world axes, with all that receivers share; none where nothing in the file shines.
    #[must_use]
    pub fn new(prt: &'a Prt, product: &LightProduct, light: &Rgb) -> Option<Self> {
        let gloss = prt.gloss.as_ref()?;
        let functions = (gloss.bands * gloss.bands) as usize;
        let matrix = product.matrix(light);
        let of_visibility = |book: &Codebook| {
            let of = |v: &[f32]| apply(&matrix, v).into_iter().zip(v).map(|([r, g, b], v)| [r, g, b, *v]).collect();
            let products = book.values().chunks_exact(functions).flat_map(|v| -> Vec<[f32; 4]> { of(v) }).collect();
            (book.rank, products)
        };
        let visibility = prt.codebooks.visibility.as_ref().map(of_visibility);
        let (light, bounce) = match &gloss.bounced {
            Some(Bounced::Relightable { bands, channels }) => {
                let light = light.with_bands(Bands::new(*bands).unwrap_or(light.bands)).values;
                let of = |book: &Codebook| (book.rank, bounce_products(book, *channels, &light, functions));
                let bounce = prt.codebooks.bounce.as_ref().map(of);
                (light, bounce)
            }
            _ => (Vec::new(), None),
        };
        Some(Self { functions, bounced: gloss.bounced.as_ref(), matrix, light, visibility, bounce })
    }

    /// The matrix of the light, `[row][column]`, RGB.
    #[must_use]
    pub fn matrix(&self) -> &[[f32; 3]] {
        &self.matrix
    }

    /// Products of the codebook of visibility: rank, and `[cluster][mean, then vectors][n^2]` with the visibility itself in the fourth.
    #[must_use]
    pub fn visibility_products(&self) -> Option<(u32, &[[f32; 4]])> {
        self.visibility.as_ref().map(|(rank, products)| (*rank, products.as_slice()))
    }

    /// Products of the codebook of bounces: rank, and `[cluster][mean, then vectors][n^2]`.
    #[must_use]
    pub fn bounce_products(&self) -> Option<(u32, &[[f32; 3]])> {
        self.bounce.as_ref().map(|(rank, products)| (*rank, products.as_slice()))
    }

    /// Writes what arrives at a receiver, `n^2` times RGB, and its visibility in the fourth. `prt` is that of the light.
    ///
    /// # Panics
    /// When the row does not exist or `out` is not `n^2` long.
    pub fn read(&self, prt: &Prt, arriving: &Arriving, row: u32, out: &mut [[f32; 4]]) {
        let table = &arriving.visibility;
        match (&self.visibility, table.form) {
            (Some((rank, products)), Form::Clustered) => {
                out.fill([0.0; 4]);
                add(table, *rank, products, row, self.functions, |k, weight, [r, g, b, v]| {
                    let sum: &mut [f32; 4] = &mut out[k];
                    *sum = [sum[0] + weight * r, sum[1] + weight * g, sum[2] + weight * b, sum[3] + weight * v];
                });
            }
            _ => {
                let mut visibility = vec![0.0; self.functions];
                table.read(prt.codebooks.visibility.as_ref(), row, &mut visibility);
                let lit = apply(&self.matrix, &visibility);
                let both = lit.into_iter().zip(visibility);
                out.iter_mut().zip(both).for_each(|(out, ([r, g, b], v))| *out = [r, g, b, v]);
            }
        }
        self.add_bounces(prt, arriving, row, out);
    }

    /// Adds what surfaces send to a receiver, `n^2` times RGB; the fourth stays.
    ///
    /// # Panics
    /// As [`ArrivingLight::read`].
    pub fn add_bounces(&self, prt: &Prt, arriving: &Arriving, row: u32, out: &mut [[f32; 4]]) {
        for table in &arriving.bounces {
            match (&self.bounce, table.form, self.bounced) {
                (Some((rank, products)), Form::Clustered, _) => {
                    add(table, *rank, products, row, self.functions, |k, weight, [r, g, b]| {
                        let sum: &mut [f32; 4] = &mut out[k];
                        *sum = [sum[0] + weight * r, sum[1] + weight * g, sum[2] + weight * b, sum[3]];
                    });
                }
                (_, _, Some(bounced)) => {
                    let mut values = vec![0.0; table.columns as usize];
                    table.read(prt.codebooks.bounce.as_ref(), row, &mut values);
                    let rgb: Vec<[f32; 3]> = match bounced {
                        Bounced::Relightable { channels, .. } => values
                            .chunks_exact(self.light.len() * *channels as usize)
                            .map(|row| sum(row, *channels, &self.light))
                            .collect(),
                        Bounced::Fixed { .. } => values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
                    };
                    for (out, [r, g, b]) in out.iter_mut().zip(rgb) {
                        *out = [out[0] + r, out[1] + g, out[2] + b, out[3]];
                    }
                }
                (_, _, None) => {}
            }
        }
    }
}

/// The diffuse light of texels: what their tables answer to one light.
#[derive(Debug, Clone)]
pub struct DiffuseLight {
    channels: u32,
    light: Vec<[f32; 3]>,
    /// Rank and `[cluster][mean, then vectors]` of the codebook.
    products: Option<(u32, Vec<[f32; 3]>)>,
}

impl DiffuseLight {
    /// Multiplies the light, in world axes with at least the bands of the transfer, with all that receivers of so many channels share.
    #[must_use]
    pub fn new(prt: &Prt, channels: u32, light: &Rgb) -> Self {
        let light = light.with_bands(Bands::new(prt.transfer.bands).unwrap_or(light.bands)).values;
        let columns = light.len() * channels as usize;
        let book = prt.codebooks.diffuse.as_ref().filter(|book| book.columns as usize == columns);
        let products = book.map(|book| {
            let rows = book.values();
            (book.rank, rows.chunks_exact(columns).map(|row| sum(row, channels, &light)).collect())
        });
        Self { channels, light, products }
    }

    /// Products of the codebook: rank, and `[cluster][mean, then vectors]`.
    #[must_use]
    pub fn products(&self) -> Option<(u32, &[[f32; 3]])> {
        self.products.as_ref().map(|(rank, products)| (*rank, products.as_slice()))
    }

    /// The radiance of a white receiver, RGB.
    ///
    /// # Panics
    /// When the row does not exist.
    #[must_use]
    pub fn read(&self, prt: &Prt, table: &Table, row: u32) -> [f32; 3] {
        let mut out = [0.0f32; 3];
        match (&self.products, table.form) {
            (Some((rank, products)), Form::Clustered) => {
                add(table, *rank, products, row, 1, |_, weight, rgb| {
                    out.iter_mut().zip(rgb).for_each(|(out, x)| *out += weight * x);
                });
                out
            }
            _ => {
                let mut values = vec![0.0; table.columns as usize];
                table.read(prt.codebooks.diffuse.as_ref(), row, &mut values);
                sum(&values, self.channels, &self.light)
            }
        }
    }
}

/// `[cluster][mean, then vectors][function]`: what each of them answers to a light.
///
/// Where clusters share vectors the light is multiplied with those alone, and the rest is short combinations of the products.
fn bounce_products(book: &Codebook, channels: u32, light: &[[f32; 3]], functions: usize) -> Vec<[f32; 3]> {
    let numbers = light.len() * channels as usize;
    let of = |rows: &[f32]| rows.chunks_exact(numbers).map(|row| sum(row, channels, light)).collect::<Vec<_>>();
    if book.shared == 0 {
        return of(&book.own());
    }
    let shared = of(&book.shared_vectors());
    let mut out = Vec::new();
    for own in book.own().chunks_exact(book.shared as usize) {
        let start = out.len();
        out.resize(start + functions, [0.0f32; 3]);
        for (factor, products) in own.iter().zip(shared.chunks_exact(functions)) {
            for (out, product) in out[start..].iter_mut().zip(products) {
                *out = std::array::from_fn(|c| out[c] + factor * product[c]);
            }
        }
    }
    out
}

/// Hands out the products of a row of a clustered table with their weights.
fn add<T: Copy>(
    table: &Table,
    rank: u32,
    products: &[T],
    row: u32,
    functions: usize,
    mut add: impl FnMut(usize, f32, T),
) {
    let first = table.cluster(row) as usize * (1 + rank as usize) * functions;
    let weights = std::iter::once(1.0).chain(table.weights(rank, row));
    for (vector, weight) in products[first..].chunks_exact(functions).zip(weights) {
        vector.iter().enumerate().for_each(|(k, product)| add(k, weight, *product));
    }
}

/// `sum_i values[i * channels + min(c, channels - 1)] light[i][c]`.
fn sum(values: &[f32], channels: u32, light: &[[f32; 3]]) -> [f32; 3] {
    let channels = channels as usize;
    let mut sum = [0.0f32; 3];
    for (value, light) in values.chunks_exact(channels).zip(light) {
        for (c, (sum, light)) in sum.iter_mut().zip(light).enumerate() {
            *sum += value[c.min(channels - 1)] * light;
        }
    }
    sum
}
