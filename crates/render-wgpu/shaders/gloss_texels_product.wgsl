// What arrives at a texel is its visibility times the light, made where it is drawn. Needs `lit_sums` of one of the products.

// Whether other surfaces send light: the kept texture holds that.
override bounced: bool = false;

// Four functions to a layer.
@group(3) @binding(9) var visibility: texture_2d_array<f32>;

fn arriving(lobe: Lobe, uv: vec2<f32>, level: f32) -> vec4<f32> {
    var seen: array<f32, COUNT>;
    for (var layer = 0u; layer < (COUNT + 3u) / 4u; layer++) {
        let four = textureSampleLevel(visibility, transfer_sampler, uv, layer, level);
        for (var c = 0u; c < 4u && 4u * layer + c < COUNT; c++) {
            seen[4u * layer + c] = four[c];
        }
    }
    var sums = lit_sums(lobe, seen);
    if bounced {
        sums += vec4<f32>(kept_sums(lobe, uv, level).rgb, 0.0);
    }
    return sums;
}
