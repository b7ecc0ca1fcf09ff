//! How finely the surface holds its transfer: coarser meshes are read at the vertices of the finest.

use super::bakes::{Bakes, Timed};
use super::deviation::{Deviation, Spread, Truth};
use super::report::{Knob, Run};
use super::study::run_of;
use super::trials::as_asked;
use super::{Error, Request};
use coeff_io::{Mesh, Prt, Refine, Settings, Transfer};
use glam::Vec3;
use scene::Scene;
use std::time::Instant;

/// Most cells along an edge of the grid that finds triangles.
const MOST_CELLS: usize = 48;
/// Share of a cell by which a point on the surface may lie beside it: roundings.
const BESIDE: f32 = 1e-3;
/// The difference of a cosine that counts as much as lying beside the surface by as much as is allowed.
const SAME_COSINE: f32 = 1e-3;

/// The runs of different meshes, compared with the finest of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolution {
    /// The runs; the last one is the finest, and is made for comparison alone.
    pub runs: Vec<Run>,
    /// Longest edge of each run's triangles, metres.
    pub edges: Vec<f64>,
}

/// A way to split the scene.
struct Split {
    /// The option of a bake, or words where there is none.
    words: String,
    can_be_typed: bool,
    scene: Scene,
    /// Seconds that splitting took.
    seconds: f64,
    edge: f64,
}

/// Bakes the scene split in other ways, as far as the budget allows, and compares each with the finest.
///
/// The finest has the vertices of the mesh as asked and no edge above a quarter, or a half, of its longest.
///
/// # Errors
/// As a bake.
pub(super) fn study(
    request: &Request<'_>,
    truth: &Truth,
    bakes: &Bakes<'_>,
    left_out: &mut Vec<String>,
) -> Result<Option<Resolution>, Error> {
    bakes.tell("splitting", 0, 1)?;
    let settings = as_asked(request).settings;
    let edge = longest_edge(&bakes.scene);
    let Some((finest, mut left)) = finest(request, bakes, edge, left_out)? else { return Ok(None) };
    let asked = Split {
        words: "--refine auto".into(),
        can_be_typed: true,
        scene: bakes.scene.clone().into_owned(),
        seconds: bakes.split,
        edge,
    };
    let mut splits = vec![asked];
    if vertices(request.scene) < vertices(&bakes.scene) {
        splits.push(split(request, request.scene, Refine::Off, "--refine off".into())?);
    }
    for part in [1.0, 2.0] {
        let even = two_digits(edge / part);
        splits.push(split(request, request.scene, Refine::Edge(even as f32), format!("--refine {even}"))?);
    }
    let mut timed = Vec::new();
    for split in splits {
        let mut other = bakes.of_mesh(split.scene, split.seconds);
        let needed = other.predict(&settings)?.seconds;
        let name = format!("{} {}", as_asked(request).setting, split.words);
        if needed > left {
            left_out.push(format!("{name}: it would take about {needed:.1} s of the {:.1} s left", left.max(0.0)));
            continue;
        }
        left -= needed;
        timed.push((name.clone(), split.can_be_typed, split.edge, other.bake(&name, &settings)?));
    }
    let mut other = bakes.of_mesh(finest.scene, finest.seconds);
    timed.push((finest.words.clone(), finest.can_be_typed, finest.edge, other.bake(&finest.words, &settings)?));
    Ok((timed.len() > 1).then(|| compare(&timed, truth)))
}

/// The finest mesh that the budget allows, and the seconds that are left beside it; `None` where there is none.
fn finest(
    request: &Request<'_>,
    bakes: &Bakes<'_>,
    edge: f64,
    left_out: &mut Vec<String>,
) -> Result<Option<(Split, f64)>, Error> {
    let settings = as_asked(request).settings;
    let plan = bake::plan(&bakes.scene, &Settings { refine: Refine::Off, ..settings.clone() })?;
    if plan.shadowed_receivers == 0 {
        left_out.push("resolution: nothing casts a shadow, so finer vertices would hold nothing more".into());
        return Ok(None);
    }
    let mut why = String::new();
    for part in [4.0, 2.0] {
        let longest = two_digits(edge / part);
        let words = format!("for comparison: no edge above {longest} m");
        let split = split(request, &bakes.scene, Refine::Edge(longest as f32), words)?;
        let count = vertices(&split.scene);
        let needed = bakes.predict(&settings)?.seconds * count as f64 / vertices(&bakes.scene).max(1) as f64;
        let left = bakes.left() - needed;
        // The mesh as asked must fit too, or there is nothing to compare.
        if left > needed * vertices(&bakes.scene) as f64 / count as f64 {
            return Ok(Some((split, left)));
        }
        why = format!(
            "resolution: {count} receivers with edges of {longest} m would take about {needed:.1} s, with {:.1} s left",
            bakes.left().max(0.0)
        );
    }
    left_out.push(why);
    Ok(None)
}

