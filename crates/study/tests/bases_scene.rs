//! The bases compared on a baked scene: against sums over directions, closed forms, and orders that hold for every signal.

mod bent;

use bake::{Directional, DirectionalTexel};
use bent::{Baked, baked, request};
use coeff_io::Encoding;
use glam::{DVec3, Vec3};
use sh_math::hemisphere::Basis;
use sh_math::{Bands, evaluate, evaluate_f64};
use study::bases::scene::{Choice, Comparison, Goal, compare, normals};
use testkit::assert_close;
use testkit::quadrature::hemisphere_tanh_sinh;

/// The comparison of a bake, made once.
fn comparison(of: &Baked) -> Comparison {
    compare(&request(of, Goal::Error(0.02))).expect("something is seen")
}

fn imse(of: &Comparison, basis: Basis) -> f64 {
    of.rows.iter().find(|row| row.basis == basis).expect("every basis has a row").imse
}

/// Solves `matrix x = right` by elimination with the largest pivots.
fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| matrix[a][i].abs().total_cmp(&matrix[b][i].abs())).unwrap();
        matrix.swap(i, pivot);
        right.swap(i, pivot);
        for j in (0..n).filter(|&j| j != i) {
            let factor = matrix[j][i] / matrix[i][i];
            let row = matrix[i].clone();
            matrix[j].iter_mut().zip(row).for_each(|(a, b)| *a -= factor * b);
            right[j] -= factor * right[i];
        }
    }
    (0..n).map(|i| right[i] / matrix[i][i]).collect()
}

/// How a test finds coefficients.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// By the normal equations.
    LeastSquares,
    /// By inner products alone, as if every basis were orthonormal.
    Products,
}

/// Functions and signal at a direction, and its solid angle.
type Sample = ([f64; 9], [f64; 3], f64);

/// The integrated square error of a texel, mean of its channels: samples of the signal itself, no harmonics' form.
fn by_brute_force(basis: Basis, texel: &DirectionalTexel, way: Way) -> f64 {
    let n = basis.count();
    let points: Vec<Sample> = hemisphere_tanh_sinh()
        .into_iter()
        .map(|(direction, weight)| {
            let mut functions = [0.0; 9];
            basis.evaluate_f64(DVec3::from(direction), &mut functions);
            (functions, signal(texel, DVec3::from(direction)), weight)
        })
        .collect();
    let total = |value: &dyn Fn(&Sample) -> f64| points.iter().map(|p| p.2 * value(p)).sum::<f64>();
    let of_channel = |c: usize| {
        let right: Vec<f64> = (0..n).map(|i| total(&|p| p.0[i] * p.1[c])).collect();
        let gram = || (0..n).map(|i| (0..n).map(|j| total(&|p| p.0[i] * p.0[j])).collect()).collect();
        let coefficients = match (basis, way) {
            (Basis::ModifiedH1, _) => vec![signal(texel, DVec3::Z)[c] / points[0].0[0]],
            (_, Way::LeastSquares) => solved(gram(), right),
            (_, Way::Products) => right,
        };
        total(&|p| (p.1[c] - coefficients.iter().zip(p.0).map(|(a, b)| a * b).sum::<f64>()).powi(2))
    };
    (0..3).map(of_channel).sum::<f64>() / 3.0
}

/// Irradiance / pi of a texel at a normal.
fn signal(texel: &DirectionalTexel, normal: DVec3) -> [f64; 3] {
    let mut harmonics = [0.0; 25];
    evaluate_f64(Bands::new(5).unwrap(), normal, &mut harmonics);
    [0, 1, 2].map(|c| texel.coefficients.iter().zip(harmonics).map(|(rgb, y)| f64::from(rgb[c]) * y).sum())
}

/// Some texels of the bent sheet, evenly taken.
fn few(of: &Baked, count: usize) -> Directional {
    let bent: Vec<&DirectionalTexel> = of.found.texels.iter().filter(|texel| texel.sheet == 0).collect();
    let texels = (0..count).map(|i| bent[i * bent.len() / count].clone()).collect();
    Directional { texels, rays: 0 }
}

