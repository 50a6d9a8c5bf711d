
// Codes of asphalt: its age, with or without manholes, paint, and gratings of drains.
const OLDEST = 7u;
const COVERS = 8u;
const PAINT = 64u;
const GRATING = 65u;
// Metres across the tile of what years leave.
const ASPHALT_M = 20.48;

// Asphalt and paint: uv are metres along a road and across it, the parameter goes from 0 to 1 across a lane.
@fragment
fn fragment_asphalt(in: Lit) -> Pixel {
    let uv = in.uv_param.xy;
    let code = code_of(in.ids);
    let age = f32(code & OLDEST) * (1.0 / 7.0);
    let fine = textureSample(noise, noise_sampler, uv * 0.41).r - 0.5;
    let clouds = textureSample(noise, noise_sampler, uv * 0.023).rg - 0.5;
    let broad = clouds.r;
    // The tile is bent, and what is on it comes and goes: no two look alike.
    let tile = (uv + vec2f(1.1, 0.5) * clouds.g) * (1.0 / ASPHALT_M);
    let marks = textureSample(ground, noise_sampler, tile, 0);
    let grain = 0.55 * fine + 0.4 * broad;
    if code == GRATING {
        // Slots between bars, across the road.
        let width = max(fwidth(uv.x) * 14.0, 0.001);
        let slots = span(abs(fract(uv.x * 14.0) - 0.5), 0.24, 1.0, width);
        let tint = vec3f((1.0 + grain) * mix(0.6, mix(1.0, 0.2, slots), clamp(2.0 - width, 0.0, 1.0)));
        return weathered(in, in.shade * tint, in.sunlit * tint);
    }
    if code >= PAINT {
        // What wheels have worn off, and the asphalt below.
        let worn = smoothstep(0.1, 0.34, 0.62 * fine + 0.9 * broad);
        let tint = vec3f(1.0 + 0.3 * grain) * mix(1.0, 0.34, worn);
        return weathered(in, in.shade * tint, in.sunlit * tint);
    }
    // No tile shows all that is on it, and each another part.
    let chance = fract(dot(floor(tile), vec2f(0.618034, 0.414214)));
    let is_patched = select(0.0, 1.0, chance < 0.75 * age);
    let cracked = clamp(age * 1.4 - 0.25 + 1.2 * broad + 2.2 * clouds.g, 0.0, 1.0);
    // Between the kerbs of a lane: tracks of wheels, and oil between them.
    let across = 4.0 * in.uv_param.z * (1.0 - in.uv_param.z);
    let seen = clamp(1.6 - 5.0 * fwidth(in.uv_param.z), 0.0, 1.0);
    let track = max(1.0 - 5.0 * abs(across - 0.78), 0.0);
    let oil = max(across - 0.9, 0.0) * 10.0;
    var tone = 1.0 + grain - seen * ((0.06 + 0.07 * age) * track + (0.16 + 0.3 * broad) * oil);
    tone *= 1.0 + is_patched * (1.6 * marks.g - 0.8);
    tone *= 1.0 - max(0.62 * cracked * marks.r, 0.34 * max(cracked - 0.3, 0.0) * marks.a);
    var tint = vec3f(tone);
    if (code & COVERS) != 0u && fract(chance * 7.0) < 0.3 {
        // Half of the channel is where it is, half how bright: its rim and its groove are dark.
        let iron = vec3f(0.62, 0.58, 0.55) * (clamp(2.0 * marks.b - 0.8, 0.3, 1.0) + grain);
        tint = mix(tint, iron, clamp(2.0 * marks.b, 0.0, 1.0));
    }
    return weathered(in, in.shade * tint, in.sunlit * tint);
}
