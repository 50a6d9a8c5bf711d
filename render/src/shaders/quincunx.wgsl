// Quincunx: half of a pixel is the sample in its middle, half those at its four corners.

@group(0) @binding(0) var middles: texture_2d<f32>;
@group(0) @binding(1) var corners: texture_2d<f32>;
@group(0) @binding(2) var<storage, read_write> out_colours: array<u32>;

// Elements a row of the output has; rows are padded.
override STRIDE: u32;

fn corner(at: vec2u) -> vec3f {
    let c = textureLoad(corners, at, 0).rgb;
    return c * c;
}

@compute @workgroup_size(8, 8)
fn quincunx(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(middles)) {
        return;
    }
    let middle = textureLoad(middles, id.xy, 0).rgb;
    let sum = corner(id.xy) + corner(id.xy + vec2u(1, 0)) + corner(id.xy + vec2u(0, 1)) + corner(id.xy + 1u);
    out_colours[id.y * STRIDE + id.x] = pack4x8unorm(vec4f(sqrt(0.5 * middle * middle + 0.125 * sum), 1.0));
}
