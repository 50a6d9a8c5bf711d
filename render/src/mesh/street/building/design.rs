//! What a house is like, chosen by its box and its variant, at all levels of detail alike.

use glam::Vec3;

use super::outline::{STOREY_M, TAG};
use crate::mesh::variety::Variety;
use crate::mesh::{Finish, Paint};

/// Bits of the style of a wall or a roof, as `facade.wgsl` reads them.
pub mod style {
    /// Which material; one of those below.
    pub const MATERIAL: u8 = 0b0000_0111;
    /// Plaster.
    pub const PLASTER: u8 = 0;
    /// Bricks in courses.
    pub const BRICK: u8 = 1;
    /// Beams with plaster between them.
    pub const TIMBER: u8 = 2;
    /// Concrete panels, one a window.
    pub const PANELS: u8 = 3;
    /// A curtain wall of glass.
    pub const GLASS: u8 = 4;
    /// Blocks of stone.
    pub const STONE: u8 = 5;
    /// Roof tiles.
    pub const TILES: u8 = 6;
    /// Plaster around a garage door.
    pub const GARAGE: u8 = 7;
    /// Light bands between the storeys, and window surrounds.
    pub const BANDS: u8 = 0b0000_1000;
    /// Shop windows on the ground floor, and a sign above them.
    pub const SHOP: u8 = 0b0001_0000;
    /// Windows above the ground floor reach down to it, for balconies.
    pub const FRENCH: u8 = 0b0010_0000;
    /// Shutters beside the windows.
    pub const SHUTTERS: u8 = 0b0100_0000;
    /// A door on the ground floor, in the column that [`super::Design::door_column`] says.
    pub const DOOR: u8 = 0b1000_0000;
    /// Columns that a front with a door has at least.
    pub const DOOR_COLUMNS: u8 = 3;
}

const PLASTERS: [[u8; 3]; 10] = [
    [200, 190, 168],
    [208, 204, 194],
    [198, 178, 138],
    [192, 162, 116],
    [172, 168, 160],
    [184, 182, 178],
    [194, 162, 142],
    [158, 168, 152],
    [202, 188, 148],
    [172, 138, 108],
];
const INFILLS: [[u8; 3]; 4] = [[212, 206, 192], [206, 192, 162], [208, 198, 178], [198, 176, 138]];
const BRICKS: [[u8; 3]; 4] = [[150, 82, 62], [134, 72, 58], [160, 100, 74], [120, 84, 72]];
const CONCRETES: [[u8; 3]; 4] = [[172, 170, 164], [186, 182, 172], [160, 164, 168], [190, 176, 156]];
const STONES: [[u8; 3]; 3] = [[188, 176, 152], [172, 164, 150], [184, 160, 132]];
const METALS: [[u8; 3]; 3] = [[96, 102, 108], [70, 76, 82], [120, 124, 126]];
const ROOF_TILES: [[u8; 3]; 6] =
    [[152, 82, 60], [126, 70, 56], [142, 88, 66], [92, 84, 80], [110, 62, 52], [78, 80, 86]];

/// What kind of house stands in a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// For a car.
    Garage,
    /// Of a church or a castle.
    Tower,
    /// Its gable to the street, between others.
    Narrow,
    /// A storey or two for one family.
    Villa,
    /// Of a street, three storeys and more.
    Terrace,
    /// Flats or offices.
    Block,
}

/// The shape of a roof.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Roof {
    Flat,
    Gabled,
    Hipped,
}

/// What hangs on the front of a house.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Adornment {
    Nothing,
    Balconies,
    Bay,
    FlowerBoxes,
}

/// All that is chosen about a house.
#[derive(Clone, Copy, Debug)]
pub(super) struct Design {
    pub(super) kind: Kind,
    pub(super) size: Vec3,
    /// Paint of the walls, without a door.
    pub(super) wall: Paint,
    pub(super) tiles: Paint,
    pub(super) roof: Roof,
    /// Height of the eaves, metres.
    pub(super) eaves_m: f32,
    /// Storeys below the eaves.
    pub(super) storeys: f32,
    pub(super) adornment: Adornment,
    pub(super) has_awning: bool,
    pub(super) has_dormers: bool,
    /// Whether the walls between neighbours have no windows.
    pub(super) is_walled_in: bool,
    /// For what follows from no choice above.
    pub(super) rest: Variety,
}

