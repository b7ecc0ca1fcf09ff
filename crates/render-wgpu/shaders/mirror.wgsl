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
    let mirrored = normalize(2.0 * cosine * normal - to_eye);
    let light = reflected_above(mirrored, plain, point.roughness).light * saturate(at.lit.w);
    return light * returned(point, cosine);
}
