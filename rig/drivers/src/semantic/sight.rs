//! What a mask says about the ground ahead, taken as flat: inverse perspective, pixel by pixel.
//!
//! Points are in the car's frame: metres from the middle of the rear axle, x forward, y left.

use render::{Camera, SemanticTag};

use crate::MaskView;

/// Height above the ground by which a person is recognised, metres; lower blobs are noise.
const PERSON_HEIGHT_M: f32 = 1.7;
/// The same for vehicles.
const VEHICLE_HEIGHT_M: f32 = 1.4;
/// Share of the expected height in pixels from which a blob counts.
const LEAST_SHARE: f32 = 0.35;
/// Least height of a blob in pixels.
const LEAST_ROWS: usize = 2;
/// Farthest contact with the ground that is told apart from the horizon, metres: two rows of pixels below it on the usual
/// screen, which are as many as a car there is high.
const FARTHEST_M: f32 = 100.0;

/// What is seen of somebody is the middle of the part in the picture: so far from its side it may leave, metres.
const LEAVING_M: f32 = 1.0;

/// Whether a point of the car's frame lies well within the picture's sides.
pub fn is_in_picture((x_m, y_m): (f32, f32)) -> bool {
    is_in_front((x_m, y_m.abs() + LEAVING_M))
}

/// Whether a point of the car's frame lies between the picture's sides, be it too near to be seen.
pub fn is_in_front((x_m, y_m): (f32, f32)) -> bool {
    let camera = Camera::driver(2, 1);
    y_m.abs() < (x_m - camera.position.x) * kernel::ops::tan(0.5 * camera.fov_x_rad)
}

/// The point at a distance that is seen in the same columns as another one.
pub fn on_ray((seen_x_m, seen_y_m): (f32, f32), x_m: f32) -> (f32, f32) {
    let camera_x_m = Camera::driver(2, 1).position.x;
    (x_m, seen_y_m * (x_m - camera_x_m) / (seen_x_m - camera_x_m))
}

/// What is lowest of a vehicle where no wheel is seen is its bumper, which hangs so much above the ground, metres: it seems
/// farther away than it is. That of a vehicle from so high on hangs higher.
const BUMPER_M: f32 = 0.2;
const HIGH_BUMPER_M: f32 = 0.35;
const HIGH_FROM_M: f32 = 2.0;
/// What is seen of a vehicle that the picture's lower edge cuts is its flank, at most so high above the ground, metres.
const FLANK_M: f32 = 0.9;

/// Where something stands whose lowest part hangs so high above the ground and hides a point of it.
fn nearer((x_m, y_m): (f32, f32), hangs_m: f32) -> (f32, f32) {
    let camera = Camera::driver(2, 1).position;
    let share = 1.0 - hangs_m / camera.z;
    (camera.x + (x_m - camera.x) * share, y_m * share)
}

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
    /// It may be so much nearer or farther, metres: half of the depth that a row of pixels covers there.
    pub depth_error_m: f32,
    /// Metres to the left.
    pub y_m: f32,
    /// So high it is seen to be, metres: less than it is where the picture cuts it.
    pub height_m: f32,
    /// The picture's lower edge cuts it: it may come nearer than it is seen.
    pub is_cut: bool,
    /// A person, not a vehicle.
    pub is_person: bool,
    /// The pixel below it is asphalt or paint.
    pub on_road: bool,
}

impl Contact {
    /// A lorry or a bus.
    pub fn is_high(&self) -> bool {
        !self.is_person && self.height_m >= HIGH_FROM_M
    }

    /// Where its lowest part is: feet on the ground, a bumper above it.
    pub fn lowest(&self) -> (f32, f32) {
        let hides = (self.x_m, self.y_m);
        let bumper_m = if self.is_high() { HIGH_BUMPER_M } else { BUMPER_M };
        if self.is_person { hides } else { nearer(hides, bumper_m) }
    }

    /// The nearest place where a vehicle may be that the picture cuts.
    pub fn nearest(&self) -> Option<(f32, f32)> {
        (self.is_cut && !self.is_person).then(|| nearer((self.x_m, self.y_m), FLANK_M))
    }
}

