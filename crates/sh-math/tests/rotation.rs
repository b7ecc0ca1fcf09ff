//! Rotation of coefficients against rotated directions and golden values.

use glam::{DQuat, DVec3};
use sh_math::{Bands, evaluate_f64, rotate::Rotation};

#[test]
fn basis_turns_with_direction() {
    for n in [2, 3, 5, 9, 20, 64, 129] {
        let bands = Bands::new(n).expect("in range");
        let q = DQuat::from_xyzw(2.0, 3.0, 4.0, 1.0).normalize();
        let v = DVec3::new(0.3, -0.5, 0.9).normalize();
        let (mut before, mut after) = (vec![0.0; bands.coefficients()], vec![0.0; bands.coefficients()]);
        evaluate_f64(bands, v, &mut before);
        evaluate_f64(bands, q * v, &mut after);
        Rotation::from_f64(bands, q).apply(&mut before);
        let worst = before.iter().zip(&after).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let m = Rotation::from_f64(bands, q).matrix(n as usize - 1);
        let s = 2 * n as usize - 1;
        let mut defect = 0.0f64;
        for i in 0..s {
            for j in 0..s {
                let dot: f64 = (0..s).map(|k| m[i * s + k] * m[j * s + k]).sum();
                defect = defect.max((dot - f64::from(u8::from(i == j))).abs());
            }
        }
        println!("{n}: {worst:e} defect {} eps", defect / f64::EPSILON);
    }
}
