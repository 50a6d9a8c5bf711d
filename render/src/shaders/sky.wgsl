// The sky behind everything: gradient, sun, clouds.

struct SkyOut {
    @builtin(position) clip: vec4f,
    @location(0) direction: vec3f,
}

struct Pixel {
    @location(0) colour: vec4f,
    @location(1) ids: u32,
}

override SKY_TAG: u32;

const FOG_TOP_M = 40.0;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> SkyOut {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u)) * 2.0 - 1.0;
    // right and up are divided by the tangents of the view, so their squares undo it.
    let across = scene.right / dot(scene.right, scene.right) * corner.x;
    let upward = scene.up / dot(scene.up, scene.up) * corner.y;
    // Depth 0 is the far plane.
    return SkyOut(vec4f(corner, 0.0, 1.0), scene.ahead + across + upward);
}

// Which way it is, level; zero where it is upright.
fn flat(direction: vec3f) -> vec2f { return direction.xy / max(length(direction.xy), 1e-4); }

// Tiles of noise in a unit of the pattern.
const COARSE_CLOUDS = 0.05;
const FINE_CLOUDS = 0.21;

fn cloud(at: vec2f) -> f32 {
    let big = textureSampleLevel(noise, noise_sampler, at * COARSE_CLOUDS, 0.0).g;
    let small = textureSampleLevel(noise, noise_sampler, at * FINE_CLOUDS + 0.37, 0.0).g;
    return 0.72 * big + 0.28 * small;
}

@fragment
fn fragment(in: SkyOut) -> Pixel {
    let direction = normalize(in.direction);
    var colour = sky_colour(direction);
    let towards = max(dot(direction, scene.sun), 0.0);
    let glow = towards * towards * towards * towards;
    colour += scene.sun_light * (0.05 * glow * glow + 0.16 * pow(towards, 90.0) + 6.0 * smoothstep(0.9993, 0.9997, towards));

    if NIGHT {
        // It is where the sun went down, and low.
        let along = 0.5 + 0.5 * dot(flat(direction), flat(scene.sun));
        let low = 1.0 - min(abs(direction.z) * 2.2, 1.0);
        colour += scene.afterglow * (along * along * along * low * low * low);
    }

    let height = max(direction.z, 0.0) + 0.06;
    let at = direction.xy / height + vec2f(scene.sky_drift_x, scene.sky_drift_y);
    let density = cloud(at);
    let bound = 0.74 - 0.42 * scene.cloudiness;
    let cover = smoothstep(bound, bound + 0.16, density) * smoothstep(0.0, 0.12, direction.z);
    // The side turned to the sun is brighter.
    let lit = clamp(0.75 + 2.2 * (density - cloud(at + scene.sun.xy * 0.35)), 0.35, 1.15);
    let white = scene.sun_light * 0.27 * lit + scene.sky_light * 0.62;
    colour = mix(colour, white, cover * 0.92);
    if WEATHER {
        // Fog lies in a layer on the ground.
        colour = fogged(colour, FOG_TOP_M / max(direction.z, 0.004));
    }
    return Pixel(to_screen(colour), SKY_TAG);
}
