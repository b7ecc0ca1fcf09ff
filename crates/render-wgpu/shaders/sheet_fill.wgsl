// Brings the coefficients of a light map into the basis that is drawn, and into the texture that surfaces read.
// Mirrors `Lit::changed` of coeff-io. Runs once per light and basis, not per frame.
struct Strip {
    // Texels along u.
    width: u32,
    // Rows of the strip and where they begin on the sheet.
    rows: u32,
    first_row: u32,
    // Functions of the basis that the file holds.
    stored: u32,
}

@group(0) @binding(0) var<uniform> strip: Strip;
// [drawn][stored]
@group(0) @binding(1) var<storage, read> change: array<f32>;
// [stored][row][column][channel]
@group(0) @binding(2) var<storage, read> lit: array<f32>;
@group(0) @binding(3) var sheet: texture_storage_2d_array<rgba16float, write>;

// The most that a 16-bit float holds.
const LARGEST: f32 = 65504.0;

@compute @workgroup_size(8, 8)
fn fill(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= strip.width || id.y >= strip.rows {
        return;
    }
    let plane = strip.width * strip.rows;
    let texel = id.y * strip.width + id.x;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < strip.stored; k++) {
        let first = 3u * (k * plane + texel);
        sum += change[id.z * strip.stored + k] * vec3<f32>(lit[first], lit[first + 1u], lit[first + 2u]);
    }
    let held = clamp(sum, vec3<f32>(-LARGEST), vec3<f32>(LARGEST));
    textureStore(sheet, vec2<u32>(id.x, id.y + strip.first_row), id.z, vec4<f32>(held, 1.0));
}
