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

// Code of a lamp that shines, and of the glass of a street lamp.
const LIT = 255u;
const STREET_LAMP = 250u;
// Code of the face of a sign, and how much brighter than dull paint it is in its own headlights, high as it is.
const RETRO = 248u;
const RETRO_GAIN = 1.5;

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
    // Of these surfaces it is what shines of them.
    out.uv_param = vec3f(0.0);
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
    if code_of(in.ids) == LIT {
        out.shade = to_linear(in.colour_param.rgb) * 2.2;
        out.sunlit = vec3f(0.0);
        if NIGHT {
            shine(&out, out.shade);
        }
    }
    if NIGHT && code_of(in.ids) == STREET_LAMP {
        shine(&out, mix(out.shade, vec3f(2.4, 2.0, 1.3), scene.shine));
    }
    if NIGHT && code_of(in.ids) == RETRO {
        // What headlights reach comes back to who drives behind them.
        let uv = out.from_eye.xy * scene.light_map_per_m + scene.light_map_at;
        let lit = textureSampleLevel(light_map, noise_sampler, clamp(uv, vec2f(0.003), vec2f(0.997)), 0.0).g;
        let back = max(-dot(view, normal), 0.0) * RETRO_GAIN * lit * lit;
        out.uv_param = to_linear(in.colour_param.rgb) * scene.headlight * back;
    }
    return out;
}

fn sunshine(at: vec3f) -> f32 {
    if !SUN {
        return 1.0;
    }
    let reach = (SHADOW_TAPS - 1) / 2;
    let middle = at.xy + vec2f(scene.shadow_at_x, scene.shadow_at_y);
    var sum = 0.0;
    for (var y = -reach; y <= reach; y++) {
        for (var x = -reach; x <= reach; x++) {
            // Half a texel apart: wider, they would wash out what is as thin as a post.
            let uv = middle + vec2f(f32(x), f32(y)) * (0.5 * scene.shadow_texel);
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
    return finish_shining(in, in.shade, in.sunlit, in.uv_param);
}
