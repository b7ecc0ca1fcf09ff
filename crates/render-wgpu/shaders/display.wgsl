// Tone curve and sRGB encoding. Mirrors `display` of render-cpu; docs/shading.md, Picture 4 and 5.
// Needs fullscreen.wgsl and tone.wgsl.
override curve: u32 = CURVE_NONE;
// What the target stores: 0 sRGB values, 1 display values that the target encodes, 2 linear radiance. As `Encoding`.
override encoding: u32 = 0u;

@group(0) @binding(0) var picture: texture_2d<f32>;

@fragment
fn display(at: Fullscreen) -> @location(0) vec4<f32> {
    let color = textureLoad(picture, vec2<i32>(at.clip.xy), 0).rgb;
    if encoding == 2u {
        return vec4<f32>(color, 1.0);
    }
    return vec4<f32>(displayed(color.r), displayed(color.g), displayed(color.b), 1.0);
}

fn displayed(radiance: f32) -> f32 {
    let value = saturate(tone(curve, radiance));
    if encoding == 1u {
        return value;
    }
    return srgb(value);
}
