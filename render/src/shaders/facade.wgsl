
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
const DOOR_COLUMNS = 3u;

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

// A place of a wall, and what is there.
struct Spot {
    uv: vec2f,
    pixel: vec2f,
    // The window's part of the wall, and the place in it from 0 to 1.
    cell: vec2f,
    at: vec2f,
    seed: f32,
    look: u32,
    code: u32,
    material: u32,
    // Drawn for the cell.
    chance: f32,
    luck: f32,
    ground: bool,
    has_windows: bool,
    door: bool,
    shop: bool,
    garage: bool,
    curtain_wall: bool,
    // None of these.
    window: bool,
}

fn spot_of(in: Lit) -> Spot {
    var it: Spot;
    it.uv = in.uv_param.xy;
    it.pixel = max(fwidth(it.uv), vec2f(0.001));
    it.cell = floor(it.uv);
    it.at = it.uv - it.cell;
    // Whole, as the vertices have it: what interpolation leaves over would tip the hash from pixel to pixel.
    it.seed = round(in.uv_param.z * 255.0);
    it.look = u32(it.seed);
    it.code = code_of(in.ids);
    it.material = it.code & MATERIAL;
    it.chance = hash(it.cell + vec2f(it.seed, it.seed * 1.7));
    it.luck = fract(it.chance * 37.0);
    it.ground = it.cell.y == 0.0;
    it.has_windows = it.cell.y >= 0.0 && it.material != TILES;
    // Their fronts may have one column.
    let narrow = it.material == GARAGE && it.cell.x == 0.0;
    it.door = it.ground && (it.code & DOOR) != 0u && (narrow || u32(it.cell.x) == (it.look >> 4u) % DOOR_COLUMNS);
    it.shop = it.ground && (it.code & SHOP) != 0u && !it.door;
    it.garage = it.material == GARAGE;
    it.curtain_wall = it.material == GLASS && !(it.door || it.shop);
    it.window = it.has_windows && !(it.door || it.shop || it.garage || it.curtain_wall);
    return it;
}

struct Opening {
    lower: vec2f,
    upper: vec2f,
    half_width: f32,
    cover: f32,
}

fn opening_of(it: Spot) -> Opening {
    var half_width = 0.16 + 0.035 * f32(it.look & 3u);
    var low = select(0.3, 0.06, (it.code & FRENCH) != 0u && !it.ground);
    var high = 0.74 + 0.035 * f32((it.look >> 2u) & 3u);
    half_width = select(half_width, 0.46, it.shop || it.garage);
    half_width = select(half_width, 0.17, it.door && !it.garage);
    half_width = select(half_width, 0.485, it.curtain_wall);
    low = select(low, 0.16, it.shop);
    low = select(low, select(select(0.1, 0.05, (it.code & SHOP) != 0u), 0.0, it.garage), it.door);
    low = select(low, select(0.2, 0.11, it.ground), it.curtain_wall);
    high = select(high, select(0.77, 0.7, (it.code & SHOP) != 0u), it.shop || it.door);
    high = select(high, 0.985, it.curtain_wall);
    let lower = vec2f(0.5 - half_width, low);
    let upper = vec2f(0.5 + half_width, high);
    let cover = select(0.0, box(it.at, lower, upper, it.pixel), it.has_windows);
    return Opening(lower, upper, half_width, cover);
}

// What the wall makes of its colour.
fn wall_of(it: Spot, hole: Opening) -> vec3f {
    let grime = textureSample(noise, noise_sampler, it.uv * vec2f(0.21, 0.27)).r - 0.5;
    let banded = (it.code & BANDS) != 0u;
    let rusticated = banded && it.ground && it.material == 0u;
    let plastered = it.material == 0u || it.material == TIMBER || it.garage;
    let masonry = courses(select(it.material, STONE, rusticated), it.uv, it.pixel);
    var wall = select(masonry, vec3f(1.0), plastered && !rusticated) * (1.0 + 0.26 * grime);
    let low = hole.lower.y;
    let band = select(0.0, span(it.at.y, 0.95, 1.01, it.pixel.y), banded && !it.ground);
    let below = vec2f(hole.upper.x + 0.035, low);
    let sill = select(0.0, box(it.at, hole.lower - vec2f(0.035, 0.045), below, it.pixel), it.window);
    // Surrounds, and lintels over windows between bricks.
    let is_brick = it.material == BRICK;
    let first = select(hole.lower - 0.035, vec2f(hole.lower.x - 0.04, hole.upper.y), is_brick);
    let last = hole.upper + select(vec2f(0.035), vec2f(0.04, 0.07), is_brick);
    let trim = select(0.0, box(it.at, first, last, it.pixel), it.window && (is_brick || banded && !it.ground));
    // Water leaves streaks below sills, and dirt gathers at the foot.
    let wet = span(abs(it.at.x - 0.5), -1.0, hole.half_width, it.pixel.x) * clamp(1.0 - (low - it.at.y) * 3.6, 0.0, 1.0);
    let streak = select(0.0, wet, it.window && it.at.y < low);
    wall *= (1.0 - streak * (0.13 + 0.3 * grime)) * (1.0 + max(0.2 * max(band, sill), 0.16 * trim));
    wall *= select(1.0, 0.78 + 0.22 * smoothstep(0.0, 0.35, it.at.y + 0.3 * grime), it.ground);
    let beam = select(0.0, beams(it.at, it.pixel, low, it.luck > 0.5), it.material == TIMBER && !it.ground);
    return mix(wall, vec3f(0.16, 0.105, 0.075), beam);
}