/// Splits a scene with a clock.
fn split(request: &Request<'_>, scene: &Scene, refine: Refine, words: String) -> Result<Split, Error> {
    let began = Instant::now();
    let scene = bake::refine(scene, &Settings { refine, ..request.settings.clone() })?.into_owned();
    let can_be_typed = words.starts_with("--");
    Ok(Split { words, can_be_typed, seconds: began.elapsed().as_secs_f64(), edge: longest_edge(&scene), scene })
}

/// Compares every bake with the last.
fn compare(timed: &[(String, bool, f64, Timed)], truth: &Truth) -> Resolution {
    let finest = &timed[timed.len() - 1].3.prt;
    let truth = Truth { transfer: finest.transfer.clone(), light: truth.light.clone() };
    let run = |(name, can_be_typed, _, timed): &(String, bool, f64, Timed)| {
        let deviation = read_at(&timed.prt, finest).map(|transfer| truth.deviation(&transfer));
        let of = |of: &Deviation| (Spread::of(&of.receivers), of.radiance);
        let (transfer, radiance) = deviation.as_ref().map_or((Spread::default(), 0.0), of);
        Run { transfer, radiance, can_be_typed: *can_be_typed, ..run_of(Knob::Resolution, name.clone(), timed) }
    };
    Resolution { runs: timed.iter().map(run).collect(), edges: timed.iter().map(|t| t.2).collect() }
}

/// A length with two digits.
fn two_digits(edge: f64) -> f64 {
    format!("{edge:.1e}").parse().unwrap_or(edge)
}

/// Longest edge of the triangles of a scene, metres.
fn longest_edge(scene: &Scene) -> f64 {
    let length = |mesh: &scene::Mesh, [a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| mesh.positions[v as usize]);
        a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
    };
    let square = scene.meshes.iter().flat_map(|mesh| mesh.triangles.iter().map(move |&t| length(mesh, t)));
    f64::from(square.fold(0.0, f32::max)).sqrt()
}

/// Vertices of a scene.
fn vertices(scene: &Scene) -> usize {
    scene.meshes.iter().map(|mesh| mesh.positions.len()).sum()
}

/// The transfer of `coarse`, interpolated at the vertices of `fine`, mesh by mesh.
fn read_at(coarse: &Prt, fine: &Prt) -> Option<Transfer> {
    if coarse.meshes.len() != fine.meshes.len() {
        return None;
    }
    let row = (coarse.transfer.bands * coarse.transfer.bands * coarse.transfer.channels) as usize;
    let mut values = vec![0.0; fine.geometry.positions.len() * row];
    for (from, to) in coarse.meshes.iter().zip(&fine.meshes) {
        let Some(surface) = Surface::new(coarse, from) else { continue };
        for vertex in to.first_vertex..to.first_vertex + to.vertices {
            let [point, normal] =
                [&fine.geometry.positions, &fine.geometry.normals].map(|of| Vec3::from(of[vertex as usize]));
            let (corners, weights) = surface.nearest(point, normal);
            let out = &mut values[vertex as usize * row..][..row];
            for (corner, weight) in corners.into_iter().zip(weights) {
                let of = &coarse.transfer.values[corner as usize * row..][..row];
                out.iter_mut().zip(of).for_each(|(out, v)| *out += weight * v);
            }
        }
    }
    let albedo = fine.transfer.albedo.clone();
    Some(Transfer { values, albedo, openness: Vec::new(), ..coarse.transfer })
}

/// The triangles of a mesh in a grid, to find the one that a point lies on.
struct Surface<'a> {
    positions: &'a [[f32; 3]],
    normals: &'a [[f32; 3]],
    triangles: &'a [[u32; 3]],
    low: Vec3,
    cell: f32,
    cells: [usize; 3],
    /// Triangles that touch each cell.
    lists: Vec<Vec<u32>>,
}

