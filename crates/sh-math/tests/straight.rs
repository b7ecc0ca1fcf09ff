//! Writes `src/straight.rs`, checks that it is up to date, and compares it with the recurrence.
//!
//! `SH_MATH_BLESS=1 cargo test -p sh-math --test straight` writes it anew.

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

/// The whole file.
fn source() -> String {
    let mut text = String::from(HEAD);
    text += "/// Hands the functions of `n_bands` bands at a unit vector to `put`; false when no code exists for that many.\n";
    text += "#[inline(always)]\n";
    text += "pub(crate) fn evaluate_into<V: Value>(\n    n_bands: usize,\n    direction: [V; 3],\n";
    text += "    put: impl FnMut(usize, V),\n) -> bool {\n";
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
