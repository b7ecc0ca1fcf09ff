// The basis of Half-Life 2. Mirrors `hemisphere::hl2` of sh-math.
// A direction of the tangent frame to the values of the functions; below the horizon z counts as 0.
fn hemisphere(direction: vec3<f32>) -> array<f32, 9> {
    let x = direction.x;
    let y = direction.y;
    let z = max(direction.z, 0.0);
    let side = 0.282094792 * x;
    let across = 0.488602512 * y;
    let up = 0.39894228 * z;
    return array<f32, 9>(up - side - across, up - side + across, up + 2.0 * side, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
}