// Where frames and leaves leave glass, at a place behind the wall.
fn glass_of(it: Spot, hole: Opening, behind: vec2f, in_door: vec2f, door_pixel: vec2f) -> f32 {
    let border = select(vec2f(0.026, 0.024), vec2f(0.012), it.shop || it.curtain_wall);
    let upright = select(0.0, span(behind.x, 0.487, 0.513, it.pixel.x), it.window && (it.look & 3u) != 0u);
    let split = mix(hole.lower.y, hole.upper.y, 0.66);
    let is_crossed = it.window && (it.code & FRENCH) == 0u && (it.look & 16u) != 0u;
    let bar = select(0.0, span(behind.y, split, split + 0.02, it.pixel.y), is_crossed);
    let pane = box(behind, hole.lower + border, hole.upper - border, it.pixel) * (1.0 - max(upright, bar));
    let above = select(0.5, 0.1, (it.code & SHOP) != 0u);
    let light = box(in_door, vec2f(0.16, above), vec2f(0.84, 0.93), door_pixel);
    return select(select(pane, light, it.door), 0.0, it.garage);
}

// Goods behind a shop window: colour, and how much of the pixel they cover.
fn goods(it: Spot, behind: vec2f) -> vec4f {
    let x = behind.x * 9.0;
    let good = hash(vec2f(floor(x), 0.0) + it.cell * 7.0 + it.seed);
    let hue = 0.3 + 0.7 * vec3f(good, fract(good * 7.0), fract(good * 13.0));
    let high = span(behind.y, 0.0, 0.24 + 0.24 * good, it.pixel.y);
    let cover = select(0.0, high * span(fract(x), 0.1, 0.9, it.pixel.x * 9.0), it.shop);
    return vec4f(hue * (0.02 + 0.2 * fract(good * 17.0)), cover);
}

