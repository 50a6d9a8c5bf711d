// Surfaces: vertices are lit, fragments add grain or windows, shadow and haze.

@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

// Samples of the shadow map along each axis.
override SHADOW_TAPS: i32 = 1;

struct VertexIn {
    @location(0) position: vec3f,
    @location(1) normal_sway: vec4f,
    @location(2) colour_param: vec4f,
    @location(3) ids: u32,
    @location(4) uv: vec2f,
}

struct Lit {
    // As in `classes.wgsl`, to the last bit.
    @builtin(position) @invariant clip: vec4f,
    // Colour in the shade and what the sun adds.
    @location(0) shade: vec3f,
    @location(1) sunlit: vec3f,
    @location(2) shadow: vec3f,
    @location(3) uv_param: vec3f,
    @location(4) @interpolate(flat) ids: u32,
    @location(5) from_eye: vec3f,
}

struct Pixel {
    @location(0) colour: vec4f,
    @location(1) ids: u32,
}

fn code_of(ids: u32) -> u32 { return (ids >> 8u) & 255u; }

fn lit(in: VertexIn) -> Lit {
    let world = swayed(in.position, in.normal_sway.w);
    let normal = in.normal_sway.xyz;
    let albedo = to_linear(in.colour_param.rgb);
    var out: Lit;
    out.clip = project(world);
    let sky = 0.5 + 0.5 * normal.z;
    out.shade = albedo * mix(scene.ground_light, scene.sky_light, sky);
    out.sunlit = albedo * scene.sun_light * max(dot(normal, scene.sun), 0.0);
    out.shadow = (scene.shadow * vec4f(world + normal * 0.06, 1.0)).xyz;
    out.uv_param = vec3f(in.uv, in.colour_param.a);
    out.ids = in.ids;
    out.from_eye = world - scene.eye;
    return out;
}

@vertex
fn vertex(in: VertexIn) -> Lit {
    return lit(in);
}

// Code of the glass of a street lamp.
const STREET_LAMP = 250u;

// Lamps do not light what shines: it is as if the sun did, beyond the reach of all shadows.
fn shine(out: ptr<function, Lit>, colour: vec3f) {
    (*out).shade = vec3f(0.0);
    (*out).sunlit = colour;
    (*out).shadow = vec3f(2.0);
}

// Lacquer and glass mirror the sky; lamps shine.
@vertex
fn vertex_plain(in: VertexIn) -> Lit {
    var out = lit(in);
    let normal = in.normal_sway.xyz;
    let gloss = in.colour_param.a;
    let view = normalize(in.position - scene.eye);
    let bounce = reflect(view, normal);
    let grazing = 1.0 - max(-dot(view, normal), 0.0);
    let fresnel = gloss * (0.07 + 0.6 * grazing * grazing * grazing);
    let mirrored = select(scene.ground_light * 0.35, sky_colour(bounce), bounce.z > 0.0);
    let glint = pow(max(dot(bounce, scene.sun), 0.0), 24.0) * gloss;
    out.shade = out.shade * (1.0 - 0.5 * fresnel) + mirrored * fresnel;
    out.sunlit += scene.sun_light * glint * 0.8;
    if code_of(in.ids) == 255u {
        out.shade = to_linear(in.colour_param.rgb) * 2.2;
        out.sunlit = vec3f(0.0);
        if NIGHT {
            shine(&out, out.shade);
        }
    }
    if NIGHT && code_of(in.ids) == STREET_LAMP {
        shine(&out, mix(out.shade, vec3f(2.4, 2.0, 1.3), scene.shine));
    }
    return out;
}

