// What glTF's surfaces return of a white sky. Mirrors `sh_math::brdf`, which says where the numbers come from; docs/shading.md, Surface 6.
// One matrix per power of the roughness; columns for 1, h, h^5 and h^8 with h = 1 - cosine, rows for powers of
// u = alpha / (alpha + cosine).
const BRDF_WHITE_0 = mat4x4<f32>(1.0, -1.284, -13.606, 10.18, 0.0, 1.025, -2.369, -9.968, 0.001, -1.392, 20.213, 2.203, -0.002, 1.65, -5.062, -1.634);
const BRDF_WHITE_1 = mat4x4<f32>(0.117, 8.95, -16.426, -7.473, -0.018, -0.008, 48.731, -17.998, -1.417, -17.749, -17.165, 11.189, 1.391, 4.126, 1.235, 2.664);
const BRDF_WHITE_2 = mat4x4<f32>(-0.635, 1.674, 12.911, -7.238, -0.22, -6.286, -12.746, 7.508, 15.144, 1.73, -4.512, -6.068, 1.479, 1.645, -7.772, 3.257);
const BRDF_BIAS_0 = mat4x4<f32>(0.0, -0.706, -4.903, 0.192, 0.0, -0.05, -7.249, 1.173, 1.001, -3.534, 7.53, -4.614, -0.001, 4.169, 4.732, 3.096);
const BRDF_BIAS_1 = mat4x4<f32>(0.014, 1.479, 1.958, -2.707, 0.168, 10.236, 11.682, -14.919, -1.469, -20.121, 10.623, 10.018, 1.535, 1.847, -10.369, -1.706);
const BRDF_BIAS_2 = mat4x4<f32>(0.445, 1.101, -1.245, -0.264, -1.67, -8.858, 10.662, -1.142, 18.236, 1.101, -10.553, -15.143, 7.577, -3.025, -0.115, 3.849);

fn environment_brdf(roughness: f32, cosine: f32) -> vec2<f32> {
    let alpha = roughness * roughness;
    let u = alpha / max(alpha + cosine, 1e-6);
    let h = 1.0 - cosine;
    let fifth = h * h * h * h * h;
    let shadow = vec4<f32>(1.0, u, u * u, u * u * u);
    let grazing = vec4<f32>(1.0, h, fifth, fifth * h * h * h);
    let white = BRDF_WHITE_0 + roughness * BRDF_WHITE_1 + alpha * BRDF_WHITE_2;
    let rest = BRDF_BIAS_0 + roughness * BRDF_BIAS_1 + alpha * BRDF_BIAS_2;
    let bias = saturate(dot(shadow, rest * grazing));
    return vec2<f32>(saturate(dot(shadow, white * grazing) - bias), bias);
}

// Share of a lobe that lies above a surface of whose normal its direction has the cosine.
fn lobe_above(roughness: f32, cosine: f32) -> f32 {
    let x = saturate(cosine);
    let alpha = roughness * roughness;
    let slopes = (1.0 - alpha) * (1.0 + 2.6 * alpha);
    let width = 4.0 * alpha * alpha;
    return 0.5 + 0.5 * x * sqrt((slopes + width) / max(slopes * x * x + width, 1e-12));
}

// Share of diffuse light that the mirror of a dielectric takes.
fn diffuse_loss(cosine: f32) -> f32 {
    let x = cosine;
    let grazing = 0.02816 + x * (-0.0798 + x * (0.08627 + x * (-0.0434 + x * 0.00886)));
    return 0.04 + 0.96 * grazing;
}
