//! Renders a session's photographs from its telemetry, with the metadata that the camera would have written.

use super::args::Args;
use super::masks;
use super::recorded::RecordedFlight;
use super::scene_drawing::SceneDrawing;
use crate::cli::picture_args::{parse_quality, parse_size};
use crate::errors::AppError;
use crate::io::clock;
use crate::io::progress::ProgressLog;
use crate::io::replace::replace;
use crate::io::report;
use crate::io::user_language::user_language;
use crate::records::reliability_beside;
use spandrel_model::geodesy::LocalPlane;
use spandrel_monitor::folder::{SMALL_SNAPSHOTS, SNAPSHOTS};
use spandrel_training::report::pictures::ReviewedPicture;
use spandrel_view::arrange::{largest_even_size_px, render_size_px};
use spandrel_view::photo::{self, PhotoInfo};
use spandrel_view::shot::Shot;
use spandrel_view::stage::SceneMoment;

/// Maximum number of pixels without a graphics card, unless a size is specified. Rendering an image then takes roughly
/// a second instead of a minute.
const MAX_SOFTWARE_PIXELS: f64 = 1280.0 * 960.0;

/// Renders all of a session's photographs to its folder, and rewrites its report.
pub fn run(args: &Args) -> Result<(), AppError> {
    let preset = parse_quality(&args.quality)?;
    let asked = args.size.as_deref().map(parse_size).transpose()?;
    let recorded = RecordedFlight::read(std::path::Path::new(&args.what))?;
    let taken = report::pictures(&recorded.folder)?;
    if taken.is_empty() {
        tracing::info!("the session has no photographs");
        return Ok(());
    }
    let drawing = SceneDrawing::new(recorded.scenario(), recorded.vehicle(), recorded.seed(), preset, taken[0].time)?;
    let drawing = drawing.with_changes(recorded.site_changes());
    let camera = &recorded.vehicle().camera;
    let most = drawing.gpu.software.then_some(MAX_SOFTWARE_PIXELS);
    let size_px = match asked {
        Some(within) => largest_even_size_px(within, camera.aspect()),
        None => render_size_px((f64::from(camera.width_px), f64::from(camera.height_px)), most),
    };
    if size_px != (camera.width_px, camera.height_px) {
        tracing::info!(
            "rendering at {} x {} px instead of the camera's {} x {}",
            size_px.0,
            size_px.1,
            camera.width_px,
            camera.height_px
        );
    }
    let folder = recorded.folder.join(SNAPSHOTS);
    let copies = folder.join(SMALL_SNAPSHOTS);
    std::fs::create_dir_all(&copies).map_err(|error| AppError::failed(format!("{}: {error}", copies.display())))?;
    let mut scene_renderer = drawing.scene_renderer();
    let mut progress = ProgressLog::start("rendering photographs");
    for (k, picture) in taken.iter().enumerate() {
        progress.report(|| format!("picture {} of {}", k + 1, taken.len()));
        let moment = recorded.moment(picture.time)?;
        let shot = drawing.stage(recorded.scenario(), recorded.vehicle()).camera(&moment, size_px);
        let drawn = scene_renderer.draw(&shot, &[])?;
        let name = format!("{:04}.jpg", picture.index.max(0));
        let path = folder.join(&name);
        replace(&path, &photo::jpeg(&drawn, &photo_info(&recorded, picture, &moment, &shot))?)?;
        replace(&copies.join(&name), &photo::copy(&drawn, report::max_picture_bytes(taken.len()))?)?;
        if args.masks {
            masks::write(&mut scene_renderer, &shot, drawing.defects(), &path)?;
        }
    }
    progress.finish();
    report::write(&recorded.folder, user_language(), &|job| reliability_beside(&recorded.folder, job))?;
    println!("pictures      {} in {}", taken.len(), folder.display());
    Ok(())
}

/// Returns a photograph's metadata, with interpolated aircraft attitude and gimbal angles.
fn photo_info(recorded: &RecordedFlight, picture: &ReviewedPicture, moment: &SceneMoment, shot: &Shot) -> PhotoInfo {
    let (scenario, vehicle) = (recorded.scenario(), recorded.vehicle());
    let taken_unix_us = recorded.unix_us(picture.time);
    let (utc, _) = clock::utc(taken_unix_us);
    let (date, time) = utc.trim_end_matches('Z').split_once('T').unwrap_or(("", ""));
    let pose = &moment.camera;
    let (yaw_deg, pitch_deg) = photo::direction_deg(pose);
    let (roll, pitch, yaw) = moment.drone.pose.ned_from_frd.euler();
    PhotoInfo {
        number: picture.number,
        taken_unix_us,
        taken_utc: (date.replace('-', ":"), time.to_owned()),
        at_s: picture.time.s(),
        place: LocalPlane::new(scenario.origin).geo_from_enu(pose.position_m),
        height_over_pad_m: (pose.position_m - scenario.ground_team.pad_m).up(),
        yaw_deg,
        pitch_deg,
        aircraft_attitude_deg: [yaw, pitch, roll].map(f64::to_degrees),
        lens: moment.lens,
        exposure_s: shot.finish.exposure.time_s,
        iso: shot.finish.exposure.iso,
        lamp: pose.lamp_on,
        distance_m: picture.target.as_ref().map(|target| target.distance_m),
        model: format!("{} inspection camera", vehicle.name),
        job: scenario.name.clone(),
    }
}
