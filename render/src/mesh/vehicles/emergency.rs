//! Ambulances, patrol cars and fire engines on a van's body.

use glam::Vec3;

use super::fittings::facing;
use super::van::{Design, axles, loft};
use crate::SemanticTag;
use crate::mesh::Paint;
use crate::mesh::model::{Detail, Model};
use crate::mesh::variety::Variety;

/// Lacquer, and the two colours of the blocks along the flanks.
struct Livery {
    lacquer: [u8; 3],
    blocks: [[u8; 3]; 2],
}

/// Ambulance, police, fire brigade.
const LIVERIES: [Livery; 3] = [
    Livery { lacquer: [238, 236, 228], blocks: [[214, 222, 46], [26, 126, 66]] },
    Livery { lacquer: [224, 228, 232], blocks: [[222, 226, 54], [24, 62, 166]] },
    Livery { lacquer: [186, 24, 26], blocks: [[232, 218, 62], [150, 16, 20]] },
];

/// Blocks of each flank, and where they are.
const BLOCKS: u32 = 9;
const BLOCKS_X: [f32; 2] = [1.7, -2.3];
const BLOCKS_Z: [f32; 2] = [0.82, 1.1];

/// An ambulance, patrol car or fire engine of class Vehicles, with blue lamps on its roof.
pub fn emergency(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Vehicles;
    let Livery { lacquer, blocks: [light, dark] } = &LIVERIES[variety.bits() as usize % LIVERIES.len()];
    let design = Design { paint: Paint::plain(tag, *lacquer).glossy(90), has_panes: true };
    let mut mesh = design.body(Some(&mut variety), detail);
    let (body, width) = (loft(), (BLOCKS_X[0] - BLOCKS_X[1]) / BLOCKS as f32);
    body.boards(&mut mesh, Paint::plain(tag, *light).glossy(40), BLOCKS_X, BLOCKS_Z, 0.016);
    let count = if detail == Detail::Fine { BLOCKS / 2 } else { 2 };
    for block in 0..count {
        // From afar every other one is as good as all.
        let x = BLOCKS_X[0] - width * (1 + 2 * block * (BLOCKS / 2 / count)) as f32;
        body.boards(&mut mesh, Paint::plain(tag, *dark).glossy(40), [x, x - width], BLOCKS_Z, 0.022);
    }
    let steel = Paint::plain(tag, [206, 210, 214]).glossy(60);
    let blue = Paint::plain(tag, [24, 70, 210]).glossy(160);
    mesh.cuboid(blue, Vec3::new(0.62, -0.64, 1.97), Vec3::new(0.92, 0.64, 2.18));
    if detail == Detail::Fine {
        facing(&mut mesh, steel, 0.925, [-0.2, 0.2], [1.99, 2.16]);
        mesh.cuboid(blue, Vec3::new(-2.2, -0.5, 1.95), Vec3::new(-2.05, 0.5, 2.1));
    }
    axles(Vec3::ONE).under(mesh, tag, detail)
}
