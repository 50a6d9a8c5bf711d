// What wet roads mirror of lamps at night: streaks on the ground. They write neither class nor depth.

struct StreakIn {
    @location(0) near: vec3f,
    @location(1) half_near_m: f32,
    @location(2) far: vec3f,
    @location(3) half_far_m: f32,
    @location(4) colour: vec3f,
}

struct StreakOut {
    @builtin(position) clip: vec4f,
    // From -1 to 1 and from 0, near, to 1.
    @location(0) across: vec2f,
    @location(1) colour: vec3f,
    @location(2) ground: vec2f,
}

// How far a streak is drawn before the ground it lies on, metres and as a share of the distance.
const BEFORE_M = 0.04;
const BEFORE = 0.02;
const LEAST_PX = 0.7;

@vertex
fn vertex(in: StreakIn, @builtin(vertex_index) index: u32) -> StreakOut {
    let side = select(-1.0, 1.0, index == 1u || index >= 4u);
    let is_far = index == 2u || index >= 3u && index != 4u;
    let ahead = normalize((in.far - in.near).xy);
    let at = select(in.near, in.far, is_far);
    let distance = length(at - scene.eye);
    let half = max(select(in.half_near_m, in.half_far_m, is_far), LEAST_PX * scene.pixel_rad * distance);
    let rel = at + vec3f(ahead.y, -ahead.x, 0.0) * (side * half) - scene.eye;
    let before = scene.eye + rel * (1.0 - BEFORE - BEFORE_M / distance);
    let seen = in.colour * exp(-scene.fog_per_m * max(distance - scene.fog_from_m, 0.0));
    return StreakOut(project(before), vec2f(side, select(0.0, 1.0, is_far)), seen, (scene.eye + rel).xy);
}

@fragment
fn fragment(in: StreakOut) -> @location(0) vec4f {
    let side = max(1.0 - in.across.x * in.across.x, 0.0);
    let along = in.across.y * (1.0 - in.across.y) * 4.0;
    // Water stands here and there.
    let water = textureSample(noise, noise_sampler, in.ground * 0.043).r;
    let share = side * side * along * (0.4 + 0.6 * in.across.y) * clamp(2.6 * water - 0.55, 0.1, 1.3);
    return vec4f(in.colour * share, 1.0);
}
