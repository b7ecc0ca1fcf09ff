// Receivers under a light: what is kept of them until the light changes. Mirrors `ArrivingLight` and `DiffuseLight` of coeff-io.
// Runs once per light, not per frame.
struct Rows {
    count: u32,
    // Numbers of what is kept per receiver.
    functions: u32,
    // Vectors of a cluster; coefficients of diffuse transfer.
    rank: u32,
    // Texels along u; channels of diffuse transfer.
    width: u32,
    // First row of the whole in what is stored.
    first: u32,
}

@group(0) @binding(0) var<uniform> rows: Rows;
// [row][function]: RGB, and visibility in the fourth.
@group(0) @binding(1) var<storage, read_write> lit: array<vec4<f32>>;
// Visibility or diffuse transfer [row][number], or weights [row][vector].
@group(0) @binding(2) var<storage, read> numbers: array<f32>;
// The matrix of the light, the products of clusters, the light itself, or rows of radiance.
@group(0) @binding(3) var<storage, read> factors: array<vec4<f32>>;
// Cluster or texel of each row.
@group(0) @binding(4) var<storage, read> index: array<u32>;
@group(0) @binding(5) var texels: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(6) var<storage, read_write> halves: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read_write> radiance: array<f32>;

// The most that a 16-bit float holds.
const LARGEST: f32 = 65504.0;

fn outside(id: vec3<u32>) -> bool {
    return id.x >= rows.count || id.y >= rows.functions;
}

fn held(id: vec3<u32>) -> vec4<f32> {
    return clamp(lit[id.x * rows.functions + id.y], vec4<f32>(-LARGEST), vec4<f32>(LARGEST));
}

@compute @workgroup_size(64)
fn clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    lit[id.x * rows.functions + id.y] = vec4<f32>(0.0);
}

// Visibility times the matrix of the light.
@compute @workgroup_size(64)
fn multiply(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    let first = id.x * rows.functions;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < rows.functions; k++) {
        sum += factors[id.y * rows.functions + k].rgb * numbers[first + k];
    }
    lit[first + id.y] = vec4<f32>(sum, numbers[first + id.y]);
}

// The products of the row's cluster, by its weights.
@compute @workgroup_size(64)
fn combine(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    let first = index[id.x] * (1u + rows.rank);
    var sum = factors[first * rows.functions + id.y];
    for (var v = 0u; v < rows.rank; v++) {
        sum += numbers[id.x * rows.rank + v] * factors[(first + 1u + v) * rows.functions + id.y];
    }
    lit[id.x * rows.functions + id.y] += sum;
}

// Radiance that is known.
@compute @workgroup_size(64)
fn add(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    let place = id.x * rows.functions + id.y;
    lit[place] += vec4<f32>(factors[place].rgb, 0.0);
}

// Diffuse transfer times the light.
@compute @workgroup_size(64)
fn diffuse(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < rows.rank; i++) {
        let first = (id.x * rows.rank + i) * rows.width;
        var answer = vec3<f32>(numbers[first]);
        if rows.width == 3u {
            answer = vec3<f32>(numbers[first], numbers[first + 1u], numbers[first + 2u]);
        }
        sum += answer * factors[i].rgb;
    }
    lit[id.x] = vec4<f32>(sum, 0.0);
}

@compute @workgroup_size(64)
fn store_texels(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    let place = index[id.x];
    textureStore(texels, vec2<u32>(place % rows.width, place / rows.width), id.y, held(id));
}

@compute @workgroup_size(64)
fn store_halves(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    let value = held(id);
    let place = (rows.first + id.x) * rows.functions + id.y;
    halves[place] = vec2<u32>(pack2x16float(value.xy), pack2x16float(value.zw));
}

@compute @workgroup_size(64)
fn store_radiance(@builtin(global_invocation_id) id: vec3<u32>) {
    if outside(id) {
        return;
    }
    let value = lit[id.x * rows.functions + id.y];
    let place = 3u * (rows.first + id.x);
    radiance[place] = value.x;
    radiance[place + 1u] = value.y;
    radiance[place + 2u] = value.z;
}
