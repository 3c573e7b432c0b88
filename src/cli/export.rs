//! `spandrel export`: writes frames, scenario, flight plan, geometry and recordings for other programs.

use super::args;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::files;
use crate::io::mcap::{self, McapRecording};
use crate::io::progress::ProgressLog;
use crate::io::report;
use crate::io::scoring;
use crate::io::session_folder::StoredSession;
use crate::records::{read_session, reliability_beside};
use spandrel_clients::pilot::flight_plan;
use spandrel_clients::pilot::goals::PlanningContext;
use spandrel_mavlink::telemetry::Timeline;
use spandrel_model::foxglove;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_monitor::assessment::scored_flight;
use spandrel_monitor::export::{ScenarioExport, frames_csv, json_text};
use spandrel_monitor::recording;
use spandrel_training::xapi;
use std::collections::BTreeMap;
use std::io::{Cursor, Write};
use std::path::Path;

/// Export frames, scenario, flight plan, geometry or a recording for other programs
///
/// To export frames (CSV, one line per scored frame), specify a session. To export the scored part of the scenario
/// (JSON: paths, defects, limits) or the collision geometry (binary glTF, each member named with its element number),
/// specify a session or a scenario. To export a recording (MCAP, for Foxglove), specify a session, or a truncated
/// recording to recover up to its last complete chunk.
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).multiple(true).args(["frames", "scenario", "glb", "plan", "mcap", "parquet", "xapi", "scorm"])))]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel export sessions/20260801T... --frames frames.csv
  spandrel export two-bridges --seed 7 --scenario -          reference paths, and the defects for seed 7
  spandrel export two-bridges --plan tasks.plan              a plan to open, upload and fly in QGroundControl
  spandrel export two-bridges --glb bridges.glb              for 3D viewers
  spandrel export sessions/20260801T... --mcap flight.mcap   for Foxglove
  spandrel export sessions/20260801T... --parquet frames.parquet --xapi statements.jsonl --scorm result.zip
  spandrel export broken.mcap --mcap whole.mcap              recover a truncated recording

