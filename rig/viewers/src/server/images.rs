//! Views as PNG files, encoded once for all clients, and only when one asks.

use std::sync::{Arc, Mutex, PoisonError};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::feed::View;

/// The last picture that was encoded.
#[derive(Debug, Default)]
pub struct Encoder(Mutex<Option<(Arc<View>, Arc<str>)>>);

impl Encoder {
    /// The view as a PNG file in base 64; other clients wait for it meanwhile. `None` when it cannot be
    /// encoded.
    pub fn png(&self, view: &Arc<View>) -> Option<Arc<str>> {
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((encoded, text)) = &*last
            && Arc::ptr_eq(encoded, view)
        {
            return Some(text.clone());
        }
        let text: Arc<str> = STANDARD.encode(encode(view).ok()?).into();
        *last = Some((view.clone(), text.clone()));
        Some(text)
    }
}

/// Fast rather than small: it is for a network, not for a disk.
fn encode(view: &View) -> Result<Vec<u8>, png::EncodingError> {
    let (mut out, image) = (Vec::new(), &view.image);
    let mut encoder = png::Encoder::new(&mut out, image.width as u32, image.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&image.rgb)?;
    writer.finish()?;
    Ok(out)
}

/// One encoder for each of the cameras.
pub type Images = [Encoder; 2];