#[cfg(test)]
impl Contact {
    /// A car's, on the road, at a distance that is known.
    pub fn of_car((x_m, y_m): (f32, f32)) -> Self {
        Self { x_m, y_m, depth_error_m: 0.0, height_m: 1.4, is_cut: false, is_person: false, on_road: true }
    }
}

/// A mask with the geometry of the camera that both drivers look through.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    mask: MaskView<'a>,
    camera: Camera,
    focal_px: f32,
    /// Rows from the upper edge to the horizon.
    horizon_px: f32,
}

impl<'a> Sight<'a> {
    /// Looks at a mask from a car whose nose is so far down, radians.
    pub fn new(mask: MaskView<'a>, down_rad: f32) -> Self {
        let camera = Camera::driver(mask.width as u32, mask.height as u32);
        let focal_px = 0.5 * mask.width as f32 / kernel::ops::tan(0.5 * camera.fov_x_rad);
        let horizon_px = 0.5 * mask.height as f32 - focal_px * down_rad;
        Self { mask, camera, focal_px, horizon_px }
    }

    fn tag(&self, column: usize, row: usize) -> u8 {
        self.mask.ids[row * self.mask.width + column]
    }

    /// First row below the horizon.
    fn horizon(&self) -> usize {
        self.horizon_px.ceil() as usize
    }

    /// Distance of the ground seen in a row below the horizon, metres from the rear axle.
    fn row_x_m(&self, row: usize) -> f32 {
        let below = row as f32 + 0.5 - self.horizon_px;
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
        let row = self.horizon_px + self.focal_px * self.camera.position.z / ahead;
        if column < 0.0 || column >= self.mask.width as f32 || row >= self.mask.height as f32 {
            return Ground::Unseen;
        }
        ground_of(self.tag(column as usize, row as usize))
    }

    /// Where people and vehicles stand. Blobs that are too low for their distance are noise; so are
    /// single columns.
    pub fn contacts(&self) -> Vec<Contact> {
        let mut contacts = self.vehicles();
        contacts.extend(self.people());
        contacts
    }

    /// Where vehicles stand, column by column: a long one reaches from near to far.
    fn vehicles(&self) -> Vec<Contact> {
        let columns: Vec<Vec<Contact>> = (0..self.mask.width).map(|c| self.vehicles_of_column(c)).collect();
        let agree = |a: &Contact, b: &Contact| (a.x_m - b.x_m).abs() < 1.0 + 0.15 * b.x_m;
        let seen_beside = |column: usize, contact: &Contact| {
            let beside = [column.checked_sub(1), Some(column + 1)];
            beside.into_iter().flatten().filter_map(|c| columns.get(c)).flatten().any(|other| agree(other, contact))
        };
        let all = columns.iter().enumerate().flat_map(|(column, contacts)| contacts.iter().map(move |c| (column, c)));
        all.filter(|(column, contact)| seen_beside(*column, contact)).map(|(_, contact)| *contact).collect()
    }

    /// The vehicles of a column, nearest first. A rider and his bicycle are one blob, and a person
    /// behind a car is one with the car: what touches the ground counts.
    fn vehicles_of_column(&self, column: usize) -> Vec<Contact> {
        let mut found = Vec::new();
        let mut row = self.mask.height;
        while row > self.horizon() {
            let hides = |r: &usize| ground_of(self.tag(column, *r)) == Ground::Hidden;
            let rows = (0..row).rev().take_while(hides).count();
            if rows > 0 && is_vehicle(self.tag(column, row - 1)) {
                found.extend(self.contact(column, row, rows));
            }
            row -= rows.max(1);
        }
        found
    }

    /// Where people stand: a walking one touches the ground with one foot, so the lowest pixel of the
    /// whole figure says how far all of it is.
    fn people(&self) -> Vec<Contact> {
        let mut seen = vec![false; self.mask.ids.len()];
        let mut found = Vec::new();
        for row in (self.horizon()..self.mask.height).rev() {
            for column in 0..self.mask.width {
                let Some(figure) = self.figure(column, row, &mut seen).filter(|f| f.left < f.right) else { continue };
                let (column, end) = self.vehicle_under(&figure).unwrap_or((column, row + 1));
                let foot = self.contact(column, end, end - figure.top);
                let on_road = |foot: &Contact| if foot.is_cut { self.is_amid_road(&figure) } else { foot.on_road };
                let foot = foot.map(|foot| Contact { on_road: on_road(&foot), ..foot });
                let part = |foot: Contact, column| Contact { y_m: self.column_y_m(column, foot.x_m), ..foot };
                found.extend(foot.iter().flat_map(|foot| (figure.left..=figure.right).map(|c| part(*foot, c))));
            }
        }
        found
    }