{EXIT_CODES}"))]
pub struct Args {
    /// Session folder, scenario file, or the name of a shipped scenario; with --mcap also a recording
    #[arg(value_name = "SESSION|SCENARIO|MCAP")]
    from: String,
    /// Write frames as CSV; '-' for standard output
    #[arg(long, value_name = "FILE")]
    frames: Option<String>,
    /// Write the scored part of the scenario as JSON; '-' for standard output
    #[arg(long, value_name = "FILE")]
    scenario: Option<String>,
    /// Write the tasks' reference paths as a QGroundControl plan with takeoff, transits clear of the bridges, each
    /// task's gimbal, lamp and camera commands, and the return flight; '-' for standard output
    #[arg(long, value_name = "FILE")]
    plan: Option<String>,
    /// Aircraft that determines the plan's clearance: a file, or the name of a shipped aircraft; ignored for a session
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2", requires = "plan")]
    vehicle: String,
    /// Autopilot for the plan's firmwareType field, which ground stations compare with the vehicle's autopilot
    #[arg(long, alias = "flavour", value_name = "NAME", default_value = "px4", requires = "plan")]
    flavor: args::Flavor,
    /// Write the geometry as binary glTF 2.0, in m, y up; '-' for standard output
    #[arg(long, value_name = "FILE")]
    glb: Option<String>,
    /// Write the flight as MCAP with the drone, camera, site, battery, clearance and contacts; '-' for standard output
    #[arg(long, value_name = "FILE")]
    mcap: Option<String>,
    /// Write frames as Parquet, with the same columns as --frames; units, reference frames and definitions are in the
    /// metadata; '-' for standard output
    #[arg(long, value_name = "FILE")]
    parquet: Option<String>,
    /// Write the session as xAPI statements, one JSON object per line; '-' for standard output
    #[arg(long, value_name = "FILE")]
    xapi: Option<String>,
    /// Write the result as a SCORM 1.2 package for a learning management system; '-' for standard output
    #[arg(long, value_name = "FILE")]
    scorm: Option<String>,
    #[command(flatten)]
    page: args::LanguageArgs,
    /// Seed for placing the defects if the scenario has no seed of its own
    #[arg(long, value_name = "N", value_parser = args::parse_seed)]
    seed: Option<u64>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid, there is no data to export, or the output cannot be written.
pub fn run(args: &Args) -> Result<(), AppError> {
    let path = Path::new(&args.from);
    if let Some(target) = &args.mcap
        && path.extension().is_some_and(|ending| ending == "mcap")
    {
        return recover(path, target);
    }
    let stored = if path.is_dir() { Some(StoredSession::read(path)?) } else { None };
    if let Some(target) = &args.frames {
        let Some(stored) = &stored else {
            return Err(AppError::invalid(format!("--frames needs a session folder, but '{}' is not one", args.from)));
        };
        files::write(target, frames_csv(&scoring::frame_rows(stored)?).as_bytes())?;
    }
    if let Some(target) = &args.mcap {
        let Some(stored) = &stored else {
            return Err(AppError::invalid(format!(
                "--mcap needs a session folder or a recording (.mcap), but '{}' is neither",
                args.from
            )));
        };
        files::write(target, &recording(stored)?)?;
    }
    export_for_learning_systems(args, stored.as_ref())?;
    if args.scenario.is_none() && args.glb.is_none() && args.plan.is_none() {
        return Ok(());
    }
    let (scenario, own) = match stored {
        Some(stored) => (stored.scenario.scenario, Some(stored.vehicle.vehicle)),
        None => (files::scenario(&args.from)?.scenario, None),
    };
    let seed = args.seed.or(scenario.seed);
    if args.scenario.is_some()
        && seed.is_none()
        && scenario.defects.count > 0
        && scenario.defects.placed.is_none()
        && scenario.defects.seed.is_none()
    {
        return Err(AppError::invalid(format!(
            "'{}' has different defects in every session: choose a seed with --seed N",
            args.from
        )));
    }
    let progress = ProgressLog::start("building the site");
    // Without a seed, only the geometry is exported; it is the same for every seed.
    let site = Site::build(&scenario, seed.unwrap_or_default());
    progress.finish();
    if let Some(target) = &args.scenario {
        files::write(target, json_text(&ScenarioExport::new(&scenario, site.defects())).as_bytes())?;
    }
    if let Some(target) = &args.plan {
        let vehicle = match own {
            Some(vehicle) => vehicle,
            None => files::vehicle(&args.vehicle)?.vehicle,
        };
        let map =
            PlanningContext { scenario: &scenario, site: &site, vehicle: &vehicle, at: SimTime::ZERO, transit_clearance_m: None };
        files::write(target, json_text(&flight_plan::plan(&map, args.flavor.display_name().autopilot)).as_bytes())?;
    }
    if let Some(target) = &args.glb {
        files::write(target, &files::site_model(&site)?)?;
    }
    Ok(())
}

/// Exports a session as Parquet, xAPI or SCORM.
fn export_for_learning_systems(args: &Args, stored: Option<&StoredSession>) -> Result<(), AppError> {
    let needed = |flag: &str| {
        stored.ok_or_else(|| AppError::invalid(format!("{flag} needs a session folder, but '{}' is not one", args.from)))
    };
    if let Some(target) = &args.parquet {
        let stored = needed("--parquet")?;
        files::write(target, &crate::io::parquet::frames_to_parquet(&scoring::frame_rows(stored)?)?)?;
    }
    if let Some(target) = &args.xapi {
        needed("--xapi")?;
        let record = read_session(Path::new(&args.from), &BTreeMap::new())?;
        let record = record.ok_or_else(|| AppError::failed("the session has no record"))?;
        files::write(target, xapi::lines(&xapi::statements(&record, xapi::DEFAULT_ACCOUNT_HOME_PAGE)).as_bytes())?;
    }
    if let Some(target) = &args.scorm {
        needed("--scorm")?;
        files::write(
            target,
            &zip_files(&report::package(Path::new(&args.from), args.page.language(), &|job| {
                reliability_beside(Path::new(&args.from), job)
            })?)?,
        )?;
    }
    Ok(())
}

/// Packs files into a ZIP archive; identical files produce identical archives.
fn zip_files(files: &[(&str, String)]) -> Result<Vec<u8>, AppError> {
    let write = || {
        let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
        let options = zip::write::SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Stored)
            .last_modified_time(zip::DateTime::default());
        for (name, text) in files {
            archive.start_file(*name, options)?;
            archive.write_all(text.as_bytes())?;
        }
        archive.finish().map(Cursor::into_inner)
    };
    write().map_err(|error: zip::result::ZipError| AppError::failed(format!("cannot create the package: {error}")))
}

/// Exports a session's flight as an MCAP recording.
fn recording(stored: &StoredSession) -> Result<Vec<u8>, AppError> {
    let (scenario, vehicle) = (&stored.scenario.scenario, &stored.vehicle.vehicle);
    let mut timeline = Timeline::new(LocalPlane::new(scenario.origin));
    timeline.push_log(&stored.log).map_err(|error| AppError::failed(format!("cannot read the telemetry: {error}")))?;
    let flight = scored_flight(&timeline, scenario, vehicle);
    let messages = recording::messages(&flight, scenario, vehicle);
    let Some(first) = messages.first() else {
        return Err(AppError::failed("the session contains no flight to export"));
    };
    // The geometry is the same for every seed.
    let glb = files::site_model(&Site::build(scenario, 0))?;
    let write = || {
        let mut out = McapRecording::begin(Cursor::new(Vec::new()))?;
        out.write(&foxglove::site(first.unix_ns, &mcap::base64(&glb)))?;
        messages.iter().try_for_each(|message| out.write(message))?;
        out.end().map(Cursor::into_inner)
    };
    write().map_err(|error: ::mcap::McapError| AppError::failed(format!("cannot create the recording: {error}")))
}

/// Recovers the readable part of a truncated recording.
fn recover(path: &Path, target: &str) -> Result<(), AppError> {
    let shown = path.display();
    let file = std::fs::read(path).map_err(|error| AppError::invalid(format!("{shown}: {error}")))?;
    let recovered =
        mcap::recover(&file).map_err(|error| AppError::invalid(format!("{shown}: not an MCAP recording: {error}")))?;
    let why = recovered.truncation_reason.as_deref().unwrap_or("complete");
    tracing::info!("{shown}: {} messages ({why})", recovered.messages);
    files::write(target, &recovered.bytes)
}
