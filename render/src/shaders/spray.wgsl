// Spray behind vehicles: soft discs that face the eye. They cover colours and write neither class nor depth.

struct PuffIn {
    @location(0) position: vec3f,
    @location(1) radius_m: f32,
    @location(2) cover: f32,
}

struct PuffOut {
    @builtin(position) clip: vec4f,
    @location(0) across: vec2f,
    @location(1) cover: f32,
    @location(2) light: vec3f,
    @location(3) drops: vec2f,
}

// Discs are so much wider than high.
const WIDE = 1.3;

@vertex
fn vertex(in: PuffIn, @builtin(vertex_index) index: u32) -> PuffOut {
    let rel = in.position - scene.eye;
    let distance = length(rel);
    let corner = vec2f(select(-1.0, 1.0, index == 1u || index >= 4u), select(-1.0, 1.0, index == 2u || index >= 3u && index != 4u));
    let aside = normalize(scene.right) * (WIDE * corner.x) + normalize(scene.up) * corner.y;
    // Nobody looks into it from inside, and fog hides it as all else.
    let seen = smoothstep(2.0, 6.0, distance) * exp(-scene.fog_per_m * max(distance - scene.fog_from_m, 0.0));
    var light = scene.sky_light * 0.72 + scene.sun_light * 0.1;
    if NIGHT {
        light *= 1.0 + 0.6 * lamplight(rel);
    }
    let drops = corner * 0.06 + in.position.xy * 0.31;
    return PuffOut(project(in.position + aside * in.radius_m), corner, in.cover * seen, light, drops);
}

@fragment
fn fragment(in: PuffOut) -> @location(0) vec4f {
    let fall = max(1.0 - dot(in.across, in.across), 0.0);
    let drops = textureSample(noise, noise_sampler, in.drops).g;
    return vec4f(to_screen(in.light).rgb, in.cover * fall * clamp(0.4 + 1.2 * drops, 0.0, 1.3));
}
