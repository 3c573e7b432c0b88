//! Renders images on a graphics card or in software.

use super::super::errors::AppError;
use super::super::files;
use super::super::progress::ProgressLog;
use super::Args;
use super::recorded::RecordedFlight;
use super::{masks, snapshots, video};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{PlacedDefect, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};
use spandrel_view::arrange::fitted_px;
use spandrel_view::camera::PinholeCamera;
use spandrel_view::gpu::{Gpu, GpuError, Overlay, Renderer};
use spandrel_view::hud;
use spandrel_view::masks::LabelMask;
use spandrel_view::picture::Picture;
use spandrel_view::quality::{PRESETS, Quality};
use spandrel_view::scene::Scene;
use spandrel_view::shot::Shot;
use spandrel_view::stage::{self, Stage, camera_aimed_at, drone_on_pad};

/// Maximum width or height of an image, px.
const LARGEST_PX: u32 = 8192;

impl From<GpuError> for AppError {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::TooLarge(..) => Self::wrong(format!("{error}: choose a smaller --size")),
            GpuError::NoDevice(_) | GpuError::Failed(_) => Self::failed(error.to_string()),
        }
    }
}

/// Renders the requested image, photographs or video.
pub fn run(args: &Args) -> Result<(), AppError> {
    masks::check(args)?;
    if std::path::Path::new(&args.what).is_dir() {
        only_of_scenarios(args)?;
    }
    if args.snapshots {
        return snapshots::run(args);
    }
    if let Some(path) = &args.video {
        return video::run(args, path);
    }
    let quality = quality(&args.quality)?;
    let size = size(args.size.as_deref().unwrap_or("1280x720"))?;
    let path = std::path::Path::new(&args.what);
    let picture = if path.is_dir() { of_session(args, quality, size)? } else { of_scenario(args, quality, size)? };
    files::write(&args.out, &png(&picture)?)
}

/// Rejects options that a session determines itself.
fn only_of_scenarios(args: &Args) -> Result<(), AppError> {
    let given = [
        ("--from", args.from.is_some()),
        ("--fov", args.fov.is_some()),
        ("--lamp", args.lamp),
        ("--utc", args.utc.is_some()),
        ("--cloud", args.cloud.is_some()),
        ("--seed", args.seed.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((name, _)) => {
            Err(AppError::wrong(format!("{name}: '{}' is a session, which is rendered as flown; {name} is for scenarios only", args.what)))
        }
    }
}

/// Returns the quality preset with this name.
pub fn quality(name: &str) -> Result<Quality, AppError> {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    Quality::named(name).ok_or_else(|| AppError::wrong(format!("--quality {name}: unknown preset (allowed: {})", names.join(", "))))
}

/// Parses width and height, px.
pub fn size(text: &str) -> Result<(u32, u32), AppError> {
    let wrong = || AppError::wrong(format!("--size {text}: not a size (allowed: WIDTHxHEIGHT in px, each 16 to {LARGEST_PX}, for example 1280x720)"));
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| text.parse::<u32>().ok().filter(|px| (16..=LARGEST_PX).contains(px)).ok_or_else(wrong);
    Ok((side(width)?, side(height)?))
}

fn point(name: &str, text: &str) -> Result<Vec3<Enu>, AppError> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [east, north, up] if numbers.iter().all(|x| x.is_finite() && x.abs() < 1e5) => Ok(Vec3::new(east, north, up)),
        _ => Err(AppError::wrong(format!("--{name} {text}: not a point (allowed: east,north,up in m from the origin, for example 10,-25,30)"))),
    }
}

/// Converts an option's value in seconds to a simulation time.
pub fn instant(name: &str, seconds: f64) -> Result<SimTime, AppError> {
    if (0.0..=86_400.0).contains(&seconds) {
        Ok(SimTime::from_s(seconds))
    } else {
        Err(AppError::wrong(format!("--{name} {seconds}: out of range (allowed: 0 to 86400 s of simulation time)")))
    }
}

