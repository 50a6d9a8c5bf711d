//! The semantic classes: the 23 tags of CARLA 0.9.10 and the finer ones behind them.
//!
//! Source: CARLA 0.9.10, `CityScapesPalette.h`. There riders count as pedestrians and two-wheelers
//! as vehicles; [`SemanticTag::coarse`] maps the finer tags to that view.

macro_rules! tags {
    ($($(#[$meta:meta])* $name:ident = $id:literal, $text:literal, [$r:literal, $g:literal, $b:literal], $coarse:ident;)*) => {
        /// What a pixel shows. Ids below 23 are the tags of CARLA 0.9.10.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u8)]
        pub enum SemanticTag { $($(#[$meta])* $name = $id,)* }

        impl SemanticTag {
            /// Every tag, by ascending id; the 23 of CARLA come first.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// The name CARLA gives it.
            pub fn name(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }

            /// Red, green and blue in images of classes.
            pub const fn colour(self) -> [u8; 3] {
                match self { $(Self::$name => [$r, $g, $b],)* }
            }

            /// The tag of CARLA 0.9.10 that stands for it.
            pub fn coarse(self) -> Self {
                match self { $(Self::$name => Self::$coarse,)* }
            }
        }
    };
}

tags! {
    /// Nothing known.
    Unlabeled = 0, "Unlabeled", [0, 0, 0], Unlabeled;
    /// House.
    Building = 1, "Building", [70, 70, 70], Building;
    /// Fence.
    Fence = 2, "Fence", [100, 40, 40], Fence;
    /// Anything without a class of its own.
    Other = 3, "Other", [55, 90, 80], Other;
    /// Person on foot; in CARLA's view riders too.
    Pedestrian = 4, "Pedestrian", [220, 20, 60], Pedestrian;
    /// Pole of a lamp, sign or signal.
    Pole = 5, "Pole", [153, 153, 153], Pole;
    /// Paint on the road.
    RoadLine = 6, "RoadLine", [157, 234, 50], RoadLine;
    /// Asphalt.
    Road = 7, "Road", [128, 64, 128], Road;
    /// Pavement for walkers, with its kerb.
    SideWalk = 8, "SideWalk", [244, 35, 232], SideWalk;
    /// Trees, trunks included, hedges and bushes.
    Vegetation = 9, "Vegetation", [107, 142, 35], Vegetation;
    /// Cars; in CARLA's view lorries, buses and two-wheelers too.
    Vehicles = 10, "Vehicles", [0, 0, 142], Vehicles;
    /// Free-standing wall.
    Wall = 11, "Wall", [102, 102, 156], Wall;
    /// Face of a traffic sign.
    TrafficSign = 12, "TrafficSign", [220, 220, 0], TrafficSign;
    /// Sky.
    Sky = 13, "Sky", [70, 130, 180], Sky;
    /// Paved ground that is neither road nor sidewalk.
    Ground = 14, "Ground", [81, 0, 81], Ground;
    /// Bridge.
    Bridge = 15, "Bridge", [150, 100, 100], Bridge;
    /// Rails and their bed.
    RailTrack = 16, "RailTrack", [230, 150, 140], RailTrack;
    /// Guard rail.
    GuardRail = 17, "GuardRail", [180, 165, 180], GuardRail;
    /// Head of a traffic light.
    TrafficLight = 18, "TrafficLight", [250, 170, 30], TrafficLight;
    /// Street furniture.
    Static = 19, "Static", [110, 190, 160], Static;
    /// Loose things.
    Dynamic = 20, "Dynamic", [170, 120, 50], Dynamic;
    /// Water.
    Water = 21, "Water", [45, 60, 150], Water;
    /// Grass and soil.
    Terrain = 22, "Terrain", [145, 170, 100], Terrain;
    /// Rider of a two-wheeler.
    Rider = 64, "Rider", [255, 0, 0], Pedestrian;
    /// Lorry or van.
    Truck = 65, "Truck", [0, 0, 70], Vehicles;
    /// Bus.
    Bus = 66, "Bus", [0, 60, 100], Vehicles;
    /// Motorcycle without its rider.
    Motorcycle = 67, "Motorcycle", [0, 0, 230], Vehicles;
    /// Bicycle without its rider.
    Bicycle = 68, "Bicycle", [119, 11, 32], Vehicles;
    /// Tram.
    Train = 69, "Train", [0, 80, 100], Vehicles;
}

/// The number of tags in CARLA 0.9.10.
pub const TAG_COUNT: usize = 23;

/// The 23 tags of CARLA 0.9.10; the index is the id.
pub const TAGS: &[SemanticTag] = SemanticTag::ALL.split_at(TAG_COUNT).0;

impl SemanticTag {
    /// The tag with an id, if there is one.
    pub fn from_id(id: u8) -> Option<Self> {
        Self::ALL.iter().copied().find(|&tag| tag as u8 == id)
    }
}

const COLOURS: [[u8; 3]; 256] = {
    let mut colours = [[0; 3]; 256];
    let mut i = 0;
    while i < SemanticTag::ALL.len() {
        let tag = SemanticTag::ALL[i];
        colours[tag as usize] = tag.colour();
        i += 1;
    }
    colours
};

/// Red, green and blue of a class id; black for ids without a tag.
pub fn colour(id: u8) -> [u8; 3] {
    COLOURS[usize::from(id)]
}

/// Red, green and blue of every class id, 3 bytes each.
pub fn colours(ids: &[u8]) -> Vec<u8> {
    let colours: Vec<[u8; 3]> = ids.iter().map(|&id| colour(id)).collect();
    colours.into_flattened()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_index_of_a_carla_tag_is_its_id() {
        assert!(TAGS.iter().enumerate().all(|(i, &tag)| tag as usize == i && tag.coarse() == tag));
        assert_eq!(TAGS[10].colour(), [0, 0, 142]);
    }

    #[test]
    fn every_tag_has_its_colour_and_other_ids_are_black() {
        for id in 0..=u8::MAX {
            let expected = SemanticTag::from_id(id).map_or([0, 0, 0], SemanticTag::colour);
            assert_eq!(colour(id), expected);
            assert_eq!(colours(&[id, 10]), [expected, [0, 0, 142]].concat());
        }
    }

    #[test]
    fn finer_tags_lie_above_and_map_into_the_carla_view() {
        for &tag in &SemanticTag::ALL[TAG_COUNT..] {
            assert!(tag as usize >= TAG_COUNT && (tag.coarse() as usize) < TAG_COUNT);
        }
    }

    #[test]
    fn names_and_colours_are_distinct() {
        for (i, a) in SemanticTag::ALL.iter().enumerate() {
            for b in &SemanticTag::ALL[..i] {
                assert!(a.name() != b.name() && a.colour() != b.colour(), "{a:?} and {b:?}");
            }
        }
    }
}
