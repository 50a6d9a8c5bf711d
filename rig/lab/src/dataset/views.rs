//! Through which cameras a dataset sees its frames.

use base::failure::Usage;
use base::say::say;
use render::{Camera, Imaging};

use crate::cameras::{self, Mounted, Named};
use crate::looks::Size;

/// A camera of a dataset.
pub(super) struct View {
    /// Its name; none where there is the drivers' alone.
    pub(super) name: Option<String>,
    pub(super) camera: Camera,
}

/// Those that a recipe describes, or else the drivers'.
pub(super) fn views(cameras: &[Mounted], size: Size, imaging: Imaging) -> anyhow::Result<Vec<View>> {
    if cameras.is_empty() {
        let camera = Camera::driver(size.0, size.1).at(imaging);
        cameras::check(&camera)?;
        return Ok(vec![View { name: None, camera }]);
    }
    let of = |Named { name, camera }: Named| View { name: Some(name), camera };
    Ok(cameras::named(cameras, size, imaging).map_err(Usage)?.into_iter().map(of).collect())
}

/// Refuses cameras through which no frames can be taken, or whose files would have the same names.
pub(super) fn check(cameras: &[Mounted], size: Size, imaging: Imaging) -> Result<(), String> {
    cameras::named(cameras, size, imaging)?;
    cameras::check_apart(cameras, |name| name.replace('_', "-"))
}

/// Says where pictures have different sizes, of which networks learn from one alone.
pub(super) fn say_sizes(views: &[View]) {
    let size = |view: &View| format!("{}x{}", view.camera.width, view.camera.height);
    let Some(first) = views.first() else { return };
    if let Some(other) = views.iter().find(|view| size(view) != size(first)) {
        let name = |view: &View| view.name.clone().unwrap_or_default();
        let (a, b) = (format!("{} {}", name(first), size(first)), format!("{} {}", name(other), size(other)));
        say(format_args!("the cameras take pictures of different sizes ({a}, {b}); `train` takes datasets of one"));
    }
}
