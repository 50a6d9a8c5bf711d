// Classes and instances alone: where surfaces are is what `world.wgsl` says.

struct Seen {
    @builtin(position) @invariant clip: vec4f,
    @location(0) @interpolate(flat) ids: u32,
}

struct Pixel {
    @location(1) ids: u32,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal_sway: vec4f, @location(3) ids: u32) -> Seen {
    return Seen(project(swayed(position, normal_sway.w)), ids);
}

@fragment
fn fragment(in: Seen) -> Pixel {
    return Pixel(in.ids);
}
