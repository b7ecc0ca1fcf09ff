// What arrives at a texel was kept when the light was put on.
fn arriving(lobe: Lobe, uv: vec2<f32>, level: f32) -> vec4<f32> {
    return kept_sums(lobe, uv, level);
}
