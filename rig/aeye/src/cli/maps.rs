//! Arguments of what looks at maps.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// Looks at maps.
#[derive(Debug, Subcommand)]
pub enum MapCommand {
    /// Say what is in maps, and what was not understood of their files.
    Inspect(MapInspectArgs),
    /// Draw a map from above, as SVG.
    Draw(MapDrawArgs),
}

/// Arguments of `map inspect`.
#[derive(Args, Clone, Debug)]
pub struct MapInspectArgs {
    /// Bundled maps or OpenDRIVE files.
    #[arg(required = true, value_name = "NAME|FILE.xodr")]
    pub files: Vec<String>,
}

/// Arguments of `map draw`.
#[derive(Args, Clone, Debug)]
pub struct MapDrawArgs {
    /// A bundled map or an OpenDRIVE file.
    #[arg(value_name = "NAME|FILE.xodr")]
    pub file: String,
    /// Longest side of the map in the picture, 200 to 20000 pixels.
    #[arg(long, default_value_t = 1600, value_parser = clap::value_parser!(u32).range(200..=20_000), value_name = "PIXELS")]
    pub size: u32,
    /// Where the picture goes; a file that is there stays.
    #[arg(long, value_name = "FILE.svg")]
    pub out: PathBuf,
}