impl<'a> Surface<'a> {
    fn new(prt: &'a Prt, mesh: &Mesh) -> Option<Self> {
        let triangles = &prt.geometry.triangles[mesh.first_triangle as usize..][..mesh.triangles as usize];
        let (positions, normals) = (&prt.geometry.positions[..], &prt.geometry.normals[..]);
        let corners = || triangles.iter().flatten().map(|&v| Vec3::from(positions[v as usize]));
        let low = corners().reduce(Vec3::min)?;
        let size = corners().reduce(Vec3::max)? - low;
        let along = ((2.0 * (triangles.len() as f32).sqrt()) as usize).clamp(1, MOST_CELLS);
        let cell = (size.max_element() / along as f32).max(f32::MIN_POSITIVE);
        let cells = size.to_array().map(|s| (s / cell) as usize + 1);
        let lists = vec![Vec::new(); cells.iter().product()];
        let mut surface = Self { positions, normals, triangles, low, cell, cells, lists };
        for (index, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|v| Vec3::from(positions[v as usize]));
            let pad = Vec3::splat(BESIDE * cell);
            let (first, last) = (surface.at(a.min(b).min(c) - pad), surface.at(a.max(b).max(c) + pad));
            for z in first[2]..=last[2] {
                for y in first[1]..=last[1] {
                    for x in first[0]..=last[0] {
                        surface.lists[(z * cells[1] + y) * cells[0] + x].push(index as u32);
                    }
                }
            }
        }
        Some(surface)
    }

    /// The cell of a point, or the one nearest to it.
    fn at(&self, point: Vec3) -> [usize; 3] {
        let place = ((point - self.low) / self.cell).to_array();
        std::array::from_fn(|i| (place[i].max(0.0) as usize).min(self.cells[i] - 1))
    }

    /// Corners and weights of the point of the surface nearest to `point`, which lies on it but for rounding.
    ///
    /// On a hard edge two faces are equally near: the one whose normal there agrees best with `normal` is meant.
    fn nearest(&self, point: Vec3, normal: Vec3) -> ([u32; 3], [f32; 3]) {
        let [x, y, z] = self.at(point);
        let list = &self.lists[(z * self.cells[1] + y) * self.cells[0] + x];
        let all: Vec<u32>;
        // A point away from the surface, as where meshes changed, is looked for everywhere.
        let candidates = if list.is_empty() {
            all = (0..self.triangles.len() as u32).collect();
            &all
        } else {
            list
        };
        let place = |&index: &u32| {
            let corners = self.triangles[index as usize];
            let weights = nearest_weights(point, corners.map(|v| Vec3::from(self.positions[v as usize])));
            let mean = |of: &[[f32; 3]]| -> Vec3 {
                corners.iter().zip(weights).map(|(&v, w)| w * Vec3::from(of[v as usize])).sum()
            };
            let cosine = mean(self.normals).normalize_or_zero().dot(normal);
            (mean(self.positions).distance(point), cosine, (corners, weights))
        };
        let places: Vec<_> = candidates.iter().map(place).collect();
        let (least, beside) = (places.iter().map(|p| p.0).fold(f32::INFINITY, f32::min), BESIDE * self.cell);
        let near = places.iter().filter(|p| p.0 <= least + beside);
        let agreement = |(distance, cosine, _): &(f32, f32, _)| cosine - SAME_COSINE * (distance - least) / beside;
        let best = near.max_by(|a, b| agreement(a).total_cmp(&agreement(b)));
        best.map_or(([0; 3], [0.0; 3]), |best| best.2)
    }
}

