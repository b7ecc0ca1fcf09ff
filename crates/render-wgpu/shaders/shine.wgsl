// Surfaces that mirror the light probe. Mirrors the specular term of render-cpu; docs/shading.md, Surface 6.
// Needs view.wgsl, equirect.wgsl, brdf.wgsl and surface.wgsl, and `specular_light` of mirror.wgsl or gloss_texels.wgsl.

// One layer per level of roughness, all of one size; read texel by texel so that columns wrap exactly.
@group(2) @binding(0) var reflection: texture_2d_array<f32>;

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
) -> Shiny {
    let offset = position - view.eye;
    let clip = clip_from_offset(offset);
    return Shiny(clip, vec4<f32>(lit, openness), vec4<f32>(uv0, uv1), color, offset, normal, tangent);
}

@fragment
fn draw_shiny(at: Shiny) -> @location(0) vec4<f32> {
    view_depth = 1.0 / at.clip.w;
    // Derivatives first: they need the neighbours that a mask may end.
    let across = cross(dpdx(at.offset), dpdy(at.offset));
    let point = surface(at.uv, at.color);
    let to_eye = normalize(-at.offset);
    // Backs are not drawn, so the geometric normal looks at the eye.
    let geometric = across * select(-1.0, 1.0, dot(across, to_eye) > 0.0);
    let normal = shading_normal(at, geometric);
    let lit = max(diffuse_light(at.lit.rgb, at.uv), vec3<f32>(0.0));
    let specular = specular_light(point, normal, unit_or(at.normal, geometric), to_eye, at, lit);
    return composite(point, lit * kept_light(dot(normal, to_eye)), specular, glow(at.uv));
}

// Depth alone: only a mask looks at the surface.
@fragment
fn cut_shiny(at: Shiny) {
    _ = surface(at.uv, at.color);
}

// Share of mirrored light that is returned.
fn returned(point: Point, cosine: f32) -> vec3<f32> {
    let f0 = mix(vec3<f32>(0.04), point.base.rgb, point.metallic);
    let albedo = environment_brdf(point.roughness, min(abs(cosine), 1.0));
    return f0 * albedo.x + albedo.y;
}

// Share of diffuse light that the mirror leaves.
fn kept_light(cosine: f32) -> f32 {
    return 1.0 - diffuse_loss(min(abs(cosine), 1.0));
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

// Light of the probe around a unit direction (light frame), blurred as roughness asks.
fn reflected(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let taps = equirect_taps(direction, vec2<i32>(textureDimensions(reflection)));
    let top = i32(textureNumLayers(reflection)) - 1;
    let level = roughness * f32(top);
    let low = min(i32(level), max(top - 1, 0));
    let high = min(low + 1, top);
    return mix(reflection_level(taps, low), reflection_level(taps, high), level - f32(low));
}

fn reflection_level(taps: Taps, level: i32) -> vec3<f32> {
    let a = textureLoad(reflection, taps.upper.xz, level, 0).rgb;
    let b = textureLoad(reflection, taps.upper.yz, level, 0).rgb;
    let c = textureLoad(reflection, taps.lower.xz, level, 0).rgb;
    let d = textureLoad(reflection, taps.lower.yz, level, 0).rgb;
    return mix(mix(a, b, taps.weight.x), mix(c, d, taps.weight.x), taps.weight.y);
}
