//! The written-out functions of gloss against those of `sh-math`.

use super::{directions, gpu, worst};
use crate::gloss_text;
use sh_math::{Bands, evaluate_f64, lobe};

/// Largest error of all functions of so many bands, as the text for `written` bands has them.
fn harmonics(bands: u32, written: u32) -> Option<f64> {
    let gpu = gpu()?;
    let library = gloss_text::functions(Bands::new(written)?);
    let bands = Bands::new(bands)?;
    let count = bands.coefficients();
    let part = |first: usize| {
        let call = |k: usize| if k < count { format!("harmonics(x.xyz)[{k}]") } else { "0.0".into() };
        let call = format!("vec4<f32>({}, {}, {}, {})", call(first), call(first + 1), call(first + 2), call(first + 3));
        worst(&gpu, &library, &call, None, &directions(), |[x, y, z, _]| {
            let mut values = vec![0.0; count + 3];
            evaluate_f64(bands, glam::DVec3::from([x, y, z].map(f64::from)), &mut values);
            values[count..].fill(0.0);
            std::array::from_fn::<f64, 4, _>(|i| values[first + i])
        })
    };
    Some((0..count).step_by(4).map(part).fold(0.0, f64::max))
}

#[test]
fn harmonics_of_any_bands_are_their_twins() {
    for bands in 1..=8 {
        let Some(error) = harmonics(bands, bands) else { return };
        assert!(error < 1e-5, "{bands}: {error:e}");
    }
}

/// The open energy of a lobe at all cosines.
fn energy(shift: f32) -> Option<f64> {
    let gpu = gpu()?;
    let bands = Bands::new(6)?;
    let factors = [1.0f32, 0.9, 0.7, 0.5, 0.3, 0.2];
    let list = factors.map(|factor| format!("{factor:?}")).join(", ");
    let call = format!("vec4<f32>(open_energy(array<f32, BANDS>({list}), x.x), 0.0, 0.0, 0.0)");
    let inputs: Vec<[f32; 4]> = (0..=64).map(|i| [i as f32 / 64.0, 0.0, 0.0, 0.0]).collect();
    let exact = |[x, ..]: [f32; 4]| [f64::from(lobe::open_energy(&factors, x + shift)), 0.0, 0.0, 0.0];
    Some(worst(&gpu, &gloss_text::functions(bands), &call, None, &inputs, exact))
}

#[test]
fn open_energy_is_its_twin() {
    let Some(error) = energy(0.0) else { return };
    assert!(error < 1e-6, "{error:e}");
    assert!(energy(0.01).is_some_and(|error| error > 1e-3), "can fail");
}
