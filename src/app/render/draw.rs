//! Pictures, by whatever device there is.

use super::super::errors::AppError;
use super::super::files;
use super::super::progress::Progress;
use super::super::session_folder::Stored;
use super::Args;
use crate::base::frames::{Enu, Vec3};
use crate::base::geodesy::LocalPlane;
use crate::base::time::SimTime;
use crate::monitor::assessment::scored_flight;
use crate::monitor::folder::EVENTS;
use crate::monitor::measures::attention;
use crate::scenario::Scenario;
use crate::site::Site;
use crate::telemetry::sample::{Header, truth_time};
use crate::telemetry::{Flight, Timeline, tlog};
use crate::vehicle::{Camera, Vehicle};
use crate::view::camera::Eye;
use crate::view::feed::Feed;
use crate::view::gpu::{Gpu, GpuError, Overlay, Renderer};
use crate::view::hud;
use crate::view::picture::Picture;
use crate::view::quality::{PRESETS, Quality};
use crate::view::scene::{DronePose, Scene};
use crate::view::shot::Shot;
use crate::view::stage::{self, Moment, Stage, aimed, parked};

/// Largest side of a picture, px.
const LARGEST_PX: u32 = 8192;

impl From<GpuError> for AppError {
    fn from(error: GpuError) -> Self {
        Self::failed(error.to_string())
    }
}

/// Draws what was asked for.
pub fn run(args: &Args) -> Result<(), AppError> {
    let quality = quality(&args.quality)?;
    let size = size(&args.size)?;
    let path = std::path::Path::new(&args.what);
    let picture = if path.is_dir() { of_session(args, quality, size)? } else { of_scenario(args, quality, size)? };
    files::write(&args.out, &png(&picture)?)
}

fn quality(name: &str) -> Result<Quality, AppError> {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    Quality::named(name).ok_or_else(|| AppError::wrong(format!("--quality {name}: give one of {}", names.join(", "))))
}

fn size(text: &str) -> Result<(u32, u32), AppError> {
    let wrong = || AppError::wrong(format!("--size {text}: give width x height in px, each 16 to {LARGEST_PX}, as 1280x720"));
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| text.parse::<u32>().ok().filter(|px| (16..=LARGEST_PX).contains(px)).ok_or_else(wrong);
    Ok((side(width)?, side(height)?))
}

fn point(name: &str, text: &str) -> Result<Vec3<Enu>, AppError> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [east, north, up] if numbers.iter().all(|x| x.is_finite() && x.abs() < 1e5) => Ok(Vec3::new(east, north, up)),
        _ => Err(AppError::wrong(format!("--{name} {text}: give east,north,up in m from the origin, as 10,-25,30"))),
    }
}

fn instant(seconds: f64) -> Result<SimTime, AppError> {
    if (0.0..=86_400.0).contains(&seconds) {
        Ok(SimTime::from_s(seconds))
    } else {
        Err(AppError::wrong(format!("--at {seconds}: give seconds of simulation time, 0 to 86400")))
    }
}

/// A scenario from anywhere.
fn of_scenario(args: &Args, quality: Quality, size: (u32, u32)) -> Result<Picture, AppError> {
    let mut scenario = files::scenario(&args.what)?.scenario;
    let vehicle = files::vehicle(&args.vehicle)?.vehicle;
    if let Some(utc) = &args.utc {
        let time: jiff::Timestamp =
            utc.parse().map_err(|error| AppError::wrong(format!("--utc {utc}: {error} (as 2026-06-20T08:00:00Z)")))?;
        scenario.light.start_unix_s = time.as_second();
    }
    if let Some(cloud) = args.cloud {
        if !(0.0..=1.0).contains(&cloud) {
            return Err(AppError::wrong(format!("--cloud {cloud}: give a share, 0 to 1")));
        }
        scenario.light.cloud_cover = cloud;
    }
    let (Some(from), Some(look)) = (&args.from, &args.look) else {
        return Err(AppError::wrong("of a scenario --from E,N,U and --look E,N,U say what to draw"));
    };
    let (from, look) = (point("from", from)?, point("look", look)?);
    let at = instant(args.at.unwrap_or(0.0))?;
    let lens = match args.fov {
        Some(deg) if (1.0..=150.0).contains(&deg) => Camera { hfov_rad: deg.to_radians(), ..vehicle.camera },
        Some(deg) => return Err(AppError::wrong(format!("--fov {deg}: give degrees, 1 to 150"))),
        None => vehicle.camera,
    };
    let drawing = Drawing::new(&scenario, &vehicle, args.seed.or(scenario.seed).unwrap_or_default(), quality, at)?;
    let stage = drawing.stage(&scenario, &vehicle);
    let pose = aimed(from, look, args.lamp);
    let standing = parked(&scenario, &vehicle);
    let shot = stage.through(Eye::of(&pose, &lens), Some(&pose), &lens, Some(&standing), (at, size));
    drawing.draw(&[(shot, Vec::new())])
}

