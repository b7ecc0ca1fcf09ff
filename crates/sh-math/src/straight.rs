//! Straight-line evaluation for few bands: the recurrence with its constants folded in.
//!
//! Written by `tests/straight.rs`; change it there. Orders ascend: with `Q` as in [`crate::recurrence`], `c` and `s` are
//! the real and imaginary part of `(x + i y)^m`, and `q` runs over the degrees.

use crate::value::Value;

/// Hands the functions of `n_bands` bands at a unit vector to `put`; false when no code exists for that many.
#[inline(always)]
pub(crate) fn evaluate_into<V: Value>(n_bands: usize, direction: [V; 3], put: impl FnMut(usize, V)) -> bool {
    match n_bands {
        1 => bands_1(direction, put),
        2 => bands_2(direction, put),
        3 => bands_3(direction, put),
        4 => bands_4(direction, put),
        5 => bands_5(direction, put),
        6 => bands_6(direction, put),
        7 => bands_7(direction, put),
        8 => bands_8(direction, put),
        _ => return false,
    }
    true
}

/// 1 band.
#[inline(always)]
fn bands_1<V: Value>([_, _, _]: [V; 3], mut put: impl FnMut(usize, V)) {
    put(0, V::of(0.28209479177387814));
}

/// 2 bands.
#[inline(always)]
fn bands_2<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    put(0, V::of(0.28209479177387814));
    let q1 = V::of(0.48860251190291987) * z;
    put(2, q1);
    let (c, s) = (x, y);
    let q0 = V::of(0.4886025119029199);
    put(1, q0 * s);
    put(3, q0 * c);
}

/// 3 bands.
#[inline(always)]
fn bands_3<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let z2 = z * z;
    put(0, V::of(0.28209479177387814));
    let q1 = V::of(0.48860251190291987) * z;
    put(2, q1);
    let q2 = V::of(0.94617469575756) * z2 - V::of(0.31539156525252);
    put(6, q2);
    let (c, s) = (x, y);
    let q0 = V::of(0.4886025119029199);
    put(1, q0 * s);
    put(3, q0 * c);
    let q1 = V::of(1.0925484305920792) * z;
    put(5, q1 * s);
    put(7, q1 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5462742152960396);
    put(4, q0 * s);
    put(8, q0 * c);
}

/// 4 bands.
#[inline(always)]
fn bands_4<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let z2 = z * z;
    put(0, V::of(0.28209479177387814));
    let q1 = V::of(0.48860251190291987) * z;
    put(2, q1);
    let q2 = V::of(0.94617469575756) * z2 - V::of(0.31539156525252);
    put(6, q2);
    let q3 = z * (V::of(1.8658816629505768) * z2 - V::of(1.119528997770346));
    put(12, q3);
    let (c, s) = (x, y);
    let q0 = V::of(0.4886025119029199);
    put(1, q0 * s);
    put(3, q0 * c);
    let q1 = V::of(1.0925484305920792) * z;
    put(5, q1 * s);
    put(7, q1 * c);
    let q2 = V::of(2.2852289973223288) * z2 - V::of(0.4570457994644657);
    put(11, q2 * s);
    put(13, q2 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5462742152960396);
    put(4, q0 * s);
    put(8, q0 * c);
    let q1 = V::of(1.4453057213202773) * z;
    put(10, q1 * s);
    put(14, q1 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5900435899266435);
    put(9, q0 * s);
    put(15, q0 * c);
}

