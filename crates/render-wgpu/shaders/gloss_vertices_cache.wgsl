// What arrives at a vertex was kept when the light was put on.
fn arriving_at(lobe: Lobe, row: u32) -> vec4<f32> {
    return kept_row_sums(lobe, row);
}
