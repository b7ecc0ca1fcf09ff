// What arrives at a vertex is its visibility times the light, made where it is drawn. Needs `lit_sums` of one of the products.

// Whether other surfaces send light: the kept rows hold that.
override bounced: bool = false;

// [row][function]
@group(3) @binding(6) var<storage, read> visibility_rows: array<f32>;

fn arriving_at(lobe: Lobe, row: u32) -> vec4<f32> {
    var seen: array<f32, COUNT>;
    for (var k = 0u; k < COUNT; k++) {
        seen[k] = visibility_rows[row * COUNT + k];
    }
    var sums = lit_sums(lobe, seen);
    if bounced {
        sums += vec4<f32>(kept_row_sums(lobe, row).rgb, 0.0);
    }
    return sums;
}
