
// Walls and roofs of houses: uv count window columns and storeys of CELL_M. Below 0 there are no windows.
struct Facade {
    // As in `classes.wgsl`, to the last bit.
    @builtin(position) @invariant clip: vec4f,
    @location(0) shade: vec3f,
    @location(1) sunlit: vec3f,
    @location(2) shadow: vec3f,
    @location(3) uv_param: vec3f,
    @location(4) @interpolate(flat) ids: u32,
    @location(5) from_eye: vec3f,
    // The way out of the wall.
    @location(6) @interpolate(flat) out: vec2f,
}

@vertex
fn vertex_facade(in: VertexIn) -> Facade {
    let it = lit(in);
    return Facade(it.clip, it.shade, it.sunlit, it.shadow, it.uv_param, it.ids, it.from_eye, in.normal_sway.xy);
}

const CELL_M = vec2f(2.7, 3.0);
// Panes lie so far inside the wall.
const REVEAL_M = 0.17;
// To the houses on the other side, which panes mirror.
const OPPOSITE_M = 15.0;

// As `building::style` has them.
const MATERIAL = 7u;
const BRICK = 1u;
const TIMBER = 2u;
const PANELS = 3u;
const GLASS = 4u;
const STONE = 5u;
const TILES = 6u;
const GARAGE = 7u;
const BANDS = 8u;
const SHOP = 16u;
const FRENCH = 32u;
const SHUTTERS = 64u;
const DOOR = 128u;

fn hash(p: vec2f) -> f32 {
    let q = fract(p * vec2f(0.1031, 0.1137));
    let r = q + dot(q, q.yx + 33.33);
    return fract((r.x + r.y) * r.x);
}

// Share of a pixel `width` wide at x that lies in [low, high].
fn span(x: f32, low: f32, high: f32, width: f32) -> f32 {
    return clamp((x - low) / width + 0.5, 0.0, 1.0) * clamp((high - x) / width + 0.5, 0.0, 1.0);
}

fn box(at: vec2f, low: vec2f, high: vec2f, width: vec2f) -> f32 {
    let inside = clamp((at - low) / width + 0.5, vec2f(0.0), vec2f(1.0)) * clamp((high - at) / width + 0.5, vec2f(0.0), vec2f(1.0));
    return inside.x * inside.y;
}

// Bricks, blocks, panels and tiles: what courses and joints make of a colour. They fade where a pixel holds a course.
fn courses(material: u32, uv: vec2f, pixel: vec2f) -> vec3f {
    var scale = vec2f(4.0, 12.0) * CELL_M;
    var joint = vec3f(1.35, 1.42, 1.45);
    var low = vec2f(0.05, 0.14);
    var vary = 0.42;
    if material == STONE {
        scale = vec2f(3.0, 7.0);
        joint = vec3f(0.72);
        low = vec2f(0.025, 0.05);
        vary = 0.16;
    } else if material == PANELS || material == GLASS {
        scale = vec2f(1.0);
        joint = vec3f(0.55);
        low = vec2f(0.012, 0.012);
        vary = 0.07;
    } else if material == TILES {
        scale = vec2f(4.2, 3.2) * CELL_M;
        joint = vec3f(0.55);
        low = vec2f(0.1, 0.2);
        vary = 0.34;
    }
    let at = uv * scale;
    let row = floor(at.y);
    let shifted = vec2f(at.x + select(0.5 * fract(0.5 * row) * 2.0, 0.0, material == PANELS || material == GLASS), at.y);
    let stone = floor(shifted);
    let width = pixel * scale;
    let solid = box(shifted - stone, low, vec2f(2.0), width);
    let tone = vec3f(1.0 + vary * (hash(stone) - 0.5));
    let mean = mix(joint, vec3f(1.0), (1.0 - low.x) * (1.0 - low.y));
    let fade = clamp(1.5 - 1.3 * max(width.x, width.y), 0.0, 1.0);
    return mix(mean, mix(joint, tone, solid), fade);
}

// Cover of the beams of a half-timbered wall whose windows begin at a height of their storey.
fn beams(at: vec2f, pixel: vec2f, sill: f32, braced: bool) -> f32 {
    let post = span(abs(at.x - 0.5), 0.465, 0.6, pixel.x);
    let rail = max(span(abs(at.y - 0.5), 0.46, 0.6, pixel.y), span(at.y, sill - 0.05, sill, pixel.y));
    let rise = at.y / sill;
    let lean = abs(abs(at.x - 0.5) * 2.0 - select(rise, 1.0 - rise, braced));
    let brace = span(lean, -1.0, 0.09, 2.0 * pixel.x + pixel.y / sill) * span(at.y, 0.0, sill, pixel.y);
    return max(max(post, rail), brace);
}

