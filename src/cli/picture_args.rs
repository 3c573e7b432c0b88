//! Image options shared by several subcommands.

use crate::errors::AppError;
use spandrel_view::quality::{PRESETS, Quality};

/// Maximum width or height of an image, px.
const MAX_SIZE_PX: u32 = 8192;

/// Returns the quality preset with this name.
pub fn parse_quality(name: &str) -> Result<Quality, AppError> {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    Quality::by_name(name)
        .ok_or_else(|| AppError::invalid(format!("--quality {name}: unknown preset (allowed: {})", names.join(", "))))
}

/// Parses a size: width and height in px.
pub fn parse_size(text: &str) -> Result<(u32, u32), AppError> {
    let wrong = || {
        AppError::invalid(format!(
            "--size {text}: not a size (allowed: WIDTHxHEIGHT in px, each 16 to {MAX_SIZE_PX}, for example 1280x720)"
        ))
    };
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| text.parse::<u32>().ok().filter(|px| (16..=MAX_SIZE_PX).contains(px)).ok_or_else(wrong);
    Ok((side(width)?, side(height)?))
}

/// Returns the quality preset with this name; `None` for auto.
pub fn parse_quality_or_auto(name: &str) -> Result<Option<Quality>, AppError> {
    if name == "auto" { Ok(None) } else { parse_quality(name).map(Some) }
}
