//! White text on a dark ground at the lower left of a picture, and a mark over somebody in it.

use render::Frame;

/// Pixels a dot of a letter.
const DOT_PX: usize = 2;

/// Rows of a letter, 3 dots each, from the top.
fn dots(letter: char) -> [u8; 5] {
    match letter {
        '0' => [7, 5, 5, 5, 7],
        '1' => [2, 6, 2, 2, 7],
        '2' => [7, 1, 7, 4, 7],
        '3' => [7, 1, 7, 1, 7],
        '4' => [5, 5, 7, 1, 1],
        '5' => [7, 4, 7, 1, 7],
        '6' => [7, 4, 7, 5, 7],
        '7' => [7, 1, 1, 2, 2],
        '8' => [7, 5, 7, 5, 7],
        '9' => [7, 5, 7, 1, 7],
        's' => [0, 7, 6, 3, 7],
        'k' => [4, 5, 6, 6, 5],
        'm' => [0, 7, 7, 5, 5],
        'h' => [4, 4, 6, 5, 5],
        '/' => [1, 1, 2, 4, 4],
        '.' => [0, 0, 0, 0, 2],
        _ => [0; 5],
    }
}

/// Colour of the mark.
pub const MARK: [u8; 3] = [255, 0, 200];
/// Height of the mark, pixels.
const MARK_PX: usize = 9;

/// Puts a mark that points down over an instance.
pub fn mark(frame: &mut Frame, instance: u16) {
    let width = frame.width as usize;
    let seen = || frame.instance_ids.iter().enumerate().filter(|(_, id)| **id == instance).map(|(at, _)| at);
    let (count, sum) = seen().fold((0, 0), |(count, sum), at| (count + 1, sum + at % width));
    let Some(top) = seen().next().map(|at| at / width).filter(|top| *top > MARK_PX + 2) else { return };
    for (up, half) in (0..MARK_PX).map(|up| (up, up / 2)) {
        for x in (sum / count).saturating_sub(half)..=(sum / count + half).min(width - 1) {
            let at = 3 * ((top - 3 - up) * width + x);
            frame.rgb[at..at + 3].copy_from_slice(&MARK);
        }
    }
}

/// Writes digits and units.
pub fn write(frame: &mut Frame, text: &str) {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let (wide, high) = ((4 * text.len() + 1) * DOT_PX, 7 * DOT_PX);
    let mut put = |x: usize, y: usize, value: u8| {
        let at = 3 * ((height - high + y) * width + x);
        frame.rgb[at..at + 3].fill(value);
    };
    for (x, y) in (0..high).flat_map(|y| (0..wide.min(width)).map(move |x| (x, y))) {
        let (column, row) = (x / DOT_PX, y / DOT_PX);
        let letter = column.checked_sub(1).and_then(|c| Some((text.chars().nth(c / 4)?, c % 4)));
        let lit = letter
            .is_some_and(|(letter, c)| c < 3 && (1..6).contains(&row) && dots(letter)[row - 1] >> (2 - c) & 1 == 1);
        put(x, y, if lit { 255 } else { 24 });
    }
}
