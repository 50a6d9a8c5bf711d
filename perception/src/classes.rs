//! What class ids mean: the tags of CARLA 0.9.10, the classes trained on, and the outputs of
//! foreign networks.

use crate::PerceptionError;

/// A class that is trained and measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrainClass {
    /// Name of the tag.
    pub name: &'static str,
    /// The tag's id in CARLA 0.9.10.
    pub tag: u8,
}

const fn class(name: &'static str, tag: u8) -> TrainClass {
    TrainClass { name, tag }
}

/// The 16 classes, at the index of their train id. The paper trains 16 of the 23 tags without
/// listing them; left out here are the tags that the simulated world lacks or that mean "anything
/// else" ([`UNTRAINED_TAGS`]).
pub const TRAIN_CLASSES: [TrainClass; 16] = [
    class("Building", 1),
    class("Fence", 2),
    class("Pedestrian", 4),
    class("Pole", 5),
    class("RoadLine", 6),
    class("Road", 7),
    class("SideWalk", 8),
    class("Vegetation", 9),
    class("Vehicles", 10),
    class("Wall", 11),
    class("TrafficSign", 12),
    class("Sky", 13),
    class("GuardRail", 17),
    class("TrafficLight", 18),
    class("Static", 19),
    class("Terrain", 22),
];

/// The tags that are neither trained nor measured.
pub const UNTRAINED_TAGS: [TrainClass; 7] = [
    class("Unlabeled", 0),
    class("Other", 3),
    class("Ground", 14),
    class("Bridge", 15),
    class("RailTrack", 16),
    class("Dynamic", 20),
    class("Water", 21),
];

/// Number of tags.
pub const TAGS: usize = TRAIN_CLASSES.len() + UNTRAINED_TAGS.len();
/// Tag id of a pedestrian (riders included).
pub const PEDESTRIAN_TAG: u8 = 4;
/// Tag id of what no class describes.
pub const UNLABELED_TAG: u8 = 0;
/// Name of the tag of what the other classes do not describe.
const OTHER: &str = "Other";
/// Train id of pixels that count nowhere.
pub const IGNORE: u8 = 255;

const fn train_ids() -> [u8; 256] {
    let mut ids = [IGNORE; 256];
    let mut i = 0;
    while i < TRAIN_CLASSES.len() {
        ids[TRAIN_CLASSES[i].tag as usize] = i as u8;
        i += 1;
    }
    ids
}

/// Train id of every tag id; [`IGNORE`] for those that are not trained.
pub const TRAIN_ID_OF_TAG: [u8; 256] = train_ids();

/// The class of pedestrians in tables by train id.
pub const PEDESTRIAN: usize = TRAIN_ID_OF_TAG[PEDESTRIAN_TAG as usize] as usize;

/// Train id of a tag, unless it is ignored.
pub fn train_id(tag: u8) -> Option<u8> {
    Some(TRAIN_ID_OF_TAG[usize::from(tag)]).filter(|&id| id != IGNORE)
}

/// Tag id of a train id; [`UNLABELED_TAG`] for ids beyond the table.
pub fn tag_of_train_id(train_id: u8) -> u8 {
    TRAIN_CLASSES.get(usize::from(train_id)).map_or(UNLABELED_TAG, |c| c.tag)
}

/// Name of a tag.
pub fn tag_name(tag: u8) -> Option<&'static str> {
    TRAIN_CLASSES.iter().chain(&UNTRAINED_TAGS).find(|c| c.tag == tag).map(|c| c.name)
}

