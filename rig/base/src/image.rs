//! Pixels for a screen or a file.

use render::Frame;

/// A picture in colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// 3 bytes a pixel: red, green, blue; rows from top to bottom.
    pub rgb: Vec<u8>,
}

impl Image {
    /// The colours of a frame.
    pub fn of(frame: Frame) -> Self {
        Self { width: frame.width as usize, height: frame.height as usize, rgb: frame.rgb }
    }

    /// The classes of a frame in their colours.
    pub fn of_classes(frame: &Frame) -> Self {
        Self { width: frame.width as usize, height: frame.height as usize, rgb: frame.class_colours() }
    }

    /// One image of several that are equally high, left one first.
    pub fn side_by_side(images: &[Self]) -> Self {
        let width = images.iter().map(|image| image.width).sum();
        let height = images.first().map_or(0, |image| image.height);
        let mut rgb = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            images.iter().for_each(|image| rgb.extend_from_slice(&image.rgb[3 * image.width * y..][..3 * image.width]));
        }
        Self { width, height, rgb }
    }

    /// This image with an equally wide one below it.
    pub fn above(mut self, below: Self) -> Self {
        self.rgb.extend(below.rgb);
        Self { height: self.height + below.height, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_put_together_row_by_row() {
        let image = |width: usize, shade: u8| Image { width, height: 2, rgb: vec![shade; 6 * width] };
        let row = Image::side_by_side(&[image(1, 7), image(2, 9)]);
        assert_eq!((row.width, row.height), (3, 2));
        let line = [7, 7, 7, 9, 9, 9, 9, 9, 9];
        assert_eq!(row.rgb, [line, line].concat());
        let both = row.clone().above(row);
        assert_eq!((both.width, both.height, both.rgb), (3, 4, [line; 4].concat()));
    }
}
