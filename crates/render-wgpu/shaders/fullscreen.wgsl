// A triangle that covers the picture, at the depth of infinity.
struct Fullscreen {
    @builtin(position) clip: vec4<f32>,
    // -1..1, y up.
    @location(0) screen: vec2<f32>,
}

@vertex
fn cover(@builtin(vertex_index) index: u32) -> Fullscreen {
    let screen = vec2<f32>(f32(i32(index & 1u) * 4 - 1), f32(i32(index >> 1u) * 4 - 1));
    return Fullscreen(vec4<f32>(screen, 0.0, 1.0), screen);
}
