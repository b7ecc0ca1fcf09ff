// Hemispherical harmonics. Mirrors `hemisphere::hsh` of sh-math.
// A direction of the tangent frame to the values of the functions; below the horizon z counts as 0.
fn hemisphere(direction: vec3<f32>) -> array<f32, 9> {
    let x = direction.x;
    let y = direction.y;
    let z = max(direction.z, 0.0);
    let ratio = z / (1.0 + z);
    let root = sqrt(ratio);
    let shifted = 2.0 * z - 1.0;
    let linear = 1.381976598 * root;
    let tilted = 3.090193616 * shifted * root;
    let flat = 3.090193616 * ratio;
    return array<f32, 9>(
        0.39894228,
        linear * y,
        0.690988299 * shifted,
        linear * x,
        2.0 * flat * x * y,
        tilted * y,
        0.892062058 * (6.0 * z * (z - 1.0) + 1.0),
        tilted * x,
        flat * (x - y) * (x + y),
    );
}
