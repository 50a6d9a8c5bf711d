// What all shaders of a frame share.

struct Scene {
    eye: vec3f,
    wind_phase: f32,
    // Scaled so that clip space follows by dot products.
    right: vec3f,
    wind_m: f32,
    up: vec3f,
    cloudiness: f32,
    ahead: vec3f,
    exposure: f32,
    // Towards the sun.
    sun: vec3f,
    shadow_texel: f32,
    sun_light: vec3f,
    sky_drift_x: f32,
    sky_light: vec3f,
    sky_drift_y: f32,
    ground_light: vec3f,
    shadow_at_x: f32,
    horizon: vec3f,
    shadow_at_y: f32,
    zenith: vec3f,
    fog_from_m: f32,
    // World to depth and uv from the corner of what the shadow map shows, which lies at `shadow_at` and goes on over its edges.
    shadow: mat4x4f,
    fog: vec3f,
    fog_per_m: f32,
    // The way that a drop leaves on a picture, and how far all have fallen.
    rain_streak: vec3f,
    rain_fall: f32,
    wet: f32,
    puddles: f32,
    pixel_rad: f32,
    // Levels of detail that leaves are shown coarser than samples ask for, as many samples are one pixel.
    leaf_bias: f32,
    // Of lamps, in the light of the sky: 1 is as bright.
    street: vec3f,
    window: f32,
    headlight: vec3f,
    windows_lit: f32,
    // Of the sky where the sun went down.
    afterglow: vec3f,
    shine: f32,
    // From what lies so far from the eye to uv of the map of lamps' light, and heights above its base.
    light_map_at: vec2f,
    light_map_per_m: f32,
    light_map_height: f32,
}

// Whether there is fog, rain or water to draw; without them a picture is what it would be if they did not exist.
override WEATHER: bool = false;

// Whether lamps shine, and whether the sun does, or is a cover of clouds' share of it left.
override NIGHT: bool = false;
override SUN: bool = true;

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var noise: texture_2d<f32>;
@group(0) @binding(2) var noise_sampler: sampler;
@group(0) @binding(3) var light_map: texture_2d<f32>;
@group(0) @binding(4) var ground: texture_2d_array<f32>;
@group(0) @binding(5) var leaves: texture_2d_array<f32>;

const NEAR_M = 0.1;

// Colours are lighted as squares of their bytes, close to sRGB and cheap.
fn to_linear(c: vec3f) -> vec3f { return c * c; }

// Exposure, a shoulder for bright parts, and back to bytes.
fn to_screen(c: vec3f) -> vec4f {
    let lit = c * scene.exposure;
    return vec4f(sqrt(lit / (lit + 0.55) * 1.42), 1.0);
}

// Reversed depth with the far plane at infinity: depth = NEAR_M / distance.
fn project(world: vec3f) -> vec4f {
    let rel = world - scene.eye;
    return vec4f(dot(rel, scene.right), dot(rel, scene.up), NEAR_M, dot(rel, scene.ahead));
}

const WIND_DIRECTION = vec2f(0.8, 0.6);
const WIND_WAVE = vec2f(0.11, 0.07);

fn swayed(position: vec3f, sway: f32) -> vec3f {
    let swing = sin(scene.wind_phase + dot(WIND_WAVE, position.xy));
    return position + vec3f(WIND_DIRECTION * (sway * scene.wind_m * (0.35 + 0.65 * swing)), 0.0);
}

// What fog leaves of a colour at a distance.
fn fogged(colour: vec3f, distance: f32) -> vec3f {
    let through = exp(-scene.fog_per_m * max(distance - scene.fog_from_m, 0.0));
    return mix(scene.fog, colour, through);
}

// Between the lowest and the highest ground that the map of lamps' light tells.
const LIGHT_MAP_RISE_M = 128.0;

// What lamps add to what lies so far from the eye, in the light of the sky.
fn lamplight(from_eye: vec3f) -> vec3f {
    let uv = clamp(from_eye.xy * scene.light_map_per_m + scene.light_map_at, vec2f(0.003), vec2f(0.997));
    let lit = textureSampleLevel(light_map, noise_sampler, uv, 0.0);
    let height = from_eye.z + scene.light_map_height - LIGHT_MAP_RISE_M * lit.b;
    // Shades of street lamps and the low beam keep light from what is high.
    let below = clamp((10.5 - height) / 6.0, 0.08, 1.0);
    let low = clamp((1.9 - height) / 1.1, 0.1, 1.0);
    return scene.street * (lit.r * lit.r * below) + scene.headlight * (lit.g * lit.g * low);
}

// The clear sky's colour in a direction.
fn sky_colour(direction: vec3f) -> vec3f {
    let up = max(direction.z, 0.0);
    let fade = 1.0 - up;
    return mix(scene.zenith, scene.horizon, fade * fade * fade);
}
