//! The window and its threads: one receives telemetry, one builds the scene, one flies, and the pipe to `train` controls the window. The main loop
//! renders.

mod controller_slot;
mod display;
mod flight_view;
mod frame;
mod keys;
mod listener;
mod panes;
mod picture_writer;
mod pilot;
mod screen;
mod sound;
mod stream;
mod train_pipe;
mod window;
pub mod window_config;
mod window_text;

use super::Args;
use crate::clock;
use crate::controller;
use crate::errors::AppError;
use crate::files;
use crate::priority;
use crate::render::size;
use crate::stop::StopRequest;
use flight_view::FlightView;
use pilot::{PilotCommand, PilotThread};
use sound::AudioOutput;
use spandrel_view::flow::{KeyNames, WindowFlow};
use std::time::Duration;
use stream::StreamSender;
use train_pipe::TrainPipe;
use window::{Cockpit, WindowThreads};

/// Longest delay of a screenshot, s.
const AFTER_MAX_S: f64 = 3_600.0;

/// Opens the window and runs it until it is closed.
pub fn run(args: &Args) -> Result<(), AppError> {
    let scenario = files::scenario(&args.job.scenario)?.scenario;
    let vehicle = files::vehicle(&args.job.vehicle)?.vehicle;
    let keys = controller::keys(args.keys.as_deref())?;
    let plan = window_config::WindowConfig {
        listen: args.listen,
        quality: window_config::quality(&args.quality)?,
        size_px: size(&args.size)?,
        map: !args.no_map,
        picture: picture(args)?,
        keep: args.picture.clone(),
        // With --led, standard output belongs to the pipe.
        announce: args.announce && !args.led,
    };
    let stop = StopRequest::install(args.leash && !args.led)?;
    let mut crew = WindowThreads { pilot: None, lead: None, flight: None, stream: None };
    if args.led || args.fly.is_some() {
        crew.pilot = Some(PilotThread::start(args, keys.clone())?);
    }
    let names = KeyNames::new(keys.labels());
    let flow = if args.led {
        crew.lead = Some(TrainPipe::listen(&stop));
        WindowFlow::new(!args.no_sound, names)
    } else {
        crew.flight = Some(FlightView::begin(args.listen, args.connect, (scenario, vehicle), args.job.seed)?);
        WindowFlow::watch_only(!args.no_sound, names)
    };
    if let (Some(pilot), Some(vehicle)) = (&crew.pilot, args.fly) {
        pilot.send_command(PilotCommand::Fly(vehicle));
    }
    // On Linux, each thread inherits its nice value from the thread that starts it: the pilot thread has started before and keeps its priority, the
    // encoder starts later and gets the lower one.
    priority::lower_priority();
    crew.stream = match args.stream.map(|to| StreamSender::open(to, clock::unix_us())).transpose() {
        // The trainee's window is more important than the stream.
        Err(error) if args.led => {
            tracing::warn!("cannot stream: {error}");
            None
        }
        opened => opened?,
    };
    let speaker = AudioOutput::new(keys.sounds, !args.no_sound);
    Cockpit::new(plan, keys, flow, crew, speaker, stop).run()
}

fn picture(args: &Args) -> Result<Option<window_config::CaptureRequest>, AppError> {
    let (Some(path), Some(after)) = (&args.screenshot, args.after) else { return Ok(None) };
    if !(0.0..=AFTER_MAX_S).contains(&after) {
        return Err(AppError::wrong(format!("--after {after}: out of range (allowed: 0 to {AFTER_MAX_S} s)")));
    }
    Ok(Some(window_config::CaptureRequest { path: path.clone(), after: Duration::from_secs_f64(after) }))
}
