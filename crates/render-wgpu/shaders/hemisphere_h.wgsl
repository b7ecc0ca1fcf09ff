// The H-basis. Mirrors `hemisphere::h` of sh-math.
// A direction of the tangent frame to the values of the functions; below the horizon z counts as 0.
fn hemisphere(direction: vec3<f32>) -> array<f32, 9> {
    let x = direction.x;
    let y = direction.y;
    let z = max(direction.z, 0.0);
    return array<f32, 9>(
        0.39894228,
        0.690988299 * y,
        0.690988299 * (2.0 * z - 1.0),
        0.690988299 * x,
        1.545096808 * x * y,
        0.772548404 * (x - y) * (x + y),
        0.0,
        0.0,
        0.0,
    );
}