    /// Whether the ground on both sides of a figure that the picture's lower edge cuts is road, as far as it is seen.
    fn is_amid_road(&self, figure: &Figure) -> bool {
        let row = self.mask.height - 1;
        let ground = |column| ground_of(self.tag(column, row));
        let is_seen = |ground: &Ground| *ground != Ground::Hidden;
        let left = (0..figure.left).rev().map(ground).find(is_seen);
        let right = (figure.right + 1..self.mask.width).map(ground).find(is_seen);
        [left, right].into_iter().flatten().all(|ground| ground != Ground::Other)
    }

    /// Where the vehicle ends that carries or hides a figure: a column, and the row below its wheels.
    fn vehicle_under(&self, figure: &Figure) -> Option<(usize, usize)> {
        let below = figure.pixels.iter().map(|&(column, row)| (column, row + 1));
        let on_vehicle = below.filter(|&(c, r)| r < self.mask.height && is_vehicle(self.tag(c, r)));
        let ends = on_vehicle.map(|(column, row)| {
            let hides = |r: &usize| ground_of(self.tag(column, *r)) == Ground::Hidden;
            (column, row + (row..self.mask.height).take_while(hides).count())
        });
        let ends: Vec<(usize, usize)> = ends.collect();
        let is_carried = 4 * ends.len() > figure.right - figure.left;
        ends.into_iter().filter(|_| is_carried).max_by_key(|(_, end)| *end)
    }

    /// The connected pixels of people around a pixel, if they were not seen before.
    fn figure(&self, column: usize, row: usize, seen: &mut [bool]) -> Option<Figure> {
        let mut figure = Figure { left: column, right: column, top: row, pixels: Vec::new() };
        let mut open = vec![(column, row)];
        while let Some((column, row)) = open.pop() {
            let is_new = !std::mem::replace(&mut seen[row * self.mask.width + column], true);
            if !is_new || !is_person(self.tag(column, row)) {
                continue;
            }
            figure.pixels.push((column, row));
            figure.left = figure.left.min(column);
            figure.right = figure.right.max(column);
            figure.top = figure.top.min(row);
            let columns = column.saturating_sub(1)..(column + 2).min(self.mask.width);
            let rows = row.saturating_sub(1)..(row + 2).min(self.mask.height);
            open.extend(columns.flat_map(|c| rows.clone().map(move |r| (c, r))));
        }
        (!figure.pixels.is_empty()).then_some(figure)
    }

    /// The contact of a blob of `rows` rows that ends above `row`, whose upper edge is its end give or take half a row.
    fn contact(&self, column: usize, row: usize, rows: usize) -> Option<Contact> {
        let is_person = is_person(self.tag(column, row - 1));
        let below_px = row as f32 - self.horizon_px;
        let ahead_m = self.focal_px * self.camera.position.z / below_px;
        let (x_m, depth_error_m) = (self.camera.position.x + ahead_m, 0.5 * ahead_m / below_px);
        let height_m = if is_person { PERSON_HEIGHT_M } else { VEHICLE_HEIGHT_M };
        let seen_m = rows as f32 * ahead_m / self.focal_px;
        let is_tall_enough = rows >= LEAST_ROWS && seen_m >= LEAST_SHARE * height_m;
        let below = (row < self.mask.height).then(|| ground_of(self.tag(column, row)));
        let on_road = below.is_none_or(|ground| ground != Ground::Other);
        let y_m = self.column_y_m(column, x_m);
        let is_cut = row == self.mask.height;
        let contact = Contact { x_m, depth_error_m, y_m, height_m: seen_m, is_cut, is_person, on_road };
        (is_tall_enough && x_m < FARTHEST_M).then_some(contact)
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

/// Pixels that are connected, as column and row.
struct Figure {
    pixels: Vec<(usize, usize)>,
    left: usize,
    right: usize,
    top: usize,
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