fn sunshine(at: vec3f) -> f32 {
    if !SUN {
        return 1.0;
    }
    let reach = (SHADOW_TAPS - 1) / 2;
    var sum = 0.0;
    for (var y = -reach; y <= reach; y++) {
        for (var x = -reach; x <= reach; x++) {
            let uv = at.xy + vec2f(f32(x), f32(y)) * scene.shadow_texel;
            sum += textureSampleCompareLevel(shadow_map, shadow_sampler, uv, at.z);
        }
    }
    let off = abs(at.xy - 0.5);
    return select(sum / f32(SHADOW_TAPS * SHADOW_TAPS), 1.0, max(off.x, off.y) > 0.495);
}

fn finish(in: Lit, shade: vec3f, sunlit: vec3f) -> Pixel {
    return finish_shining(in, shade, sunlit, vec3f(0.0));
}

// `shining` is what no lamp lights: windows, and what water mirrors.
fn finish_shining(in: Lit, shade: vec3f, sunlit: vec3f, shining: vec3f) -> Pixel {
    var colour = shade + sunlit * sunshine(in.shadow);
    if NIGHT {
        colour += shade * lamplight(in.from_eye) + shining;
    }
    let distance = length(in.from_eye);
    let haze = min(distance / 1400.0, 0.9);
    colour = mix(colour, scene.horizon * 0.8, haze * haze);
    if WEATHER {
        colour = fogged(colour, distance);
    }
    return Pixel(to_screen(colour), in.ids);
}

@fragment
fn fragment_plain(in: Lit) -> Pixel {
    return finish(in, in.shade, in.sunlit);
}

// Asphalt, paint, slabs, soil, grass, bark and leaves: uv are metres.
@fragment
fn fragment_grainy(in: Lit) -> Pixel {
    let uv = in.uv_param.xy;
    let strength = in.uv_param.z;
    let fine = textureSample(noise, noise_sampler, uv * 0.31).r - 0.5;
    let broad = textureSample(noise, noise_sampler, uv * 0.023).r - 0.5;
    var tint = vec3f(1.0 + strength * (1.1 * fine + 0.9 * broad));
    let code = code_of(in.ids);
    // Grass turns from green to straw.
    let straw = select(0.0, clamp(0.5 + 2.2 * broad + 0.8 * fine, 0.0, 1.0), code == 2u);
    tint *= mix(vec3f(1.0), vec3f(1.28, 1.05, 0.78), straw);
    // Joints between slabs of 0.6 m x 0.6 m.
    let cell = fract(uv / 0.6);
    let width = 0.03 + fwidth(uv) / 0.6;
    let edge = min(cell, 1.0 - cell) / width;
    let joint = clamp(1.0 - min(edge.x, edge.y), 0.0, 1.0) * 0.03 / max(width.x, width.y);
    tint *= select(1.0, 1.0 - 0.45 * joint, code == 1u);
    if WEATHER {
        return wetted(in, in.shade * tint, in.sunlit * tint);
    }
    return finish(in, in.shade * tint, in.sunlit * tint);
}

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

fn hash(p: vec2f) -> f32 {
    let q = fract(p * vec2f(0.1031, 0.1137));
    let r = q + dot(q, q.yx + 33.33);
    return fract((r.x + r.y) * r.x);
}

// Share of a pixel `width` wide at x that lies in [low, high].
fn span(x: f32, low: f32, high: f32, width: f32) -> f32 {
    return clamp((x - low) / width + 0.5, 0.0, 1.0) * clamp((high - x) / width + 0.5, 0.0, 1.0);
}

