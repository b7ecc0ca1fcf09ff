//! The bases of light maps in WGSL against those of sh-math, at normals over, on and under the horizon.

use super::{TOLERANCE, directions, gpu, worst};
use crate::{Gpu, shaders};
use sh_math::hemisphere::Basis;

/// Directions all over the sphere, the horizon all round, and heights at which roots turn steep or floats run out.
fn normals() -> Vec<[f32; 4]> {
    let heights = [0.0f32, -0.0, 1e-3, 1e-6, 1e-12, 1e-30, -1e-6, -1e-3, -0.5];
    let ring = (0..64).map(|i| std::f32::consts::TAU * i as f32 / 64.0).flat_map(|angle| {
        let (sin, cos) = angle.sin_cos();
        heights.map(|z| {
            let radius = (1.0 - z * z).sqrt();
            [radius * cos, radius * sin, z, 0.0]
        })
    });
    directions().into_iter().chain(ring).collect()
}

/// Four functions from `first` on, in f64; those that are not there are 0.
fn exact(basis: Basis, first: usize, [x, y, z, _]: [f32; 4]) -> [f64; 4] {
    let mut values = [0.0; Basis::MAX_COUNT + 3];
    basis.evaluate_f64(glam::DVec3::from([x, y, z].map(f64::from)), &mut values);
    std::array::from_fn(|i| values[first + i])
}

/// The WGSL of the module that draws `basis`, from its `hemisphere` on.
fn library(basis: Basis) -> String {
    let text = shaders::surface(false, Some(basis)).text.into_owned();
    // The file of the basis stands last.
    let start = text.rfind("fn hemisphere(").expect("the module holds a basis");
    format!("{}{}", super::FUNCTIONS, &text[start..])
}

/// Largest error of the functions of `basis`, all of them.
fn error(gpu: &Gpu, basis: Basis) -> f64 {
    let library = library(basis);
    let call = |i: usize| if i < basis.count() { format!("hemisphere(x.xyz)[{i}]") } else { "0.0".into() };
    let part = |first: usize| {
        let call = format!("vec4<f32>({}, {}, {}, {})", call(first), call(first + 1), call(first + 2), call(first + 3));
        worst(gpu, &library, &call, None, &normals(), |x| exact(basis, first, x))
    };
    [0, 4, 8].map(part).into_iter().fold(0.0, |worst, error| if error <= worst { worst } else { error })
}

#[test]
fn every_basis_is_its_twin() {
    let Some(gpu) = gpu() else { return };
    for basis in Basis::ALL {
        let error = error(&gpu, basis);
        assert!(error < TOLERANCE, "{} is off by {error}", basis.name());
    }
}

/// Formulas as the third paper prints them, whose errors sh-math's files name.
#[test]
fn bases_can_fail() {
    let Some(gpu) = gpu() else { return };
    let printed = [
        ("eq. 1.12, without its x", Basis::Sh9, 3, "0.48860251"),
        ("eq. 1.23, of the other sign", Basis::Hsh9, 1, "-1.3819766 * x.y * sqrt(x.z / (1.0 + x.z))"),
        ("eq. 1.33, without its root", Basis::Makhotkin9, 0, "0.56418958 * x.z"),
        ("eq. 1.48, of the other sign", Basis::Zernike6, 2, "-0.79788456 * x.x / sqrt(1.0 + x.z)"),
    ];
    let above = normals().into_iter().filter(|x| x[2] >= 0.0).collect::<Vec<_>>();
    for (name, basis, index, formula) in printed {
        let call = format!("vec4<f32>({formula})");
        let error = worst(&gpu, super::FUNCTIONS, &call, None, &above, |x| [exact(basis, index, x)[0]]);
        assert!(error > 0.1, "{name} must be noticed, but is off by {error} only");
    }
}

/// The value of the border counts under the horizon: the functions as they stand have none there.
#[test]
fn the_horizon_can_fail() {
    let Some(gpu) = gpu() else { return };
    let unclamped = "vec4<f32>(0.48860251 * x.z)";
    let error = worst(&gpu, super::FUNCTIONS, unclamped, None, &normals(), |x| [exact(Basis::Sh9, 2, x)[0]]);
    assert!(error > 0.1, "a z below 0 must be noticed, but is off by {error} only");
}
