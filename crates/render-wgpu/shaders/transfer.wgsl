// Diffuse light of surfaces with a transfer texture. Mirrors render-cpu; docs/shading.md, Transfer textures.
// Needs surface.wgsl and gloss_frame.wgsl.
struct Detail {
    // Texels per metre of the finest level.
    density: f32,
    // The last level.
    last: f32,
    // Fills up the structure.
    unused: vec2<f32>,
}

@group(3) @binding(5) var transfer_sampler: sampler;
@group(3) @binding(6) var<uniform> sheet_detail: Detail;
@group(3) @binding(7) var transfer_light: texture_2d_array<f32>;

// The level of detail at the fragment: no derivatives, the same on every machine.
fn detail() -> f32 {
    let texels = view_depth * gloss_frame.pixel * sheet_detail.density;
    return min(max(log2(max(texels, 1e-12)), gloss_frame.level), sheet_detail.last);
}

fn diffuse_light(lit: vec3<f32>, uv: vec4<f32>) -> vec3<f32> {
    return textureSampleLevel(transfer_light, transfer_sampler, uv.zw, 0, detail()).rgb;
}
