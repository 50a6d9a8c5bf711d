//! What a mask says about the ground ahead, taken as flat: inverse perspective, pixel by pixel.
//!
//! Points are in the car's frame: metres from the middle of the rear axle, x forward, y left.

use render::{Camera, SemanticTag};

use crate::drivers::MaskView;

/// Height above the ground by which a person is recognised, metres; lower blobs are noise.
const PERSON_HEIGHT_M: f32 = 1.7;
/// The same for vehicles.
const VEHICLE_HEIGHT_M: f32 = 1.4;
/// Share of the expected height in pixels from which a blob counts.
const LEAST_SHARE: f32 = 0.35;
/// Least height of a blob in pixels.
const LEAST_ROWS: usize = 2;
/// Farthest contact with the ground that is told apart from the horizon, metres.
const FARTHEST_M: f32 = 55.0;

/// What a piece of ground shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Asphalt.
    Road,
    /// Paint on asphalt.
    Line,
    /// A vehicle or a person hides it.
    Hidden,
    /// Not to be driven on.
    Other,
    /// Outside the picture.
    Unseen,
}

/// Where something that must not be hit touches the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Metres forward of the rear axle.
    pub x_m: f32,
    /// Metres to the left.
    pub y_m: f32,
    /// A person, not a vehicle.
    pub is_person: bool,
    /// The pixel below it is asphalt or paint.
    pub on_road: bool,
}

/// A mask with the geometry of the camera that both drivers look through.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    mask: MaskView<'a>,
    camera: Camera,
    focal_px: f32,
}

impl<'a> Sight<'a> {
    /// Looks at a mask.
    pub fn new(mask: MaskView<'a>) -> Self {
        let camera = Camera::driver(mask.width as u32, mask.height as u32);
        let focal_px = 0.5 * mask.width as f32 / kernel::ops::tan(0.5 * camera.fov_x_rad);
        Self { mask, camera, focal_px }
    }

    fn tag(&self, column: usize, row: usize) -> u8 {
        self.mask.ids[row * self.mask.width + column]
    }

    /// First row below the horizon.
    fn horizon(&self) -> usize {
        self.mask.height / 2
    }

    /// Distance of the ground seen in a row below the horizon, metres from the rear axle.
    fn row_x_m(&self, row: usize) -> f32 {
        let below = row as f32 + 0.5 - 0.5 * self.mask.height as f32;
        self.camera.position.x + self.focal_px * self.camera.position.z / below
    }

    /// Metres to the left at a distance, for the middle of a column.
    fn column_y_m(&self, column: usize, x_m: f32) -> f32 {
        (0.5 * self.mask.width as f32 - column as f32 - 0.5) * (x_m - self.camera.position.x) / self.focal_px
    }

    /// What lies at a point.
    pub fn ground(&self, x_m: f32, y_m: f32) -> Ground {
        let ahead = x_m - self.camera.position.x;
        if ahead < 0.5 {
            return Ground::Unseen;
        }
        let column = 0.5 * self.mask.width as f32 - self.focal_px * y_m / ahead;
        let row = 0.5 * self.mask.height as f32 + self.focal_px * self.camera.position.z / ahead;
        if column < 0.0 || column >= self.mask.width as f32 || row >= self.mask.height as f32 {
            return Ground::Unseen;
        }
        ground_of(self.tag(column as usize, row as usize))
    }

    /// For each column, where the nearest person and the nearest vehicle stand. Blobs that are too
    /// low for their distance are noise; so are single columns.
    pub fn contacts(&self) -> Vec<Contact> {
        let columns: Vec<[Option<Contact>; 2]> = (0..self.mask.width).map(|c| self.contacts_of_column(c)).collect();
        let agrees = |a: Option<Contact>, b: Contact| a.is_some_and(|a| (a.x_m - b.x_m).abs() < 1.0 + 0.1 * b.x_m);
        let mut contacts = Vec::new();
        for (i, column) in columns.iter().enumerate() {
            for (kind, contact) in column.iter().enumerate() {
                let Some(contact) = *contact else { continue };
                let left = i > 0 && agrees(columns[i - 1][kind], contact);
                let right = columns.get(i + 1).is_some_and(|c| agrees(c[kind], contact));
                if left || right {
                    contacts.push(contact);
                }
            }
        }
        contacts
    }

