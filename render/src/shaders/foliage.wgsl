
// Leaves are lit from both sides; `param` is how much of the light behind them they let through.
@vertex
fn vertex_leafy(in: VertexIn) -> Lit {
    var out = lit(in);
    let normal = in.normal_sway.xyz;
    let albedo = to_linear(in.colour_param.rgb);
    let facing = dot(normal, scene.sun);
    let against = max(dot(normalize(out.from_eye), scene.sun), 0.0);
    let through = in.colour_param.a * (0.25 * max(-facing, 0.0) + 0.55 * against * against * against);
    let direct = max(0.22 + 0.78 * facing, 0.0);
    out.sunlit = albedo * scene.sun_light * (vec3f(direct) + vec3f(1.1, 1.1, 0.5) * through);
    // A crown's own outer leaves do not shade it.
    out.shadow = (scene.shadow * vec4f(out.from_eye + scene.eye + normal * 0.25 + scene.sun * 0.7, 1.0)).xyz;
    return out;
}

@fragment
fn fragment_leafy(in: Lit) -> Pixel {
    let leaf = leaf_at(in.uv_param.xy, in.ids);
    if leaf.x < LEAF {
        discard;
    }
    let tint = 2.0 * leaf.y;
    return finish(in, in.shade * tint, in.sunlit * tint);
}
