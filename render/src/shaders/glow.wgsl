// Glow around lamps at night: discs that face the eye and brighten what is there. They write neither class nor depth.

struct GlowIn {
    @location(0) position: vec3f,
    @location(1) radius_m: f32,
    @location(2) colour: vec3f,
}

struct GlowOut {
    @builtin(position) clip: vec4f,
    @location(0) across: vec2f,
    @location(1) colour: vec3f,
}

// A camera's glare grows with distance, as an angle.
const SPREAD = 0.008;
const LEAST_PX = 1.2;
const HALF_M = 120.0;

@vertex
fn vertex(in: GlowIn, @builtin(vertex_index) index: u32) -> GlowOut {
    let rel = in.position - scene.eye;
    let distance = length(rel);
    let corner = vec2f(select(-1.0, 1.0, index == 1u || index >= 4u), select(-1.0, 1.0, index == 2u || index >= 3u && index != 4u));
    let radius = max(in.radius_m + SPREAD * distance, LEAST_PX * scene.pixel_rad * distance);
    // Before the lamp's own surface.
    let near = scene.eye + rel * (1.0 - min(0.5, 0.3 * distance) / max(distance, 0.01));
    // right and up are divided by the tangents of the view.
    let aside = normalize(scene.right) * corner.x + normalize(scene.up) * corner.y;
    var seen = in.colour;
    if WEATHER {
        seen *= exp(-scene.fog_per_m * max(distance - scene.fog_from_m, 0.0));
    }
    // What is far covers no less, but shines less.
    seen /= 1.0 + distance / HALF_M;
    return GlowOut(project(near + aside * radius), corner, seen);
}

@fragment
fn fragment(in: GlowOut) -> @location(0) vec4f {
    let fall = max(1.0 - dot(in.across, in.across), 0.0);
    return vec4f(in.colour * (0.85 * fall * fall * fall), 1.0);
}