    /// The nearest vehicle and the nearest person of a column.
    fn contacts_of_column(&self, column: usize) -> [Option<Contact>; 2] {
        let mut found = [None, None];
        let mut row = self.mask.height;
        while row > self.horizon() && found.iter().any(Option::is_none) {
            let tag = self.tag(column, row - 1);
            let top = self.run_top(column, row, tag);
            if is_vehicle(tag) || is_person(tag) {
                let kind = usize::from(is_person(tag));
                if found[kind].is_none() && self.is_tall_enough(row - top, row - 1, is_person(tag)) {
                    found[kind] = self.contact(column, row, is_person(tag));
                }
            }
            row = top;
        }
        found
    }

    /// The row above which the run of equal kind that ends above `row` stops.
    fn run_top(&self, column: usize, row: usize, tag: u8) -> usize {
        let same = |t: u8| t == tag || (is_vehicle(t) && is_vehicle(tag)) || (is_person(t) && is_person(tag));
        (0..row - 1).rev().take_while(|&r| same(self.tag(column, r))).last().unwrap_or(row - 1)
    }

    fn is_tall_enough(&self, rows: usize, bottom_row: usize, is_person: bool) -> bool {
        let height_m = if is_person { PERSON_HEIGHT_M } else { VEHICLE_HEIGHT_M };
        let ahead_m = self.row_x_m(bottom_row) - self.camera.position.x;
        rows >= LEAST_ROWS && rows as f32 >= LEAST_SHARE * height_m * self.focal_px / ahead_m
    }

    fn contact(&self, column: usize, row: usize, is_person: bool) -> Option<Contact> {
        let x_m = self.row_x_m(row - 1);
        let below = (row < self.mask.height).then(|| self.tag(column, row));
        // A person above a vehicle rides it or stands behind it: the vehicle's contact counts.
        let rides = is_person && below.is_some_and(is_vehicle);
        let on_road = below.is_none_or(|t| matches!(ground_of(t), Ground::Road | Ground::Line));
        let y_m = self.column_y_m(column, x_m);
        (x_m < FARTHEST_M && !rides).then_some(Contact { x_m, y_m, is_person, on_road })
    }

    /// What borders the lane around a point of a row: metres to the left and to the right of
    /// `y_m`, each to a line or to the edge of the road, within `reach_m`.
    pub fn borders(&self, row: usize, y_m: f32, reach_m: f32) -> [Option<Border>; 2] {
        [1.0, -1.0].map(|side| self.border(row, y_m, side, reach_m))
    }

    fn border(&self, row: usize, y_m: f32, side: f32, reach_m: f32) -> Option<Border> {
        let x_m = self.row_x_m(row);
        let step_m = (x_m - self.camera.position.x) / self.focal_px;
        // Paint right below the middle of the lane belongs to an arrow or a crossing.
        let mut distance_m = 0.5;
        while distance_m < reach_m {
            match self.ground(x_m, y_m + side * distance_m) {
                Ground::Line => return Some(Border { distance_m, is_line: true }),
                Ground::Other => return Some(Border { distance_m, is_line: false }),
                Ground::Road => {}
                Ground::Hidden | Ground::Unseen => return None,
            }
            distance_m += step_m;
        }
        None
    }

    /// The rows that show the ground between two distances from the rear axle.
    pub fn rows_between(&self, from_m: f32, to_m: f32) -> impl Iterator<Item = (usize, f32)> + '_ {
        (self.horizon()..self.mask.height)
            .map(|row| (row, self.row_x_m(row)))
            .filter(move |(_, x)| (from_m..=to_m).contains(x))
    }
}

/// Where a lane ends on one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Border {
    /// Metres from the point asked about.
    pub distance_m: f32,
    /// Paint, not the edge of the asphalt.
    pub is_line: bool,
}

fn is_vehicle(tag: u8) -> bool {
    tag == SemanticTag::Vehicles as u8 || tag == SemanticTag::Dynamic as u8
}

fn is_person(tag: u8) -> bool {
    tag == SemanticTag::Pedestrian as u8
}

fn ground_of(tag: u8) -> Ground {
    match tag {
        t if t == SemanticTag::Road as u8 => Ground::Road,
        t if t == SemanticTag::RoadLine as u8 => Ground::Line,
        t if is_vehicle(t) || is_person(t) => Ground::Hidden,
        _ => Ground::Other,
    }
}
