// Where the eye is and how the light is turned. Mirrors `View` in gpu_data.rs and the camera of render-cpu.
struct View {
    eye: vec3<f32>,
    near: f32,
    // Unit; view depth is dot(forward, p - eye).
    forward: vec3<f32>,
    // Most that the picture's format can hold.
    largest: f32,
    // Half the picture's width and height at view depth 1, as world vectors: d = forward + x * right + y * up.
    right: vec3<f32>,
    // 1 where surfaces are white, else 0.
    white: f32,
    up: vec3<f32>,
    // The rows that give clip x and y: right and up divided by their squared lengths.
    clip_x: vec3<f32>,
    clip_y: vec3<f32>,
    light_from_world: mat3x3<f32>,
}

@group(0) @binding(0) var<uniform> view: View;

// Reversed depth with the far plane at infinity: depth = near / w.
fn clip_from_offset(offset: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(dot(view.clip_x, offset), dot(view.clip_y, offset), view.near, dot(view.forward, offset));
}

// What the target can hold; a sun may exceed a 16-bit float.
fn storable(color: vec3<f32>) -> vec3<f32> {
    return clamp(color, vec3<f32>(0.0), vec3<f32>(view.largest));
}
