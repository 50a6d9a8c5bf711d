
// Codes of stones: how they are laid, with or without a kerb along their edge, and of a kerb alone.
const BOND = 3u;
const KERBED = 4u;
const KERB = 8u;
// Metres across the tile of stones.
const PAVING_M = 5.12;
// Width of kerb stones, and of the joint between two, metres.
const KERB_M = 0.18;
const JOINT_M = 0.012;

// Setts, slabs and kerbs: uv are metres along a road and from its kerb.
@fragment
fn fragment_paving(in: Lit) -> Pixel {
    let uv = in.uv_param.xy;
    let code = code_of(in.ids);
    let bonds = textureSample(ground, noise_sampler, uv * (1.0 / PAVING_M), 1);
    let broad = textureSample(noise, noise_sampler, uv * 0.061).r - 0.5;
    let pixel = fwidth(uv);
    var stone = 2.0 * bonds[code & BOND];
    var tint = vec3f(stone + 0.5 * broad);
    // Kerb stones are of granite, a metre long.
    let to_joint = abs(fract(uv.x) - 0.5);
    let joint = clamp((to_joint - 0.5 + 0.5 * JOINT_M) / pixel.x + 0.5, 0.0, 1.0) * min(JOINT_M / pixel.x, 1.0);
    let granite = (vec3f(1.24, 1.22, 1.2) + 0.9 * broad) * (1.0 - 0.6 * joint);
    let at_edge = select(0.0, clamp((KERB_M - uv.y) / pixel.y + 0.5, 0.0, 1.0), (code & KERBED) != 0u);
    tint = mix(tint, granite, select(at_edge, 1.0, code == KERB));
    return weathered(in, in.shade * tint, in.sunlit * tint);
}
