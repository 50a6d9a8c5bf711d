
// What walls and roofs of houses are made of: courses, beams, and signs on them.

fn hash(p: vec2f) -> f32 {
    let q = fract(p * vec2f(0.1031, 0.1137));
    let r = q + dot(q, q.yx + 33.33);
    return fract((r.x + r.y) * r.x);
}

// Share of a pixel `width` wide at x that lies in [low, high].
fn span(x: f32, low: f32, high: f32, width: f32) -> f32 {
    return max(min(high, x + 0.5 * width) - max(low, x - 0.5 * width), 0.0) / width;
}

fn box(at: vec2f, low: vec2f, high: vec2f, width: vec2f) -> f32 {
    let inside = max(min(high, at + 0.5 * width) - max(low, at - 0.5 * width), vec2f(0.0)) / width;
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

// Cover of signs that look like writing from afar: stems with one bar and another or a second stem, no letters of any
// script. `at` counts them.
fn writing(at: vec2f, pixel: vec2f, seed: f32) -> f32 {
    let sign = floor(at.x);
    let x = at.x - sign;
    let chance = hash(vec2f(sign, seed));
    let top = 0.66 + 0.34 * step(0.6, fract(chance * 7.0));
    let stem = box(vec2f(x, at.y), vec2f(0.12, 0.0), vec2f(0.34, top), pixel);
    let high = select(0.44, 0.5 * fract(chance * 3.0), fract(chance * 5.0) > 0.5);
    let bar = box(vec2f(x, at.y), vec2f(0.12, high), vec2f(0.8, high + 0.2), pixel);
    let is_two = fract(chance * 11.0) < 0.5;
    let first = select(vec2f(0.12, top - 0.2), vec2f(0.62, 0.0), is_two);
    let second = box(vec2f(x, at.y), first, vec2f(select(0.74, 0.82, is_two), top), pixel);
    let drawn = max(max(stem, bar), second) * step(0.14, chance);
    return mix(drawn, 0.3 * span(at.y, 0.0, 0.8, pixel.y), clamp(1.6 * pixel.x - 0.6, 0.0, 1.0));
}
