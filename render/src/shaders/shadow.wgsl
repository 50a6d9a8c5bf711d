// The world seen from the sun: depth only.

// From the world to the clip space of the map.
@group(0) @binding(0) var<uniform> clip: mat4x4f;

@vertex
fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip * vec4f(position, 1.0);
}