/// 5 bands.
#[inline(always)]
fn bands_5<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let z2 = z * z;
    put(0, V::of(0.28209479177387814));
    let q1 = V::of(0.48860251190291987) * z;
    put(2, q1);
    let q2 = V::of(0.94617469575756) * z2 - V::of(0.31539156525252);
    put(6, q2);
    let q3 = z * (V::of(1.8658816629505768) * z2 - V::of(1.119528997770346));
    put(12, q3);
    let q4 = V::of(1.984313483298443) * z * q3 - V::of(1.0062305898749055) * q2;
    put(20, q4);
    let (c, s) = (x, y);
    let q0 = V::of(0.4886025119029199);
    put(1, q0 * s);
    put(3, q0 * c);
    let q1 = V::of(1.0925484305920792) * z;
    put(5, q1 * s);
    put(7, q1 * c);
    let q2 = V::of(2.2852289973223288) * z2 - V::of(0.4570457994644657);
    put(11, q2 * s);
    put(13, q2 * c);
    let q3 = z * (V::of(4.683325804901025) * z2 - V::of(2.0071396306718676));
    put(19, q3 * s);
    put(21, q3 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5462742152960396);
    put(4, q0 * s);
    put(8, q0 * c);
    let q1 = V::of(1.4453057213202773) * z;
    put(10, q1 * s);
    put(14, q1 * c);
    let q2 = V::of(3.3116114351514607) * z2 - V::of(0.47308734787878004);
    put(18, q2 * s);
    put(22, q2 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5900435899266435);
    put(9, q0 * s);
    put(15, q0 * c);
    let q1 = V::of(1.7701307697799304) * z;
    put(17, q1 * s);
    put(23, q1 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6258357354491761);
    put(16, q0 * s);
    put(24, q0 * c);
}

/// 6 bands.
#[inline(always)]
fn bands_6<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let z2 = z * z;
    put(0, V::of(0.28209479177387814));
    let q1 = V::of(0.48860251190291987) * z;
    put(2, q1);
    let q2 = V::of(0.94617469575756) * z2 - V::of(0.31539156525252);
    put(6, q2);
    let q3 = z * (V::of(1.8658816629505768) * z2 - V::of(1.119528997770346));
    put(12, q3);
    let q4 = V::of(1.984313483298443) * z * q3 - V::of(1.0062305898749055) * q2;
    put(20, q4);
    let q5 = V::of(1.98997487421324) * z * q4 - V::of(1.002853072844814) * q3;
    put(30, q5);
    let (c, s) = (x, y);
    let q0 = V::of(0.4886025119029199);
    put(1, q0 * s);
    put(3, q0 * c);
    let q1 = V::of(1.0925484305920792) * z;
    put(5, q1 * s);
    put(7, q1 * c);
    let q2 = V::of(2.2852289973223288) * z2 - V::of(0.4570457994644657);
    put(11, q2 * s);
    put(13, q2 * c);
    let q3 = z * (V::of(4.683325804901025) * z2 - V::of(2.0071396306718676));
    put(19, q3 * s);
    put(21, q3 * c);
    let q4 = V::of(2.03100960115899) * z * q3 - V::of(0.991031208965115) * q2;
    put(29, q4 * s);
    put(31, q4 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5462742152960396);
    put(4, q0 * s);
    put(8, q0 * c);
    let q1 = V::of(1.4453057213202773) * z;
    put(10, q1 * s);
    put(14, q1 * c);
    let q2 = V::of(3.3116114351514607) * z2 - V::of(0.47308734787878004);
    put(18, q2 * s);
    put(22, q2 * c);
    let q3 = z * (V::of(7.190305177459987) * z2 - V::of(2.3967683924866625));
    put(28, q3 * s);
    put(32, q3 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5900435899266435);
    put(9, q0 * s);
    put(15, q0 * c);
    let q1 = V::of(1.7701307697799304) * z;
    put(17, q1 * s);
    put(23, q1 * c);
    let q2 = V::of(4.403144694917253) * z2 - V::of(0.4892382994352504);
    put(27, q2 * s);
    put(33, q2 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6258357354491761);
    put(16, q0 * s);
    put(24, q0 * c);
    let q1 = V::of(2.075662314881041) * z;
    put(26, q1 * s);
    put(34, q1 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6563820568401701);
    put(25, q0 * s);
    put(35, q0 * c);
}

