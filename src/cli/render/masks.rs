//! Labels beside pictures: which element and which defect each pixel shows.

use super::args::Args;
use super::scene_drawing::SceneRenderer;
use crate::errors::AppError;
use crate::io::replace::replace;
use spandrel_model::scenario::PlacedDefect;
use spandrel_view::shot::Shot;
use std::path::Path;

/// Refuses what has no one picture beside which labels could lie.
pub fn check(args: &Args) -> Result<(), AppError> {
    let one = args.snapshots || args.from.is_some() || args.view != "both";
    if args.masks && !one {
        return Err(AppError::wrong("--masks belongs to one picture: say --view camera or --view inspector"));
    }
    if args.masks && !args.snapshots && args.out == "-" {
        return Err(AppError::wrong("--masks writes files beside the picture: give --out a file"));
    }
    Ok(())
}

/// Writes the labels of a shot beside its picture: NAME.elements.png, NAME.defects.png (16 bits grey), NAME.masks.json.
pub fn write(brush: &mut SceneRenderer, shot: &Shot, placed: &[PlacedDefect], picture: &Path) -> Result<(), AppError> {
    let masks = brush.labels(shot)?;
    let size_px = (masks.width, masks.height);
    replace(&picture.with_extension("elements.png"), &grayscale(&masks.elements, size_px)?)?;
    replace(&picture.with_extension("defects.png"), &grayscale(&masks.defects, size_px)?)?;
    replace(&picture.with_extension("masks.json"), format!("{:#}\n", masks.legend(placed)).as_bytes())
}

/// Numbers as a PNG file with 16 bits a pixel.
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
