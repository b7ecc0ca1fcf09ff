// Mirrored light of surfaces without gloss: the prefiltered probe by how open the surface is, and of the rest what diffuse light has more than
// the open share of the probe gives, up to its mean.
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
    let open = saturate(at.lit.w);
    let direction = view.light_from_world * (2.0 * cosine * normal - to_eye);
    var light = reflected(normalize(direction), point.roughness) * open;
    if open < 1.0 {
        let beyond = lit - reflected(normalize(view.light_from_world * plain), 1.0) * open;
        light += clamp(beyond, vec3<f32>(0.0), lit * (1.0 - open));
    }
    return light * returned(point, cosine);
}
