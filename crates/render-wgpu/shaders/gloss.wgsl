// Mirrored light by direction. Mirrors `gloss` of render-cpu; docs/shading.md, Gloss.
// Needs gloss_frame.wgsl, and BANDS, COUNT, `harmonics` and `open_energy` that gloss_text.rs writes.

// Rows of the table of factors, by roughness.
const LOBE_ROWS: u32 = 65u;

// [row][band]
@group(3) @binding(1) var<storage, read> lobe_factors: array<f32>;
// The turned light, the first 2 BANDS - 1 bands.
@group(3) @binding(2) var<storage, read> gloss_light: array<vec4<f32>>;

struct Lobe {
    // Per function: the factor of its band times its value in the mirror direction.
    values: array<f32, COUNT>,
    // What an open white hemisphere gives.
    energy: f32,
}

fn lobe_about(mirrored: vec3<f32>, plain: vec3<f32>, roughness: f32) -> Lobe {
    let place = roughness * f32(LOBE_ROWS - 1u);
    let low = min(u32(place), LOBE_ROWS - 2u);
    let part = place - f32(low);
    var factors: array<f32, BANDS>;
    for (var l = 0u; l < BANDS; l++) {
        let first = lobe_factors[low * BANDS + l];
        factors[l] = first + part * (lobe_factors[(low + 1u) * BANDS + l] - first);
    }
    var lobe = Lobe(harmonics(mirrored), open_energy(factors, max(dot(plain, mirrored), 0.0)));
    var k = 0u;
    for (var l = 0u; l < BANDS; l++) {
        for (var m = 0u; m < 2u * l + 1u; m++) {
            lobe.values[k] *= factors[l];
            k++;
        }
    }
    return lobe;
}

// Sums of a lobe with what arrives become mirrored light, and the open share of the lobe in the fourth.
fn mirrored_sums(sums: vec4<f32>, energy: f32) -> vec4<f32> {
    return vec4<f32>(max(sums.rgb, vec3<f32>(0.0)) / energy, saturate(sums.a / energy));
}

// What is mirrored, of the sums of a lobe: where it is all open that is the prefiltered light, of which the bands know less; the more it closes the more
// the bands count, and of the prefiltered light what they lack.
fn mirrored_light(
    sums: vec4<f32>,
    lobe: Lobe,
    mirrored: vec3<f32>,
    plain: vec3<f32>,
    roughness: f32,
    lit: vec3<f32>,
) -> vec3<f32> {
    if gloss_frame.tail == 0.0 {
        return sums.rgb;
    }
    var values = lobe.values;
    var held = vec3<f32>(0.0);
    for (var k = 0u; k < COUNT; k++) {
        held += values[k] * gloss_light[k].rgb;
    }
    let whole = reflected_above(mirrored, plain, roughness);
    held = (held - (1.0 - lobe.energy) * whole.below) / lobe.energy;
    let part = min(4.0 * (1.0 - sums.a), 1.0);
    let beyond = sums.rgb - sums.a * held;
    // What surfaces send counts in full; no more than they can be thought to send, lest bands ring about lamps.
    let sent = clamp(beyond, vec3<f32>(0.0), lit * (1.0 - sums.a));
    return max(sums.a * whole.light + part * beyond + (1.0 - part) * sent, vec3<f32>(0.0));
}

fn gloss_roughness(own: f32) -> f32 {
    return select(own, gloss_frame.roughness, gloss_frame.roughness >= 0.0);
}
