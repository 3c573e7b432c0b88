//! `spandrel import`: makes a job out of a bridge from a 3D model.

use crate::errors::{AppError, EXIT_CODES};
use crate::io::files;
use crate::io::panics::caught_silently;
use crate::io::progress::ProgressLog;
use spandrel_model::elements::Element;
use spandrel_model::mesh::mesh_file::MAX_FILE_BYTES;
use spandrel_model::mesh::part_shapes::{ConcaveShape, ShapeLimits};
use spandrel_model::mesh::reader::ModelFormat;
use spandrel_model::mesh::voxel_surface::{CloudLimits, CloudReport, VOXEL_RANGE_M};
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::{self, MAX_NAME_CHARS, is_name, is_name_char};
use spandrel_model::site::bridge_import::{
    self, ELEMENTS_FILE, ImportError, ImportOptions, ImportReport, ImportSource, ImportedBridge, MODEL_FILE, ModelOrigin,
    PartReport, SCENARIO_FILE, UpAxis,
};
use std::panic::AssertUnwindSafe;
use std::path::Path;

/// Number of parts without an element that a message lists.
const MAX_LISTED: usize = 20;

/// Import a bridge from a 3D model
///
/// Reads a glTF 2.0 file (.glb, or .gltf with its buffers), an IFC file (.ifc, IFC2X3 to IFC4X3), a Wavefront OBJ file, a PLY file or a point cloud (.las, .laz, .xyz, .pts, or
/// .ply without faces), cleans its meshes, converts them to parts that collide (convex solids where they fit, their own triangles elsewhere) and writes a folder with the parts
/// (bridge.glb), their elements (elements.toml) and a job (scenario.toml) that you can check, fly and edit. A part's element comes
/// from the elements file, from `element` in the extras of its node or in the properties of its product, or from its IFC class. If parts have no element, it prints an elements file to
/// start from. It prints a table of the parts: triangles (and those removed as degenerate or repeated), connected pieces, open
/// edges and holes, parts that collide, how they were made, the largest deviation of their surfaces from the model, and the size.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel import bridge.glb --out my-bridge/                          parts with element numbers in their extras
  spandrel import bridge.glb --out my-bridge/ > elements.toml          an elements file to edit, if parts have no element
  spandrel import bridge.glb --out my-bridge/ --elements elements.toml
  spandrel import bridge.gltf --out my-bridge/ --scale 0.001 --up z    a model in millimeters with z up
  spandrel import bridge.ifc --out my-bridge/                          a building information model
  spandrel import scan.ply --out my-bridge/ --up z --element 144       a mesh from photogrammetry
  spandrel import scan.laz --out my-bridge/ --element 107 --voxel-size 0.2
  spandrel check my-bridge/scenario.toml

{EXIT_CODES}"))]
pub struct Args {
    /// Model (.glb, .gltf, .ifc, .obj, .ply, .las, .laz, .xyz or .pts)
    #[arg(value_name = "FILE")]
    file: String,
    /// Folder for the bridge; created if it does not exist
    #[arg(long, value_name = "FOLDER")]
    out: String,
    /// Name of the bridge and the job, of a-z, 0-9 and hyphens [default: from the file's name]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Factor from the model's units to meters (IFC files state their own unit)
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = parse_scale)]
    scale: f64,
    /// Axis of the model that points up: y (as glTF requires) or z [default: z for .ifc, .las, .laz, .xyz and .pts, y for other files]
    #[arg(long, value_name = "AXIS", value_parser = parse_up)]
    up: Option<UpAxis>,
    /// Origin of the bridge axes: center (the middle of the deck's upper surface), or a point X,Y,Z in the model, in m with z up
    #[arg(long, value_name = "X,Y,Z|center", default_value = "center", value_parser = parse_origin, allow_hyphen_values = true)]
    origin: ModelOrigin,
    /// Counterclockwise turn of the model, seen from above, that makes the deck run along x, degrees
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true, value_parser = parse_turn)]
    turn: f64,
    /// Elements by the names of parts, and by boxes (TOML)
    #[arg(long, value_name = "FILE")]
    elements: Option<String>,
    /// Element number of all parts that have no other
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=999))]
    element: Option<u16>,
    /// Maximum deviation of a hull or of a cut that replaces a piece, m
    #[arg(long, value_name = "M", default_value_t = 0.01, value_parser = parse_tolerance)]
    tolerance: f64,
    /// Replace pieces that cannot be cut exactly by hulls of groups of voxels instead of their own triangles; N is the number of voxels
    /// along the longest side
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=400))]
    voxels: Option<u32>,
    /// Size of the voxels that replace a point cloud, m
    #[arg(long, value_name = "M", default_value_t = CloudLimits::default().voxel_m, value_parser = parse_voxel_size)]
    voxel_size: f64,
    /// Minimum number of points in a group of touching voxels of a point cloud; smaller groups are left out as outliers
    #[arg(long, value_name = "N", default_value_t = CloudLimits::default().min_points as u32, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    min_points: u32,
    /// Replace the files of an earlier import
    #[arg(long)]
    overwrite: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if the model or the elements are invalid, parts have no element, or the folder cannot be written.
