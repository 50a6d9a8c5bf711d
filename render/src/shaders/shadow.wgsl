// The world seen from the sun: depth only.

@vertex
fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    let at = scene.shadow * vec4f(position, 1.0);
    return vec4f(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, at.z, 1.0);
}