// House fronts: uv count window columns and storeys.
@fragment
fn fragment_facade(in: Lit) -> Pixel {
    let uv = in.uv_param.xy;
    // Whole, as the vertices have it: what interpolation leaves over would tip the hash from pixel to pixel.
    let seed = round(in.uv_param.z * 255.0);
    let code = code_of(in.ids);
    let pixel = max(fwidth(uv), vec2f(0.001));
    let cell = floor(uv);
    let at = uv - cell;
    let chance = hash(cell + vec2f(seed, seed * 1.7));
    let ground = cell.y < 0.5;
    let shop = ground && (code & 16u) != 0u;
    let half_width = select(0.17 + 0.045 * f32(code & 3u), 0.44, shop);
    let low = select(select(0.3, 0.34, ground), 0.16, shop);
    let high = select(0.7 + 0.05 * f32((code >> 2u) & 3u), 0.8, shop);
    let door_at = floor(hash(vec2f(seed, 3.0)) * 3.0);
    let door = ground && cell.x == door_at && (code & 128u) != 0u;

    let x0 = select(0.5 - half_width, 0.3, door);
    let x1 = 1.0 - x0;
    let y0 = select(low, 0.02, door);
    let y1 = select(high, 0.74, door);
    let frame = span(at.x, x0 - 0.035, x1 + 0.035, pixel.x) * span(at.y, y0 - 0.035, y1 + 0.03, pixel.y);
    let pane = span(at.x, x0, x1, pixel.x) * span(at.y, y0, y1, pixel.y);
    let bar = select(span(at.x, 0.488, 0.512, pixel.x), 0.0, shop || door);

    // Glass: dark rooms, some with curtains, the sky mirrored above.
    let room = mix(vec3f(0.012, 0.016, 0.022), vec3f(0.23, 0.21, 0.18), step(0.72, chance) * 0.8);
    let sheen = scene.sky_light * (0.03 + 0.16 * smoothstep(0.1, 0.9, at.y + 0.4 * (chance - 0.5)));
    let leaf = vec3f(0.07, 0.035, 0.02) * (0.6 + chance) * (scene.sky_light * 2.0);
    let glass = select(room * scene.sky_light + sheen, leaf, door);
    let white = vec3f(0.62, 0.61, 0.58);

    let grime = textureSample(noise, noise_sampler, uv * vec2f(0.21, 0.27)).r - 0.5;
    let course = textureSample(noise, noise_sampler, vec2f(uv.x * 1.7, floor(uv.y * 36.0) * 0.137)).r - 0.5;
    let bricks = select(0.0, course * 0.45, (code & 32u) != 0u);
    let band = select(0.0, span(at.y, 0.93, 1.01, pixel.y), (code & 64u) != 0u);
    let sill = span(at.x, x0 - 0.06, x1 + 0.06, pixel.x) * span(at.y, y0 - 0.075, y0 - 0.03, pixel.y) * select(1.0, 0.0, door);
    var wall = vec3f(1.0 + 0.28 * grime + bricks);
    wall *= mix(1.0, 1.22, max(band, sill));
    // Dirt gathers at the foot.
    wall *= select(1.0, 0.86 + 0.14 * smoothstep(0.0, 0.5, at.y), ground);

    let framed = select(white, white * 0.3, door || shop);
    let light = scene.sky_light * 0.75;
    var shade = mix(in.shade * wall, framed * light, frame);
    var sunlit = mix(in.sunlit * wall, framed * in.sunlit * 2.0, frame);
    let open = pane * (1.0 - bar);
    shade = mix(shade, glass, open);
    sunlit = mix(sunlit, in.sunlit * 0.05, open);
    if NIGHT {
        let who = hash(cell.yx * 3.0 + vec2f(seed * 1.3, seed + 11.0));
        let is_lit = shop || (who < scene.windows_lit && !door);
        let bulb = mix(vec3f(1.1, 0.56, 0.2), vec3f(1.0, 0.85, 0.6), select(fract(who * 29.0), 0.75, shop));
        // Curtains, and the ceiling brighter than what stands below.
        let seen = (0.3 + 0.7 * fract(who * 53.0)) * (0.6 + 0.5 * at.y);
        let goods = 0.6 + 0.4 * smoothstep(0.25, 0.6, at.y + 0.5 * grime);
        let brightness = scene.window * select(seen, goods, shop);
        return finish_shining(in, shade, sunlit, select(vec3f(0.0), bulb * (brightness * open), is_lit));
    }
    return finish(in, shade, sunlit);
}
