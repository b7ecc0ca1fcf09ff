// GGX integrated over a white environment, split into a scale of F0 and a bias. Mirrors `environment_brdf` of render-cpu,
// which says where the numbers come from; docs/shading.md, Surface 6. One row per power of the roughness, columns for
// 1, h and h^4 with h = 1 - cosine.
const BRDF_SCALE = mat3x3<f32>(0.953, 0.253, -1.353, 0.517, -1.658, 3.4, -1.22, 1.728, -1.725);
const BRDF_BIAS = mat3x3<f32>(0.015, -0.113, 1.195, -0.07, 0.504, -2.859, 0.06, -0.42, 1.75);

fn environment_brdf(roughness: f32, cosine: f32) -> vec2<f32> {
    let h = 1.0 - cosine;
    let grazing = vec3<f32>(1.0, h, h * h * h * h);
    let rough = vec3<f32>(1.0, roughness, roughness * roughness);
    return max(vec2<f32>(dot(grazing, BRDF_SCALE * rough), dot(grazing, BRDF_BIAS * rough)), vec2<f32>(0.0));
}
