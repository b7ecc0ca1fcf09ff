// Diffuse light of surfaces with a light map. Mirrors `Sheet` of render-cpu; docs/shading.md, Light maps.
// Needs surface.wgsl and one hemisphere_*.wgsl.

// Functions that are drawn: the first of those of the basis.
override functions: u32 = 1u;

// One layer of coefficients per function.
@group(3) @binding(0) var sheet: texture_2d_array<f32>;
@group(3) @binding(1) var sheet_sampler: sampler;

fn diffuse_light(lit: vec3<f32>, uv: vec4<f32>) -> vec3<f32> {
    var values = hemisphere(tangent_normal(uv));
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < functions; k++) {
        sum += values[k] * textureSampleLevel(sheet, sheet_sampler, uv.zw, k, 0.0).rgb;
    }
    return sum;
}

fn tangent_normal(uv: vec4<f32>) -> vec3<f32> {
    let straight = vec3<f32>(0.0, 0.0, 1.0);
    if !normal_textured {
        return straight;
    }
    return unit_or(bend(uv), straight);
}
