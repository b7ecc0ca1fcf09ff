// Zernike polynomials on the hemisphere. Mirrors `hemisphere::zernike` of sh-math.
// A direction of the tangent frame to the values of the functions; below the horizon z counts as 0.
fn hemisphere(direction: vec3<f32>) -> array<f32, 9> {
    let x = direction.x;
    let y = direction.y;
    let z = max(direction.z, 0.0);
    let above = 1.0 + z;
    let radial = 0.797884561 / sqrt(above);
    let flat = 0.977205024 / above;
    return array<f32, 9>(
        0.39894228,
        -radial * y,
        radial * x,
        -2.0 * flat * x * y,
        0.690988299 * (1.0 - 2.0 * z),
        flat * (x - y) * (x + y),
        0.0,
        0.0,
        0.0,
    );
}
