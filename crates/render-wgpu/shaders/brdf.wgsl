// The directional albedo of GGX, split into a scale of F0 and a bias. Mirrors `environment_brdf` of render-cpu.
// Karis, "Physically Based Shading on Mobile" (2014), after Lazarov 2013.
fn environment_brdf(roughness: f32, cosine: f32) -> vec2<f32> {
    let r = vec4<f32>(-1.0, -0.0275, -0.572, 0.022) * roughness + vec4<f32>(1.0, 0.0425, 1.04, -0.04);
    let g = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    return vec2<f32>(r.z - 1.04 * g, r.w + 1.04 * g);
}
