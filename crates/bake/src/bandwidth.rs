//! How many bands matter: what a transfer, and a light where one is named, hold in each.

use coeff_io::Survey;

/// What is left out with n bands, for n from 0 to all: against an open receiver.
///
/// Without a light it is the norm of the bands left out over that of all bands of an open receiver: no light of a given norm
/// can show more. With a light it is the sum over the bands left out of |transfer| |light|, which bounds the radiance that
/// they carry however the light is turned (Cauchy and Schwarz, band by band), over the radiance of an open receiver
/// under the light's mean. `gain` stands for bounces, which add to what is direct.
pub(crate) fn left_out(survey: &Survey, open: &[f32], light: &[f32], gain: f64) -> Vec<f64> {
    let norms = || survey.band_norms.iter().map(|&n| f64::from(n) * gain);
    let terms: Vec<f64> = if light.is_empty() {
        norms().map(|n| n * n).collect()
    } else {
        norms().zip(light).map(|(n, &l)| n * f64::from(l)).collect()
    };
    let rest = |n: usize| terms[n..].iter().sum::<f64>();
    let whole = if light.is_empty() {
        open.iter().map(|&n| f64::from(n) * f64::from(n)).sum::<f64>().sqrt()
    } else {
        f64::from(open[0]) * f64::from(light[0])
    };
    let share = |rest: f64| match () {
        () if rest <= 0.0 => 0.0,
        () if whole <= 0.0 => f64::INFINITY,
        () => rest / whole,
    };
    (0..=terms.len()).map(|n| share(if light.is_empty() { rest(n).sqrt() } else { rest(n) })).collect()
}

/// Fewest bands that leave out no more than the tolerance.
pub(crate) fn needed(left_out: &[f64], tolerance: f64) -> u32 {
    let enough = left_out.iter().skip(1).position(|&left| left <= tolerance);
    enough.map_or(left_out.len() - 1, |n| n + 1) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Norms of the clamped cosine over pi: factors 1, 2/3, 1/4, 0, 1/24 times sqrt((2l+1)/4pi).
    fn cosine() -> Vec<f32> {
        let norm = |l: u32, a: f32| a * (f32::from(2 * l as u16 + 1) / (4.0 * std::f32::consts::PI)).sqrt();
        [1.0, 2.0 / 3.0, 0.25, 0.0, 1.0 / 24.0].iter().zip(0..).map(|(&a, l)| norm(l, a)).collect()
    }

    fn open(bands: usize) -> Survey {
        Survey { band_norms: cosine()[..bands].to_vec(), ..Survey::default() }
    }

    /// The fourth band of an open receiver is empty; the fifth is not.
    #[test]
    fn an_empty_band_is_left_out() {
        let four = left_out(&open(4), &cosine()[..4], &[], 1.0);
        assert_eq!(needed(&four, 1e-6), 3);
        let five = left_out(&open(5), &cosine(), &[], 1.0);
        assert_eq!(needed(&five, 1e-6), 5, "can fail: band 4 holds something");
        // By hand: sqrt(9/4pi)/24 over sqrt(2/(3 pi)), less what is beyond band 4.
        assert!((five[3] - 0.0766).abs() < 1e-3, "{five:?}");
    }

    /// A light that is the same from everywhere reaches one band; one lamp reaches all.
    #[test]
    fn the_light_decides() {
        let white = left_out(&open(5), &cosine(), &[3.5, 0.0, 0.0, 0.0, 0.0], 1.0);
        assert_eq!(needed(&white, 1e-6), 1);
        // A lamp in one direction: |L_l| = sqrt((2l+1)/4pi).
        let lamp: Vec<f32> = (0..5).map(|l| ((2 * l + 1) as f32).sqrt()).collect();
        let lit = left_out(&open(5), &cosine(), &lamp, 1.0);
        assert_eq!(needed(&lit, 0.01), 5);
        // The value of the series at its peak without band 4: 9/24.
        assert!((lit[4] - 9.0 / 24.0).abs() < 1e-3, "{lit:?}");
        let dark = left_out(&open(5), &cosine(), &[0.0; 5], 1.0);
        assert_eq!(needed(&dark, 1e-6), 1, "no light shows nothing");
    }
}
