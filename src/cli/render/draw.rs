//! Renders images on a graphics card or in software.

use super::args::Args;
use super::recorded::RecordedFlight;
use super::scene_drawing::{SceneDrawing, aspect, sim_time_arg};
use super::{dataset, masks, snapshots, video};
use crate::cli::picture_args::{parse_quality, parse_size};
use crate::errors::AppError;
use crate::io::files;
use crate::io::png::png;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::Site;
use spandrel_model::vehicle::Camera;
use spandrel_view::arrange::largest_even_size_px;
use spandrel_view::camera::PinholeCamera;
use spandrel_view::hud::{self, DisplayStyle};
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;
use spandrel_view::shot::Shot;
use spandrel_view::stage::{self, camera_aimed_at, drone_on_pad};

/// Renders the requested image, photographs or video.
pub fn run(args: &Args) -> Result<(), AppError> {
    masks::check(args)?;
    if let Some(count) = args.dataset {
        return dataset::run(args, count);
    }
    if std::path::Path::new(&args.what).is_dir() {
        reject_scenario_options(args)?;
    }
    if args.snapshots {
        return snapshots::run(args);
    }
    if let Some(file) = &args.video {
        return video::run(args, file.as_deref());
    }
    let quality = parse_quality(&args.quality)?;
    let size = parse_size(args.size.as_deref().unwrap_or("1280x720"))?;
    let path = std::path::Path::new(&args.what);
    let picture = if path.is_dir() { render_session(args, quality, size)? } else { render_scenario(args, quality, size)? };
    files::write(&args.out, &png(&picture)?)
}

/// Rejects options that do not apply to a session, because the session sets their values.
fn reject_scenario_options(args: &Args) -> Result<(), AppError> {
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
            Err(AppError::invalid(format!("{name}: '{}' is a session, but {name} applies only to scenarios", args.what)))
        }
    }
}

fn point(name: &str, text: &str) -> Result<Vec3<Enu>, AppError> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [east, north, up] if numbers.iter().all(|x| x.is_finite() && x.abs() < 1e5) => Ok(Vec3::new(east, north, up)),
        _ => Err(AppError::invalid(format!(
            "--{name} {text}: not a point (allowed: east,north,up in m from the origin, for example 10,-25,30)"
        ))),
    }
}

/// Rejects a viewpoint in the ground or in a bridge, from which a picture would show the inside of a solid.
fn check_viewpoint(site: &Site, from: Vec3<Enu>) -> Result<(), AppError> {
    let [east, north, up] = from.array();
    let ground_m = site.ground_up_m(east, north);
    let given = format!("--from {east},{north},{up}");
    if up <= ground_m {
        return Err(AppError::invalid(format!(
            "{given}: in the ground (allowed: above {ground_m:.1} m up, the height of the ground there)"
        )));
    }
    match site.member_around(from) {
        Some(member) => Err(AppError::invalid(format!(
            "{given}: in a bridge, in {} (allowed: outside of all bridges and above {ground_m:.1} m up, the height of the ground there)",
            member.name
        ))),
        None => Ok(()),
    }
}

/// Renders a scenario from any viewpoint.
fn render_scenario(args: &Args, quality: Quality, size: (u32, u32)) -> Result<Picture, AppError> {
    let mut scenario = files::scenario(&args.what)?.scenario;
    let vehicle = files::vehicle(&args.vehicle)?.vehicle;
    if let Some(utc) = &args.utc {
        let time: jiff::Timestamp =
            utc.parse().map_err(|error| AppError::invalid(format!("--utc {utc}: {error} (example: 2026-06-20T08:00:00Z)")))?;
        scenario.light.start_unix_s = time.as_second();
    }
    if let Some(cloud) = args.cloud {
        if !(0.0..=1.0).contains(&cloud) {
            return Err(AppError::invalid(format!("--cloud {cloud}: out of range (allowed: 0 to 1)")));
        }
        scenario.light.cloud_cover = cloud;
    }
    let (Some(from), Some(look)) = (&args.from, &args.look) else {
        return Err(AppError::invalid("a scenario needs a viewpoint: --from E,N,U and --look E,N,U"));
    };
    let (from, look) = (point("from", from)?, point("look", look)?);
    let at = sim_time_arg("at", args.at.unwrap_or(0.0))?;
    let lens = match args.fov {
        Some(deg) if (1.0..=150.0).contains(&deg) => Camera { hfov_rad: deg.to_radians(), ..vehicle.camera },
        Some(deg) => return Err(AppError::invalid(format!("--fov {deg}: out of range (allowed: 1 to 150 deg)"))),
        None => vehicle.camera,
    };
    let drawing = SceneDrawing::new(&scenario, &vehicle, args.seed.or(scenario.seed).unwrap_or_default(), quality, at)?;
    check_viewpoint(drawing.site(), from)?;
    let stage = drawing.stage(&scenario, &vehicle);
    let pose = camera_aimed_at(from, look, args.lamp);
    let standing = drone_on_pad(&scenario, &vehicle);
    let shot = stage.camera_view_from(PinholeCamera::of(&pose, &lens), Some(&pose), &lens, Some(&standing), (at, size));
    draw(&drawing, args, &[(shot, Vec::new())])
}

