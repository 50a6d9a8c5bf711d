//! Where something is to be played.

/// A device for sound, as it is asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// The system's own choice, if it has one.
    #[default]
    Default,
    /// None.
    Off,
    /// None, but everything is computed as for one.
    Null,
    /// The one whose name holds this.
    Named(String),
}

impl From<&str> for Choice {
    fn from(text: &str) -> Self {
        match text {
            "default" => Self::Default,
            "off" => Self::Off,
            "null" => Self::Null,
            name => Self::Named(name.to_owned()),
        }
    }
}
