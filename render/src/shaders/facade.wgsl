
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
