
// Soil, stone, bark and leaves: uv are metres.
@fragment
fn fragment_grainy(in: Lit) -> Pixel {
    let uv = in.uv_param.xy;
    let strength = in.uv_param.z;
    let fine = textureSample(noise, noise_sampler, uv * 0.31).r - 0.5;
    let broad = textureSample(noise, noise_sampler, uv * 0.023).r - 0.5;
    let tint = 1.0 + strength * (1.1 * fine + 0.9 * broad);
    return weathered(in, in.shade * tint, in.sunlit * tint);
}

// Grass: uv are metres, the parameter is how worn the ground is.
@fragment
fn fragment_grass(in: Lit) -> Pixel {
    let uv = in.uv_param.xy;
    let fine = textureSample(noise, noise_sampler, uv * 0.31).r - 0.5;
    let broad = textureSample(noise, noise_sampler, uv * 0.023).r - 0.5;
    let field = textureSample(noise, noise_sampler, uv * 0.0071).rg - 0.5;
    // Tufts, and where it was mown last or is left to itself, from green to straw.
    let straw = clamp(0.42 + 1.5 * field.g + 1.2 * broad + 0.7 * fine, 0.0, 1.0);
    let wild = clamp(2.2 * field.g + 1.4 * broad, 0.0, 1.0);
    let blades = mix(mix(vec3f(0.86, 0.98, 0.84), vec3f(1.2, 1.04, 0.86), straw), vec3f(0.66, 0.76, 0.6), wild);
    // Where it is worn, soil and gravel show, and grass stands on in patches.
    let bare = smoothstep(0.36, 0.6, in.uv_param.z * (1.0 + 2.2 * broad + 1.2 * fine));
    let tint = (1.0 + 1.3 * fine + 0.9 * broad) * mix((1.0 + 0.7 * field.r) * blades, vec3f(1.62, 1.3, 1.7), bare);
    return weathered(in, in.shade * tint, in.sunlit * tint);
}
