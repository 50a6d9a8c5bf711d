// Where leaves are: the same in every pass that draws them.

// How much is leaf and how bright, of the layer that a vertex's code names; layers are those of `leaves.rs`.
fn leaf_at(uv: vec2f, ids: u32) -> vec2f {
    let leaf = textureSampleBias(leaves, noise_sampler, uv, i32((ids >> 8u) & 255u), scene.leaf_bias).rg;
    // Of what is seen edge-on only a line of dashes would be left.
    let x = dpdx(uv);
    let y = dpdy(uv);
    let is_edge_on = abs(x.x * y.y - x.y * y.x) < 0.07 * (dot(x, x) + dot(y, y));
    return select(leaf, vec2f(0.0), is_edge_on);
}

// Less than this is air.
const LEAF = 0.5;
