// Makhotkin's basis. Mirrors `hemisphere::makhotkin` of sh-math.
// A direction of the tangent frame to the values of the functions; below the horizon z counts as 0.
fn hemisphere(direction: vec3<f32>) -> array<f32, 9> {
    let x = direction.x;
    let y = direction.y;
    let z = max(direction.z, 0.0);
    let root = sqrt(z);
    let above = 1.0 + z;
    let lobe = 0.977205024 * z / sqrt(above);
    let flat = 4.370193722 * z * root / above;
    let tilted = lobe * (10.0 * z - 6.0);
    return array<f32, 9>(
        0.564189584 * root,
        2.0 * lobe * y,
        0.39894228 * root * (6.0 * z - 4.0),
        2.0 * lobe * x,
        2.0 * flat * x * y,
        tilted * y,
        0.977205024 * root * ((10.0 * z - 12.0) * z + 3.0),
        tilted * x,
        flat * (x - y) * (x + y),
    );
}
