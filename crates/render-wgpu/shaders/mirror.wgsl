// Mirrored light of surfaces without gloss: the prefiltered probe, dimmed by how open the surface is.
// Needs shine.wgsl.
fn specular_light(
    point: Point,
    normal: vec3<f32>,
    plain: vec3<f32>,
    to_eye: vec3<f32>,
    at: Shiny,
    lit: vec3<f32>,
) -> vec3<f32> {
    let cosine = dot(normal, to_eye);
    let direction = view.light_from_world * (2.0 * cosine * normal - to_eye);
    let light = reflected(normalize(direction), point.roughness) * saturate(at.lit.w);
    return light * returned(point, cosine);
}
