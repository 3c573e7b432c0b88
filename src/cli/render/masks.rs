//! Label masks, which contain the element and defect that each pixel shows.

use super::args::Args;
use super::scene_drawing::SceneRenderer;
use crate::errors::AppError;
use crate::io::replace::replace;
use spandrel_model::scenario::PlacedDefect;
use spandrel_view::masks::LabelMask;
use spandrel_view::shot::Shot;
use std::path::Path;

/// Checks that label masks are requested only for a single image, for photographs or for a data set.
pub fn check(args: &Args) -> Result<(), AppError> {
    let one = args.snapshots || args.dataset.is_some() || args.from.is_some() || args.view != "both";
    if args.masks && !one {
        return Err(AppError::invalid("--masks needs a single view: use --view camera or --view inspector"));
    }
    if args.masks && !args.snapshots && args.dataset.is_none() && args.out == "-" {
        return Err(AppError::invalid("--masks writes files next to the picture: specify a file with --out"));
    }
    Ok(())
}

/// Writes a shot's label masks next to its image: NAME.elements.png, NAME.defects.png (16-bit grayscale) and
/// NAME.masks.json.
pub fn write(scene_renderer: &mut SceneRenderer, shot: &Shot, placed: &[PlacedDefect], picture: &Path) -> Result<(), AppError> {
    write_labels(&scene_renderer.labels(shot)?, placed, picture)
}

/// Writes label masks next to their image.
pub fn write_labels(masks: &LabelMask, placed: &[PlacedDefect], picture: &Path) -> Result<(), AppError> {
    let size_px = (masks.width, masks.height);
    replace(&picture.with_extension("elements.png"), &grayscale(&masks.elements, size_px)?)?;
    replace(&picture.with_extension("defects.png"), &grayscale(&masks.defects, size_px)?)?;
    replace(&picture.with_extension("masks.json"), format!("{:#}\n", masks.legend(placed)).as_bytes())
}

/// Encodes labels as a PNG file with 16 bits per pixel.
fn grayscale(labels: &[u16], (width, height): (u32, u32)) -> Result<Vec<u8>, AppError> {
    let failed = |error: png::EncodingError| AppError::failed(error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let data: Vec<u8> = labels.iter().flat_map(|label| label.to_be_bytes()).collect();
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&data).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}
