// Rain: drops as thin streaks in a box around the eye. They cover colours and write neither class nor depth.

struct DropOut {
    @builtin(position) clip: vec4f,
    @location(0) alpha: f32,
    @location(1) light: vec3f,
}

const BOX_M = vec3f(24.0, 24.0, 12.0);
const WIDTH_M = 0.004;

fn drawn(number: u32) -> f32 {
    var h = (number ^ (number >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    return f32((h ^ (h >> 16u)) >> 8u) / 16777216.0;
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> DropOut {
    let drop = 3u * (index / 6u);
    let start = vec3f(drawn(drop), drawn(drop + 1u), drawn(drop + 2u));
    // Drops are in the world, and those that leave the box come in again on its other side. The higher they are, the less far
    // has the wind taken them.
    let up = (fract(start.z + (scene.rain_fall - scene.eye.z) / BOX_M.z + 0.5) - 0.5) * BOX_M.z;
    let aside_m = scene.rain_streak.xy / scene.rain_streak.z * up;
    let rel = vec3f((fract(start.xy + (aside_m - scene.eye.xy) / BOX_M.xy + 0.5) - 0.5) * BOX_M.xy, up);
    let distance = length(rel);
    let side = cross(rel, scene.rain_streak);
    let half_width = 0.5 * max(WIDTH_M, scene.pixel_rad * distance);
    let aside = side / max(length(side), 1e-4) * half_width;
    // Two triangles.
    let number = index % 6u;
    let corner = vec2f(f32((number >= 2u && number != 4u)), select(-1.0, 1.0, number == 1u || number >= 4u));
    // What is thinner than a pixel covers it in part.
    let share = WIDTH_M / (2.0 * half_width);
    let seen = smoothstep(0.6, 1.5, distance) * (1.0 - smoothstep(8.0, 12.0, distance));
    var light = scene.sky_light * 0.9 + scene.sun_light * 0.1;
    if NIGHT {
        light *= 1.0 + 0.5 * lamplight(rel);
    }
    let at = scene.eye + rel + scene.rain_streak * corner.x + aside * corner.y;
    return DropOut(project(at), seen * mix(share, 1.0, 0.4), light);
}

@fragment
fn fragment(in: DropOut) -> @location(0) vec4f {
    let colour = to_screen(in.light);
    return vec4f(colour.rgb, 0.45 * in.alpha);
}
