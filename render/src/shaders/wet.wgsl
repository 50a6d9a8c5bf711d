// What water makes of the ground.

// Drawn for a corner of the squares of `kernel::weather::Water`, 0 to 1.
fn corner(at: vec2i) -> f32 {
    let cell = bitcast<vec2u>(at);
    var h = (cell.x * 0x9e3779b1u) ^ (cell.y * 0x85ebca77u);
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    return f32((h ^ (h >> 15u)) >> 8u) / 16777216.0;
}

// Height of the ground in its relief, as there.
fn relief(at: vec2f) -> f32 {
    let cell = floor(at / 3.0);
    let inside = at / 3.0 - cell;
    let t = inside * inside * (3.0 - 2.0 * inside);
    let c = vec2i(cell);
    let low = mix(corner(c), corner(c + vec2i(1, 0)), t.x);
    let high = mix(corner(c + vec2i(0, 1)), corner(c + vec2i(1, 1)), t.x);
    return mix(low, high, t.y);
}

const ROAD_LINE = 6u;
const SIDEWALK = 8u;
const GROUND = 14u;
const TERRAIN = 22u;
// Share of the light around a lamp that wet ground mirrors.
const LAMPS_SHARE = 0.15;

// A surface in the weather of the picture.
fn weathered(in: Lit, shade: vec3f, sunlit: vec3f) -> Pixel {
    if WEATHER {
        return wetted(in, shade, sunlit);
    }
    return finish(in, shade, sunlit);
}

// A wet surface is darker, for light that is caught in the water; a puddle mirrors the sky.
fn wetted(in: Lit, shade: vec3f, sunlit: vec3f) -> Pixel {
    let class_id = in.ids & 255u;
    let paved = (class_id >= ROAD_LINE && class_id <= SIDEWALK) || class_id == GROUND;
    if !(paved || class_id == TERRAIN) {
        return finish(in, shade, sunlit);
    }
    let place = scene.eye + in.from_eye;
    let depth = select(0.0, scene.puddles - relief(place.xy), paved && scene.puddles > 0.0);
    let puddle = smoothstep(0.0, 0.12, depth);
    let dark = mix(1.0, select(0.75, 0.55, paved), scene.wet) * mix(1.0, 0.7, puddle);
    let view = normalize(in.from_eye);
    let grazing = 1.0 - clamp(-view.z, 0.0, 1.0);
    let fresnel = 0.02 + 0.98 * grazing * grazing * grazing * grazing * grazing;
    let film = select(0.0, 0.3 * scene.wet, paved);
    let mirror = fresnel * mix(film, 0.9, puddle);
    let bounce = vec3f(view.xy, abs(view.z));
    let overcast = scene.sun_light * 0.24 + scene.sky_light * 0.6;
    let sky = mix(sky_colour(bounce), overcast, 0.85 * scene.cloudiness);
    let towards = max(dot(bounce, scene.sun), 0.0);
    let glint = mix(0.25 * film * pow(towards, 24.0), 3.0 * pow(towards, 400.0), puddle);
    if NIGHT {
        let lit = shade * (dark * (1.0 - mirror));
        // Lamps lie somewhere in what is mirrored around them.
        let mirrored = sky + scene.sky_light * lamplight(in.from_eye) * LAMPS_SHARE;
        return finish_shining(in, lit, sunlit * dark * (1.0 - mirror), mirrored * mirror + scene.sun_light * glint);
    }
    return finish(in, mix(shade * dark, sky, mirror), sunlit * dark * (1.0 - mirror) + scene.sun_light * glint);
}
