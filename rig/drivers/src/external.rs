//! What looks at pictures outside of this program: a function of whoever uses its libraries, in the place of a checkpoint.

use std::fmt;
use std::sync::Arc;

use base::failure::Usage;
use base::files::check_name;
use perception::classes::TAGS;
use perception::{BUNDLED, Mask, RgbView, TRUTH};
use render::Imaging;

/// How an identity begins, as no digest does.
const EXTERNAL: &str = "external ";

/// A function from pictures to masks. Several threads may call it at once.
pub trait Sight: Send + Sync {
    /// The class of every pixel, as tag ids, in a mask of the picture's size.
    fn see(&self, picture: RgbView<'_>) -> anyhow::Result<Mask>;
}

/// Such a function, with the name and the version that its user gives it. No file holds it: recordings say both, and
/// nobody can open it again from there.
#[derive(Clone)]
pub struct External {
    name: String,
    version: String,
    size: (u32, u32),
    imaging: Imaging,
    sight: Arc<dyn Sight>,
}

impl External {
    /// A function that looks at pictures of a size, (width, height) in pixels, where nothing else is asked for. The name
    /// is that of files; the version is what tells results of one function of that name from those of the next.
    pub fn new(name: &str, version: &str, size: (u32, u32), sight: Arc<dyn Sight>) -> Result<Self, Usage> {
        check_name(name).map_err(Usage)?;
        if name == TRUTH || BUNDLED.contains(&name) {
            return Err(Usage(format!("the name {name} is that of a checkpoint of this program; expected another")));
        }
        check_version(version)?;
        Ok(Self { name: name.to_owned(), version: version.to_owned(), size, imaging: Imaging::default(), sight })
    }

    /// What it is called in results.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Which one of that name it is.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// What results are told apart by, where they hold digests of checkpoints.
    pub fn identity(&self) -> String {
        identity(&self.name, &self.version)
    }

    /// Width and height of the pictures it looks at, pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// How the pictures are made that it looks at.
    pub fn imaging(&self) -> Imaging {
        self.imaging
    }

    /// The same for pictures that are made otherwise.
    pub fn of_imaging(self, imaging: Imaging) -> Self {
        Self { imaging, ..self }
    }

    /// The same for pictures of another size.
    pub fn at(&self, size: (u32, u32)) -> Self {
        Self { size, ..self.clone() }
    }

    /// The mask of a picture; one of another size, or with classes that are none, is refused.
    pub fn see(&self, picture: RgbView<'_>) -> anyhow::Result<Mask> {
        let mask = self.sight.see(picture)?;
        let (found, expected) = ((mask.width, mask.height), (picture.width(), picture.height()));
        let refused = |what: String| Err(Usage(format!("{}: {what}", self.name)).into());
        if found != expected {
            return refused(format!(
                "gave a mask of {}x{} pixels; expected the picture's {}x{}",
                found.0, found.1, expected.0, expected.1
            ));
        }
        match mask.ids.iter().position(|id| usize::from(*id) >= TAGS) {
            Some(at) => {
                let (id, row, column) = (mask.ids[at], at / found.0, at % found.0);
                refused(format!("gave class {id} in row {row}, column {column}; expected 0 to {}", TAGS - 1))
            }
            None => Ok(mask),
        }
    }
}

/// What stands for a digest where there is no file: name and version.
pub fn identity(name: &str, version: &str) -> String {
    format!("{EXTERNAL}{name}@{version}")
}

/// `NAME@VERSION` of such an identity; `None` of a digest.
pub fn name_and_version(identity: &str) -> Option<&str> {
    identity.strip_prefix(EXTERNAL)
}

fn check_version(version: &str) -> Result<(), Usage> {
    const LONGEST: usize = 100;
    if version.is_empty() || version.len() > LONGEST || version.contains(char::is_control) {
        return Err(Usage(format!("version {version:?}; expected 1 to {LONGEST} bytes in one line")));
    }
    Ok(())
}

impl PartialEq for External {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, &self.version, self.size) == (&other.name, &other.version, other.size)
            && Arc::ptr_eq(&self.sight, &other.sight)
    }
}

impl Eq for External {}

impl fmt::Debug for External {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "External({}@{}, {}x{})", self.name, self.version, self.size.0, self.size.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives the same mask for every picture.
    struct Always(Mask);

    impl Sight for Always {
        fn see(&self, _: RgbView<'_>) -> anyhow::Result<Mask> {
            Ok(self.0.clone())
        }
    }

    fn external(name: &str, version: &str, ids: Vec<u8>) -> Result<External, Usage> {
        let mask = Mask::new(2, ids.len() / 2, ids).expect("as many as pixels");
        External::new(name, version, (2, 2), Arc::new(Always(mask)))
    }

    #[test]
    fn masks_that_are_none_of_the_picture_are_refused() {
        let rgb = [0; 12];
        let see = |ids: Vec<u8>| {
            let picture = RgbView::new(2, 2, &rgb).expect("of that size");
            external("mine", "1", ids).expect("well named").see(picture).map_err(|error| error.to_string())
        };
        assert_eq!(see(vec![0, 7, 22, 4]).map(|mask| mask.ids), Ok(vec![0, 7, 22, 4]));
        assert_eq!(see(vec![0; 6]), Err("mine: gave a mask of 2x3 pixels; expected the picture's 2x2".into()));
        assert_eq!(see(vec![0, 0, 23, 0]), Err("mine: gave class 23 in row 1, column 0; expected 0 to 22".into()));
    }

    #[test]
    fn names_and_versions_are_such_as_results_can_hold() {
        let refused = |name: &str, version: &str| external(name, version, vec![0; 4]).map_err(|Usage(said)| said).err();
        assert_eq!(refused("mine", "2024-05, run 7"), None);
        for (name, version, said) in [
            ("early", "1", "the name early is that of a checkpoint"),
            ("truth", "1", "the name truth is that of a checkpoint"),
            ("a/b", "1", "cannot be a file's"),
            ("mine", "", "version \"\"; expected 1 to 100 bytes"),
            ("mine", "1\n2", "expected 1 to 100 bytes in one line"),
        ] {
            assert!(refused(name, version).is_some_and(|sentence| sentence.contains(said)), "{name} {version}");
        }
    }

    #[test]
    fn one_is_itself_at_its_size() {
        let mine = external("mine", "1", vec![0; 4]).expect("well named");
        assert_eq!(mine, mine.clone());
        assert_ne!(mine, mine.at((4, 4)));
        assert_ne!(mine, external("mine", "1", vec![0; 4]).expect("another function"));
        assert_eq!((mine.identity(), mine.at((4, 4)).size()), ("external mine@1".into(), (4, 4)));
    }
}