/// Rounding: harmonics and sums in f64, of errors down to 1e-7 of the square of the signal.
#[test]
fn errors_are_those_of_brute_force() {
    let of = baked();
    let found = few(of, 12);
    let some = compare(&study::bases::scene::Request { found: &found, ..request(of, Goal::Error(0.02)) }).unwrap();
    let mean = |basis: Basis, way: Way| {
        let errors = found.texels.iter().map(|texel| by_brute_force(basis, texel, way));
        errors.sum::<f64>() / found.texels.len() as f64
    };
    for row in &some.rows {
        assert_close!(row.imse, mean(row.basis, Way::LeastSquares), 1e-12, 1e-8, "{}", row.basis.name());
        assert!(row.imse > 0.0 && row.worst.relative >= row.relative, "{}", row.basis.name());
    }
    let wrong = mean(Basis::Sh9, Way::Products) / imse(&some, Basis::Sh9);
    assert!(wrong > 100.0, "can fail: inner products are no coefficients of harmonics: {wrong}");
}

/// Orders that hold for every signal, since one span lies in another: for the mean and for single texels.
fn orders_broken(of: &Comparison, orders: &[(Basis, Basis)]) -> usize {
    let broken = |(smaller, larger): &&(Basis, Basis)| imse(of, *smaller) > imse(of, *larger) * (1.0 + 1e-9) + 1e-15;
    orders.iter().filter(broken).count()
}

#[test]
fn orders_of_spans_hold_on_a_scene() {
    use Basis::{H4, H6, Hl2, Hsh4, Hsh9, Makhotkin4, Makhotkin9, ModifiedH1, ModifiedH4, ModifiedH6};
    use Basis::{Sh4, Sh9, Zernike3, Zernike6};
    let orders = [(Sh9, H6), (H6, H4), (H4, Hl2), (Hsh9, Hsh4), (Makhotkin9, Makhotkin4), (Zernike6, Zernike3)];
    let equal = [(H6, ModifiedH6), (ModifiedH6, H6), (H4, ModifiedH4), (ModifiedH4, Sh4), (Sh4, H4)];
    let of = baked();
    let whole = comparison(of);
    let single = few(of, 4).texels.into_iter().map(|texel| {
        let found = Directional { texels: vec![texel], rays: 0 };
        compare(&study::bases::scene::Request { found: &found, ..request(of, Goal::Error(0.02)) }).unwrap()
    });
    for some in single.chain([whole.clone()]) {
        assert_eq!(orders_broken(&some, &orders) + orders_broken(&some, &equal), 0);
        assert_eq!(orders_broken(&some, &[(ModifiedH4, ModifiedH1)]), 0);
    }
    let reversed = orders.map(|(smaller, larger)| (larger, smaller));
    assert_eq!(orders_broken(&whole, &reversed), orders.len(), "can fail: no order holds the other way round");
}

/// A signal that is the same at every normal.
#[test]
fn a_constant_is_lost_where_no_function_is_constant() {
    let of = baked();
    let mut found = few(of, 3);
    for texel in &mut found.texels {
        texel.coefficients = [[0.0; 3]; 25];
        texel.coefficients[0] = [0.5, 1.0, 2.0].map(|v| v * (4.0 * std::f32::consts::PI).sqrt());
    }
    let all = compare(&study::bases::scene::Request { found: &found, ..request(of, Goal::Error(0.02)) }).unwrap();
    assert_close!(all.mean, 3.5 / 3.0, 0.0, 1e-6, "the mean of the three channels");
    assert_eq!(all.negative, 0.0, "nothing is below 0");
    let below =
        found.texels.iter().map(|t| DirectionalTexel { coefficients: t.coefficients.map(|rgb| rgb.map(|v| -v)), ..*t });
    let below = Directional { texels: below.collect(), rays: 0 };
    let below = compare(&study::bases::scene::Request { found: &below, ..request(of, Goal::Error(0.02)) }).unwrap();
    assert_eq!(below.negative, 1.0, "can fail: everything is");
    for row in &all.rows {
        let exact = !matches!(row.basis, Basis::Hl2 | Basis::Makhotkin4 | Basis::Makhotkin9);
        let name = row.basis.name();
        // f32 coefficients are drawn.
        assert_eq!(row.relative < 1e-6 && row.stored[0].drawn.rms < 1e-6, exact, "{name}: {}", row.relative);
        assert!(exact || row.relative > 0.01, "can fail: {name} holds no constant: {}", row.relative);
    }
}

