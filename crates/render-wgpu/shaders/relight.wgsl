// One dot product of transfer and light per vertex and channel: diffuse radiance without albedo.
// Mirrors `relight` of render-cpu. Runs once per light, not per frame.
struct Chunk {
    vertices: u32,
    coefficients: u32,
}

// 1 where colour cannot enter the transfer, else 3.
override channels: u32 = 1u;

@group(0) @binding(0) var<uniform> chunk: Chunk;
@group(0) @binding(1) var<storage, read> light: array<vec4<f32>>;
// [coefficient][channel][vertex]: neighbouring threads read neighbouring words.
@group(0) @binding(2) var<storage, read> transfer: array<f32>;
@group(0) @binding(3) var<storage, read_write> lit: array<f32>;

@compute @workgroup_size(64)
fn relight(@builtin(global_invocation_id) id: vec3<u32>) {
    let vertex = id.x;
    if vertex >= chunk.vertices {
        return;
    }
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < chunk.coefficients; i++) {
        let first = i * channels * chunk.vertices + vertex;
        var answer = vec3<f32>(transfer[first]);
        if channels == 3u {
            answer.y = transfer[first + chunk.vertices];
            answer.z = transfer[first + 2u * chunk.vertices];
        }
        sum += answer * light[i].rgb;
    }
    lit[3u * vertex] = sum.x;
    lit[3u * vertex + 1u] = sum.y;
    lit[3u * vertex + 2u] = sum.z;
}
