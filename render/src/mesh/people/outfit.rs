//! Who somebody is and what somebody wears and carries: drawn from a variant, whatever the level of detail.

use crate::mesh::variety::Variety;

/// Years as far as they are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Age {
    /// 6 to 13.
    Child,
    /// Up to about 65.
    Adult,
    /// Above.
    Old,
}

/// Shape of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Build {
    /// Height when upright, bare-headed, metres.
    pub height_m: f32,
    /// Girth as a share of the usual.
    pub girth: f32,
    /// Half the breadth of the shoulders at a height of [`UPRIGHT_M`], metres.
    pub shoulders_m: f32,
    /// Half the breadth of the hips at a height of [`UPRIGHT_M`], metres.
    pub hips_m: f32,
    /// Size of the head as a share of that of an adult of that height.
    pub head: f32,
    /// Bend of the upper back, radians.
    pub stoop_rad: f32,
    /// Chest and waist of a woman.
    pub waisted: bool,
}

/// Height that bodies are shaped at before they are scaled, metres.
pub(super) const UPRIGHT_M: f32 = 1.75;

/// Hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hair {
    Bald,
    Short,
    Long,
    Tied,
}

/// What is on a head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Headgear {
    None,
    Cap,
    Beanie,
    Hat,
    Scarf,
}

/// What covers the trunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Top {
    TShirt,
    Shirt,
    Hoodie,
    Jacket,
    Suit,
    Coat,
}

/// What covers the legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bottom {
    Trousers,
    Shorts,
    Skirt,
    /// Of one cloth with the top.
    Dress,
}

/// What is carried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// Both hands free.
    Nothing,
    /// On the back.
    Backpack,
    /// At the shoulder.
    Handbag,
    /// In a hand.
    ShoppingBag,
    /// In a hand.
    Briefcase,
    /// In a hand, and above the head in rain.
    RolledUmbrella,
    /// To lean on.
    Stick,
}

impl Carried {
    /// Whether an arm hangs under it.
    pub(super) fn is_in_hand(self) -> bool {
        matches!(self, Self::ShoppingBag | Self::Briefcase | Self::RolledUmbrella)
    }
}

/// What one does with the arms while standing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stance {
    Hanging,
    Pockets,
    Phone,
}

/// Somebody's body and clothes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outfit {
    pub age: Age,
    pub build: Build,
    pub skin: [u8; 3],
    pub hair: Hair,
    pub hair_colour: [u8; 3],
    pub beard: bool,
    pub headgear: Headgear,
    pub headgear_colour: [u8; 3],
    pub top: Top,
    pub top_colour: [u8; 3],
    /// Of what is seen under an open jacket.
    pub shirt_colour: [u8; 3],
    pub bottom: Bottom,
    pub bottom_colour: [u8; 3],
    pub shoe_colour: [u8; 3],
    /// Colour of a high-visibility vest.
    pub vest: Option<[u8; 3]>,
    pub carried: Carried,
    pub carried_colour: [u8; 3],
    pub stance: Stance,
    /// The leg that bears the weight of one who stands: 1 left, -1 right.
    pub bears: f32,
    /// Rain in percent from which on an umbrella is open, if there is one.
    pub umbrella_pct: Option<f32>,
    pub umbrella_colour: [u8; 3],
}

const SKINS: [[u8; 3]; 6] =
    [[236, 198, 172], [224, 180, 150], [206, 158, 126], [172, 122, 92], [122, 82, 58], [84, 56, 42]];
const HAIRS: [[u8; 3]; 10] = [
    [30, 24, 22],
    [26, 22, 22],
    [48, 34, 26],
    [44, 34, 28],
    [60, 44, 32],
    [82, 58, 38],
    [74, 54, 38],
    [120, 90, 56],
    [164, 134, 88],
    [98, 54, 34],
];
const GREYS: [[u8; 3]; 3] = [[160, 158, 154], [200, 198, 192], [116, 114, 112]];
/// Black, anthracite, navy, dark brown, dark olive: most of what is worn outdoors.
const DARKS: [[u8; 3]; 7] =
    [[26, 26, 29], [36, 37, 42], [30, 36, 58], [48, 40, 34], [44, 50, 40], [56, 26, 34], [44, 52, 62]];
const MUTED: [[u8; 3]; 7] =
    [[104, 100, 94], [126, 110, 88], [88, 104, 122], [106, 116, 92], [128, 92, 88], [150, 148, 144], [84, 86, 96]];
