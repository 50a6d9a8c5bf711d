// Soft shadows of moving things on the ground: darken what is there, write no class.

struct BlobOut {
    @builtin(position) clip: vec4f,
    @location(0) darkness: f32,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) darkness: f32) -> BlobOut {
    // Fog lies over shadows too.
    let through = exp(-scene.fog_per_m * max(length(position - scene.eye) - scene.fog_from_m, 0.0));
    return BlobOut(project(position), select(darkness, darkness * through, scene.fog_per_m > 0.0));
}

@fragment
fn fragment(in: BlobOut) -> @location(0) vec4f {
    return vec4f(0.0, 0.0, 0.0, in.darkness);
}