/// Renders a scenario from any viewpoint.
fn of_scenario(args: &Args, quality: Quality, size: (u32, u32)) -> Result<Picture, AppError> {
    let mut scenario = files::scenario(&args.what)?.scenario;
    let vehicle = files::vehicle(&args.vehicle)?.vehicle;
    if let Some(utc) = &args.utc {
        let time: jiff::Timestamp =
            utc.parse().map_err(|error| AppError::wrong(format!("--utc {utc}: {error} (example: 2026-06-20T08:00:00Z)")))?;
        scenario.light.start_unix_s = time.as_second();
    }
    if let Some(cloud) = args.cloud {
        if !(0.0..=1.0).contains(&cloud) {
            return Err(AppError::wrong(format!("--cloud {cloud}: out of range (allowed: 0 to 1)")));
        }
        scenario.light.cloud_cover = cloud;
    }
    let (Some(from), Some(look)) = (&args.from, &args.look) else {
        return Err(AppError::wrong("a scenario needs a viewpoint: --from E,N,U and --look E,N,U"));
    };
    let (from, look) = (point("from", from)?, point("look", look)?);
    let at = instant("at", args.at.unwrap_or(0.0))?;
    let lens = match args.fov {
        Some(deg) if (1.0..=150.0).contains(&deg) => Camera { hfov_rad: deg.to_radians(), ..vehicle.camera },
        Some(deg) => return Err(AppError::wrong(format!("--fov {deg}: out of range (allowed: 1 to 150 deg)"))),
        None => vehicle.camera,
    };
    let drawing = SceneDrawing::new(&scenario, &vehicle, args.seed.or(scenario.seed).unwrap_or_default(), quality, at)?;
    let stage = drawing.stage(&scenario, &vehicle);
    let pose = camera_aimed_at(from, look, args.lamp);
    let standing = drone_on_pad(&scenario, &vehicle);
    let shot = stage.through(PinholeCamera::of(&pose, &lens), Some(&pose), &lens, Some(&standing), (at, size));
    drawing.draw(args, &[(shot, Vec::new())])
}

/// Renders a moment of a session.
fn of_session(args: &Args, quality: Quality, size: (u32, u32)) -> Result<Picture, AppError> {
    let recorded = RecordedFlight::read(std::path::Path::new(&args.what))?;
    let (scenario, vehicle) = (recorded.scenario(), recorded.vehicle());
    let (first, last) = recorded.span();
    let at = instant("at", args.at.unwrap_or(0.5 * (first.s() + last.s())))?;
    let moment = recorded.moment(at)?;
    let drawing = SceneDrawing::new(scenario, vehicle, recorded.seed(), quality, at)?.with_gates(recorded.gates());
    let stage = drawing.stage(scenario, vehicle);
    let mut views = Vec::new();
    if args.view != "camera" {
        let shot = stage.inspector(&moment, size);
        let mark = stage.drone_marker(&shot, &moment);
        views.push((shot, if args.no_hud { Vec::new() } else { mark }));
    }
    if args.view != "inspector" {
        let mut heard = recorded.heard();
        let display = stage::hud(&stage, &moment, &recorded.flight, (heard.advance_to(at), true), true);
        let size = fitted_px(size, vehicle.camera.aspect());
        views.push((stage.camera(&moment, size), if args.no_hud { Vec::new() } else { hud::layout(&display, aspect(size)) }));
    }
    drawing.draw(args, &views)
}

/// Returns width divided by height.
pub fn aspect((width, height): (u32, u32)) -> f64 {
    f64::from(width) / f64::from(height)
}

/// A site with its scene and the device to render it.
pub struct SceneDrawing {
    /// Graphics device or software renderer.
    pub gpu: Gpu,
    site: Site,
    scene: Scene,
    quality: Quality,
}