/// Renders a session at one moment.
fn render_session(args: &Args, quality: Quality, size: (u32, u32)) -> Result<Picture, AppError> {
    let recorded = RecordedFlight::read(std::path::Path::new(&args.what))?;
    let (scenario, vehicle) = (recorded.scenario(), recorded.vehicle());
    let (first, last) = recorded.span();
    let at = sim_time_arg("at", args.at.unwrap_or(0.5 * (first.s() + last.s())))?;
    let moment = recorded.moment(at)?;
    let drawing = SceneDrawing::new(scenario, vehicle, recorded.seed(), quality, at)?.with_changes(recorded.site_changes());
    let stage = drawing.stage(scenario, vehicle);
    let mut views = Vec::new();
    if args.view != "camera" {
        let shot = stage.inspector(&moment, size);
        let mark = stage.drone_marker(&shot, &moment, DisplayStyle::default());
        views.push((shot, if args.no_hud { Vec::new() } else { mark }));
    }
    if args.view != "inspector" {
        let mut replay_feed = recorded.replay_feed();
        let display = stage::hud(&stage, &moment, &recorded.flight, (replay_feed.advance_to(at), true), true);
        let size = largest_even_size_px(size, vehicle.camera.aspect());
        views.push((stage.camera(&moment, size), if args.no_hud { Vec::new() } else { hud::layout(&display, aspect(size)) }));
    }
    draw(&drawing, args, &views)
}

/// Renders shots side by side, each with its overlay. If label masks are requested and there is a single shot, writes
/// them as well.
fn draw(drawing: &SceneDrawing, args: &Args, views: &[(Shot, Vec<hud::DrawItem>)]) -> Result<Picture, AppError> {
    let mut scene_renderer = drawing.scene_renderer();
    if let (true, [(shot, _)]) = (args.masks, views) {
        masks::write(&mut scene_renderer, shot, drawing.defects(), std::path::Path::new(&args.out))?;
    }
    let pictures = views.iter().map(|(shot, items)| scene_renderer.draw(shot, items)).collect::<Result<Vec<_>, _>>()?;
    Ok(side_by_side(&pictures))
}

/// Places images side by side; shorter images are centered vertically on black.
fn side_by_side(pictures: &[Picture]) -> Picture {
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

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    #[test]
    fn exact_viewpoints_in_the_ground_and_in_bridges_are_rejected() {
        let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|_| Err("none".into())).unwrap();
        let site = Site::without_defects(&job);
        let error =
            |east: f64, north: f64, up: f64| check_viewpoint(&site, Vec3::new(east, north, up)).map_err(|e| e.to_string());
        let ground_m = site.ground_up_m(-150.0, -60.0);
        assert_eq!(
            error(-150.0, -60.0, 12.0),
            Err(format!("--from -150,-60,12: in the ground (allowed: above {ground_m:.1} m up, the height of the ground there)"))
        );
        // The slab of the arch bridge is 0.23 m thick; its upper side is 34 m up.
        let words = error(0.0, 0.0, 33.9).unwrap_err();
        assert!(words.starts_with("--from 0,0,33.9: in a bridge, in arch/") && words.contains("height of the ground"), "{words}");
        assert_eq!((error(-150.0, -60.0, 40.0), error(0.0, 0.0, 36.0)), (Ok(()), Ok(())));
    }
}
