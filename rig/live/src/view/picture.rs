//! What a view shows.

use std::sync::Arc;

use base::image::Image;

/// An image, or why there is none.
pub type Picture = Result<Arc<Image>, String>;
