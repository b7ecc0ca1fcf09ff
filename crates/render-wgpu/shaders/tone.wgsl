// Display values from radiance, per channel. Mirrors the tone curves of render-cpu; see docs/shading.md, Picture 4 and 5.
const CURVE_NONE: u32 = 0u;
const CURVE_REINHARD: u32 = 1u;
const CURVE_FILMIC: u32 = 2u;

// From here on every curve is at its limit of 1 within an 8-bit step; larger values, infinity too, count as this.
const BRIGHTEST: f32 = 1e6;

fn reinhard(x: f32) -> f32 {
    return x / (1.0 + x);
}

// Narkowicz 2016, fit of the ACES curve.
fn filmic(x: f32) -> f32 {
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

fn tone(curve: u32, radiance: f32) -> f32 {
    // A comparison with NaN is false, so NaN counts as 0, as negative values do.
    let x = select(0.0, min(radiance, BRIGHTEST), radiance > 0.0);
    switch curve {
        case CURVE_REINHARD: { return reinhard(x); }
        case CURVE_FILMIC: { return filmic(x); }
        default: { return min(x, 1.0); }
    }
}

fn srgb(x: f32) -> f32 {
    return select(1.055 * pow(x, 1.0 / 2.4) - 0.055, 12.92 * x, x <= 0.0031308);
}
