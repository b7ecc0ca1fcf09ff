// Surfaces with normals: those that shine or whose light a normal map bends. Mirrors render-cpu; docs/shading.md, Bent light of vertices.
// Needs view.wgsl and surface.wgsl.

// Whether a normal map bends the light of the vertices.
override bends_light: bool = false;

// What keeps the answer of a lamp that grazes the surface finite.
const GRAZING: f32 = 0.05;
// Cosine of a lamp above which it is believed.
const BELIEVED: f32 = 0.25;

struct Shiny {
    @invariant @builtin(position) clip: vec4<f32>,
    // The fourth is openness.
    @location(0) lit: vec4<f32>,
    @location(1) uv: vec4<f32>,
    @location(2) color: vec4<f32>,
    // World position relative to the eye.
    @location(3) offset: vec3<f32>,
    @location(4) normal: vec3<f32>,
    @location(5) tangent: vec4<f32>,
    // Luminance of the light times the direction that it comes from.
    @location(6) heading: vec3<f32>,
}

@vertex
fn place_shiny(
    @location(0) position: vec3<f32>,
    @location(1) lit: vec3<f32>,
    @location(2) uv0: vec2<f32>,
    @location(3) uv1: vec2<f32>,
    @location(4) color: vec4<f32>,
    @location(5) normal: vec3<f32>,
    @location(6) tangent: vec4<f32>,
    @location(7) openness: f32,
    @location(8) heading: vec3<f32>,
) -> Shiny {
    let offset = position - view.eye;
    let clip = clip_from_offset(offset);
    return Shiny(clip, vec4<f32>(lit, openness), vec4<f32>(uv0, uv1), color, offset, normal, tangent, heading);
}

// Depth alone: only a mask looks at the surface.
@fragment
fn cut_shiny(at: Shiny) {
    _ = surface(at.uv, at.color);
}

fn shading_normal(at: Shiny, geometric: vec3<f32>) -> vec3<f32> {
    let plain = unit_or(at.normal, geometric);
    if !normal_textured {
        return plain;
    }
    let bent = bend(at.uv);
    let handed = select(-1.0, 1.0, at.tangent.w >= 0.0);
    let bitangent = handed * cross(at.normal, at.tangent.xyz);
    return unit_or(at.tangent.xyz * bent.x + bitangent * bent.y + at.normal * bent.z, plain);
}

// The light of a surface with the unit normal `plain` on the unit normal `bent`: as the sum of a grey sky and a lamp.
fn bent_light(light: vec3<f32>, heading: vec3<f32>, plain: vec3<f32>, bent: vec3<f32>) -> vec3<f32> {
    let whole = dot(light, vec3<f32>(0.2126, 0.7152, 0.0722));
    if !bends_light || whole <= 0.0 {
        return light;
    }
    let mean = heading / whole;
    let spread = sky_share(mean, plain);
    let lamp = mean - plain * (2.0 / 3.0 * spread);
    let towards = normalize(select(plain, lamp, length(lamp) > 1e-6));
    let share = (1.0 - spread) * saturate(dot(towards, plain) / BELIEVED);
    let of_lamp = (max(dot(towards, bent), 0.0) + GRAZING) / (max(dot(towards, plain), 0.0) + GRAZING);
    let of_sky = 0.5 * (1.0 + dot(plain, bent));
    return light * ((1.0 - share) * of_sky + share * of_lamp);
}

// The share of the sky: |mean - 2/3 s plain| = 1 - s.
fn sky_share(mean: vec3<f32>, plain: vec3<f32>) -> f32 {
    let c = max(1.0 - dot(mean, mean), 0.0);
    let b = 2.0 - 4.0 / 3.0 * clamp(dot(mean, plain), -1.0, 1.0);
    return clamp(2.0 * c / (b + sqrt(max(b * b - 20.0 / 9.0 * c, 0.0))), 0.0, 1.0);
}