/// 7 bands.
#[inline(always)]
fn bands_7<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let z2 = z * z;
    put(0, V::of(0.28209479177387814));
    let q1 = V::of(0.48860251190291987) * z;
    put(2, q1);
    let q2 = V::of(0.94617469575756) * z2 - V::of(0.31539156525252);
    put(6, q2);
    let q3 = z * (V::of(1.8658816629505768) * z2 - V::of(1.119528997770346));
    put(12, q3);
    let q4 = V::of(1.984313483298443) * z * q3 - V::of(1.0062305898749055) * q2;
    put(20, q4);
    let q5 = V::of(1.98997487421324) * z * q4 - V::of(1.002853072844814) * q3;
    put(30, q5);
    let q6 = V::of(1.9930434571835665) * z * q5 - V::of(1.0015420209622192) * q4;
    put(42, q6);
    let (c, s) = (x, y);
    let q0 = V::of(0.4886025119029199);
    put(1, q0 * s);
    put(3, q0 * c);
    let q1 = V::of(1.0925484305920792) * z;
    put(5, q1 * s);
    put(7, q1 * c);
    let q2 = V::of(2.2852289973223288) * z2 - V::of(0.4570457994644657);
    put(11, q2 * s);
    put(13, q2 * c);
    let q3 = z * (V::of(4.683325804901025) * z2 - V::of(2.0071396306718676));
    put(19, q3 * s);
    put(21, q3 * c);
    let q4 = V::of(2.03100960115899) * z * q3 - V::of(0.991031208965115) * q2;
    put(29, q4 * s);
    put(31, q4 * c);
    let q5 = V::of(2.0213149892370277) * z * q4 - V::of(0.9952267030562386) * q3;
    put(41, q5 * s);
    put(43, q5 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5462742152960396);
    put(4, q0 * s);
    put(8, q0 * c);
    let q1 = V::of(1.4453057213202773) * z;
    put(10, q1 * s);
    put(14, q1 * c);
    let q2 = V::of(3.3116114351514607) * z2 - V::of(0.47308734787878004);
    put(18, q2 * s);
    put(22, q2 * c);
    let q3 = z * (V::of(7.190305177459987) * z2 - V::of(2.3967683924866625));
    put(28, q3 * s);
    put(32, q3 * c);
    let q4 = V::of(2.1139418156609704) * z * q3 - V::of(0.9736101204623269) * q2;
    put(40, q4 * s);
    put(44, q4 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5900435899266435);
    put(9, q0 * s);
    put(15, q0 * c);
    let q1 = V::of(1.7701307697799304) * z;
    put(17, q1 * s);
    put(23, q1 * c);
    let q2 = V::of(4.403144694917253) * z2 - V::of(0.4892382994352504);
    put(27, q2 * s);
    put(33, q2 * c);
    let q3 = z * (V::of(10.133257854664159) * z2 - V::of(2.7636157785447706));
    put(39, q3 * s);
    put(45, q3 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6258357354491761);
    put(16, q0 * s);
    put(24, q0 * c);
    let q1 = V::of(2.075662314881041) * z;
    put(26, q1 * s);
    put(34, q1 * c);
    let q2 = V::of(5.550213908015965) * z2 - V::of(0.5045649007287242);
    put(38, q2 * s);
    put(46, q2 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6563820568401701);
    put(25, q0 * s);
    put(35, q0 * c);
    let q1 = V::of(2.366619162231752) * z;
    put(37, q1 * s);
    put(47, q1 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6831841051919143);
    put(36, q0 * s);
    put(48, q0 * c);
}

