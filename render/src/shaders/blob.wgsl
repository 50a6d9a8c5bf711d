// Soft shadows of moving things on the ground: darken what is there, write no class.

struct BlobOut {
    @builtin(position) clip: vec4f,
    @location(0) darkness: f32,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) darkness: f32) -> BlobOut {
    return BlobOut(project(position), darkness);
}

@fragment
fn fragment(in: BlobOut) -> @location(0) vec4f {
    return vec4f(0.0, 0.0, 0.0, in.darkness);
}
