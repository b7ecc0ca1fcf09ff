// What is the same for all surfaces with gloss or transfer textures in a frame.
struct GlossFrame {
    // Size of a sample at view depth 1.
    pixel: f32,
    // One roughness for all that shines; negative where materials have their own.
    roughness: f32,
    // The finest level of transfer textures that is shown.
    level: f32,
    // 1 where what the lobe holds beyond the bands comes from the prefiltered probe.
    tail: f32,
}

@group(3) @binding(0) var<uniform> gloss_frame: GlossFrame;
