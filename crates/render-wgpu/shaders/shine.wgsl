// Surfaces that mirror the light probe. Mirrors the specular term of render-cpu; docs/shading.md, Surface 6.
// Needs view.wgsl, equirect.wgsl, brdf.wgsl, surface.wgsl and bend.wgsl, and `specular_light` of mirror.wgsl or gloss_texels.wgsl.

// One layer per level of roughness, all of one size; read texel by texel so that columns wrap exactly.
@group(2) @binding(0) var reflection: texture_2d_array<f32>;

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
    let plain = unit_or(at.normal, geometric);
    let diffuse = bent_light(diffuse_light(at.lit.rgb, at.uv), at.heading, plain, normal);
    let lit = max(diffuse, vec3<f32>(0.0));
    let specular = specular_light(point, normal, plain, to_eye, at, lit);
    return composite(point, lit * kept_light(dot(normal, to_eye)), specular, glow(at.uv));
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

// Light of the probe around a unit direction (light frame), blurred as roughness asks.
fn reflected(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let taps = equirect_taps(direction, vec2<i32>(textureDimensions(reflection)));
    let top = i32(textureNumLayers(reflection)) - 1;
    let level = roughness * f32(top);
    let low = min(i32(level), max(top - 1, 0));
    let high = min(low + 1, top);
    return mix(reflection_level(taps, low), reflection_level(taps, high), level - f32(low));
}

struct Reflected {
    // Of what lies above the surface.
    light: vec3<f32>,
    // Of what lies below it, where the lobe dips in.
    below: vec3<f32>,
}

// Light of the probe around a unit direction (world), above a surface of unit normal `plain`.
fn reflected_above(mirrored: vec3<f32>, plain: vec3<f32>, roughness: f32) -> Reflected {
    let cosine = dot(plain, mirrored);
    let share = lobe_above(roughness, cosine);
    let whole = reflected(normalize(view.light_from_world * mirrored), roughness);
    let deep = mirrored - plain * (cosine + 0.15 + 1.5 * roughness * roughness);
    // A lamp below must not put out what a lobe that hardly dips sees above.
    let below = min(reflected(normalize(view.light_from_world * deep), roughness), 4.0 * whole);
    return Reflected(max((whole - (1.0 - share) * below) / share, vec3<f32>(0.0)), below);
}

fn reflection_level(taps: Taps, level: i32) -> vec3<f32> {
    let a = textureLoad(reflection, taps.upper.xz, level, 0).rgb;
    let b = textureLoad(reflection, taps.upper.yz, level, 0).rgb;
    let c = textureLoad(reflection, taps.lower.xz, level, 0).rgb;
    let d = textureLoad(reflection, taps.lower.yz, level, 0).rgb;
    return mix(mix(a, b, taps.weight.x), mix(c, d, taps.weight.x), taps.weight.y);
}
