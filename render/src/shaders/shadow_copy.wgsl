// Parts of shadow maps: nothing, or what another map has there. Depth textures cannot be copied in part, and in OpenGL not at all.

@group(0) @binding(0) var still: texture_depth_2d;

// All of the map, as far as it can be.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32((index << 1u) & 2u), f32(index & 2u)) * 2.0 - 1.0, 1.0, 1.0);
}

@fragment
fn copied(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(still, vec2u(at.xy), 0);
}
