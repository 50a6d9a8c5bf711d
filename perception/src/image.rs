//! Pictures and masks.

use crate::PerceptionError;
use crate::classes;

/// A borrowed picture: rows from top to bottom, three bytes (red, green, blue) a pixel, no padding.
#[derive(Clone, Copy, Debug)]
pub struct RgbView<'a> {
    width: usize,
    height: usize,
    bytes: &'a [u8],
}

impl<'a> RgbView<'a> {
    /// Wraps `3 * width * height` bytes.
    pub fn new(width: usize, height: usize, bytes: &'a [u8]) -> Result<Self, PerceptionError> {
        if width == 0 || height == 0 || bytes.len() != 3 * width * height {
            return Err(PerceptionError::ImageSize { bytes: bytes.len(), width, height, channels: 3 });
        }
        Ok(Self { width, height, bytes })
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels.
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes
    }
}

/// A class for every pixel, as tag ids of CARLA 0.9.10.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Tag ids, rows from top to bottom.
    pub ids: Vec<u8>,
}

impl Mask {
    /// From tag ids; their number must be `width * height`.
    pub fn new(width: usize, height: usize, ids: Vec<u8>) -> Result<Self, PerceptionError> {
        if width == 0 || height == 0 || ids.len() != width * height {
            return Err(PerceptionError::ImageSize { bytes: ids.len(), width, height, channels: 1 });
        }
        Ok(Self { width, height, ids })
    }

    /// The same mask in train ids; 255 where the tag is not trained.
    pub fn train_ids(&self) -> Vec<u8> {
        self.ids.iter().map(|&tag| classes::TRAIN_ID_OF_TAG[usize::from(tag)]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked() {
        assert!(RgbView::new(2, 2, &[0; 11]).is_err());
        assert!(RgbView::new(0, 2, &[]).is_err());
        assert!(Mask::new(2, 2, vec![0; 5]).is_err());
    }

    #[test]
    fn tags_become_train_ids() {
        let mask = Mask::new(3, 1, vec![7, 4, 0]).unwrap();
        assert_eq!(mask.train_ids(), [5, 2, 255]);
    }
}