/// Names of other schemes that mean one class and no other, as the tag that it is in CARLA 0.9.10, where riders count
/// as Pedestrian and two-wheelers as Vehicles. The later ones are from ADE20K and Mapillary Vistas.
const SYNONYMS: [(&str, &str); 34] = [
    ("person", "Pedestrian"),
    ("rider", "Pedestrian"),
    ("bicyclist", "Pedestrian"),
    ("motorcyclist", "Pedestrian"),
    ("vehicle", "Vehicles"),
    ("car", "Vehicles"),
    ("truck", "Vehicles"),
    ("bus", "Vehicles"),
    ("van", "Vehicles"),
    ("caravan", "Vehicles"),
    ("trailer", "Vehicles"),
    ("train", "Vehicles"),
    ("motorcycle", "Vehicles"),
    ("motorbike", "Vehicles"),
    ("minibike", "Vehicles"),
    ("bicycle", "Vehicles"),
    ("bike", "Vehicles"),
    ("house", "Building"),
    ("skyscraper", "Building"),
    ("tree", "Vegetation"),
    ("palm", "Vegetation"),
    ("plant", "Vegetation"),
    ("grass", "Terrain"),
    ("earth", "Terrain"),
    ("field", "Terrain"),
    ("street light", "Pole"),
    ("utility pole", "Pole"),
    ("pole group", "Pole"),
    ("pavement", "SideWalk"),
    ("lane marking", "RoadLine"),
    ("sea", "Water"),
    ("river", "Water"),
    ("lake", "Water"),
    ("void", "Unlabeled"),
];

/// Tag id of a class name; case, spaces, hyphens, underscores and a plural's s do not matter, and the names of Cityscapes
/// and of CARLA 0.9.14 are understood.
pub fn tag_of_name(name: &str) -> Option<u8> {
    let plain = |s: &str| s.replace([' ', '_', '-'], "").to_ascii_lowercase();
    let tag = |wanted: &str| {
        let synonym = SYNONYMS.iter().find(|(from, _)| plain(from) == wanted).map(|(_, to)| plain(to));
        let wanted = synonym.as_deref().unwrap_or(wanted);
        TRAIN_CLASSES.iter().chain(&UNTRAINED_TAGS).find(|c| plain(c.name) == wanted).map(|c| c.tag)
    };
    let wanted = plain(name);
    tag(&wanted).or_else(|| tag(wanted.strip_suffix('s')?))
}

/// The 19 train ids of Cityscapes, in order.
const CITYSCAPES: [&str; 19] = [
    "road",
    "sidewalk",
    "building",
    "wall",
    "fence",
    "pole",
    "traffic light",
    "traffic sign",
    "vegetation",
    "terrain",
    "sky",
    "person",
    "rider",
    "car",
    "truck",
    "bus",
    "train",
    "motorcycle",
    "bicycle",
];

/// The ids that CARLA 0.9.14 has after those of Cityscapes.
const CARLA_0_9_14_TAIL: [&str; 9] =
    ["static", "dynamic", "other", "water", "road line", "ground", "bridge", "rail track", "guard rail"];

/// What the channels, or the values of the class map, that a network gives out mean.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMap {
    names: Vec<String>,
    tags: Vec<u8>,
}

impl ClassMap {
    /// From the classes' names in the order of the outputs.
    pub fn from_names<S: AsRef<str>>(names: &[S]) -> Result<Self, PerceptionError> {
        let tag = |name: &S| {
            tag_of_name(name.as_ref()).ok_or_else(|| PerceptionError::UnknownClass { name: name.as_ref().to_owned() })
        };
        if names.is_empty() || names.len() > 256 {
            return Err(PerceptionError::ClassCount { count: names.len() });
        }
        Ok(Self {
            tags: names.iter().map(tag).collect::<Result<_, _>>()?,
            names: names.iter().map(|n| n.as_ref().to_owned()).collect(),
        })
    }

    /// From the labels of a network of any other origin, in the order of the outputs: of alternatives (`car; auto`) the
    /// first one that is known counts, and where none is, as of the furniture in ADE20K, the class is Other. At least one
    /// must be known.
    pub fn from_labels<S: AsRef<str>>(labels: &[S]) -> Result<Self, PerceptionError> {
        let known = labels.iter().map(|label| {
            let mut alternatives = label.as_ref().split([';', ',']).map(str::trim);
            alternatives.find(|name| tag_of_name(name).is_some())
        });
        let known: Vec<Option<&str>> = known.collect();
        match labels.first().filter(|_| known.iter().all(Option::is_none)) {
            Some(label) => Err(PerceptionError::UnknownClass { name: label.as_ref().chars().take(80).collect() }),
            None => Self::from_names(&known.iter().map(|name| name.unwrap_or(OTHER)).collect::<Vec<_>>()),
        }
    }

