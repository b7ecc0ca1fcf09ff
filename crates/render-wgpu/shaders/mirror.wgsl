// Mirrored light of surfaces without gloss: the prefiltered probe, dimmed by how open the surface is.
// Needs shine.wgsl.
fn specular_light(point: Point, normal: vec3<f32>, plain: vec3<f32>, to_eye: vec3<f32>, at: Shiny) -> vec3<f32> {
    return mirrored(point, normal, to_eye) * saturate(at.lit.w);
}
