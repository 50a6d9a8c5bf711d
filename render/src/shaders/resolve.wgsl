// From samples to one pixel: the mean colour; class and depth of the middle sample.

@group(0) @binding(0) var colours: texture_2d<f32>;
@group(0) @binding(1) var ids: texture_2d<u32>;
@group(0) @binding(2) var depths: texture_depth_2d;
@group(0) @binding(3) var<storage, read_write> out_colours: array<u32>;
@group(0) @binding(4) var<storage, read_write> out_ids: array<u32>;
@group(0) @binding(5) var<storage, read_write> out_depths: array<f32>;

// Elements a row of the outputs has; rows are padded.
override STRIDE: u32;
// Samples of a pixel along each axis, odd.
override SIDE: u32;

@compute @workgroup_size(8, 8)
fn resolve(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(colours) / SIDE;
    if any(id.xy >= size) {
        return;
    }
    let corner = id.xy * SIDE;
    var sum = vec3f(0.0);
    for (var i = 0u; i < SIDE * SIDE; i++) {
        let c = textureLoad(colours, corner + vec2u(i % SIDE, i / SIDE), 0).rgb;
        sum += c * c;
    }
    let at = id.y * STRIDE + id.x;
    out_colours[at] = pack4x8unorm(vec4f(sqrt(sum / f32(SIDE * SIDE)), 1.0));
    out_ids[at] = textureLoad(ids, corner + SIDE / 2u, 0).r;
    out_depths[at] = textureLoad(depths, corner + SIDE / 2u, 0);
}
