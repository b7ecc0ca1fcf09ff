// Directions on an equirectangular picture: +z at the centre, +x to the left of it, +y up.
// Mirrors the equirectangular layout of probe-io.
const PI: f32 = 3.14159265358979;

// Texel coordinates (column, row) of a unit direction, texel centres at half-integers.
fn equirect_position(direction: vec3<f32>, size: vec2<f32>) -> vec2<f32> {
    let longitude = atan2(-direction.x, direction.z);
    // From the pole; well conditioned everywhere, unlike acos(y).
    let polar = atan2(length(direction.xz), direction.y);
    return vec2<f32>(longitude / (2.0 * PI) + 0.5, polar / PI) * size;
}

// The four texels around a direction: columns wrap, rows go on over the poles.
struct Taps {
    // Columns and row of the upper pair, then of the lower pair.
    upper: vec3<i32>,
    lower: vec3<i32>,
    // How far the direction lies towards the right column and the lower row.
    weight: vec2<f32>,
}

fn equirect_taps(direction: vec3<f32>, size: vec2<i32>) -> Taps {
    let position = equirect_position(direction, vec2<f32>(size)) - 0.5;
    let low = floor(position);
    let first = vec2<i32>(low);
    return Taps(equirect_pair(first, size), equirect_pair(first + vec2<i32>(0, 1), size), position - low);
}

// Columns `first.x` and `first.x + 1` and the row, brought onto the picture.
fn equirect_pair(first: vec2<i32>, size: vec2<i32>) -> vec3<i32> {
    let row = clamp(first.y, 0, size.y - 1);
    let turned = first.x + select(size.x / 2, 0, row == first.y);
    let columns = (vec2<i32>(turned, turned + 1) + 2 * size.x) % size.x;
    return vec3<i32>(columns, row);
}
