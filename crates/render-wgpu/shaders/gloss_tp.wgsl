// The triple product of lobe, light and visibility, term by term: TP.
struct Triple {
    lobe: u32,
    light: u32,
    visibility: u32,
    value: f32,
}

@group(3) @binding(4) var<storage, read> triples: array<Triple>;

fn lit_sums(lobe: Lobe, visibility: array<f32, COUNT>) -> vec4<f32> {
    var values = lobe.values;
    var seen = visibility;
    var sums = vec4<f32>(0.0);
    for (var t = 0u; t < arrayLength(&triples); t++) {
        let triple = triples[t];
        let factor = triple.value * values[triple.lobe] * seen[triple.visibility];
        sums += vec4<f32>(factor * gloss_light[triple.light].rgb, 0.0);
    }
    for (var k = 0u; k < COUNT; k++) {
        sums.a += values[k] * seen[k];
    }
    return sums;
}