const LIGHTS: [[u8; 3]; 4] = [[222, 218, 208], [204, 190, 166], [196, 206, 214], [232, 226, 216]];
const BRIGHTS: [[u8; 3]; 8] = [
    [178, 42, 44],
    [42, 84, 158],
    [206, 160, 52],
    [52, 118, 84],
    [128, 70, 120],
    [96, 146, 184],
    [196, 104, 56],
    [214, 130, 152],
];
const JEANS: [[u8; 3]; 3] = [[44, 56, 84], [66, 84, 116], [94, 112, 140]];
const LEATHERS: [[u8; 3]; 4] = [[34, 30, 28], [84, 56, 36], [120, 44, 40], [138, 112, 82]];
const SHOES: [[u8; 3]; 5] = [[26, 25, 26], [34, 32, 34], [74, 50, 36], [206, 206, 202], [96, 98, 104]];
/// Fluorescent yellow and orange-red (EN ISO 20471).
const VESTS: [[u8; 3]; 3] = [[204, 232, 42], [204, 232, 42], [250, 106, 30]];

/// Cloth: of 10, so many are dark, muted and light, the rest bright.
fn cloth(variety: &mut Variety, [dark, muted, light]: [u32; 3]) -> [u8; 3] {
    let drawn = variety.bits() % 10;
    let colours: &[[u8; 3]] = match drawn {
        n if n < dark => &DARKS,
        n if n < dark + muted => &MUTED,
        n if n < dark + muted + light => &LIGHTS,
        _ => &BRIGHTS,
    };
    variety.colour(colours)
}

/// A number about the middle of a range (triangular distribution).
fn about(variety: &mut Variety, lo: f32, hi: f32) -> f32 {
    0.5 * (variety.between(lo, hi) + variety.between(lo, hi))
}

impl Build {
    fn of(variety: &mut Variety, age: Age, waisted: bool) -> Self {
        let (low_m, high_m) = match (age, waisted) {
            (Age::Child, _) => (1.17, 1.43),
            (_, true) => (1.53, 1.77),
            (_, false) => (1.63, 1.88),
        };
        let height_m = about(variety, low_m, high_m) - if age == Age::Old { 0.02 } else { 0.0 };
        let girth = match age {
            Age::Child => about(variety, 0.84, 1.1),
            Age::Adult => about(variety, 0.84, 1.3),
            Age::Old => about(variety, 0.88, 1.34),
        };
        let wide = 0.5 * (girth - 1.0);
        let shoulders_m = variety.between(0.0, 0.014) + if waisted { 0.176 } else { 0.198 };
        let hips_m = variety.between(0.0, 0.014) + if waisted { 0.166 } else { 0.15 };
        let stoop_rad = if age == Age::Old { variety.between(0.06, 0.4) } else { variety.between(0.0, 0.06) };
        let [shoulders_m, hips_m] = match age {
            Age::Child => [shoulders_m.min(0.186), 0.148],
            _ => [shoulders_m, hips_m],
        };
        Self {
            height_m,
            girth,
            shoulders_m: shoulders_m * (1.0 + 0.3 * wide),
            hips_m: hips_m * (1.0 + wide),
            // A child's head is nearly as large as an adult's.
            head: if age == Age::Child { 1.2 } else { variety.between(0.98, 1.06) },
            stoop_rad,
            waisted: waisted && age != Age::Child,
        }
    }
}

impl Outfit {
    /// What a variant draws for a child, or for somebody grown up.
    pub(super) fn of(variety: &mut Variety, is_child: bool) -> Self {
        // Others draw from the same stream after this: one number of it is enough here.
        let v = &mut Variety::of(variety.bits());
        let age = match v.bits() % 100 {
            _ if is_child => Age::Child,
            // The share of the EU's adults who are over 65 (Eurostat 2023).
            n if n < 25 => Age::Old,
            _ => Age::Adult,
        };
        let woman = v.one_in(2);
        let build = Build::of(v, age, woman);
        let (top, bottom) = clothes(v, age, woman);
        let (hair, headgear) = head(v, age, woman);
        let top_colour = match top {
            Top::Suit => v.colour(&DARKS[..4]),
            Top::Coat | Top::Jacket => cloth(v, [7, 2, 0]),
            Top::Hoodie => cloth(v, [5, 3, 1]),
            Top::TShirt | Top::Shirt => cloth(v, [4, 2, 2]),
        };
        let bottom_colour = match bottom {
            _ if top == Top::Suit => top_colour,
            Bottom::Dress => top_colour,
            Bottom::Trousers if v.one_in(3) => v.colour(&JEANS),
            _ => cloth(v, [6, 3, 1]),
        };
        Self {
            age,
            build,
            skin: v.colour(&SKINS),
            hair,
            hair_colour: if age == Age::Old { v.colour(&GREYS) } else { v.colour(&HAIRS) },
            beard: !woman && age != Age::Child && v.one_in(3),
            headgear,
            headgear_colour: cloth(v, [5, 2, 1]),
            top,
            top_colour,
            shirt_colour: cloth(v, [2, 4, 3]),
            bottom,
            bottom_colour,
            shoe_colour: v.pick(&SHOES),
            vest: v.one_in(if age == Age::Child { 10 } else { 18 }).then(|| v.pick(&VESTS)),
            carried: carried(v, age, woman, top),
            carried_colour: if v.one_in(4) { cloth(v, [2, 2, 2]) } else { v.colour(&LEATHERS) },
            stance: match v.bits() % 4 {
                0 => Stance::Pockets,
                1 if age != Age::Old => Stance::Phone,
                _ => Stance::Hanging,
            },
            bears: v.pick(&[1.0, -1.0]),
            umbrella_pct: (age != Age::Child && !v.one_in(3)).then(|| v.between(5.0, 35.0)),
            umbrella_colour: cloth(v, [7, 1, 0]),
        }
    }

