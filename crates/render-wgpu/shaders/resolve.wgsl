// Mean of the samples of each pixel, times the exposure. Mirrors `resolve` of render-cpu; docs/shading.md, Picture 1 and 2.
// Needs fullscreen.wgsl and post.wgsl.
@group(0) @binding(0) var<uniform> post: Post;
@group(0) @binding(1) var samples: texture_2d<f32>;

@fragment
fn resolve(at: Fullscreen) -> @location(0) vec4<f32> {
    let first = vec2<u32>(at.clip.xy) * post.supersample;
    var sum = vec3<f32>(0.0);
    for (var y = 0u; y < post.supersample; y++) {
        for (var x = 0u; x < post.supersample; x++) {
            sum += textureLoad(samples, first + vec2<u32>(x, y), 0).rgb;
        }
    }
    let exposed = sum * post.exposure / f32(post.supersample * post.supersample);
    return vec4<f32>(min(exposed, vec3<f32>(post.largest)), 1.0);
}
