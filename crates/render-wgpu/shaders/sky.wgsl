// The light probe behind the scene. Mirrors `Environment::radiance` of probe-io.
// Needs view.wgsl, equirect.wgsl and fullscreen.wgsl.
struct Lamp {
    // Unit, light frame.
    direction: vec3<f32>,
    // Square of the chord from the centre to the rim: keeps its digits where the cosine of the angle does not.
    chord_squared: f32,
    radiance: vec3<f32>,
}

@group(1) @binding(0) var picture: texture_2d<f32>;
@group(1) @binding(1) var<storage, read> lamps: array<Lamp>;

@fragment
fn draw_sky(at: Fullscreen) -> @location(0) vec4<f32> {
    let world = view.forward + at.screen.x * view.right + at.screen.y * view.up;
    let direction = normalize(view.light_from_world * world);
    return vec4<f32>(storable(pictured(direction) + lamplight(direction)), 1.0);
}

fn pictured(direction: vec3<f32>) -> vec3<f32> {
    let taps = equirect_taps(direction, vec2<i32>(textureDimensions(picture)));
    let a = textureLoad(picture, taps.upper.xz, 0).rgb;
    let b = textureLoad(picture, taps.upper.yz, 0).rgb;
    let c = textureLoad(picture, taps.lower.xz, 0).rgb;
    let d = textureLoad(picture, taps.lower.yz, 0).rgb;
    return mix(mix(a, b, taps.weight.x), mix(c, d, taps.weight.x), taps.weight.y);
}

fn lamplight(direction: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < arrayLength(&lamps); i++) {
        let chord = direction - lamps[i].direction;
        sum += select(vec3<f32>(0.0), lamps[i].radiance, dot(chord, chord) <= lamps[i].chord_squared);
    }
    return sum;
}
