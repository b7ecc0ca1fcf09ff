// Diffuse surfaces: textures, masks, opacity. Mirrors the surface shading of render-cpu; docs/shading.md, Surface 1 to 5.
// Needs view.wgsl, and `diffuse_light` of vertex_light.wgsl, sheet.wgsl or transfer.wgsl.
struct Slot {
    // Rows of the transform of (u, v, 1); the fourth of the first is 1 for the second set of coordinates.
    u: vec4<f32>,
    v: vec4<f32>,
}

struct Material {
    base_color: vec4<f32>,
    emissive: vec3<f32>,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    cutoff: f32,
    transmission: f32,
    base: Slot,
    metallic_roughness: Slot,
    normal: Slot,
    glow: Slot,
}

// What the material holds: branches on these cost nothing, the pipeline is built without them.
override base_textured: bool = false;
override metallic_roughness_textured: bool = false;
override normal_textured: bool = false;
override glow_textured: bool = false;
override masked: bool = false;
// Drawn over what lies behind.
override blended: bool = false;
// Alpha is coverage.
override fades: bool = false;
// The base colour is shown as it is, whatever the light.
override unlit: bool = false;

@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var metallic_roughness_texture: texture_2d<f32>;
@group(1) @binding(3) var normal_texture: texture_2d<f32>;
@group(1) @binding(4) var glow_texture: texture_2d<f32>;
@group(1) @binding(5) var base_sampler: sampler;
@group(1) @binding(6) var metallic_roughness_sampler: sampler;
@group(1) @binding(7) var normal_sampler: sampler;
@group(1) @binding(8) var glow_sampler: sampler;

// Depth of the fragment along the view, for levels of detail.
var<private> view_depth: f32 = 1.0;

struct Diffuse {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) lit: vec3<f32>,
    // Both sets of texture coordinates.
    @location(1) uv: vec4<f32>,
    @location(2) color: vec4<f32>,
}

@vertex
fn place_diffuse(
    @location(0) position: vec3<f32>,
    @location(1) lit: vec3<f32>,
    @location(2) uv0: vec2<f32>,
    @location(3) uv1: vec2<f32>,
    @location(4) color: vec4<f32>,
) -> Diffuse {
    return Diffuse(clip_from_offset(position - view.eye), lit, vec4<f32>(uv0, uv1), color);
}

@fragment
fn draw_diffuse(at: Diffuse) -> @location(0) vec4<f32> {
    view_depth = 1.0 / at.clip.w;
    let point = surface(at.uv, at.color);
    return composite(point, max(diffuse_light(at.lit, at.uv), vec3<f32>(0.0)), vec3<f32>(0.0), glow(at.uv));
}

// Depth alone: only a mask looks at the surface.
@fragment
fn cut_diffuse(at: Diffuse) {
    _ = surface(at.uv, at.color);
}

struct Point {
    base: vec4<f32>,
    metallic: f32,
    roughness: f32,
}

// The material at a point; the point does not exist where a mask cuts it out.
fn surface(uv: vec4<f32>, color: vec4<f32>) -> Point {
    var point = Point(material.base_color * color, material.metallic, material.roughness);
    if base_textured {
        point.base *= textureSampleLevel(base_texture, base_sampler, slot_uv(material.base, uv), 0.0);
    }
    if masked && point.base.a < material.cutoff {
        discard;
    }
    if metallic_roughness_textured {
        let place = slot_uv(material.metallic_roughness, uv);
        let texel = textureSampleLevel(metallic_roughness_texture, metallic_roughness_sampler, place, 0.0);
        point.metallic *= texel.b;
        point.roughness *= texel.g;
    }
    point.metallic = saturate(point.metallic);
    point.roughness = saturate(point.roughness);
    if view.white > 0.5 {
        return Point(vec4<f32>(vec3<f32>(1.0), point.base.a), 0.0, point.roughness);
    }
    return point;
}

fn slot_uv(slot: Slot, uv: vec4<f32>) -> vec2<f32> {
    let place = vec3<f32>(select(uv.xy, uv.zw, slot.u.w > 0.5), 1.0);
    return vec2<f32>(dot(slot.u.xyz, place), dot(slot.v.xyz, place));
}

// What the normal map says in the tangent frame, not unit.
fn bend(uv: vec4<f32>) -> vec3<f32> {
    let texel = textureSampleLevel(normal_texture, normal_sampler, slot_uv(material.normal, uv), 0.0);
    return (2.0 * texel.xyz - 1.0) * vec3<f32>(material.normal_scale, material.normal_scale, 1.0);
}

// `v` made unit, or `other` made unit where `v` is too short to have a direction.
fn unit_or(v: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    return normalize(select(other, v, length(v) >= 1e-12));
}

fn glow(uv: vec4<f32>) -> vec3<f32> {
    if glow_textured {
        return material.emissive * textureSampleLevel(glow_texture, glow_sampler, slot_uv(material.glow, uv), 0.0).rgb;
    }
    return material.emissive;
}

// Premultiplied: the share (1 - alpha) of what lies behind is added by the blend stage. `lit` is not negative.
fn composite(point: Point, lit: vec3<f32>, specular: vec3<f32>, emission: vec3<f32>) -> vec4<f32> {
    var diffuse = lit * point.base.rgb * (1.0 - point.metallic);
    var gloss = specular + emission;
    if unlit {
        diffuse = point.base.rgb;
        gloss = vec3<f32>(0.0);
    }
    if blended {
        let coverage = select(1.0, saturate(point.base.a), fades);
        let alpha = coverage * (1.0 - material.transmission);
        return vec4<f32>(storable(alpha * diffuse + coverage * gloss), alpha);
    }
    return vec4<f32>(storable(diffuse + gloss), 1.0);
}