/// 8 bands.
#[inline(always)]
fn bands_8<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let z2 = z * z;
    put(0, V::of(0.28209479177387814));
    let q1 = V::of(0.48860251190291987) * z;
    put(2, q1);
    let q2 = V::of(0.94617469575756) * z2 - V::of(0.31539156525252);
    put(6, q2);
    let q3 = z * (V::of(1.8658816629505768) * z2 - V::of(1.119528997770346));
    put(12, q3);
    let q4 = V::of(1.984313483298443) * z * q3 - V::of(1.0062305898749055) * q2;
    put(20, q4);
    let q5 = V::of(1.98997487421324) * z * q4 - V::of(1.002853072844814) * q3;
    put(30, q5);
    let q6 = V::of(1.9930434571835665) * z * q5 - V::of(1.0015420209622192) * q4;
    put(42, q6);
    let q7 = V::of(1.9948914348241344) * z * q6 - V::of(1.0009272139219583) * q5;
    put(56, q7);
    let (c, s) = (x, y);
    let q0 = V::of(0.4886025119029199);
    put(1, q0 * s);
    put(3, q0 * c);
    let q1 = V::of(1.0925484305920792) * z;
    put(5, q1 * s);
    put(7, q1 * c);
    let q2 = V::of(2.2852289973223288) * z2 - V::of(0.4570457994644657);
    put(11, q2 * s);
    put(13, q2 * c);
    let q3 = z * (V::of(4.683325804901025) * z2 - V::of(2.0071396306718676));
    put(19, q3 * s);
    put(21, q3 * c);
    let q4 = V::of(2.03100960115899) * z * q3 - V::of(0.991031208965115) * q2;
    put(29, q4 * s);
    put(31, q4 * c);
    let q5 = V::of(2.0213149892370277) * z * q4 - V::of(0.9952267030562386) * q3;
    put(41, q5 * s);
    put(43, q5 * c);
    let q6 = V::of(2.0155644370746373) * z * q5 - V::of(0.9971550440218321) * q4;
    put(55, q6 * s);
    put(57, q6 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5462742152960396);
    put(4, q0 * s);
    put(8, q0 * c);
    let q1 = V::of(1.4453057213202773) * z;
    put(10, q1 * s);
    put(14, q1 * c);
    let q2 = V::of(3.3116114351514607) * z2 - V::of(0.47308734787878004);
    put(18, q2 * s);
    put(22, q2 * c);
    let q3 = z * (V::of(7.190305177459987) * z2 - V::of(2.3967683924866625));
    put(28, q3 * s);
    put(32, q3 * c);
    let q4 = V::of(2.1139418156609704) * z * q3 - V::of(0.9736101204623269) * q2;
    put(40, q4 * s);
    put(44, q4 * c);
    let q5 = V::of(2.0816659994661326) * z * q4 - V::of(0.9847319278346618) * q3;
    put(54, q5 * s);
    put(58, q5 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.5900435899266435);
    put(9, q0 * s);
    put(15, q0 * c);
    let q1 = V::of(1.7701307697799304) * z;
    put(17, q1 * s);
    put(23, q1 * c);
    let q2 = V::of(4.403144694917253) * z2 - V::of(0.4892382994352504);
    put(27, q2 * s);
    put(33, q2 * c);
    let q3 = z * (V::of(10.133257854664159) * z2 - V::of(2.7636157785447706));
    put(39, q3 * s);
    put(45, q3 * c);
    let q4 = V::of(2.207940216581962) * z * q3 - V::of(0.959403223600247) * q2;
    put(53, q4 * s);
    put(59, q4 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6258357354491761);
    put(16, q0 * s);
    put(24, q0 * c);
    let q1 = V::of(2.075662314881041) * z;
    put(26, q1 * s);
    put(34, q1 * c);
    let q2 = V::of(5.550213908015965) * z2 - V::of(0.5045649007287242);
    put(38, q2 * s);
    put(46, q2 * c);
    let q3 = z * (V::of(13.491805046726766) * z2 - V::of(3.1134934723215624));
    put(52, q3 * s);
    put(60, q3 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6563820568401701);
    put(25, q0 * s);
    put(35, q0 * c);
    let q1 = V::of(2.366619162231752) * z;
    put(37, q1 * s);
    put(47, q1 * c);
    let q2 = V::of(6.745902523363384) * z2 - V::of(0.5189155787202604);
    put(51, q2 * s);
    put(61, q2 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.6831841051919143);
    put(36, q0 * s);
    put(48, q0 * c);
    let q1 = V::of(2.6459606618019) * z;
    put(50, q1 * s);
    put(62, q1 * c);
    let (c, s) = (x * c - y * s, x * s + y * c);
    let q0 = V::of(0.7071627325245963);
    put(49, q0 * s);
    put(63, q0 * c);
}