// Cover of signs that look like writing from afar: stems with bars, no letters of any script. `at` counts them.
fn writing(at: vec2f, pixel: vec2f, seed: f32) -> f32 {
    let sign = floor(at.x);
    let x = at.x - sign;
    let chance = hash(vec2f(sign, seed));
    let top = 0.66 + 0.34 * step(0.6, fract(chance * 7.0));
    let stem = box(vec2f(x, at.y), vec2f(0.12, 0.0), vec2f(0.34, top), pixel);
    let high = select(0.44, 0.5 * fract(chance * 3.0), fract(chance * 5.0) > 0.5);
    let bar = box(vec2f(x, at.y), vec2f(0.12, high), vec2f(0.8, high + 0.2), pixel);
    let drawn = max(stem, bar) * step(0.14, chance);
    return mix(drawn, 0.3 * span(at.y, 0.0, 0.8, pixel.y), clamp(1.6 * pixel.x - 0.6, 0.0, 1.0));
}

// A strong colour of signs and doors; each hue is one.
fn accent(hue: f32) -> vec3f {
    let wheel = clamp(abs(fract(hue + vec3f(0.0, 0.667, 0.333)) * 6.0 - 3.0) - 1.0, vec3f(0.0), vec3f(1.0));
    return 0.016 + vec3f(0.2, 0.12, 0.17) * wheel * wheel;
}

// What a pane mirrors at a place of the wall, metres: the sky above the houses opposite, or those.
fn mirrored(place: vec2f, slope: vec2f, view: vec3f, out: vec2f, seed: f32) -> vec3f {
    let there = place + slope * OPPOSITE_M;
    let house = hash(vec2f(floor(there.x * 0.11), seed));
    let above = clamp((there.y - 7.0 - 6.0 * house) * 0.7 + 0.5, 0.0, 1.0);
    let bounce = view - 2.0 * dot(view.xy, out) * vec3f(out, 0.0);
    let walls = (scene.ground_light + scene.sun_light * 0.1) * (0.16 + 0.12 * house);
    let overcast = scene.sun_light * 0.2 + scene.sky_light * 0.5;
    return mix(walls, mix(sky_colour(bounce), overcast, 0.8 * scene.cloudiness), above);
}