/// A moment of a session.
fn of_session(args: &Args, quality: Quality, size: (u32, u32)) -> Result<Picture, AppError> {
    let stored = Stored::read(std::path::Path::new(&args.what))?;
    let (scenario, vehicle) = (&stored.scenario.scenario, &stored.vehicle.vehicle);
    let mut timeline = Timeline::new(LocalPlane::new(scenario.origin));
    timeline.push_log(&stored.log);
    let flight = scored_flight(&timeline, scenario, vehicle);
    let (Some(first), Some(last)) = (flight.truths.first(), flight.truths.last()) else {
        return Err(AppError::failed("the session holds no flight to draw"));
    };
    let middle = 0.5 * (first.time.s() + last.time.s());
    let at = instant(args.at.unwrap_or(middle))?;
    let Some(moment) = moment(&flight, at, vehicle) else {
        return Err(AppError::failed(format!(
            "the session holds nothing at {:.1} s: it goes from {:.1} to {:.1} s",
            at.s(),
            first.time.s(),
            last.time.s()
        )));
    };
    let seed = scenario.seed.or(flight.seeds.all().first().map(|said| said.2)).unwrap_or_default();
    let drawing = Drawing::new(scenario, vehicle, seed, quality, at)?;
    let stage = drawing.stage(scenario, vehicle);
    let mut views = Vec::new();
    if args.view != "camera" {
        let shot = stage.inspector(&moment, size);
        let mark = hud::marker(&shot.eye, aspect(size), moment.drone.position_m);
        views.push((shot, if args.no_hud { Vec::new() } else { mark }));
    }
    if args.view != "inspector" {
        let feed = heard(&stored, std::path::Path::new(&args.what), at);
        let display = hud::layout(&stage::hud(&stage, &moment, &flight, (&feed, true), true), aspect(size));
        views.push((stage.camera(&moment, size), if args.no_hud { Vec::new() } else { display }));
    }
    drawing.draw(&views)
}

fn aspect((width, height): (u32, u32)) -> f64 {
    f64::from(width) / f64::from(height)
}

/// What the display tells besides the flight: from the telemetry up to a time, and the monitor's own cues and words from its record.
fn heard(stored: &Stored, folder: &std::path::Path, at: SimTime) -> Feed {
    let mut feed = Feed::default();
    let mut now = SimTime::ZERO;
    for record in tlog::Reader::new(&stored.log) {
        now = truth_time(record.frame).unwrap_or(now);
        if now > at {
            break;
        }
        if Header::peek(record.frame).is_some_and(|header| Feed::listens(header.message_id)) {
            feed.hear(record.frame, now);
        }
    }
    // A session without its record of events is drawn without cues.
    for line in files::read(&folder.join(EVENTS)).unwrap_or_default().lines() {
        let Ok(event) = serde_json::from_str::<serde_json::Value>(line) else { continue };
        let Some(time) = event["t_s"].as_f64().map(SimTime::from_s).filter(|time| *time <= at) else { continue };
        if let Some(mask) = event["cues"].as_i64() {
            feed.cue(i32::try_from(mask).unwrap_or(0), time);
        }
        if let Some(words) = event["text"].as_str() {
            feed.words(words);
        }
    }
    feed
}

/// Where everything was; `None` where the telemetry says nothing.
fn moment(flight: &Flight, at: SimTime, vehicle: &Vehicle) -> Option<Moment> {
    let state = flight.between(at)?;
    Some(Moment {
        at,
        drone: DronePose {
            position_m: state.position_m,
            ned_from_frd: state.ned_from_frd,
            spinning: flight.armed.at(at).unwrap_or(false),
        },
        velocity_m_s: state.velocity_m_s,
        camera: attention::pose(flight, at, vehicle)?,
        lens: attention::camera(flight, at, &vehicle.camera),
    })
}

/// A site and what draws it.
struct Drawing {
    gpu: Gpu,
    site: Site,
    scene: Scene,
    quality: Quality,
}

impl Drawing {
    fn new(scenario: &Scenario, vehicle: &Vehicle, seed: u64, quality: Quality, at: SimTime) -> Result<Self, AppError> {
        let gpu = Gpu::open()?;
        tracing::info!("drawing with {}", gpu.name);
        let progress = Progress::start("building the site and its light");
        let site = Site::build(scenario, seed);
        let scene = Scene::build(scenario, &site, vehicle, &quality, at);
        progress.end();
        Ok(Self { gpu, site, scene, quality })
    }

    fn stage<'a>(&'a self, scenario: &'a Scenario, vehicle: &'a Vehicle) -> Stage<'a> {
        Stage { scenario, vehicle, site: &self.site, scene: &self.scene }
    }

    /// Shots side by side, each with what lies over it.
    fn draw(&self, views: &[(Shot, Vec<hud::Item>)]) -> Result<Picture, AppError> {
        let mut renderer = Renderer::new(&self.gpu, self.quality, &self.scene);
        let mut overlay = Overlay::new(&self.gpu);
        let mut pictures = Vec::new();
        for (shot, items) in views {
            pictures.push(renderer.picture_with(&self.gpu, shot, &mut overlay, items)?);
        }
        Ok(beside(&pictures))
    }
}

fn beside(pictures: &[Picture]) -> Picture {
    let height = pictures.iter().map(|p| p.height).min().unwrap_or(0);
    let width = pictures.iter().map(|p| p.width).sum();
    let row = |p: &Picture, y: u32| p.rgba[(4 * y * p.width) as usize..(4 * (y + 1) * p.width) as usize].to_vec();
    let rgba = (0..height).flat_map(|y| pictures.iter().flat_map(move |p| row(p, y))).collect();
    Picture { width, height, rgba }
}

fn png(picture: &Picture) -> Result<Vec<u8>, AppError> {
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