impl Design {
    pub(super) fn new(variant: u32, size: Vec3) -> Self {
        let mut variety = Variety::of(variant);
        let kind = Kind::of(size, &mut variety);
        let material = material(kind, size, &mut variety);
        let roof = roof(kind, material, size, &mut variety);
        let (eaves_m, floors) = eaves(kind, roof, size);
        let storeys = (size.z / STOREY_M).round().max(1.0);
        let is_shop = match kind {
            Kind::Terrace | Kind::Block => storeys >= 3.0 && !variety.one_in(3),
            Kind::Narrow => storeys >= 3.0 && variety.one_in(2),
            _ => false,
        };
        let adornment = adornment(kind, material, floors, &mut variety);
        let mut code = material;
        let mut add = |is_so: bool, bit: u8| code |= if is_so { bit } else { 0 };
        add(is_shop, style::SHOP);
        // Tall windows, those of churches too.
        add(adornment == Adornment::Balconies || is_hall(size), style::FRENCH);
        add(
            matches!(material, style::PLASTER | style::BRICK)
                && matches!(kind, Kind::Narrow | Kind::Terrace)
                && variety.one_in(2),
            style::BANDS,
        );
        let shutters = matches!(kind, Kind::Villa | Kind::Narrow | Kind::Terrace) && variety.one_in(3);
        add(shutters && adornment != Adornment::Balconies && material != style::TIMBER, style::SHUTTERS);
        let wall = Paint { tag: TAG, colour: colour(material, &mut variety), finish: Finish::Facade, param: 0, code };
        Self {
            kind,
            size,
            wall: Paint { param: variety.bits() as u8, ..wall },
            tiles: Paint { colour: variety.colour(&ROOF_TILES), code: style::TILES, ..wall },
            roof,
            eaves_m,
            storeys: floors,
            adornment,
            has_awning: is_shop && variety.one_in(3),
            has_dormers: roof == Roof::Gabled
                && size.y > size.x
                && size.z - eaves_m > 0.3 * size.x
                && variety.one_in(2),
            is_walled_in: !matches!(kind, Kind::Villa | Kind::Tower) && !variety.one_in(3),
            rest: variety,
        }
    }

    /// Which column of windows the door stands in, counted along the y axis.
    pub(super) fn door_column(&self) -> f32 {
        f32::from((self.wall.param >> 4) % style::DOOR_COLUMNS)
    }

    /// A dull paint in the colour of the walls.
    pub(super) fn plain(&self) -> Paint {
        Paint::plain(TAG, self.wall.colour)
    }

    pub(super) fn is_shop(&self) -> bool {
        self.wall.code & style::SHOP != 0
    }
}

impl Kind {
    fn of(size: Vec3, variety: &mut Variety) -> Self {
        let (slender, long) = (size.x.min(size.y), size.x.max(size.y));
        if size.z < 3.6 {
            Self::Garage
        } else if long < 7.0 && size.z > 1.8 * long {
            Self::Tower
        } else if is_hall(size)
            || size.y < 9.0 && size.z > 0.95 * size.y
            || size.y < 11.0 && size.z > size.y && variety.one_in(2)
        {
            Self::Narrow
        } else if size.z < 9.0 {
            Self::Villa
        } else if size.z > 13.0 && slender > 8.5 && !variety.one_in(3) {
            Self::Block
        } else {
            Self::Terrace
        }
    }
}

/// Whether it is a church or a hall: long, high, its gable to the street.
fn is_hall(size: Vec3) -> bool {
    size.x > 1.5 * size.y && size.z > 12.0
}

