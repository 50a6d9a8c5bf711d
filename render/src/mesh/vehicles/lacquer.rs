//! Colours that vehicles are painted in.

use kernel::scene::ActorKind;

use crate::SemanticTag;
use crate::mesh::Paint;
use crate::mesh::variety::Variety;

/// Colours of cars with their shares in per cent, about those of new cars in Europe.
const CARS: [([u8; 3], u32); 14] = [
    ([234, 234, 232], 26),
    ([34, 34, 38], 20),
    ([112, 116, 122], 13),
    ([78, 82, 88], 8),
    ([186, 190, 194], 9),
    ([40, 68, 128], 7),
    ([24, 44, 76], 4),
    ([160, 26, 30], 5),
    ([100, 22, 32], 1),
    ([62, 86, 70], 2),
    ([190, 180, 160], 2),
    ([204, 116, 36], 1),
    ([214, 178, 44], 1),
    ([110, 160, 190], 1),
];

/// Colours of vans and of lorries' cabs with their shares in per cent: most are white.
const GOODS: [([u8; 3], u32); 8] = [
    ([232, 232, 228], 56),
    ([176, 180, 184], 11),
    ([70, 74, 80], 9),
    ([36, 70, 136], 8),
    ([168, 34, 32], 6),
    ([216, 172, 40], 5),
    ([52, 94, 64], 3),
    ([206, 112, 36], 2),
];

/// The lacquer of a road user who has one of many colours.
pub(crate) fn of(kind: ActorKind, variety: &mut Variety) -> Paint {
    match kind {
        ActorKind::Truck | ActorKind::Van | ActorKind::Bus => of_goods(variety, SemanticTag::Truck),
        _ => of_cars(variety),
    }
}

/// The lacquer of a passenger car.
pub(super) fn of_cars(variety: &mut Variety) -> Paint {
    shade(variety, &CARS, SemanticTag::Vehicles).glossy(110)
}

/// The lacquer of a van or a lorry's cab.
pub(super) fn of_goods(variety: &mut Variety, tag: SemanticTag) -> Paint {
    shade(variety, &GOODS, tag).glossy(90)
}

fn shade(variety: &mut Variety, shares: &[([u8; 3], u32)], tag: SemanticTag) -> Paint {
    let factor = variety.between(0.9, 1.06);
    Paint::plain(tag, variety.weighted(shares)).shaded(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn most_cars_are_white_black_or_grey() {
        let mut counts = [0u32; 3];
        for variant in 0..3000 {
            let [r, g, b] = of_cars(&mut Variety::of(variant)).colour.map(i32::from);
            let (low, high) = (r.min(g).min(b), r.max(g).max(b));
            let kind = if high - low <= 14 {
                0
            } else if b == high || r > 2 * g {
                1
            } else {
                2
            };
            counts[kind] += 1;
        }
        let share = |i: usize| f64::from(counts[i]) / 3000.0;
        assert!((0.7..0.82).contains(&share(0)), "without hue: {counts:?}");
        assert!((0.12..0.24).contains(&share(1)), "blue and red: {counts:?}");
        assert!(share(2) < 0.1, "others: {counts:?}");
    }
}
