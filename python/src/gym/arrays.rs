//! Arrays of observations with a row for each place, written where they lie.

use drivers::episode::{COLUMNS, Row, hud};
use numpy::ndarray::Dimension;
use numpy::{Element, PyReadwriteArray, PyReadwriteArray2, PyReadwriteArray3, PyReadwriteArray4};
use pyo3::prelude::*;

use crate::errors::input;

/// Masks (places, height, width), images (places, height, width, 3), HUDs (places, 11) and figures (places, columns).
#[derive(FromPyObject)]
pub struct Arrays<'py>(
    Option<PyReadwriteArray3<'py, u8>>,
    Option<PyReadwriteArray4<'py, u8>>,
    PyReadwriteArray2<'py, f32>,
    PyReadwriteArray2<'py, f64>,
);

/// How much of what there is of one drive.
#[derive(Clone, Copy)]
pub struct Sizes {
    /// Places.
    pub places: usize,
    /// Bytes of a mask, where masks are observed.
    pub mask: Option<usize>,
    /// Bytes of an image, where images are observed.
    pub image: Option<usize>,
}

impl Arrays<'_> {
    /// The rows of places, in their order: ascending, and each once.
    pub fn rows(&mut self, places: &[usize], sizes: Sizes) -> PyResult<Vec<Row<'_>>> {
        let Self(masks, images, huds, figures) = self;
        if !places.is_sorted_by(|a, b| a < b) || places.last().is_some_and(|last| *last >= sizes.places) {
            return Err(input(format!("places {places:?}; expected some of 0 to {}, ascending", sizes.places - 1)));
        }
        let mut masks = parts(masks.as_mut(), sizes.mask, sizes.places)?;
        let mut images = parts(images.as_mut(), sizes.image, sizes.places)?;
        let mut huds = parts(Some(huds), Some(hud::NAMES.len()), sizes.places)?;
        let mut figures = parts(Some(figures), Some(COLUMNS.len()), sizes.places)?;
        let wrong = || input("an array has no row for each place".to_owned());
        let row = |place: &usize| {
            Some(Row {
                place: *place,
                mask: masks.get_mut(*place).and_then(Option::take),
                image: images.get_mut(*place).and_then(Option::take),
                hud: huds[*place].take()?,
                figures: figures[*place].take()?,
            })
        };
        places.iter().map(row).collect::<Option<_>>().ok_or_else(wrong)
    }
}

/// The rows of an array; none of one that is not asked for.
fn parts<'a, T: Element, D: Dimension>(
    array: Option<&'a mut PyReadwriteArray<'_, T, D>>,
    length: Option<usize>,
    places: usize,
) -> PyResult<Vec<Option<&'a mut [T]>>> {
    let (Some(array), Some(length)) = (array, length) else { return Ok(Vec::new()) };
    let wrong = || input(format!("expected an array of {places} rows of {length} without gaps"));
    let values = array.as_slice_mut().map_err(|_| wrong())?;
    if values.len() != places * length {
        return Err(wrong());
    }
    Ok(values.chunks_exact_mut(length).map(Some).collect())
}
