//! The window and what stands behind it: a thread that listens, a thread that builds the scene, a thread that flies, the pipe to whoever
//! leads it, and the loop that draws.

mod controller_slot;
mod display;
mod flight_view;
mod frame;
mod keys;
mod listener;
mod panes;
mod picture_writer;
mod pilot;
pub mod priority;
mod screen;
pub mod secondary_renderer;
mod sound;
mod stream;
mod train_pipe;
mod window;
pub mod window_config;
mod window_text;

use crate::cli::render::size;
use crate::cli::view::Args;
use crate::errors::AppError;
use crate::io::clock;
use crate::io::controller;
use crate::io::files;
use crate::io::stop::StopRequest;
use flight_view::FlightView;
use pilot::{PilotCommand, PilotThread};
use sound::AudioOutput;
use spandrel_view::flow::{KeyNames, WindowFlow};
use std::time::Duration;
use stream::StreamSender;
use train_pipe::TrainPipe;
use window::{Cockpit, WindowThreads};

/// Longest time to the picture that can be asked for, s.
const AFTER_MAX_S: f64 = 3_600.0;

/// Opens the window and stays until it is closed.
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
        // Led, its standard output belongs to the pipe.
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
    // On Linux every thread has a niceness of its own, that of the thread which began it: sticks are sent by one that began before, pictures
    // are encoded by one that begins after.
    priority::lower_priority();
    crew.stream = match args.stream.map(|to| StreamSender::open(to, clock::unix_us())).transpose() {
        // A trainee's window is worth more than what it sends elsewhere.
        Err(error) if args.led => {
            tracing::warn!("no stream: {error}");
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
        return Err(AppError::wrong(format!("--after {after}: give seconds, 0 to {AFTER_MAX_S}")));
    }
    Ok(Some(window_config::CaptureRequest { path: path.clone(), after: Duration::from_secs_f64(after) }))
}
