//! What selects colour and shape of a static object.

use kernel::map::{Prop, PropKind};

use super::variety::Variety;

/// Pieces of hedges, fences and walls that stand in the same square, metres, are one row.
const ROW_M: f32 = 64.0;

/// What selects colour and shape. Maps have few variants; where a thing stands tells it apart from its neighbours. Of what
/// stands in rows the upper half is that of the row: [`row_of`].
pub fn look(prop: &Prop) -> u32 {
    let at = prop.position;
    let own = prop.variant ^ Variety::of(at.x.to_bits().rotate_left(16) ^ at.y.to_bits()).bits();
    if !matches!(prop.kind, PropKind::Hedge | PropKind::Fence | PropKind::Wall) {
        return own;
    }
    let [x, y] = [at.x, at.y].map(|m| (m / ROW_M).floor() as i32 as u32);
    Variety::of(x.rotate_left(16) ^ y).bits() & ROW | own & !ROW
}

const ROW: u32 = 0xffff_0000;

/// What is chosen for all pieces of a row alike.
pub fn row_of(look: u32) -> Variety {
    Variety::of(look & ROW)
}
