//! Options for pictures that several subcommands share.

use crate::errors::AppError;
use spandrel_view::quality::{PRESETS, Quality};

/// Largest side of a picture, px.
const LARGEST_PX: u32 = 8192;

/// The preset of a name.
pub fn quality(name: &str) -> Result<Quality, AppError> {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    Quality::named(name).ok_or_else(|| AppError::wrong(format!("--quality {name}: give one of {}", names.join(", "))))
}

/// Width and height from the command line, px.
pub fn size(text: &str) -> Result<(u32, u32), AppError> {
    let wrong = || AppError::wrong(format!("--size {text}: give width x height in px, each 16 to {LARGEST_PX}, as 1280x720"));
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| text.parse::<u32>().ok().filter(|px| (16..=LARGEST_PX).contains(px)).ok_or_else(wrong);
    Ok((side(width)?, side(height)?))
}

/// The preset of a name; `None` for auto.
pub fn quality_or_auto(name: &str) -> Result<Option<Quality>, AppError> {
    if name == "auto" { Ok(None) } else { quality(name).map(Some) }
}