    /// Dressed for a saddle: legs free, nothing but a backpack, of usual size.
    pub(super) fn riding(self) -> Self {
        let build = Build { height_m: UPRIGHT_M, stoop_rad: 0.0, ..self.build };
        let bottom = if self.bottom == Bottom::Shorts { Bottom::Shorts } else { Bottom::Trousers };
        let top = if self.top == Top::Coat { Top::Jacket } else { self.top };
        let carried = if self.carried == Carried::Backpack { Carried::Backpack } else { Carried::Nothing };
        let headgear = if self.headgear == Headgear::Hat { Headgear::None } else { self.headgear };
        Self { build, bottom, top, carried, headgear, umbrella_pct: None, ..self }
    }

    /// Dressed for both hands at a handle, or for a chair with a back.
    pub(super) fn handed(self) -> Self {
        Self { carried: Carried::Nothing, umbrella_pct: None, ..self }
    }

    /// Whether it is dressed in dark: top and legs, without a vest.
    pub(super) fn is_dark(&self) -> bool {
        let dark = |c: [u8; 3]| c.iter().map(|&c| u32::from(c)).sum::<u32>() < 3 * 64;
        self.vest.is_none() && dark(self.top_colour) && dark(self.bottom_colour)
    }
}

fn clothes(v: &mut Variety, age: Age, woman: bool) -> (Top, Bottom) {
    use Top::{Coat, Hoodie, Jacket, Shirt, Suit, TShirt};
    let top = match age {
        Age::Child => v.pick(&[TShirt, TShirt, Hoodie, Hoodie, Jacket, Jacket, Shirt]),
        Age::Adult => v.pick(&[TShirt, Shirt, Hoodie, Hoodie, Jacket, Jacket, Jacket, Coat, Coat, Suit]),
        Age::Old => v.pick(&[Shirt, Jacket, Jacket, Jacket, Coat, Coat, Suit]),
    };
    let skirted = woman && v.one_in(4);
    let warm = matches!(top, TShirt | Shirt);
    let bottom = match v.bits() % 3 {
        0 if warm && (!skirted || age == Age::Child) => Bottom::Shorts,
        n if skirted => {
            if warm && n == 1 {
                Bottom::Dress
            } else {
                Bottom::Skirt
            }
        }
        _ => Bottom::Trousers,
    };
    (top, bottom)
}

fn head(v: &mut Variety, age: Age, woman: bool) -> (Hair, Headgear) {
    let hair = match (woman, age) {
        (true, _) => v.pick(&[Hair::Long, Hair::Long, Hair::Tied, Hair::Short]),
        (false, Age::Old) => v.pick(&[Hair::Short, Hair::Bald]),
        (false, Age::Child) => Hair::Short,
        (false, Age::Adult) => v.pick(&[Hair::Short, Hair::Short, Hair::Short, Hair::Short, Hair::Bald, Hair::Tied]),
    };
    let headgear = match v.bits() % 20 {
        0 | 1 => Headgear::Cap,
        2 | 3 => Headgear::Beanie,
        4 if age == Age::Old => Headgear::Hat,
        5 if age != Age::Child => Headgear::Hat,
        6 | 7 if woman && age != Age::Child => Headgear::Scarf,
        _ => Headgear::None,
    };
    (hair, headgear)
}

fn carried(v: &mut Variety, age: Age, woman: bool, top: Top) -> Carried {
    use Carried::{Backpack, Briefcase, Handbag, Nothing, RolledUmbrella, ShoppingBag, Stick};
    match age {
        Age::Child => v.pick(&[Backpack, Backpack, Nothing, Nothing]),
        Age::Old => v.pick(&[Stick, Stick, ShoppingBag, RolledUmbrella, Nothing, Nothing]),
        Age::Adult if top == Top::Suit => v.pick(&[Briefcase, Briefcase, RolledUmbrella, Nothing]),
        Age::Adult if woman => v.pick(&[Handbag, Handbag, Handbag, Backpack, ShoppingBag, Nothing, Nothing, Nothing]),
        Age::Adult => v.pick(&[Backpack, Backpack, ShoppingBag, RolledUmbrella, Nothing, Nothing, Nothing, Nothing]),
    }
}