pub fn run(args: &Args) -> Result<(), AppError> {
    let out = Path::new(&args.out);
    let targets = [MODEL_FILE, ELEMENTS_FILE, SCENARIO_FILE].map(|name| out.join(name));
    if let Some(old) = targets.iter().find(|target| target.exists() && !args.overwrite) {
        return Err(AppError::invalid(format!("{} already exists: choose another --out, or set --overwrite", old.display())));
    }
    let imported = import(args)?;
    check(&imported)?;
    std::fs::create_dir_all(out).map_err(|error| AppError::failed(format!("{}: cannot create: {error}", out.display())))?;
    // The job is last, so that an interrupted import leaves no job without its parts.
    let contents = [&imported.model[..], imported.elements.as_bytes(), imported.scenario.as_bytes()];
    for (target, content) in targets.iter().zip(contents) {
        files::write(&target.display().to_string(), content)?;
    }
    print!("{}", report_text(&imported.report));
    println!("\nwrote {}: next, run `spandrel check {}`", out.display(), targets[2].display());
    Ok(())
}

fn import(args: &Args) -> Result<ImportedBridge, AppError> {
    let path = Path::new(&args.file);
    let format = ModelFormat::of_file(&args.file)
        .ok_or_else(|| AppError::invalid(format!("{}: unknown format (allowed: {})", args.file, ModelFormat::NAMES)))?;
    let bytes = files::read_limited(path, MAX_FILE_BYTES);
    let bytes = bytes.map_err(|error| AppError::invalid(format!("{}: cannot read: {error}", args.file)))?;
    let elements = match &args.elements {
        Some(file) => ElementMap::read_for_import(file, &files::read(Path::new(file))?)?,
        None => ElementMap::default(),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let load = |name: &str| files::read_limited(&files::path_in_folder(folder, name)?, MAX_FILE_BYTES);
    let options = ImportOptions {
        name: bridge_name(args, path)?,
        scale: args.scale,
        up: args.up.unwrap_or(if format.is_z_up() { UpAxis::Z } else { UpAxis::Y }),
        origin: args.origin,
        turn_deg: args.turn,
        default_element: args.element.map(Element::from_number),
        limits: ShapeLimits {
            tolerance_m: args.tolerance,
            concave: args.voxels.map_or(ConcaveShape::Mesh, |resolution| ConcaveShape::Voxels { resolution }),
        },
        cloud: CloudLimits { voxel_m: args.voxel_size, min_points: args.min_points as usize },
    };
    let source = ImportSource { file: &args.file, format, bytes: &bytes, load: &load, elements };
    let progress = ProgressLog::start("importing the bridge");
    // Readers of compressed points and of IFC files catch the panics of their libraries.
    let imported = caught_silently(AssertUnwindSafe(|| bridge_import::import(&source, &options)));
    progress.finish();
    let imported =
        imported.ok_or_else(|| AppError::failed(format!("{}: this model cannot be converted; please report it", args.file)))?;
    imported.map_err(|error| import_error(&args.file, error))
}

/// Converts an error. Prints the elements file to start from on standard output.
fn import_error(file: &str, error: ImportError) -> AppError {
    match error {
        ImportError::Invalid(words) => AppError::invalid(words),
        ImportError::UnknownElements { parts, elements, notes } => {
            print!("{elements}");
            notes.iter().take(MAX_LISTED).for_each(|note| tracing::warn!("{note}"));
            let shown: Vec<&str> = parts.iter().take(MAX_LISTED).map(String::as_str).collect();
            let more = parts.len().saturating_sub(MAX_LISTED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            AppError::invalid(format!(
                "{file}: {} parts have no element: {}{more}. Save the elements file from standard output, correct it and set --elements, \
                 or set --element N for all",
                parts.len(),
                shown.join(", ")
            ))
        }
    }
}

/// Reads the files as the other commands will.
fn check(imported: &ImportedBridge) -> Result<(), AppError> {
    let load = |name: &str| match name {
        MODEL_FILE => Ok(imported.model.clone()),
        ELEMENTS_FILE => Ok(imported.elements.clone().into_bytes()),
        _ => Err("no such file".to_owned()),
    };
    scenario::read(SCENARIO_FILE, &imported.scenario, &load)?;
    Ok(())
}

fn bridge_name(args: &Args, path: &Path) -> Result<String, AppError> {
    if let Some(name) = &args.name {
        return if is_name(name) {
            Ok(name.clone())
        } else {
            Err(AppError::invalid(format!("--name {name}: invalid (allowed: 1 to {MAX_NAME_CHARS} characters: a-z, 0-9 and -)")))
        };
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let clean: String = stem.chars().map(|c| if is_name_char(c) { c } else { '-' }).take(MAX_NAME_CHARS).collect();
    let clean = clean.trim_matches('-');
    Ok(if clean.is_empty() { "bridge".to_owned() } else { clean.to_owned() })
}

fn report_text(report: &ImportReport) -> String {
    let header =
        ["part", "element", "triangles", "removed", "pieces", "open edges", "holes", "shapes", "by", "deviation mm", "size m"];
    let mut rows: Vec<[String; 11]> = vec![header.map(str::to_owned)];
    rows.extend(report.parts.iter().map(row));
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let mut text = String::new();
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    text.push_str(&summary(report));
    text
}

fn row(part: &PartReport) -> [String; 11] {
    let [x, y, z] = part.size_m;
    let method = part.method.map_or("flat", spandrel_model::mesh::part_shapes::Method::word);
    [
        part.name.clone(),
        part.element.number().to_string(),
        part.triangles.to_string(),
        part.dropped_triangles.to_string(),
        part.pieces.to_string(),
        part.open_edges.to_string(),
        part.holes.to_string(),
        part.shapes.to_string(),
        method.to_owned(),
        format!("{:.1}", 1000.0 * part.deviation_m),
        format!("{x:.2} x {y:.2} x {z:.2}"),
    ]
}

/// Returns the totals, and notes on parts of the model to correct.
fn summary(report: &ImportReport) -> String {
    let sum = |count: fn(&PartReport) -> usize| report.parts.iter().map(count).sum::<usize>();
    let (low, high) = report.extent.whole;
    let [x, y, z] = [0, 1, 2].map(|k: usize| high[k] - low[k]);
    let [ox, oy, oz] = report.origin_m;
    let deviation_mm = 1000.0 * report.parts.iter().map(|part| part.deviation_m).fold(0.0, f64::max);
    let mut text = format!(
        "\n{} parts with {} triangles became {} shapes; {} holes; largest deviation {deviation_mm:.1} mm; {x:.1} x {y:.1} x {z:.1} m\n\
         origin of the bridge axes in the model: --origin {ox:.3},{oy:.3},{oz:.3}\n",
        report.parts.len(),
        sum(|part| part.triangles),
        sum(|part| part.shapes) - report.lost_parts,
        sum(|part| part.holes),
    );
    if let Some(cloud) = report.cloud {
        text.push_str(&cloud_text(cloud));
    }
    let mut note = |words: String| text.push_str(&format!("note: {words}\n"));
    let flat = sum(|part| part.flat_pieces);
    if flat > 0 {
        note(format!("{flat} pieces have no volume and were left out: give them a thickness in the modeling program"));
    }
    if report.lost_parts > 0 {
        note(format!("{} shapes are too small for the precision of the file and were left out", report.lost_parts));
    }
    if !report.skipped.is_empty() {
        note(format!("no part of a bridge: {}", report.skipped.join(", ")));
    }
    report.notes.iter().take(MAX_LISTED).for_each(|words| note(words.clone()));
    if report.notes.len() > MAX_LISTED {
        note(format!("{} more notes on parts", report.notes.len() - MAX_LISTED));
    }
    let lines = sum(|part| part.ignored_primitives);
    if lines > 0 {
        note(format!("{lines} sets of points or lines were ignored"));
    }
    for (number, corners) in &report.empty_boxes {
        note(format!("elements file, row {number}: no triangle has its middle in box_m = {corners} and in no earlier row"));
    }
    let (deck_low, deck_high) = report.extent.deck;
    if deck_high[1] - deck_low[1] > deck_high[0] - deck_low[0] {
        note("the deck is longer along y than along x: set --turn 90 if it runs along y".to_owned());
    }
    text
}

fn cloud_text(cloud: CloudReport) -> String {
    let CloudReport { left_out, points, outliers, voxels, filled } = cloud;
    let kept = points - outliers;
    let all = points + left_out;
    format!(
        "{kept} of {all} points in {voxels} voxels; left out: {outliers} outliers and {left_out} ground, water, noise or withheld points; \
         {filled} more voxels fill voids and contacts\n"
    )
}

fn parse_scale(text: &str) -> Result<f64, String> {
    let scale: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1e-6..=1e6).contains(&scale) { Ok(scale) } else { Err("allowed: 0.000001 to 1000000".to_owned()) }
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    let tolerance: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.001..=1.0).contains(&tolerance) { Ok(tolerance) } else { Err("allowed: 0.001 to 1".to_owned()) }
}

fn parse_voxel_size(text: &str) -> Result<f64, String> {
    let size: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    let (least, most) = VOXEL_RANGE_M;
    if (least..=most).contains(&size) { Ok(size) } else { Err(format!("allowed: {least} to {most}")) }
}

fn parse_turn(text: &str) -> Result<f64, String> {
    let turn_deg: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (-360.0..=360.0).contains(&turn_deg) { Ok(turn_deg) } else { Err("allowed: -360 to 360".to_owned()) }
}

fn parse_up(text: &str) -> Result<UpAxis, String> {
    match text {
        "y" => Ok(UpAxis::Y),
        "z" => Ok(UpAxis::Z),
        _ => Err("allowed: y, z".to_owned()),
    }
}

fn parse_origin(text: &str) -> Result<ModelOrigin, String> {
    if text == "center" {
        return Ok(ModelOrigin::Center);
    }
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|part| part.trim().parse().ok().filter(|n: &f64| n.is_finite())).collect();
    numbers
        .and_then(|numbers| <[f64; 3]>::try_from(numbers).ok())
        .map(ModelOrigin::Point)
        .ok_or_else(|| "allowed: center, or three numbers with commas".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_turn_is_at_most_a_circle() {
        assert_eq!((parse_turn("-90"), parse_turn("360")), (Ok(-90.0), Ok(360.0)));
        for bad in ["inf", "nan", "-inf", "1e308", "360.1", "", "north"] {
            assert!(parse_turn(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn exact_origin_is_the_center_or_three_numbers() {
        assert_eq!(parse_origin("center"), Ok(ModelOrigin::Center));
        assert_eq!(parse_origin("1, -2.5,3"), Ok(ModelOrigin::Point([1.0, -2.5, 3.0])));
        for bad in ["", "1,2", "1,2,3,4", "1,2,inf", "middle"] {
            assert!(parse_origin(bad).is_err(), "{bad}");
        }
    }
}
