//! Writes `src/straight.rs`, checks that it is up to date, and compares it with the recurrence.
//!
//! `SH_MATH_BLESS=1 cargo test -p sh-math --test straight` writes it anew.

use glam::{DVec3, Vec3};
use sh_math::{Bands, evaluate, evaluate_batch, evaluate_f64, recurrence};
use std::fmt::Write;
use std::path::Path;

/// Straight-line code exists for `1..=MOST` bands.
const MOST: usize = 8;

const HEAD: &str = "//! Straight-line evaluation for few bands: the recurrence with its constants folded in.
//!
//! Written by `tests/straight.rs`; change it there. Orders ascend: with `Q` as in [`crate::recurrence`], `c` and `s` are
//! the real and imaginary part of `(x + i y)^m`, and `q` runs over the degrees.

use crate::value::Value;

";

#[test]
fn source_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/straight.rs");
    let expected = source();
    if std::env::var_os("SH_MATH_BLESS").is_some() {
        std::fs::write(&path, &expected).expect("src can be written");
    }
    let found = std::fs::read_to_string(&path).expect("src/straight.rs can be read");
    assert!(found == expected, "src/straight.rs is not what its generator writes: run with SH_MATH_BLESS=1");
}

/// 61 directions: seven whole blocks of the batch and five more.
fn directions() -> Vec<DVec3> {
    let direction = |i: u32| {
        let z = 1.0 - f64::from(2 * i + 1) / 61.0;
        let (sine, cosine) = libm::sincos(2.4 * f64::from(i));
        DVec3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z)
    };
    (0..61).map(direction).collect()
}

#[test]
fn straight_line_equals_recurrence() {
    for n in 1..=MOST {
        let bands = Bands::new(n as u32).expect("few bands are in range");
        let (mut straight, mut general) = (vec![0.0; n * n], vec![0.0; n * n]);
        for direction in directions() {
            evaluate_f64(bands, direction, &mut straight);
            recurrence::evaluate(n, direction.to_array(), &mut general);
            for (i, (a, b)) in straight.iter().zip(&general).enumerate() {
                assert!((a - b).abs() < 1e-14, "{n} bands, function {i} at {direction}: {a} is not {b}");
            }
        }
    }
}

#[test]
fn batch_equals_single_bit_for_bit() {
    let directions: Vec<Vec3> = directions().into_iter().map(DVec3::as_vec3).collect();
    let [xs, ys, zs] = [0, 1, 2].map(|axis| directions.iter().map(|d| d[axis]).collect::<Vec<f32>>());
    for n in 1..=12 {
        let bands = Bands::new(n).expect("few bands are in range");
        let mut batch = vec![0.0; bands.coefficients() * directions.len()];
        evaluate_batch(bands, &xs, &ys, &zs, &mut batch);
        let mut single = vec![0.0; bands.coefficients()];
        for (j, direction) in directions.iter().enumerate() {
            evaluate(bands, *direction, &mut single);
            let equal = (0..single.len()).all(|i| single[i].to_bits() == batch[i * directions.len() + j].to_bits());
            assert!(equal, "{n} bands at {direction}: batch and single differ");
        }
    }
}

#[test]
fn batch_of_nothing_is_nothing() {
    evaluate_batch::<f32>(Bands::new(5).expect("in range"), &[], &[], &[], &mut []);
}

#[test]
fn generator_can_fail() {
    let broken = source().replace("0.9461746957575", "0.9461746957576");
    assert!(broken != source(), "a changed constant must be seen");
}

/// The whole file.
fn source() -> String {
    let mut text = String::from(HEAD);
    text += "/// Hands the functions of `n_bands` bands at a unit vector to `put`; false when no code exists for that many.\n";
    text += "#[inline(always)]\n";
    text += "pub(crate) fn evaluate_into<V: Value>(";
    text += "n_bands: usize, direction: [V; 3], put: impl FnMut(usize, V)) -> bool {\n";
    text += "    match n_bands {\n";
    for n in 1..=MOST {
        writeln!(text, "        {n} => bands_{n}(direction, put),").expect("a string takes all");
    }
    text += "        _ => return false,\n    }\n    true\n}\n";
    for n in 1..=MOST {
        text += &function(n);
    }
    text
}

/// The evaluator of `n` bands.
fn function(n: usize) -> String {
    let direction = match n {
        1 => "[_, _, _]",
        _ => "[x, y, z]",
    };
    let plural = if n == 1 { "band" } else { "bands" };
    let mut text = format!("\n/// {n} {plural}.\n#[inline(always)]\n");
    writeln!(text, "fn bands_{n}<V: Value>({direction}: [V; 3], mut put: impl FnMut(usize, V)) {{")
        .expect("a string takes all");
    if n > 2 {
        text += "    let z2 = z * z;\n";
    }
    for m in 0..n {
        text += &order(n, m);
    }
    text += "}\n";
    text
}

/// The functions of one order, degree by degree.
fn order(n: usize, m: usize) -> String {
    let mut text = String::new();
    let mut line = |words: String| writeln!(text, "    {words}").expect("a string takes all");
    match m {
        0 => {}
        1 => line("let (c, s) = (x, y);".into()),
        _ => line("let (c, s) = (x * c - y * s, x * s + y * c);".into()),
    }
    // Q_mm, then Q_(m+1)m = p1 z, Q_(m+2)m = p2 z^2 - r2, Q_(m+3)m = z (p3 z^2 - r3)
    let constant = sectoral(m);
    let p1 = step(m + 1, m)[0] * constant;
    let ([a2, b2], [a3, b3]) = (step(m + 2, m), step(m + 3, m));
    let (p2, r2) = (a2 * p1, a2 * b2 * constant);
    let (p3, r3) = (a3 * p2, a3 * (r2 + b3 * p1));
    for l in m..n {
        match l - m {
            0 if m > 0 => line(format!("let q0 = V::of({constant:?});")),
            0 => line(format!("put(0, V::of({constant:?}));")),
            1 => line(format!("let q1 = V::of({p1:?}) * z;")),
            2 => line(format!("let q2 = V::of({p2:?}) * z2 - V::of({r2:?});")),
            3 => line(format!("let q3 = z * (V::of({p3:?}) * z2 - V::of({r3:?}));")),
            k => {
                let [a, b] = step(l, m);
                line(format!("let q{k} = V::of({a:?}) * z * q{} - V::of({:?}) * q{};", k - 1, a * b, k - 2));
            }
        }
        let (k, index) = (l - m, l * (l + 1));
        match m {
            0 if l == 0 => {}
            0 => line(format!("put({index}, q{k});")),
            _ => {
                line(format!("put({}, q{k} * s);", index - m));
                line(format!("put({}, q{k} * c);", index + m));
            }
        }
    }
    text
}

/// `Q_mm`: `sqrt((2m+1)!! / (4 pi (2m)!!))`, times `sqrt(2)` for `m > 0`.
fn sectoral(m: usize) -> f64 {
    let product: f64 = (1..=m).map(|k| (2 * k + 1) as f64 / (2 * k) as f64).product();
    let both = if m == 0 { 1.0 } else { 2.0 };
    (both * product / (4.0 * std::f64::consts::PI)).sqrt()
}

/// `[a_lm, b_lm]` as at the head of `src/recurrence.rs`.
fn step(l: usize, m: usize) -> [f64; 2] {
    let (l, m, k) = (l as f64, m as f64, l as f64 - 1.0);
    [((4.0 * l * l - 1.0) / (l * l - m * m)).sqrt(), ((k * k - m * m) / (4.0 * k * k - 1.0)).sqrt()]
}