    /// From the name of a scheme: `aeye` (train ids of [`TRAIN_CLASSES`]), `cityscapes` (its 19
    /// train ids), `carla-0.9.10` (the 23 tags) or `carla-0.9.14`.
    pub fn named(scheme: &str) -> Result<Self, PerceptionError> {
        let names: Vec<&str> = match scheme {
            "aeye" => TRAIN_CLASSES.iter().map(|c| c.name).collect(),
            "cityscapes" => CITYSCAPES.to_vec(),
            "carla-0.9.10" => (0..TAGS as u8).filter_map(tag_name).collect(),
            "carla-0.9.14" => ["unlabeled"].iter().chain(&CITYSCAPES).chain(&CARLA_0_9_14_TAIL).copied().collect(),
            _ => return Err(PerceptionError::UnknownScheme { name: scheme.to_owned() }),
        };
        Self::from_names(&names)
    }

    /// Number of classes.
    pub fn count(&self) -> usize {
        self.tags.len()
    }

    /// Tag id of each output.
    pub fn tags(&self) -> &[u8] {
        &self.tags
    }

    /// Names as the checkpoint gives them.
    pub fn names(&self) -> &[String] {
        &self.names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tag_has_one_name() {
        let named: Vec<_> = (0..=255).filter_map(tag_name).collect();
        assert_eq!(named.len(), TAGS);
        for tag in 0..TAGS as u8 {
            let name = tag_name(tag).expect("tags 0 to 22 are named");
            assert_eq!(tag_of_name(name), Some(tag));
        }
    }

    #[test]
    fn train_ids_and_tags_are_inverse() {
        for (id, class) in TRAIN_CLASSES.iter().enumerate() {
            assert_eq!(train_id(class.tag), Some(id as u8));
            assert_eq!(tag_of_train_id(id as u8), class.tag);
        }
        assert!(UNTRAINED_TAGS.iter().all(|c| train_id(c.tag).is_none()));
        assert_eq!(tag_of_train_id(IGNORE), UNLABELED_TAG);
    }

    #[test]
    fn schemes_map_to_the_tags_of_the_domain_table() {
        let cityscapes = ClassMap::named("cityscapes").unwrap();
        assert_eq!(cityscapes.tags(), [7, 8, 1, 11, 2, 5, 18, 12, 9, 22, 13, 4, 4, 10, 10, 10, 10, 10, 10]);
        let carla = ClassMap::named("carla-0.9.14").unwrap();
        assert_eq!(carla.tags()[0], UNLABELED_TAG);
        assert_eq!(carla.tags()[1..20], *cityscapes.tags());
        assert_eq!(carla.tags()[20..], [19, 20, 3, 21, 6, 14, 15, 16, 17]);
        let own: Vec<u8> = (0..TAGS as u8).collect();
        assert_eq!(ClassMap::named("carla-0.9.10").unwrap().tags(), own);
    }

    #[test]
    fn unknown_names_are_refused_by_name() {
        let error = ClassMap::from_names(&["Road", "Zebra"]).unwrap_err().to_string();
        assert!(error.contains("Zebra"), "{error}");
    }

    #[test]
    fn labels_of_other_origin_are_understood_and_the_rest_is_other() {
        let labels = ["Trees", "car;auto;automobile", "chest of drawers", "double house, house", "lane-marking"];
        let classes = ClassMap::from_labels(&labels).unwrap();
        assert_eq!(classes.tags(), [9, 10, 3, 1, 6]);
        assert_eq!(ClassMap::from_names(classes.names()).unwrap(), classes, "they read back as they are written");
        let error = ClassMap::from_labels(&["LABEL_0", "LABEL_1"]).unwrap_err().to_string();
        assert!(error.contains("unknown class name \"LABEL_0\""), "{error}");
        assert!(ClassMap::from_labels(&[""; 0]).is_err());
        assert!(ClassMap::from_labels(&["road"; 257]).is_err());
    }
}
