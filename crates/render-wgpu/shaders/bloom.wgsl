// A blur pyramid, added up and mixed in. Mirrors `bloom` of render-cpu; docs/shading.md, Picture 3.
// Needs fullscreen.wgsl and post.wgsl.
@group(0) @binding(0) var<uniform> post: Post;
// Down: the finer level. Up and mix: the level of the target's size.
@group(0) @binding(1) var fine: texture_2d<f32>;
@group(0) @binding(2) var coarse: texture_2d<f32>;

// P_{k+1} from P_k: (1, 3, 3, 1) / 8 along both axes.
@fragment
fn bloom_down(at: Fullscreen) -> @location(0) vec4<f32> {
    var weights = array<f32, 4>(0.125, 0.375, 0.375, 0.125);
    let last = vec2<i32>(textureDimensions(fine)) - 1;
    let first = 2 * vec2<i32>(at.clip.xy) - 1;
    var sum = vec3<f32>(0.0);
    for (var y = 0; y < 4; y++) {
        var row = vec3<f32>(0.0);
        for (var x = 0; x < 4; x++) {
            let texel = clamp(first + vec2<i32>(x, y), vec2<i32>(0), last);
            row += weights[x] * textureLoad(fine, texel, 0).rgb;
        }
        sum += weights[y] * row;
    }
    return vec4<f32>(sum, 1.0);
}

// S_k = P_k + up(S_{k+1}).
@fragment
fn bloom_up(at: Fullscreen) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(at.clip.xy);
    return vec4<f32>(textureLoad(fine, texel, 0).rgb + enlarged(texel), 1.0);
}

// (1 - b) P_0 + b up(S_1) / n.
@fragment
fn bloom_mix(at: Fullscreen) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(at.clip.xy);
    let sharp = textureLoad(fine, texel, 0).rgb;
    return vec4<f32>((1.0 - post.bloom) * sharp + post.bloom * enlarged(texel) / post.levels, 1.0);
}

// The coarse level at a fine texel: 3/4 of the nearer and 1/4 of the farther texel along both axes.
fn enlarged(texel: vec2<i32>) -> vec3<f32> {
    let last = vec2<i32>(textureDimensions(coarse)) - 1;
    let near = texel / 2;
    let far = clamp(near + 2 * (texel & vec2<i32>(1)) - 1, vec2<i32>(0), last);
    let a = textureLoad(coarse, near, 0).rgb;
    let b = textureLoad(coarse, vec2<i32>(far.x, near.y), 0).rgb;
    let c = textureLoad(coarse, vec2<i32>(near.x, far.y), 0).rgb;
    let d = textureLoad(coarse, far, 0).rgb;
    return mix(mix(a, b, 0.25), mix(c, d, 0.25), 0.25);
}
