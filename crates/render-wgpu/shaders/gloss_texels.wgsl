// Mirrored light of surfaces with gloss in their transfer texture: evaluated at the fragment.
// Needs shine.wgsl, gloss.wgsl, transfer.wgsl and `arriving` of one of the ways.

// What arrives, kept once per light: a layer per function, RGB and visibility; or, where products are made at the fragment, bounces alone.
@group(3) @binding(8) var kept: texture_2d_array<f32>;

fn kept_sums(lobe: Lobe, uv: vec2<f32>, level: f32) -> vec4<f32> {
    var values = lobe.values;
    var sums = vec4<f32>(0.0);
    for (var k = 0u; k < COUNT; k++) {
        sums += values[k] * textureSampleLevel(kept, transfer_sampler, uv, k, level);
    }
    return sums;
}

fn specular_light(
    point: Point,
    normal: vec3<f32>,
    plain: vec3<f32>,
    to_eye: vec3<f32>,
    at: Shiny,
    lit: vec3<f32>,
) -> vec3<f32> {
    var own = point;
    own.roughness = gloss_roughness(point.roughness);
    let cosine = dot(normal, to_eye);
    let mirrored = normalize(2.0 * cosine * normal - to_eye);
    let lobe = lobe_about(mirrored, plain, own.roughness);
    let sums = mirrored_sums(arriving(lobe, at.uv.zw, detail()), lobe.energy);
    let light = mirrored_light(sums, lobe, mirrored, plain, own.roughness, lit);
    return light * returned(own, cosine);
}
