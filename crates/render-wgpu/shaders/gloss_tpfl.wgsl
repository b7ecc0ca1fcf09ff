// Visibility times the matrix of the light: TPFL.

// [row][column]
@group(3) @binding(3) var<storage, read> light_matrix: array<vec4<f32>>;

fn lit_sums(lobe: Lobe, visibility: array<f32, COUNT>) -> vec4<f32> {
    var values = lobe.values;
    var seen = visibility;
    var sums = vec4<f32>(0.0);
    for (var i = 0u; i < COUNT; i++) {
        var row = vec3<f32>(0.0);
        for (var k = 0u; k < COUNT; k++) {
            row += light_matrix[i * COUNT + k].rgb * seen[k];
        }
        sums += values[i] * vec4<f32>(row, seen[i]);
    }
    return sums;
}