/// The error as drawn, with f32 functions and every error in a list.
#[test]
fn errors_as_drawn_are_those_at_the_normals() {
    let of = baked();
    let whole = comparison(of);
    let picked = normals(&of.scene, of.sheets[0].meshes.iter().copied());
    let at = |basis: Basis, picked: &[Vec3]| {
        let (mut errors, mut sum) = (Vec::new(), 0.0);
        let rows = |basis: Basis| {
            basis.fit(|n| {
                let mut y = [0.0; 25];
                evaluate_f64(Bands::new(5).unwrap(), n, &mut y);
                y
            })
        };
        let [bent, plain] = [basis, Basis::ModifiedH1].map(|held| (held, rows(held)));
        for texel in &of.found.texels {
            let ((held, rows), seen) = if texel.sheet == 0 { (&bent, picked) } else { (&plain, &[Vec3::Z][..]) };
            let own: Vec<[f32; 3]> = match held {
                Basis::ModifiedH1 => vec![signal(texel, DVec3::Z).map(|v| (v * std::f64::consts::TAU.sqrt()) as f32)],
                _ => rows
                    .iter()
                    .map(|r| {
                        [0, 1, 2].map(|c| {
                            r.iter().zip(&texel.coefficients).map(|(a, b)| a * f64::from(b[c])).sum::<f64>() as f32
                        })
                    })
                    .collect(),
            };
            for normal in seen {
                let mut y = [0.0; 25];
                evaluate(Bands::new(5).unwrap(), *normal, &mut y);
                let value = held.reconstruct(&own, *normal);
                for c in 0..3 {
                    let truth: f32 = texel.coefficients.iter().zip(y).map(|(rgb, y)| rgb[c] * y).sum();
                    errors.extend(std::iter::repeat_n(f64::from(value[c] - truth).abs(), 64 / seen.len()));
                    sum += f64::from(truth) * (64 / seen.len()) as f64;
                }
            }
        }
        errors.sort_by(f64::total_cmp);
        let mean = sum / errors.len() as f64;
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        [rms / mean, errors[(0.99 * errors.len() as f64).ceil() as usize - 1] / mean]
    };
    for row in whole.rows.iter().filter(|row| row.basis != Basis::Sh9) {
        let [rms, p99] = at(row.basis, &picked);
        // f32 functions of a signal of some units; the percentile is told apart by 0.2 %.
        assert_close!(row.stored[0].drawn.rms, rms, 1e-6, 1e-3, "{}", row.basis.name());
        assert_close!(row.stored[0].drawn.p99, p99, 1e-5, 4e-3, "{}", row.basis.name());
    }
    let [flat, _] = at(Basis::Hl2, &[Vec3::Z]);
    let drawn = whole.rows.iter().find(|row| row.basis == Basis::Hl2).unwrap().stored[0].drawn.rms;
    assert!((flat / drawn - 1.0).abs() > 0.05, "can fail: at other normals the error is another: {flat}, {drawn}");
}