/// Barycentric weights of the point of a triangle that is nearest to `point`, or one near it where it lies outside:
/// weights below 0 are cut and the rest scaled to 1.
fn nearest_weights(point: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let normal = ab.cross(ac);
    let square = normal.length_squared();
    if square <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let v = ap.cross(ac).dot(normal) / square;
    let w = ab.cross(ap).dot(normal) / square;
    let cut = [1.0 - v - w, v, w].map(|x| x.max(0.0));
    let sum: f32 = cut.iter().sum();
    cut.map(|x| x / sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coeff_io::Geometry;

    /// A square of n x n cells in the plane z = x / 2, its transfer in one band a function of the place.
    fn square(n: u32, value: impl Fn(f32, f32) -> f32) -> Prt {
        let (mut geometry, mut transfer) =
            (Geometry::default(), Transfer { bands: 1, channels: 1, ..Transfer::default() });
        for i in 0..=n {
            for j in 0..=n {
                let (x, y) = (i as f32 / n as f32, j as f32 / n as f32);
                geometry.positions.push([x, y, 0.5 * x]);
                geometry.normals.push(Vec3::new(-0.5, 0.0, 1.0).normalize().to_array());
                transfer.values.push(value(x, y));
                transfer.albedo.push([1.0; 3]);
                if i < n && j < n {
                    let at = |i: u32, j: u32| i * (n + 1) + j;
                    geometry.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                    geometry.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        one_mesh(geometry, transfer)
    }

    fn one_mesh(geometry: Geometry, transfer: Transfer) -> Prt {
        let mesh = Mesh {
            name: "one".into(),
            material: 0,
            first_vertex: 0,
            vertices: geometry.positions.len() as u32,
            first_triangle: 0,
            triangles: geometry.triangles.len() as u32,
        };
        Prt { geometry, transfer, meshes: vec![mesh], ..crate::cost::sample::prt() }
    }

    /// A cube whose six faces of n x n cells have vertices of their own; the transfer is the number of the face.
    fn cube(n: u32) -> Prt {
        let (mut geometry, mut transfer) =
            (Geometry::default(), Transfer { bands: 1, channels: 1, ..Transfer::default() });
        for face in 0..6u32 {
            let (first, sign) = (geometry.positions.len() as u32, if face < 3 { 1.0 } else { -1.0 });
            let axes: [Vec3; 3] = std::array::from_fn(|k| Vec3::AXES[(face as usize + k) % 3]);
            for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
                let [u, v] = [i, j].map(|k| 2.0 * k as f32 / n as f32 - 1.0);
                geometry.positions.push((sign * axes[0] + u * axes[1] + v * axes[2]).to_array());
                geometry.normals.push((sign * axes[0]).to_array());
                transfer.values.push(face as f32);
                transfer.albedo.push([1.0; 3]);
                if i < n && j < n {
                    let at = |i: u32, j: u32| first + i * (n + 1) + j;
                    geometry.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                    geometry.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        one_mesh(geometry, transfer)
    }

    /// Vertices of `fine` that read another number than that of their face; 1e-5 is some roundings of numbers up to 5.
    fn of_another_face(coarse: &Prt, fine: &Prt) -> usize {
        let read = read_at(coarse, fine).unwrap();
        read.values.iter().zip(&fine.transfer.values).filter(|(a, b)| (**a - **b).abs() > 1e-5).count()
    }

    #[test]
    fn a_hard_edge_keeps_its_faces_apart() {
        for n in [4, 7, 12] {
            assert_eq!(of_another_face(&cube(4), &cube(n)), 0, "{n}");
        }
    }

    /// Without normals the faces on both sides of an edge are equally good.
    #[test]
    fn a_hard_edge_keeps_its_faces_apart_can_fail() {
        let mut fine = cube(12);
        fine.geometry.normals.fill([0.0; 3]);
        assert!(of_another_face(&cube(4), &fine) > 20);
    }

    fn worst(value: impl Fn(f32, f32) -> f32) -> f32 {
        let read = read_at(&square(4, &value), &square(15, &value)).unwrap();
        let fine = square(15, &value);
        read.values.iter().zip(&fine.transfer.values).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    /// Interpolation over triangles reproduces what is linear; 1e-5 is some roundings of values up to 3.
    #[test]
    fn what_is_linear_is_read_exactly() {
        let off = worst(|x, y| 1.0 + 2.0 * x - 3.0 * y);
        assert!(off < 1e-5, "{off}");
    }

    /// A step within the cells of the coarse square is not.
    #[test]
    fn what_is_linear_is_read_exactly_can_fail() {
        assert!(worst(|x, _| if x > 0.4 { 1.0 } else { 0.0 }) > 0.1);
    }

    #[test]
    fn other_meshes_are_not_compared() {
        let mut other = square(4, |_, _| 0.0);
        other.meshes.clear();
        assert!(read_at(&square(4, |_, _| 0.0), &other).is_none());
    }
}