@fragment
fn fragment_facade(facade: Facade) -> Pixel {
    let in = Lit(facade.clip, facade.shade, facade.sunlit, facade.shadow, facade.uv_param, facade.ids, facade.from_eye);
    let uv = in.uv_param.xy;
    // Whole, as the vertices have it: what interpolation leaves over would tip the hash from pixel to pixel.
    let seed = round(in.uv_param.z * 255.0);
    let look = u32(seed);
    let code = code_of(in.ids);
    let material = code & MATERIAL;
    let pixel = max(fwidth(uv), vec2f(0.001));
    let cell = floor(uv);
    let at = uv - cell;
    let chance = hash(cell + vec2f(seed, seed * 1.7));
    let luck = fract(chance * 37.0);
    let has_windows = cell.y >= 0.0 && material != TILES;
    let ground = cell.y == 0.0;
    let door = ground && (code & DOOR) != 0u && u32(cell.x) == (look >> 4u) % 3u;
    let shop = ground && (code & SHOP) != 0u && !door;
    let garage = material == GARAGE;
    let curtain_wall = material == GLASS && !(door || shop);
    let plain = !(door || shop || curtain_wall || garage);

    // The opening.
    var half_width = 0.16 + 0.035 * f32(look & 3u);
    var low = select(0.3, 0.06, (code & FRENCH) != 0u && !ground);
    var high = 0.74 + 0.035 * f32((look >> 2u) & 3u);
    half_width = select(half_width, 0.46, shop || garage);
    half_width = select(half_width, 0.17, door && !garage);
    half_width = select(half_width, 0.485, curtain_wall);
    low = select(low, 0.16, shop);
    low = select(low, select(0.1, 0.0, garage), door);
    low = select(low, select(0.2, 0.11, ground), curtain_wall);
    high = select(high, 0.7, shop || door);
    high = select(high, 0.985, curtain_wall);
    let lower = vec2f(0.5 - half_width, low);
    let upper = vec2f(0.5 + half_width, high);

    // What is behind it moves against its edges as the eye does.
    let out = facade.out;
    let tangent = vec2f(-out.y, out.x);
    let away = max(-dot(in.from_eye.xy, out), 0.05);
    let slope = vec2f(dot(in.from_eye.xy, tangent), in.from_eye.z) / away;
    let reveal = select(REVEAL_M, 0.05, curtain_wall) / CELL_M;
    let behind = at + clamp(slope * reveal, vec2f(-0.3), vec2f(0.3));
    let opening = select(0.0, box(at, lower, upper, pixel), has_windows);
    let inside = box(behind, lower, upper, pixel);
    let border = select(vec2f(0.026, 0.024), vec2f(0.012), shop || curtain_wall);
    let bars = select(0.0, span(behind.x, 0.487, 0.513, pixel.x), plain && (look & 3u) != 0u);
    let cross = select(0.0, span(behind.y, mix(low, high, 0.66), mix(low, high, 0.66) + 0.02, pixel.y), plain && (code & FRENCH) == 0u && (look & 16u) != 0u);
    let pane = box(behind, lower + border, upper - border, pixel) * (1.0 - max(bars, cross));

    // The wall around it.
    let grime = textureSample(noise, noise_sampler, uv * vec2f(0.21, 0.27)).r - 0.5;
    let rusticated = (code & BANDS) != 0u && ground && material == 0u;
    let plastered = material == 0u || material == TIMBER || garage;
    let masonry = courses(select(material, STONE, rusticated), uv, pixel);
    var wall = select(masonry, vec3f(1.0), plastered && !rusticated) * (1.0 + 0.26 * grime);
    let timber = select(0.0, beams(at, pixel, low, luck > 0.5), material == TIMBER && !ground);
    let banded = (code & BANDS) != 0u && !ground;
    let band = select(0.0, span(at.y, 0.95, 1.01, pixel.y), banded);
    let sill = box(at, lower - vec2f(0.035, 0.045), vec2f(upper.x + 0.035, low), pixel) * select(0.0, 1.0, plain && has_windows);
    let trim = box(at, lower - 0.035, upper + 0.035, pixel) * select(0.0, 0.16, banded && plain && has_windows);
    // Water leaves streaks below sills, and dirt gathers at the foot.
    let streak = select(0.0, span(abs(at.x - 0.5), -1.0, half_width, pixel.x) * clamp(1.0 - (low - at.y) * 3.6, 0.0, 1.0) * step(at.y, low), plain && has_windows);
    wall *= (1.0 - streak * (0.13 + 0.3 * grime)) * (1.0 + max(0.2 * max(band, sill), trim));
    wall *= select(1.0, 0.78 + 0.22 * smoothstep(0.0, 0.35, at.y + 0.3 * grime), ground);
    wall = mix(wall, vec3f(0.16, 0.105, 0.075), timber);

    let facing = max(dot(out, scene.sun.xy), 0.0);
    let sun_on = scene.sun_light * facing;
    let sky_on = mix(scene.ground_light, scene.sky_light, 0.5);
    var shade = in.shade * wall;
    var sunlit = in.sunlit * wall;

    // Shutters beside windows, and the fascia above shops.
    let tint = accent(fract(seed * 0.37));
    let muted = mix(tint, vec3f(0.045, 0.05, 0.045), 0.6);
    let beside = span(abs(at.x - 0.5), half_width + 0.012, half_width + 0.16, pixel.x) * span(at.y, low, high, pixel.y);
    let folded = select(0.0, beside, plain && has_windows && (code & SHUTTERS) != 0u);
    let fascia = select(0.0, span(at.y, 0.75, 0.93, pixel.y), ground && (code & SHOP) != 0u);
    let letters = fascia * writing(vec2f(uv.x * 8.0, (at.y - 0.79) * 10.0), pixel * vec2f(8.0, 10.0), seed);
    let is_pale = (look & 8u) != 0u;
    let board = select(tint, vec3f(0.5, 0.48, 0.43), is_pale);
    let painted = mix(select(muted, board, fascia > folded), select(vec3f(0.72, 0.68, 0.56), tint, is_pale), letters);
    shade = mix(shade, painted * sky_on, max(folded, fascia));
    sunlit = mix(sunlit, painted * sun_on, max(folded, fascia));

    // Reveals: the sun reaches one side and the sill, less the deeper it shines past.
    let sun_slope = vec2f(dot(scene.sun.xy, tangent), scene.sun.z) / max(facing, 0.05);
    let left = behind.x < lower.x;
    let soffit = behind.y > high;
    let reached = select(0.0, clamp(select(-sun_slope.x, sun_slope.x, left), 0.0, 1.4), !soffit);
    let cheek = select(0.55, 0.36, soffit);
    shade = mix(shade, in.shade * cheek, opening);
    sunlit = mix(sunlit, in.sunlit * (0.55 * reached), opening);

    // Frames, leaves of doors, in the shadow of the opening's edges.
    let struck = behind + clamp(sun_slope * reveal, vec2f(-0.3), vec2f(0.3));
    let sun_in = sun_on * box(struck, lower, upper, pixel);
    let pale = select(vec3f(0.6, 0.59, 0.56), vec3f(0.06, 0.062, 0.065), (look & 0x60u) == 0x60u || shop || curtain_wall);
    let leaf = mix(muted, vec3f(0.09, 0.045, 0.022), step(0.4, luck));
    let door_size = upper - lower;
    let in_door = (behind - lower) / door_size;
    let panels = 1.0 - 0.3 * box(in_door, vec2f(0.16, 0.07), vec2f(0.84, 0.4), pixel / door_size);
    let ribs = 0.85 + 0.15 * span(abs(fract(at.y * 7.0) - 0.5), 0.06, 1.0, pixel.y * 7.0);
    let framed = select(select(pale, leaf * panels, door), vec3f(0.5) * ribs, garage);
    let solid = opening * inside;
    shade = mix(shade, framed * sky_on, solid);
    sunlit = mix(sunlit, framed * sun_in, solid);

    // Roller shutters, some half down.
    let drop = select(1.0, select(0.08 + 0.9 * luck, 0.0, luck > 0.6), chance < 0.22 && (look & 0x40u) == 0u);
    let rolled = select(0.0, span(behind.y, mix(low, high, drop), 2.0, pixel.y), plain);
    let slats = 0.42 * (0.86 + 0.14 * span(abs(fract(at.y * 34.0) - 0.5), 0.12, 1.0, pixel.y * 34.0));

    // Rooms are dark, curtains hang in some; goods stand behind shop windows.
    let aside = abs(behind.x - 0.5) / half_width;
    let drape = select(0.0, select(step(0.62, aside), 0.7, luck > 0.7), chance > 0.45 && plain);
    let shelf = floor(vec2f(behind.x * 9.0, 0.0));
    let good = hash(shelf + cell * 7.0 + seed);
    let ware = (0.3 + 0.7 * vec3f(good, fract(good * 7.0), fract(good * 13.0))) * (0.02 + 0.2 * fract(good * 17.0));
    let stocked = select(0.0, span(behind.y, 0.0, 0.24 + 0.24 * good, pixel.y), shop) * span(fract(behind.x * 9.0), 0.1, 0.9, pixel.x * 9.0);
    let room = mix(mix(vec3f(0.014, 0.017, 0.021), vec3f(0.26, 0.24, 0.21), drape), ware, stocked);
    let view = in.from_eye / max(length(in.from_eye), 0.01);
    let grazing = 1.0 - clamp(-dot(view.xy, out), 0.0, 1.0);
    let g2 = grazing * grazing;
    let fresnel = select(0.13, 0.34, curtain_wall) + 0.8 * g2 * g2 * grazing;
    let mirror = mirrored(uv * CELL_M, slope, view, out, seed) * fresnel;
    let glass = room * sky_on * (1.0 - fresnel) + mirror;
    let shop_door = (code & SHOP) != 0u;
    let light = box(in_door, vec2f(0.16, select(0.5, 0.1, shop_door)), vec2f(0.84, 0.93), pixel / door_size);
    let glazed = opening * select(select(pane, light * inside, door), 0.0, garage);
    let see_through = glazed * (1.0 - rolled);
    shade = mix(shade, mix(glass, slats * sky_on, rolled), glazed);
    sunlit = mix(sunlit, mix(sun_in * (0.02 + 0.1 * drape), slats * sun_in, rolled), glazed);
    if NIGHT {
        let who = hash(cell.yx * 3.0 + vec2f(seed * 1.3, seed + 11.0));
        let is_lit = shop || (who < scene.windows_lit && !door) || (door && shop_door);
        let bulb = mix(vec3f(1.1, 0.56, 0.2), vec3f(1.0, 0.85, 0.6), select(fract(who * 29.0), 0.75, shop || curtain_wall));
        // Curtains, and the ceiling brighter than what stands below.
        let lamp = (behind - vec2f(0.35 + 0.3 * luck, 0.8)) * vec2f(2.2, 3.0);
        let seen = (0.3 + 0.7 * fract(who * 53.0)) * (0.5 + 0.75 / (1.0 + dot(lamp, lamp))) * (1.0 - 0.45 * drape);
        let goods = mix(vec3f(0.55 + 0.4 * at.y), ware * 6.0, stocked);
        let brightness = scene.window * select(vec3f(seen), goods, shop);
        let sign = (painted * 2.0 + letters * 0.6) * (scene.window * 0.8 * fascia);
        return finish_shining(in, shade, sunlit, select(vec3f(0.0), bulb * (brightness * see_through), is_lit) + sign);
    }
    return finish(in, shade, sunlit);
}