@fragment
fn fragment_facade(facade: Facade) -> Pixel {
    let in = Lit(facade.clip, facade.shade, facade.sunlit, facade.shadow, facade.uv_param, facade.ids, facade.from_eye);
    let it = spot_of(in);
    let hole = opening_of(it);
    let wall = wall_of(it, hole);
    let out = facade.out;
    let facing = max(dot(out, scene.sun.xy), 0.0);
    let sun_on = scene.sun_light * facing;
    let sky_on = mix(scene.ground_light, scene.sky_light, 0.5);
    var shade = in.shade * wall;
    var sunlit = in.sunlit * wall;

    // Shutters beside windows, and the fascia above shops.
    let tint = accent(fract(it.seed * 0.37));
    let muted = mix(tint, vec3f(0.045, 0.05, 0.045), 0.6);
    let beside = span(abs(it.at.x - 0.5), hole.half_width + 0.012, hole.half_width + 0.16, it.pixel.x);
    let folded = beside * span(it.at.y, hole.lower.y, hole.upper.y, it.pixel.y);
    let shutters = select(0.0, folded, it.window && (it.code & SHUTTERS) != 0u);
    let is_front = (it.code & SHOP) != 0u && it.ground;
    let fascia = select(0.0, span(it.at.y, 0.75, 0.93, it.pixel.y), is_front);
    let glyphs = vec2f(8.0, 10.0);
    let letters = fascia * writing(vec2f(it.uv.x, it.at.y - 0.79) * glyphs, it.pixel * glyphs, it.seed);
    let is_pale = (it.look & 8u) != 0u;
    let board = select(muted, select(tint, vec3f(0.5, 0.48, 0.43), is_pale), is_front);
    let painted = mix(board, select(vec3f(0.72, 0.68, 0.56), tint, is_pale), letters);
    shade = mix(shade, painted * sky_on, max(shutters, fascia));
    sunlit = mix(sunlit, painted * sun_on, max(shutters, fascia));

    // What is behind the wall moves against the edges of its opening as the eye does.
    let tangent = vec2f(-out.y, out.x);
    let away = max(-dot(in.from_eye.xy, out), 0.05);
    let slope = vec2f(dot(in.from_eye.xy, tangent), in.from_eye.z) / away;
    let sun_slope = vec2f(dot(scene.sun.xy, tangent), scene.sun.z) / max(facing, 0.05);
    let reveal = select(REVEAL_M, 0.05, it.curtain_wall) / CELL_M;
    let behind = it.at + clamp(slope * reveal, vec2f(-0.3), vec2f(0.3));
    let inside = box(behind, hole.lower, hole.upper, it.pixel);

    // Reveals: the sun reaches one side, and none of what is above.
    let soffit = behind.y > hole.upper.y;
    let side = select(-sun_slope.x, sun_slope.x, behind.x < hole.lower.x);
    let reached = select(clamp(side, 0.0, 1.4), 0.0, soffit);
    shade = mix(shade, in.shade * select(0.55, 0.36, soffit), hole.cover);
    sunlit = mix(sunlit, in.sunlit * (0.55 * reached), hole.cover);

    // Frames and leaves of doors, in the shadow of the opening's edges.
    let struck = behind + clamp(sun_slope * reveal, vec2f(-0.3), vec2f(0.3));
    let sun_in = sun_on * box(struck, hole.lower, hole.upper, it.pixel);
    let is_dark = (it.look & 0x60u) == 0x60u || it.shop || it.curtain_wall;
    let frame = select(vec3f(0.6, 0.59, 0.56), vec3f(0.06, 0.062, 0.065), is_dark);
    let leaf = select(muted, vec3f(0.09, 0.045, 0.022), it.luck > 0.4);
    let door_size = hole.upper - hole.lower;
    let in_door = (behind - hole.lower) / door_size;
    let door_pixel = it.pixel / door_size;
    let panels = 1.0 - 0.3 * box(in_door, vec2f(0.16, 0.07), vec2f(0.84, 0.4), door_pixel);
    let ribs = 0.85 + 0.15 * span(abs(fract(it.at.y * 7.0) - 0.5), 0.06, 1.0, it.pixel.y * 7.0);
    let framed = select(select(frame, leaf * panels, it.door), vec3f(0.5) * ribs, it.garage);
    shade = mix(shade, framed * sky_on, hole.cover * inside);
    sunlit = mix(sunlit, framed * sun_in, hole.cover * inside);

    // Roller shutters, some half down.
    let has_rolled = it.window && it.chance < 0.22 && (it.look & 0x40u) == 0u;
    let end = mix(hole.lower.y, hole.upper.y, select(0.0, 0.08 + 0.9 * it.luck, it.luck < 0.6));
    let rolled = select(0.0, span(behind.y, end, 2.0, it.pixel.y), has_rolled);
    let slats = 0.42 * (0.86 + 0.14 * span(abs(fract(it.at.y * 34.0) - 0.5), 0.12, 1.0, it.pixel.y * 34.0));

    // Rooms are dark, curtains hang in some; goods stand behind shop windows.
    let aside = abs(behind.x - 0.5) / hole.half_width;
    let drape = select(0.0, select(step(0.62, aside), 0.7, it.luck > 0.7), it.chance > 0.45 && it.window);
    let ware = goods(it, behind);
    let room = mix(mix(vec3f(0.014, 0.017, 0.021), vec3f(0.26, 0.24, 0.21), drape), ware.rgb, ware.a);
    let view = in.from_eye / max(length(in.from_eye), 0.01);
    let grazing = 1.0 - clamp(-dot(view.xy, out), 0.0, 1.0);
    let g2 = grazing * grazing;
    let fresnel = select(0.13, 0.34, it.curtain_wall) + 0.8 * g2 * g2 * grazing;
    let mirror = mirrored(it.uv * CELL_M, slope, view, out, it.seed) * fresnel;
    let glass = room * sky_on * (1.0 - fresnel) + mirror;
    let glazed = hole.cover * inside * glass_of(it, hole, behind, in_door, door_pixel);
    shade = mix(shade, mix(glass, slats * sky_on, rolled), glazed);
    sunlit = mix(sunlit, sun_in * mix(0.02 + 0.1 * drape, slats, rolled), glazed);
    if NIGHT {
        let sign = (painted * 2.0 + letters * 0.6) * (scene.window * 0.8 * fascia);
        let light = lit_room(it, behind, drape, ware) * (scene.window * glazed * (1.0 - rolled));
        return finish_shining(in, shade, sunlit, light + sign);
    }
    return finish(in, shade, sunlit);
}

// What comes out of a window at night.
fn lit_room(it: Spot, behind: vec2f, drape: f32, ware: vec4f) -> vec3f {
    let who = hash(it.cell.yx * 3.0 + vec2f(it.seed * 1.3, it.seed + 11.0));
    let of_shop = it.shop || it.door && (it.code & SHOP) != 0u;
    let is_lit = of_shop || who < scene.windows_lit && !it.door;
    let cool = select(fract(who * 29.0), 0.75, of_shop || it.curtain_wall);
    let bulb = mix(vec3f(1.1, 0.56, 0.2), vec3f(1.0, 0.85, 0.6), cool);
    // Curtains, and a lamp below the ceiling.
    let lamp = (behind - vec2f(0.35 + 0.3 * it.luck, 0.8)) * vec2f(2.2, 3.0);
    let seen = (0.3 + 0.7 * fract(who * 53.0)) * (0.5 + 0.75 / (1.0 + dot(lamp, lamp))) * (1.0 - 0.45 * drape);
    let shown = mix(vec3f(0.55 + 0.4 * it.at.y), ware.rgb * 6.0, ware.a);
    return select(vec3f(0.0), bulb * select(vec3f(seen), shown, of_shop), is_lit);
}
