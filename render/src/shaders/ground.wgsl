
const GRASS = 2u;

// Tufts, and where it was mown last or is left to itself, from green to straw.
fn grass(uv: vec2f, fine: f32, broad: f32) -> vec3f {
    let field = textureSample(noise, noise_sampler, uv * 0.0071).rg - 0.5;
    let tuft = 1.0 + 1.3 * fine + 0.9 * broad + 0.7 * field.r;
    let straw = clamp(0.42 + 1.5 * field.g + 1.2 * broad + 0.7 * fine, 0.0, 1.0);
    let wild = clamp(2.2 * field.g + 1.4 * broad, 0.0, 1.0);
    return tuft * mix(mix(vec3f(0.86, 0.98, 0.84), vec3f(1.2, 1.04, 0.86), straw), vec3f(0.66, 0.76, 0.6), wild);
}

// Soil, grass, bark and leaves: uv are metres.
@fragment
fn fragment_grainy(in: Lit) -> Pixel {
    let uv = in.uv_param.xy;
    let strength = in.uv_param.z;
    let fine = textureSample(noise, noise_sampler, uv * 0.31).r - 0.5;
    let broad = textureSample(noise, noise_sampler, uv * 0.023).r - 0.5;
    var tint = vec3f(1.0 + strength * (1.1 * fine + 0.9 * broad));
    if code_of(in.ids) == GRASS {
        // Where it is worn, soil and gravel show, and grass stands on in patches.
        let bare = smoothstep(0.36, 0.6, strength * (1.0 + 2.2 * broad + 1.2 * fine));
        let soil = vec3f(1.62, 1.3, 1.7) * (1.0 + 1.4 * fine + 0.8 * broad);
        tint = mix(grass(uv, fine, broad), soil, bare);
    }
    return weathered(in, in.shade * tint, in.sunlit * tint);
}