impl SceneDrawing {
    /// Opens a device and builds the site, which takes seconds.
    pub fn new(scenario: &Scenario, vehicle: &Vehicle, seed: u64, quality: Quality, at: SimTime) -> Result<Self, AppError> {
        let gpu = Gpu::open()?;
        tracing::info!("rendering with {}", gpu.name);
        let progress = ProgressLog::start("loading scene");
        let site = Site::build(scenario, seed);
        let scene = Scene::build(scenario, &site, vehicle, &quality, at);
        progress.end();
        Ok(Self { gpu, site, scene, quality })
    }

    /// Sets the bridge closures of a recorded flight.
    pub fn with_gates(self, gates: BridgeClosures) -> Self {
        Self { site: self.site.with_closures(gates), ..self }
    }

    /// Returns the parts of the scene that do not change during a session.
    pub fn stage<'a>(&'a self, scenario: &'a Scenario, vehicle: &'a Vehicle) -> Stage<'a> {
        Stage { scenario, vehicle, site: &self.site, scene: &self.scene }
    }

    /// Creates a renderer for a sequence of images.
    pub fn brush(&self) -> SceneRenderer<'_> {
        SceneRenderer {
            gpu: &self.gpu,
            renderer: Renderer::new(&self.gpu, self.quality, &self.scene),
            overlay: Overlay::new(&self.gpu),
        }
    }

    /// Returns the defects of the site.
    pub fn defects(&self) -> &[PlacedDefect] {
        self.site.defects()
    }

    /// Renders shots side by side, each with its overlay. Also writes the label masks if there is a single shot and they are requested.
    fn draw(&self, args: &Args, views: &[(Shot, Vec<hud::DrawItem>)]) -> Result<Picture, AppError> {
        let mut brush = self.brush();
        if let (true, [(shot, _)]) = (args.masks, views) {
            masks::write(&mut brush, shot, self.defects(), std::path::Path::new(&args.out))?;
        }
        let pictures = views.iter().map(|(shot, items)| brush.draw(shot, items)).collect::<Result<Vec<_>, _>>()?;
        Ok(beside(&pictures))
    }
}

/// Renders shots of a scene on its device.
pub struct SceneRenderer<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    overlay: Overlay,
}

impl SceneRenderer<'_> {
    /// Renders a shot with its overlay.
    pub fn draw(&mut self, shot: &Shot, items: &[hud::DrawItem]) -> Result<Picture, AppError> {
        Ok(self.renderer.picture_with(self.gpu, shot, &mut self.overlay, items)?)
    }

    /// Returns the elements and defects that each pixel of a shot shows.
    pub fn labels(&mut self, shot: &Shot) -> Result<LabelMask, AppError> {
        Ok(self.renderer.labels(self.gpu, shot)?)
    }
}

/// Places images side by side; lower ones are centered vertically on black.
fn beside(pictures: &[Picture]) -> Picture {
    const BLACK: [u8; 4] = [0, 0, 0, 255];
    let height = pictures.iter().map(|p| p.height).max().unwrap_or(0);
    let width = pictures.iter().map(|p| p.width).sum();
    let row = |p: &Picture, y: u32| match y.checked_sub((height - p.height) / 2).filter(|y| *y < p.height) {
        Some(y) => p.rgba[(4 * y * p.width) as usize..(4 * (y + 1) * p.width) as usize].to_vec(),
        None => BLACK.repeat(p.width as usize),
    };
    let rgba = (0..height).flat_map(|y| pictures.iter().flat_map(move |p| row(p, y))).collect();
    Picture { width, height, rgba }
}

/// Encodes an image as PNG.
pub fn png(picture: &Picture) -> Result<Vec<u8>, AppError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let rgb: Vec<u8> = picture.rgba.chunks(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let mut writer = encoder.write_header().map_err(|error| AppError::failed(error.to_string()))?;
    writer.write_image_data(&rgb).map_err(|error| AppError::failed(error.to_string()))?;
    writer.finish().map_err(|error| AppError::failed(error.to_string()))?;
    Ok(bytes)
}
