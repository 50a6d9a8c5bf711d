// Classes and instances alone: where surfaces are is what `surface.wgsl` says.

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

// Leaves, with air between them.
struct SeenLeaf {
    @builtin(position) @invariant clip: vec4f,
    @location(0) @interpolate(flat) ids: u32,
    @location(1) uv: vec2f,
}

@vertex
fn vertex_leafy(
    @location(0) position: vec3f,
    @location(1) normal_sway: vec4f,
    @location(3) ids: u32,
    @location(4) uv: vec2f,
) -> SeenLeaf {
    return SeenLeaf(project(swayed(position, normal_sway.w)), ids, uv);
}

@fragment
fn fragment_leafy(in: SeenLeaf) -> Pixel {
    if leaf_at(in.uv, in.ids).x < LEAF {
        discard;
    }
    return Pixel(in.ids);
}
