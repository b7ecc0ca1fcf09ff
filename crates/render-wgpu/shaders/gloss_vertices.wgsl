// Mirrored light of surfaces with gloss at their vertices: evaluated there and interpolated; the tail is taken at the fragment.
// Needs shine.wgsl, gloss.wgsl and `arriving_at` of one of the ways.
struct Glossy {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) lit: vec4<f32>,
    @location(1) uv: vec4<f32>,
    @location(2) color: vec4<f32>,
    @location(3) offset: vec3<f32>,
    @location(4) normal: vec3<f32>,
    @location(5) tangent: vec4<f32>,
    // Mirrored light, and the open share of the lobe.
    @location(6) gloss: vec4<f32>,
    @location(7) heading: vec3<f32>,
}

// What arrives, kept once per light, in halves: RGB and visibility per function; or bounces alone.
@group(3) @binding(5) var<storage, read> kept_rows: array<vec2<u32>>;

@vertex
fn place_glossy(
    @location(0) position: vec3<f32>,
    @location(1) lit: vec3<f32>,
    @location(2) uv0: vec2<f32>,
    @location(3) uv1: vec2<f32>,
    @location(4) color: vec4<f32>,
    @location(5) normal: vec3<f32>,
    @location(6) tangent: vec4<f32>,
    @location(7) openness: f32,
    @location(8) heading: vec3<f32>,
    @location(9) row: u32,
) -> Glossy {
    let offset = position - view.eye;
    let uv = vec4<f32>(uv0, uv1);
    let plain = unit_or(normal, vec3<f32>(0.0, 1.0, 0.0));
    let to_eye = normalize(-offset);
    let mirrored = normalize(2.0 * dot(plain, to_eye) * plain - to_eye);
    let lobe = lobe_about(mirrored, plain, roughness_at(uv));
    let gloss = mirrored_sums(arriving_at(lobe, row), lobe.energy);
    let clip = clip_from_offset(offset);
    return Glossy(clip, vec4<f32>(lit, openness), uv, color, offset, normal, tangent, gloss, heading);
}

fn roughness_at(uv: vec4<f32>) -> f32 {
    var roughness = material.roughness;
    if metallic_roughness_textured {
        let place = slot_uv(material.metallic_roughness, uv);
        roughness *= textureSampleLevel(metallic_roughness_texture, metallic_roughness_sampler, place, 0.0).g;
    }
    return gloss_roughness(saturate(roughness));
}

fn kept_row_sums(lobe: Lobe, row: u32) -> vec4<f32> {
    var values = lobe.values;
    var sums = vec4<f32>(0.0);
    for (var k = 0u; k < COUNT; k++) {
        let halves = kept_rows[row * COUNT + k];
        sums += values[k] * vec4<f32>(unpack2x16float(halves.x), unpack2x16float(halves.y));
    }
    return sums;
}

@fragment
fn draw_glossy(at: Glossy) -> @location(0) vec4<f32> {
    let across = cross(dpdx(at.offset), dpdy(at.offset));
    let point = surface(at.uv, at.color);
    let to_eye = normalize(-at.offset);
    let geometric = across * select(-1.0, 1.0, dot(across, to_eye) > 0.0);
    let shiny = Shiny(at.clip, at.lit, at.uv, at.color, at.offset, at.normal, at.tangent, at.heading);
    let normal = shading_normal(shiny, geometric);
    var own = point;
    own.roughness = gloss_roughness(point.roughness);
    let cosine = dot(normal, to_eye);
    let mirrored = normalize(2.0 * cosine * normal - to_eye);
    let plain = unit_or(at.normal, geometric);
    let lobe = lobe_about(mirrored, plain, own.roughness);
    let diffuse = bent_light(diffuse_light(at.lit.rgb, at.uv), at.heading, plain, normal);
    let lit = max(diffuse, vec3<f32>(0.0));
    let light = mirrored_light(at.gloss, lobe, mirrored, plain, own.roughness, lit);
    return composite(point, lit * kept_light(cosine), light * returned(own, cosine), glow(at.uv));
}

@fragment
fn cut_glossy(at: Glossy) {
    _ = surface(at.uv, at.color);
}

// Mirrored light of fragments of such surfaces is not taken from here.
fn specular_light(
    point: Point,
    normal: vec3<f32>,
    plain: vec3<f32>,
    to_eye: vec3<f32>,
    at: Shiny,
    lit: vec3<f32>,
) -> vec3<f32> {
    return vec3<f32>(0.0);
}
