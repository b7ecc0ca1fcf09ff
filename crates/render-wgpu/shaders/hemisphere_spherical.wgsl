// Spherical harmonics of 3 bands. Mirrors `hemisphere::spherical` of sh-math.
// A direction of the tangent frame to the values of the functions; below the horizon z counts as 0.
fn hemisphere(direction: vec3<f32>) -> array<f32, 9> {
    let x = direction.x;
    let y = direction.y;
    let z = max(direction.z, 0.0);
    return array<f32, 9>(
        0.282094792,
        0.488602512 * y,
        0.488602512 * z,
        0.488602512 * x,
        1.092548431 * x * y,
        1.092548431 * y * z,
        0.946174696 * z * z - 0.315391565,
        1.092548431 * x * z,
        0.546274215 * (x - y) * (x + y),
    );
}