/// Bytes in closed form: 2 a number, and 16 a block of 4 x 4 texels; one function on the plain sheet where the basis can be cut.
#[test]
fn bytes_are_those_of_sheets() {
    let of = baked();
    let whole = comparison(of);
    let of_sheet = |index: usize, functions: usize, encoding: Encoding| {
        let [w, h] = [of.sheets[index].width as usize, of.sheets[index].height as usize];
        match encoding {
            Encoding::F16 => functions * w * h * 3 * 2,
            _ => functions * w.div_ceil(4) * h.div_ceil(4) * 16,
        }
    };
    let bytes = |basis: Basis, encoding: Encoding| {
        let row = whole.rows.iter().find(|row| row.basis == basis).unwrap();
        row.stored.iter().find(|stored| stored.encoding == encoding).unwrap().bytes as usize
    };
    for (basis, plain) in [(Basis::ModifiedH6, 1), (Basis::ModifiedH1, 1), (Basis::H6, 1), (Basis::Hl2, 1)] {
        for encoding in [Encoding::F16, Encoding::Bc6h] {
            let expected = of_sheet(0, basis.count(), encoding) + of_sheet(1, plain, encoding);
            let rest = bytes(basis, encoding) - expected;
            // BC6H has a number per layer and channel before its blocks.
            assert!(
                rest <= if encoding == Encoding::F16 { 0 } else { 64 * 12 },
                "{} {}: {rest}",
                basis.name(),
                encoding.id()
            );
        }
    }
    let all = of_sheet(0, 6, Encoding::F16) + of_sheet(1, 6, Encoding::F16);
    assert_ne!(bytes(Basis::H6, Encoding::F16), all, "can fail: six functions where one is enough show");
    for row in &whole.rows {
        let stored = |index: usize| (row.stored[index].bytes, row.stored[index].drawn.rms);
        assert!(stored(0).0 > stored(1).0 && stored(1).0 > stored(2).0, "u8 is the smaller: {}", row.basis.name());
        assert!(stored(2).1 >= stored(1).1 * 0.99, "and no closer: {}", row.basis.name());
    }
}

#[test]
fn what_is_recommended_is_written() {
    let of = baked();
    let whole = comparison(of);
    let Choice { row, stored, met, .. } = whole.choice;
    assert!(met && whole.rows[row].stored[stored].drawn.rms <= 0.02, "{}", whole.text());
    let csv = whole.csv();
    assert_eq!(csv.lines().count(), 1 + 14 * 4);
    let columns = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == columns), "{csv}");
    assert_eq!(csv.lines().filter(|line| line.ends_with(",true")).count(), 1);
    assert!(whole.recommendation().starts_with("for an error of 2 %: "), "{}", whole.recommendation());
    let svg = whole.chart().svg().unwrap();
    assert!(svg.contains("bc6h") && svg.contains("#D1345B") && svg.contains(whole.rows[row].basis.name()));
    assert!(whole.text().contains("modified H 6") && whole.text().contains("worst texel"), "{}", whole.text());
    let remark = |rms: f64| {
        let mut flat = whole.clone();
        let plain = flat.rows.iter_mut().find(|row| row.basis == Basis::ModifiedH1).unwrap();
        plain.stored.iter_mut().for_each(|stored| stored.drawn.rms = rms);
        flat.remark()
    };
    assert!(remark(0.0).is_some_and(|text| text.contains("ordinary light map")));
    assert_eq!(remark(1.0), None, "a light map that errs more is not spoken of");
    let strict = compare(&request(of, Goal::Bytes(10))).unwrap();
    assert!(!strict.choice.met && strict.recommendation().contains("nothing fits"), "{}", strict.recommendation());
    let empty = Directional { texels: vec![], rays: 0 };
    let refused = compare(&study::bases::scene::Request { found: &empty, ..request(of, Goal::Bytes(10)) });
    assert!(refused.unwrap_err().to_string().contains("--texels"));
}

/// Without normal maps one function is all that is drawn.
#[test]
fn a_scene_without_normal_maps_gets_a_light_map() {
    let of = baked();
    let sheets: Vec<_> =
        of.sheets.iter().map(|sheet| bake::SheetSettings { directional: false, ..sheet.clone() }).collect();
    let plain = compare(&study::bases::scene::Request { sheets: &sheets, ..request(of, Goal::Error(0.02)) }).unwrap();
    assert!(!plain.has_normal_maps);
    assert_eq!(plain.rows[plain.choice.row].basis, Basis::ModifiedH1);
    assert!(plain.options().contains("--texels 24 --basis modified-h1"), "{}", plain.options());
    let exact = plain.rows[plain.choice.row].stored[0].drawn.rms;
    assert!(exact < 1e-6, "a light map is exact at the surface's own normal: {exact}");
    let bent = comparison(of);
    assert!(bent.has_normal_maps && bent.rows[bent.choice.row].basis != Basis::ModifiedH1, "can fail");
}
