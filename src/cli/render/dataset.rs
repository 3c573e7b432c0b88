//! Renders a data set of labeled pictures for training defect detectors.

use super::args::Args;
use super::dataset_folder::DatasetFolder;
use super::scene_drawing::{SceneDrawing, aspect};
use crate::cli::picture_args::{parse_quality, parse_size};
use crate::errors::AppError;
use crate::io::files;
use crate::io::progress::ProgressLog;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::arrange::largest_even_size_px;
use spandrel_view::camera::PinholeCamera;
use spandrel_view::dataset::DatasetOrigin;
use spandrel_view::dataset::DatasetPicture;
use spandrel_view::dataset::scenes::{self, DatasetScene};
use spandrel_view::dataset::viewpoints::Viewpoints;
use spandrel_view::gpu::Gpu;
use spandrel_view::stage::drone_on_pad;
use std::path::Path;

/// Size within which the pictures fit unless a size is specified, px. It doesn't depend on the graphics card, so that the same options
/// yield the same pictures' sizes everywhere.
const DEFAULT_SIZE: &str = "1280x960";

/// Renders the data set.
pub fn run(args: &Args, count: u32) -> Result<(), AppError> {
    if Path::new(&args.what).is_dir() {
        return Err(AppError::invalid(format!(
            "--dataset: '{}' is a session, but --dataset applies only to scenarios",
            args.what
        )));
    }
    if args.out == "-" {
        return Err(AppError::invalid("--dataset writes many files: specify a folder with --out"));
    }
    let quality = parse_quality(&args.quality)?;
    let within_px = parse_size(args.size.as_deref().unwrap_or(DEFAULT_SIZE))?;
    let base = files::scenario(&args.what)?.scenario;
    let vehicle = files::vehicle(&args.vehicle)?.vehicle;
    let seed = args.seed.or(base.seed).unwrap_or_default();
    if base.defects.placed.is_some() {
        tracing::warn!("the scenario lists its defects, so that all scenes show the same ones, in both splits");
    }
    let mut gpu = Gpu::open()?;
    tracing::info!("rendering with {}", gpu.name);
    let renderer = gpu.name.clone();
    let size_px = largest_even_size_px(within_px, vehicle.camera.aspect());
    let mut folder = DatasetFolder::new(Path::new(&args.out), LocalPlane::new(base.origin))?;
    let mut work = DatasetWork {
        folder: &mut folder,
        vehicle: &vehicle,
        size_px,
        with_masks: args.masks,
        done: 0,
        count,
        progress: ProgressLog::start("rendering data set"),
    };
    for scene in scenes::plan(&base, seed, count) {
        let scenario = scene.scenario(&base);
        let drawing = SceneDrawing::on(gpu, &scenario, &vehicle, scene.seed, (quality, SimTime::ZERO));
        work.draw_scene(&scene, &scenario, &drawing)?;
        gpu = drawing.into_gpu();
    }
    work.progress.finish();
    let origin = DatasetOrigin {
        version: env!("CARGO_PKG_VERSION"),
        scenario: &base.name,
        seed,
        quality: quality.name,
        renderer: &renderer,
    };
    let labels = folder.finish(&origin, &command(args, count, seed, size_px))?;
    println!("data set      {count} pictures, {labels} labeled defects in {}", args.out);
    Ok(())
}

/// Returns the command that renders the data set again.
fn command(args: &Args, count: u32, seed: u64, (width, height): (u32, u32)) -> String {
    let masks = if args.masks { " --masks" } else { "" };
    format!(
        "spandrel render {} --dataset {count} --seed {seed} --size {width}x{height} --quality {} --vehicle {}{masks} --out FOLDER",
        args.what, args.quality, args.vehicle
    )
}

/// A data set in progress.
struct DatasetWork<'a> {
    folder: &'a mut DatasetFolder,
    vehicle: &'a Vehicle,
    size_px: (u32, u32),
    with_masks: bool,
    done: u32,
    count: u32,
    progress: ProgressLog,
}

impl DatasetWork<'_> {
    /// Renders the pictures of a scene.
    fn draw_scene(&mut self, scene: &DatasetScene, scenario: &Scenario, drawing: &SceneDrawing) -> Result<(), AppError> {
        let lens = &self.vehicle.camera;
        let mut viewpoints = Viewpoints::new(scenario, self.vehicle, drawing.site(), aspect(self.size_px), scene.seed);
        let mut scene_renderer = drawing.scene_renderer();
        let stage = drawing.stage(scenario, self.vehicle);
        let standing = drone_on_pad(scenario, self.vehicle);
        for _ in 0..scene.pictures {
            self.done += 1;
            let (done, count) = (self.done, self.count);
            self.progress.report(|| format!("picture {done} of {count}"));
            let viewpoint = viewpoints.draw().map_err(|error| AppError::invalid(error.to_string()))?;
            let eye = PinholeCamera::of(&viewpoint.pose, lens);
            let at = (viewpoint.at, self.size_px);
            let shot = stage.camera_view_from(eye, Some(&viewpoint.pose), lens, Some(&standing), at);
            let drawn = scene_renderer.draw(&shot, &[])?;
            let labels = scene_renderer.labels(&shot)?;
            let exposure = shot.finish.exposure;
            let about = DatasetPicture { number: self.done, size_px: self.size_px, scene, viewpoint: &viewpoint, lens, exposure };
            self.folder.add(&about, &drawn, (&labels, drawing.defects(), self.with_masks))?;
        }
        Ok(())
    }
}