fn material(kind: Kind, size: Vec3, variety: &mut Variety) -> u8 {
    use style::*;
    match kind {
        Kind::Garage => GARAGE,
        Kind::Tower => STONE,
        _ if is_hall(size) => STONE,
        // On the narrow plots of old towns; what is lower stands in gardens too.
        Kind::Narrow if size.y < 9.0 && size.z > 9.0 => variety.weighted(&[(PLASTER, 5), (TIMBER, 5), (BRICK, 2)]),
        Kind::Narrow => variety.weighted(&[(PLASTER, 8), (BRICK, 4)]),
        Kind::Villa => variety.weighted(&[(PLASTER, 7), (BRICK, 3)]),
        Kind::Terrace => variety.weighted(&[(PLASTER, 6), (BRICK, 3), (STONE, 1)]),
        // Old towns have narrow plots.
        Kind::Block if size.y < 11.0 => variety.weighted(&[(PLASTER, 3), (BRICK, 1)]),
        Kind::Block => variety.weighted(&[(PLASTER, 3), (PANELS, 3), (GLASS, 2), (BRICK, 1)]),
    }
}

fn colour(material: u8, variety: &mut Variety) -> [u8; 3] {
    match material {
        style::BRICK => variety.colour(&BRICKS),
        style::TIMBER => variety.colour(&INFILLS),
        style::PANELS => variety.colour(&CONCRETES),
        style::GLASS => variety.colour(&METALS),
        style::STONE => variety.colour(&STONES),
        _ => variety.colour(&PLASTERS),
    }
}

fn roof(kind: Kind, material: u8, size: Vec3, variety: &mut Variety) -> Roof {
    match kind {
        Kind::Garage | Kind::Block => Roof::Flat,
        Kind::Tower => Roof::Hipped,
        Kind::Narrow => Roof::Gabled,
        _ if size.x.min(size.y) > 16.0 => Roof::Flat,
        Kind::Villa => variety.weighted(&[(Roof::Gabled, 6), (Roof::Hipped, 3), (Roof::Flat, 1)]),
        Kind::Terrace if material == style::STONE => Roof::Hipped,
        Kind::Terrace => variety.weighted(&[(Roof::Gabled, 5), (Roof::Hipped, 2), (Roof::Flat, 3)]),
    }
}

/// Height of the eaves, metres, and the storeys below them: roofs are as steep as storeys of a good height let them be.
fn eaves(kind: Kind, roof: Roof, size: Vec3) -> (f32, f32) {
    let slender = size.x.min(size.y);
    let wanted_m = match (kind, roof) {
        (Kind::Garage, _) => return (size.z - 0.2, 1.0),
        (_, Roof::Flat) => return (size.z - 0.9, ((size.z - 0.9) / STOREY_M).round().max(1.0)),
        (Kind::Tower, _) => 0.3 * size.z,
        (Kind::Narrow, _) => 0.55 * slender,
        _ => (0.36 * slender).min(4.5),
    };
    let least_m = 0.6 * size.z;
    let storeys = ((size.z - wanted_m).max(least_m) / 2.75 + 0.48).floor().max(1.0);
    ((2.9 * storeys).min(size.z - 0.15 * slender).max(least_m), storeys)
}

fn adornment(kind: Kind, material: u8, storeys: f32, variety: &mut Variety) -> Adornment {
    use Adornment::*;
    match kind {
        Kind::Garage | Kind::Tower => Nothing,
        _ if matches!(material, style::GLASS | style::STONE) || storeys < 2.0 => Nothing,
        Kind::Narrow => variety.weighted(&[(Nothing, 4), (Bay, 2), (FlowerBoxes, 3)]),
        Kind::Villa => variety.weighted(&[(Nothing, 4), (Balconies, 2), (FlowerBoxes, 2)]),
        Kind::Terrace => variety.weighted(&[(Nothing, 3), (Balconies, 3), (Bay, 2), (FlowerBoxes, 2)]),
        Kind::Block => variety.weighted(&[(Nothing, 1), (Balconies, 2)]),
    }
}
