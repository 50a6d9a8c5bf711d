//! The flank of a vehicle that the picture's lower edge cuts goes on below it as straight as it is seen to.

use kernel::ego::FRONT_M;

use super::arc::{HALF_WIDTH_M, Point};
use super::sight::Contact;

/// A flank is known by at least so much of it, and by at most so much, metres.
const LEAST_M: f32 = 0.8;
const MOST_M: f32 = 5.0;
/// Contacts in columns next to each other belong to one flank if they are no farther apart, metres, and for each metre of distance.
const GAP_M: f32 = 0.7;
const GAP_PER_M: f32 = 0.1;
/// Below the picture it is taken to go on at most to here, metres before the rear axle, in such steps.
const TO_X_M: f32 = 2.0;
const STEP_M: f32 = 0.3;

/// Places below the picture where flanks are, of contacts from left to right.
pub fn below_picture(contacts: &[Contact]) -> Vec<Point> {
    let vehicles: Vec<&Contact> = contacts.iter().filter(|contact| !contact.is_person).collect();
    // From the picture's side towards its middle.
    let on_left = vehicles.iter().copied().filter(|contact| contact.y_m > 0.0);
    let on_right = vehicles.iter().rev().copied().filter(|contact| contact.y_m < 0.0);
    let mut found = goes_on(on_left);
    found.extend(goes_on(on_right));
    found
}

/// Where the flank goes on that leaves the picture on one side.
fn goes_on<'a>(inwards: impl Iterator<Item = &'a Contact> + Clone) -> Vec<Point> {
    let Some(cut) = inwards.clone().filter(|contact| contact.is_cut).last() else { return Vec::new() };
    let mut far = cut;
    for contact in inwards.skip_while(|contact| *contact != cut) {
        let farther_m = contact.x_m - far.x_m;
        if (0.0..GAP_M + GAP_PER_M * far.x_m).contains(&farther_m) && contact.x_m < cut.x_m + MOST_M {
            far = contact;
        }
    }
    let ((x_m, y_m), (far_x_m, far_y_m)) = (cut.lowest(), far.lowest());
    if far_x_m - x_m < LEAST_M {
        return Vec::new();
    }
    let slope = (far_y_m - y_m) / (far_x_m - x_m);
    let steps = (0..).map(|step| x_m - STEP_M * step as f32).take_while(|x_m| *x_m > TO_X_M);
    let places = steps.map(|at_x_m| (at_x_m, y_m + slope * (at_x_m - x_m)));
    places.take_while(|at| at.0 > FRONT_M || at.1.abs() > HALF_WIDTH_M).take_while(|at| at.1 * y_m > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A car that stands askew beside the ego car: the ground beside it is seen from 5.6 m on.
    fn askew(side: f32, slope: f32) -> Vec<Contact> {
        let cut = (0..12).map(|i| (5.55, 2.6 - 0.06 * i as f32));
        let seen = (1..12).map(|i| (5.55 + 0.12 * i as f32, 1.9 + slope * 0.12 * i as f32));
        let contact = |at: Point| Contact { is_cut: at.0 == 5.55, ..Contact::of_car((at.0, side * at.1)) };
        let mut contacts: Vec<Contact> = cut.chain(seen).map(contact).collect();
        let to_left = |contact: &Contact| contact.y_m / (contact.x_m - render::Camera::driver(2, 1).position.x);
        contacts.sort_by(|a, b| to_left(b).total_cmp(&to_left(a)));
        contacts
    }

    #[test]
    fn a_flank_goes_on_as_straight_as_it_is_seen() {
        for side in [1.0, -1.0] {
            let below = below_picture(&askew(side, 0.25));
            let last = below.last().expect("it is cut");
            assert!((2.0..2.4).contains(&last.0) && (0.9..1.2).contains(&(side * last.1)), "{last:?}");
            assert!(below.windows(2).all(|pair| pair[1].0 < pair[0].0 && pair[1].1.abs() < pair[0].1.abs()));
        }
    }

    #[test]
    fn who_is_wholly_in_the_picture_or_shows_no_flank_has_none_below_it() {
        let whole: Vec<Contact> = askew(1.0, 0.25).into_iter().map(|c| Contact { is_cut: false, ..c }).collect();
        let face: Vec<Contact> = askew(1.0, 0.25).into_iter().filter(|c| c.is_cut).collect();
        let people: Vec<Contact> = askew(1.0, 0.25).into_iter().map(|c| Contact { is_person: true, ..c }).collect();
        assert_eq!([whole, face, people].map(|contacts| below_picture(&contacts).len()), [0; 3]);
    }

    /// Where the ego car is, nobody else is.
    #[test]
    fn it_does_not_go_on_into_the_car() {
        let below = below_picture(&askew(1.0, 0.5));
        assert!(!below.is_empty() && below.iter().all(|at| at.0 > FRONT_M || at.1 > HALF_WIDTH_M), "{below:?}");
    }
}
