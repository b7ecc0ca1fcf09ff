// Matt surfaces whose light a normal map bends. Needs bend.wgsl and vertex_light.wgsl.
@fragment
fn draw_bent(at: Shiny) -> @location(0) vec4<f32> {
    view_depth = 1.0 / at.clip.w;
    // Derivatives first: they need the neighbours that a mask may end.
    let across = cross(dpdx(at.offset), dpdy(at.offset));
    let point = surface(at.uv, at.color);
    let geometric = across * select(-1.0, 1.0, dot(across, -at.offset) > 0.0);
    let plain = unit_or(at.normal, geometric);
    let light = bent_light(diffuse_light(at.lit.rgb, at.uv), at.heading, plain, shading_normal(at, geometric));
    return composite(point, max(light, vec3<f32>(0.0)), vec3<f32>(0.0), glow(at.uv));
}
