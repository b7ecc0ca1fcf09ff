// Diffuse light of surfaces without a light map: that of the vertices.
fn diffuse_light(lit: vec3<f32>, uv: vec4<f32>) -> vec3<f32> {
    return lit;
}
